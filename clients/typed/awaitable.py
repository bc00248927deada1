"""Typed commands, awaitable. Written by `python -m clients.generate`; do not edit."""

# ruff: noqa
# fmt: off

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from clients import values
from clients.choices import EndOfTravel, ErrorLevel, FeedbackSource
from clients.faces import AwaitableFace
from clients.values import Number


class AxisCommands(AwaitableFace):
    """The settings, reports and actions of one axis."""

    async def get_absolute_positioning(self) -> bool:
        """Absolute/incremental positioning (`MA`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "MA", self._axis))

    async def set_absolute_positioning(self, value: bool) -> None:
        """Absolute/incremental positioning (`MA`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "MA", self._axis, value))

    async def get_acceleration(self) -> float:
        """Acceleration (`A`). Units: units/sec^2 (revs/sec^2 unscaled: counts = value*ERES). Range 0.00025 to 24999975.
        Default 10.0."""
        return await self._run(values.real(self._session, "A", self._axis))

    async def set_acceleration(self, value: Number) -> None:
        """Acceleration (`A`). Units: units/sec^2 (revs/sec^2 unscaled: counts = value*ERES). Range 0.00025 to 24999975.
        Default 10.0."""
        await self._run(values.write(self._session, "A", self._axis, value))

    async def get_acceleration_feedforward_gain(self) -> float:
        """Acceleration feedforward gain (`SGAF`). Units: microvolts/(count/sec^2). Range 0.0 to 2800000.0. Default
        0.0."""
        return await self._run(values.real(self._session, "SGAF", self._axis))

    async def set_acceleration_feedforward_gain(self, value: Number) -> None:
        """Acceleration feedforward gain (`SGAF`). Units: microvolts/(count/sec^2). Range 0.0 to 2800000.0. Default
        0.0."""
        await self._run(values.write(self._session, "SGAF", self._axis, value))

    async def get_acceleration_scale_factor(self) -> int:
        """Acceleration scale factor (`SCLA`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return await self._run(values.whole(self._session, "SCLA", self._axis))

    async def set_acceleration_scale_factor(self, value: int) -> None:
        """Acceleration scale factor (`SCLA`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        await self._run(values.write(self._session, "SCLA", self._axis, value))

    async def get_actual_velocity(self) -> float:
        """Report actual velocity (`TVELA`)."""
        return await self._run(values.real(self._session, "TVELA", self._axis))

    async def advance_by(self, value: Number) -> None:
        """Geared advance (`FGADV`). Units: slave distance (SCLD). Range -999999999.99999 to 999999999.99999."""
        await self._run(values.write(self._session, "FGADV", self._axis, value))

    async def get_analog_output(self) -> float:
        """Report analog output voltage (`TDAC`)."""
        return await self._run(values.real(self._session, "TDAC", self._axis))

    async def get_ani_polarity(self) -> bool:
        """ANI polarity (`ANIPOL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "ANIPOL", self._axis))

    async def set_ani_polarity(self, value: bool) -> None:
        """ANI polarity (`ANIPOL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "ANIPOL", self._axis, value))

    async def get_ani_position(self) -> float:
        """Report ANI position (`TPANI`)."""
        return await self._run(values.real(self._session, "TPANI", self._axis))

    async def get_ani_voltage(self) -> float:
        """Report ANI voltage (`TANI`)."""
        return await self._run(values.real(self._session, "TANI", self._axis))

    async def get_average_acceleration(self) -> float:
        """Average acceleration (S-curve) (`AA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "AA", self._axis))

    async def set_average_acceleration(self, value: Number) -> None:
        """Average acceleration (S-curve) (`AA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "AA", self._axis, value))

    async def get_average_deceleration(self) -> float:
        """Average deceleration (S-curve) (`ADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "ADA", self._axis))

    async def set_average_deceleration(self, value: Number) -> None:
        """Average deceleration (S-curve) (`ADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "ADA", self._axis, value))

    async def begin_compiled_loop(self, value: Number) -> None:
        """Begin compiled loop (`PLOOP`). Units: loop count, 0 endless. Range 0 to 999999999."""
        await self._run(values.write(self._session, "PLOOP", self._axis, value))

    async def captured_analog_input_position(self, trigger: Literal["A", "B"] = "A") -> float:
        """Report captured analog input position (`TPCA`)."""
        return await self._run(values.real(self._session, "TPCA", self._axis, trigger))

    async def captured_commanded_position(self, trigger: Literal["A", "B"] = "A") -> float:
        """Report captured commanded position (`TPCC`)."""
        return await self._run(values.real(self._session, "TPCC", self._axis, trigger))

    async def captured_encoder_position(self, trigger: Literal["A", "B"] = "A") -> float:
        """Report captured encoder position (`TPCE`)."""
        return await self._run(values.real(self._session, "TPCE", self._axis, trigger))

    async def get_commanded_direction_reversed(self) -> bool:
        """Commanded direction polarity (`CMDDIR`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "CMDDIR", self._axis))

    async def set_commanded_direction_reversed(self, value: bool) -> None:
        """Commanded direction polarity (`CMDDIR`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "CMDDIR", self._axis, value))

    async def get_commanded_position(self) -> float:
        """Report commanded position (`TPC`)."""
        return await self._run(values.real(self._session, "TPC", self._axis))

    async def get_commanded_velocity(self) -> float:
        """Report commanded velocity (`TVEL`)."""
        return await self._run(values.real(self._session, "TVEL", self._axis))

    async def get_continuous_motion(self) -> bool:
        """Preset/continuous move mode (`MC`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "MC", self._axis))

    async def set_continuous_motion(self, value: bool) -> None:
        """Preset/continuous move mode (`MC`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "MC", self._axis, value))

    async def get_deceleration(self) -> float:
        """Deceleration (`AD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "AD", self._axis))

    async def set_deceleration(self, value: Number) -> None:
        """Deceleration (`AD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "AD", self._axis, value))

    async def get_distance(self) -> float:
        """Distance / destination (`D`). Units: distance units (encoder counts unscaled). Range -999999999.99999 to
        999999999.99999. Default 4000."""
        return await self._run(values.real(self._session, "D", self._axis))

    async def set_distance(self, value: Number) -> None:
        """Distance / destination (`D`). Units: distance units (encoder counts unscaled). Range -999999999.99999 to
        999999999.99999. Default 4000."""
        await self._run(values.write(self._session, "D", self._axis, value))

    async def get_distance_scale_factor(self) -> int:
        """Distance scale factor (`SCLD`). Units: counts/unit. Range 1 to 999999. Default 1."""
        return await self._run(values.whole(self._session, "SCLD", self._axis))

    async def set_distance_scale_factor(self, value: int) -> None:
        """Distance scale factor (`SCLD`). Units: counts/unit. Range 1 to 999999. Default 1."""
        await self._run(values.write(self._session, "SCLD", self._axis, value))

    async def get_dither_amplitude(self) -> float:
        """Dither amplitude (`SDTAMP`). Units: volts. Range 0.0 to 10.0. Default 0.0."""
        return await self._run(values.real(self._session, "SDTAMP", self._axis))

    async def set_dither_amplitude(self, value: Number) -> None:
        """Dither amplitude (`SDTAMP`). Units: volts. Range 0.0 to 10.0. Default 0.0."""
        await self._run(values.write(self._session, "SDTAMP", self._axis, value))

    async def get_dither_frequency_ratio(self) -> int:
        """Dither frequency ratio (`SDTFR`). Range 0 to 99. Default 0."""
        return await self._run(values.whole(self._session, "SDTFR", self._axis))

    async def set_dither_frequency_ratio(self, value: int) -> None:
        """Dither frequency ratio (`SDTFR`). Range 0 to 99. Default 0."""
        await self._run(values.write(self._session, "SDTFR", self._axis, value))

    async def get_drive_enabled(self) -> bool:
        """Drive shutdown control (`DRIVE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "DRIVE", self._axis))

    async def set_drive_enabled(self, value: bool) -> None:
        """Drive shutdown control (`DRIVE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "DRIVE", self._axis, value))

    async def get_drive_fault_active_high(self) -> bool:
        """Drive fault input active level (`DRFLVL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "DRFLVL", self._axis))

    async def set_drive_fault_active_high(self, value: bool) -> None:
        """Drive fault input active level (`DRFLVL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "DRFLVL", self._axis, value))

    async def get_drive_off_on_kill(self) -> bool:
        """Disable drive on kill (`KDRIVE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "KDRIVE", self._axis))

    async def set_drive_off_on_kill(self, value: bool) -> None:
        """Disable drive on kill (`KDRIVE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "KDRIVE", self._axis, value))

    async def get_encoder_resolution(self) -> int:
        """Encoder resolution (`ERES`). Units: counts/rev (after 4x decode). Range 1 to 65535. Default 4000."""
        return await self._run(values.whole(self._session, "ERES", self._axis))

    async def set_encoder_resolution(self, value: int) -> None:
        """Encoder resolution (`ERES`). Units: counts/rev (after 4x decode). Range 1 to 65535. Default 4000."""
        await self._run(values.write(self._session, "ERES", self._axis, value))

    async def get_encoder_reversed(self) -> bool:
        """Encoder polarity (`ENCPOL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "ENCPOL", self._axis))

    async def set_encoder_reversed(self, value: bool) -> None:
        """Encoder polarity (`ENCPOL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "ENCPOL", self._axis, value))

    async def end_compiled_loop(self) -> None:
        """End compiled loop (`PLN`). Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "PLN", self._axis))

    async def get_extended_status_text(self) -> tuple[str, ...]:
        """Report extended axis status as text (`TASXF`)."""
        return await self._run(values.lines_of(self._session, "TASXF", self._axis))

    async def get_feedback_position(self) -> float:
        """Report selected feedback position (`TFB`)."""
        return await self._run(values.real(self._session, "TFB", self._axis))

    async def get_feedback_source(self) -> FeedbackSource:
        """Select servo feedback source (`SFB`). Range 0 to 2. Default 1."""
        return await self._run(values.choice(self._session, "SFB", self._axis, FeedbackSource))

    async def set_feedback_source(self, value: FeedbackSource) -> None:
        """Select servo feedback source (`SFB`). Range 0 to 2. Default 1."""
        await self._run(values.write(self._session, "SFB", self._axis, value))

    async def get_final_home_velocity(self) -> float:
        """Final home velocity (`HOMVF`). Units: units/sec. Range 0.0 to 200.0. Default 0.1."""
        return await self._run(values.real(self._session, "HOMVF", self._axis))

    async def set_final_home_velocity(self, value: Number) -> None:
        """Final home velocity (`HOMVF`). Units: units/sec. Range 0.0 to 200.0. Default 0.1."""
        await self._run(values.write(self._session, "HOMVF", self._axis, value))

    async def get_final_ratio_numerator(self) -> float:
        """Final ratio numerator (`FOLRNF`). Units: slave distance. Range 0.0 to 999999999.99999. Default 0."""
        return await self._run(values.real(self._session, "FOLRNF", self._axis))

    async def set_final_ratio_numerator(self, value: Number) -> None:
        """Final ratio numerator (`FOLRNF`). Units: slave distance. Range 0.0 to 999999999.99999. Default 0."""
        await self._run(values.write(self._session, "FOLRNF", self._axis, value))

    async def get_final_velocity_of_compiled_segment(self) -> float:
        """Final velocity of compiled segment (`VF`). Units: units/sec. Range 0 to 200.0. Default 0."""
        return await self._run(values.real(self._session, "VF", self._axis))

    async def set_final_velocity_of_compiled_segment(self, value: Number) -> None:
        """Final velocity of compiled segment (`VF`). Units: units/sec. Range 0 to 200.0. Default 0."""
        await self._run(values.write(self._session, "VF", self._axis, value))

    async def get_following_enabled(self) -> bool:
        """Following mode enable (`FOLEN`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "FOLEN", self._axis))

    async def set_following_enabled(self, value: bool) -> None:
        """Following mode enable (`FOLEN`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "FOLEN", self._axis, value))

    async def get_following_filter(self) -> int:
        """Following filter (`FFILT`). Range 0 to 4. Default 0."""
        return await self._run(values.whole(self._session, "FFILT", self._axis))

    async def set_following_filter(self, value: int) -> None:
        """Following filter (`FFILT`). Range 0 to 4. Default 0."""
        await self._run(values.write(self._session, "FFILT", self._axis, value))

    async def get_following_kill(self) -> bool:
        """Following kill (`FOLK`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "FOLK", self._axis))

    async def set_following_kill(self, value: bool) -> None:
        """Following kill (`FOLK`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "FOLK", self._axis, value))

    async def get_following_status_text(self) -> tuple[str, ...]:
        """Report Following status as text (`TFSF`)."""
        return await self._run(values.lines_of(self._session, "TFSF", self._axis))

    async def go(self) -> None:
        """Start motion (`GO`). Values: 1 go, 0 or X no effect."""
        await self._run(values.write(self._session, "GO", self._axis))

    async def go_linear(self) -> None:
        """Start linear interpolated move (`GOL`)."""
        await self._run(values.write(self._session, "GOL", self._axis))

    async def get_hard_limit_average_deceleration(self) -> float:
        """Hard limit average deceleration (`LHADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return await self._run(values.real(self._session, "LHADA", self._axis))

    async def set_hard_limit_average_deceleration(self, value: Number) -> None:
        """Hard limit average deceleration (`LHADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        await self._run(values.write(self._session, "LHADA", self._axis, value))

    async def get_hard_limit_deceleration(self) -> float:
        """Hard limit deceleration (`LHAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return await self._run(values.real(self._session, "LHAD", self._axis))

    async def set_hard_limit_deceleration(self, value: Number) -> None:
        """Hard limit deceleration (`LHAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        await self._run(values.write(self._session, "LHAD", self._axis, value))

    async def get_hard_limits(self) -> EndOfTravel:
        """Hardware end-of-travel limit enable (`LH`). Range 0 to 3. Default 3."""
        return await self._run(values.choice(self._session, "LH", self._axis, EndOfTravel))

    async def set_hard_limits(self, value: EndOfTravel) -> None:
        """Hardware end-of-travel limit enable (`LH`). Range 0 to 3. Default 3."""
        await self._run(values.write(self._session, "LH", self._axis, value))

    async def get_home_acceleration(self) -> float:
        """Home acceleration (`HOMA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "HOMA", self._axis))

    async def set_home_acceleration(self, value: Number) -> None:
        """Home acceleration (`HOMA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "HOMA", self._axis, value))

    async def get_home_average_acceleration(self) -> float:
        """Home average acceleration (`HOMAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "HOMAA", self._axis))

    async def set_home_average_acceleration(self, value: Number) -> None:
        """Home average acceleration (`HOMAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "HOMAA", self._axis, value))

    async def get_home_average_deceleration(self) -> float:
        """Home average deceleration (`HOMADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "HOMADA", self._axis))

    async def set_home_average_deceleration(self, value: Number) -> None:
        """Home average deceleration (`HOMADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "HOMADA", self._axis, value))

    async def get_home_backs_up(self) -> bool:
        """Back up to home (`HOMBAC`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "HOMBAC", self._axis))

    async def set_home_backs_up(self, value: bool) -> None:
        """Back up to home (`HOMBAC`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "HOMBAC", self._axis, value))

    async def get_home_deceleration(self) -> float:
        """Home deceleration (`HOMAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "HOMAD", self._axis))

    async def set_home_deceleration(self, value: Number) -> None:
        """Home deceleration (`HOMAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "HOMAD", self._axis, value))

    async def get_home_edge_negative(self) -> bool:
        """Home reference edge (`HOMEDG`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "HOMEDG", self._axis))

    async def set_home_edge_negative(self, value: bool) -> None:
        """Home reference edge (`HOMEDG`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "HOMEDG", self._axis, value))

    async def get_home_final_direction_negative(self) -> bool:
        """Final home direction (`HOMDF`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "HOMDF", self._axis))

    async def set_home_final_direction_negative(self, value: bool) -> None:
        """Final home direction (`HOMDF`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "HOMDF", self._axis, value))

    async def get_home_input_active_high(self) -> bool:
        """Home input active level (`HOMLVL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "HOMLVL", self._axis))

    async def set_home_input_active_high(self, value: bool) -> None:
        """Home input active level (`HOMLVL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "HOMLVL", self._axis, value))

    async def get_home_to_z_channel(self) -> bool:
        """Home to encoder Z (`HOMZ`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "HOMZ", self._axis))

    async def set_home_to_z_channel(self, value: bool) -> None:
        """Home to encoder Z (`HOMZ`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "HOMZ", self._axis, value))

    async def get_home_velocity(self) -> float:
        """Home velocity (`HOMV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return await self._run(values.real(self._session, "HOMV", self._axis))

    async def set_home_velocity(self, value: Number) -> None:
        """Home velocity (`HOMV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        await self._run(values.write(self._session, "HOMV", self._axis, value))

    async def get_initial_master_cycle_position(self) -> float:
        """Initial master cycle position (`FMCP`). Units: master distance (SCLMAS). Range -999999999.0 to 999999999.0.
        Default 0."""
        return await self._run(values.real(self._session, "FMCP", self._axis))

    async def set_initial_master_cycle_position(self, value: Number) -> None:
        """Initial master cycle position (`FMCP`). Units: master distance (SCLMAS). Range -999999999.0 to 999999999.0.
        Default 0."""
        await self._run(values.write(self._session, "FMCP", self._axis, value))

    async def get_integral_feedback_gain(self) -> float:
        """Integral feedback gain (`SGI`). Units: millivolts/(count*sec). Range 0.0 to 2800000.0. Default 0.0."""
        return await self._run(values.real(self._session, "SGI", self._axis))

    async def set_integral_feedback_gain(self, value: Number) -> None:
        """Integral feedback gain (`SGI`). Units: millivolts/(count*sec). Range 0.0 to 2800000.0. Default 0.0."""
        await self._run(values.write(self._session, "SGI", self._axis, value))

    async def get_integral_limit(self) -> float:
        """Integral windup limit (`SGILIM`). Units: volts. Range 0 to 200. Default 200."""
        return await self._run(values.real(self._session, "SGILIM", self._axis))

    async def set_integral_limit(self, value: Number) -> None:
        """Integral windup limit (`SGILIM`). Units: volts. Range 0 to 200. Default 200."""
        await self._run(values.write(self._session, "SGILIM", self._axis, value))

    async def get_jog_acceleration(self) -> float:
        """Jog acceleration (`JOGA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOGA", self._axis))

    async def set_jog_acceleration(self, value: Number) -> None:
        """Jog acceleration (`JOGA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOGA", self._axis, value))

    async def get_jog_average_acceleration(self) -> float:
        """Jog average acceleration (`JOGAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOGAA", self._axis))

    async def set_jog_average_acceleration(self, value: Number) -> None:
        """Jog average acceleration (`JOGAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOGAA", self._axis, value))

    async def get_jog_average_deceleration(self) -> float:
        """Jog average deceleration (`JOGADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOGADA", self._axis))

    async def set_jog_average_deceleration(self, value: Number) -> None:
        """Jog average deceleration (`JOGADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOGADA", self._axis, value))

    async def get_jog_deceleration(self) -> float:
        """Jog deceleration (`JOGAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOGAD", self._axis))

    async def set_jog_deceleration(self, value: Number) -> None:
        """Jog deceleration (`JOGAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOGAD", self._axis, value))

    async def get_jog_high_velocity(self) -> float:
        """Jog high velocity (`JOGVH`). Units: units/sec. Range 0.0 to 200.0. Default 10.0."""
        return await self._run(values.real(self._session, "JOGVH", self._axis))

    async def set_jog_high_velocity(self, value: Number) -> None:
        """Jog high velocity (`JOGVH`). Units: units/sec. Range 0.0 to 200.0. Default 10.0."""
        await self._run(values.write(self._session, "JOGVH", self._axis, value))

    async def get_jog_low_velocity(self) -> float:
        """Jog low velocity (`JOGVL`). Units: units/sec. Range 0.0 to 200.0. Default 0.5."""
        return await self._run(values.real(self._session, "JOGVL", self._axis))

    async def set_jog_low_velocity(self, value: Number) -> None:
        """Jog low velocity (`JOGVL`). Units: units/sec. Range 0.0 to 200.0. Default 0.5."""
        await self._run(values.write(self._session, "JOGVL", self._axis, value))

    async def get_jog_mode(self) -> bool:
        """Jog mode enable (`JOG`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "JOG", self._axis))

    async def set_jog_mode(self, value: bool) -> None:
        """Jog mode enable (`JOG`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "JOG", self._axis, value))

    async def get_joystick_acceleration(self) -> float:
        """Joystick acceleration (`JOYA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOYA", self._axis))

    async def set_joystick_acceleration(self, value: Number) -> None:
        """Joystick acceleration (`JOYA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOYA", self._axis, value))

    async def get_joystick_analog_channel_select_high(self) -> int:
        """Joystick analog channel, select high (`JOYAXH`). Range 0 to 3. Default 0."""
        return await self._run(values.whole(self._session, "JOYAXH", self._axis))

    async def set_joystick_analog_channel_select_high(self, value: int) -> None:
        """Joystick analog channel, select high (`JOYAXH`). Range 0 to 3. Default 0."""
        await self._run(values.write(self._session, "JOYAXH", self._axis, value))

    async def get_joystick_analog_channel_select_low(self) -> int:
        """Joystick analog channel, select low (`JOYAXL`). Range 0 to 3. Default 0."""
        return await self._run(values.whole(self._session, "JOYAXL", self._axis))

    async def set_joystick_analog_channel_select_low(self, value: int) -> None:
        """Joystick analog channel, select low (`JOYAXL`). Range 0 to 3. Default 0."""
        await self._run(values.write(self._session, "JOYAXL", self._axis, value))

    async def get_joystick_average_acceleration(self) -> float:
        """Joystick average acceleration (`JOYAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOYAA", self._axis))

    async def set_joystick_average_acceleration(self, value: Number) -> None:
        """Joystick average acceleration (`JOYAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOYAA", self._axis, value))

    async def get_joystick_average_deceleration(self) -> float:
        """Joystick average deceleration (`JOYADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOYADA", self._axis))

    async def set_joystick_average_deceleration(self, value: Number) -> None:
        """Joystick average deceleration (`JOYADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOYADA", self._axis, value))

    async def get_joystick_deceleration(self) -> float:
        """Joystick deceleration (`JOYAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "JOYAD", self._axis))

    async def set_joystick_deceleration(self, value: Number) -> None:
        """Joystick deceleration (`JOYAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "JOYAD", self._axis, value))

    async def get_joystick_high_velocity(self) -> float:
        """Joystick high velocity (`JOYVH`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return await self._run(values.real(self._session, "JOYVH", self._axis))

    async def set_joystick_high_velocity(self, value: Number) -> None:
        """Joystick high velocity (`JOYVH`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        await self._run(values.write(self._session, "JOYVH", self._axis, value))

    async def get_joystick_low_velocity(self) -> float:
        """Joystick low velocity (`JOYVL`). Units: units/sec. Range 0.0 to 200.0. Default 0.2."""
        return await self._run(values.real(self._session, "JOYVL", self._axis))

    async def set_joystick_low_velocity(self, value: Number) -> None:
        """Joystick low velocity (`JOYVL`). Units: units/sec. Range 0.0 to 200.0. Default 0.2."""
        await self._run(values.write(self._session, "JOYVL", self._axis, value))

    async def get_joystick_mode(self) -> bool:
        """Joystick mode enable (`JOY`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "JOY", self._axis))

    async def set_joystick_mode(self, value: bool) -> None:
        """Joystick mode enable (`JOY`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "JOY", self._axis, value))

    async def get_keep_buffer_on_limit(self) -> bool:
        """Keep buffer on limit (`COMEXL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "COMEXL", self._axis))

    async def set_keep_buffer_on_limit(self, value: bool) -> None:
        """Keep buffer on limit (`COMEXL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "COMEXL", self._axis, value))

    async def kill_motion(self) -> None:
        """Kill motion (`K`)."""
        await self._run(values.write(self._session, "K", self._axis))

    async def get_master(self) -> int:
        """Assign master to slave axis (`FOLMAS`). Units: sign, master axis number, source digit. Default +0."""
        return await self._run(values.whole(self._session, "FOLMAS", self._axis))

    async def set_master(self, value: int) -> None:
        """Assign master to slave axis (`FOLMAS`). Units: sign, master axis number, source digit. Default +0."""
        await self._run(values.write(self._session, "FOLMAS", self._axis, value))

    async def get_master_cycle_length(self) -> float:
        """Master cycle length (`FMCLEN`). Units: master distance (SCLMAS). Range 0.0 to 999999999.0. Default 0."""
        return await self._run(values.real(self._session, "FMCLEN", self._axis))

    async def set_master_cycle_length(self, value: Number) -> None:
        """Master cycle length (`FMCLEN`). Units: master distance (SCLMAS). Range 0.0 to 999999999.0. Default 0."""
        await self._run(values.write(self._session, "FMCLEN", self._axis, value))

    async def get_master_cycle_number(self) -> int:
        """Report master cycle number (`TNMCY`)."""
        return await self._run(values.whole(self._session, "TNMCY", self._axis))

    async def get_master_cycle_position(self) -> float:
        """Report master cycle position (`TPMAS`)."""
        return await self._run(values.real(self._session, "TPMAS", self._axis))

    async def get_master_distance(self) -> float:
        """Master distance (`FOLMD`). Units: master distance (SCLMAS). Range 0 to 999999999. Default 0."""
        return await self._run(values.real(self._session, "FOLMD", self._axis))

    async def set_master_distance(self, value: Number) -> None:
        """Master distance (`FOLMD`). Units: master distance (SCLMAS). Range 0 to 999999999. Default 0."""
        await self._run(values.write(self._session, "FOLMD", self._axis, value))

    async def get_master_prediction_enabled(self) -> bool:
        """Master position prediction enable (`FPPEN`). Default 1. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "FPPEN", self._axis))

    async def set_master_prediction_enabled(self, value: bool) -> None:
        """Master position prediction enable (`FPPEN`). Default 1. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "FPPEN", self._axis, value))

    async def get_master_scale_factor(self) -> int:
        """Master scale factor (`SCLMAS`). Units: counts/unit. Range 1 to 999999. Default 1."""
        return await self._run(values.whole(self._session, "SCLMAS", self._axis))

    async def set_master_scale_factor(self, value: int) -> None:
        """Master scale factor (`SCLMAS`). Units: counts/unit. Range 1 to 999999. Default 1."""
        await self._run(values.write(self._session, "SCLMAS", self._axis, value))

    async def get_master_velocity(self) -> float:
        """Report master velocity (`TVMAS`)."""
        return await self._run(values.real(self._session, "TVMAS", self._axis))

    async def get_maximum_position_error(self) -> float:
        """Maximum allowable position error (`SMPER`). Units: feedback counts (scaled by SCLD). Range 0 to 200000000.
        Default 4000."""
        return await self._run(values.real(self._session, "SMPER", self._axis))

    async def set_maximum_position_error(self, value: Number) -> None:
        """Maximum allowable position error (`SMPER`). Units: feedback counts (scaled by SCLD). Range 0 to 200000000.
        Default 4000."""
        await self._run(values.write(self._session, "SMPER", self._axis, value))

    async def get_motor_position(self) -> float:
        """Report motor position (stepper report, answered for hosts) (`TPM`)."""
        return await self._run(values.real(self._session, "TPM", self._axis))

    async def get_negative_soft_limit(self) -> float:
        """Negative software limit (`LSNEG`). Units: distance units (SCLD). Range -999999999.99999 to 999999999.99999.
        Default 0."""
        return await self._run(values.real(self._session, "LSNEG", self._axis))

    async def set_negative_soft_limit(self, value: Number) -> None:
        """Negative software limit (`LSNEG`). Units: distance units (SCLD). Range -999999999.99999 to 999999999.99999.
        Default 0."""
        await self._run(values.write(self._session, "LSNEG", self._axis, value))

    async def get_net_shift(self) -> float:
        """Report net shift (`TPSHF`)."""
        return await self._run(values.real(self._session, "TPSHF", self._axis))

    async def get_output_limit(self) -> float:
        """Analog output limit (`DACLIM`). Units: volts. Range 0.0 to 10.0. Default 10.0."""
        return await self._run(values.real(self._session, "DACLIM", self._axis))

    async def set_output_limit(self, value: Number) -> None:
        """Analog output limit (`DACLIM`). Units: volts. Range 0.0 to 10.0. Default 10.0."""
        await self._run(values.write(self._session, "DACLIM", self._axis, value))

    async def get_output_offset(self) -> float:
        """Servo output offset (`SOFFS`). Units: volts. Range -10.0 to 10.0. Default 0.0."""
        return await self._run(values.real(self._session, "SOFFS", self._axis))

    async def set_output_offset(self, value: Number) -> None:
        """Servo output offset (`SOFFS`). Units: volts. Range -10.0 to 10.0. Default 0.0."""
        await self._run(values.write(self._session, "SOFFS", self._axis, value))

    async def get_position(self) -> float:
        """Report encoder position (`TPE`)."""
        return await self._run(values.real(self._session, "TPE", self._axis))

    async def get_position_error(self) -> float:
        """Report position error (`TPER`)."""
        return await self._run(values.real(self._session, "TPER", self._axis))

    async def get_positive_soft_limit(self) -> float:
        """Positive software limit (`LSPOS`). Units: distance units (SCLD). Range -999999999.99999 to 999999999.99999.
        Default 0."""
        return await self._run(values.real(self._session, "LSPOS", self._axis))

    async def set_positive_soft_limit(self, value: Number) -> None:
        """Positive software limit (`LSPOS`). Units: distance units (SCLD). Range -999999999.99999 to 999999999.99999.
        Default 0."""
        await self._run(values.write(self._session, "LSPOS", self._axis, value))

    async def get_proportional_feedback_gain(self) -> float:
        """Proportional feedback gain (`SGP`). Units: millivolts/count (6000 text: millivolts/step). Range 0.0 to
        2800000.0. Default 0.5."""
        return await self._run(values.real(self._session, "SGP", self._axis))

    async def set_proportional_feedback_gain(self, value: Number) -> None:
        """Proportional feedback gain (`SGP`). Units: millivolts/count (6000 text: millivolts/step). Range 0.0 to
        2800000.0. Default 0.5."""
        await self._run(values.write(self._session, "SGP", self._axis, value))

    async def get_ratio_denominator(self) -> float:
        """Slave-to-master ratio denominator (`FOLRD`). Units: master distance (SCLMAS). Range 1.0 to 999999999. Default
        1."""
        return await self._run(values.real(self._session, "FOLRD", self._axis))

    async def set_ratio_denominator(self, value: Number) -> None:
        """Slave-to-master ratio denominator (`FOLRD`). Units: master distance (SCLMAS). Range 1.0 to 999999999. Default
        1."""
        await self._run(values.write(self._session, "FOLRD", self._axis, value))

    async def get_ratio_numerator(self) -> float:
        """Slave-to-master ratio numerator (`FOLRN`). Units: slave distance (SCLD). Range 0.0 to 999999999.99999.
        Default 1."""
        return await self._run(values.real(self._session, "FOLRN", self._axis))

    async def set_ratio_numerator(self, value: Number) -> None:
        """Slave-to-master ratio numerator (`FOLRN`). Units: slave distance (SCLD). Range 0.0 to 999999999.99999.
        Default 1."""
        await self._run(values.write(self._session, "FOLRN", self._axis, value))

    async def get_registration_distance_for_trigger_a(self) -> float:
        """Registration distance for trigger A (`REGA`). Units: distance units (SCLD). Range 0 to 999999999.99999.
        Default 0."""
        return await self._run(values.real(self._session, "REGA", self._axis))

    async def set_registration_distance_for_trigger_a(self, value: Number) -> None:
        """Registration distance for trigger A (`REGA`). Units: distance units (SCLD). Range 0 to 999999999.99999.
        Default 0."""
        await self._run(values.write(self._session, "REGA", self._axis, value))

    async def get_registration_distance_for_trigger_b(self) -> float:
        """Registration distance for trigger B (`REGB`). Units: distance units (SCLD). Range 0 to 999999999.99999.
        Default 0."""
        return await self._run(values.real(self._session, "REGB", self._axis))

    async def set_registration_distance_for_trigger_b(self, value: Number) -> None:
        """Registration distance for trigger B (`REGB`). Units: distance units (SCLD). Range 0 to 999999999.99999.
        Default 0."""
        await self._run(values.write(self._session, "REGB", self._axis, value))

    async def get_registration_enabled(self) -> bool:
        """Registration enable (`RE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "RE", self._axis))

    async def set_registration_enabled(self, value: bool) -> None:
        """Registration enable (`RE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "RE", self._axis, value))

    async def get_registration_lockout(self) -> float:
        """Registration lockout distance (`REGLOD`). Units: distance units (SCLD). Range 0 to 999999999.99999. Default
        0."""
        return await self._run(values.real(self._session, "REGLOD", self._axis))

    async def set_registration_lockout(self, value: Number) -> None:
        """Registration lockout distance (`REGLOD`). Units: distance units (SCLD). Range 0 to 999999999.99999. Default
        0."""
        await self._run(values.write(self._session, "REGLOD", self._axis, value))

    async def get_registration_single_shot(self) -> bool:
        """Registration single shot (`REGSS`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "REGSS", self._axis))

    async def set_registration_single_shot(self, value: bool) -> None:
        """Registration single shot (`REGSS`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "REGSS", self._axis, value))

    async def restart_master_cycle(self) -> None:
        """Restart master cycle counting (`FMCNEW`). Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "FMCNEW", self._axis))

    async def set_position(self, value: Number) -> None:
        """Establish absolute position (`PSET`). Units: distance units. Range -999999999.99999 to 999999999.99999."""
        await self._run(values.write(self._session, "PSET", self._axis, value))

    async def get_settling_time(self) -> int:
        """Report settling time (`TSTLT`)."""
        return await self._run(values.whole(self._session, "TSTLT", self._axis))

    async def shift_by(self, value: Number) -> None:
        """Preset following shift (`FSHFD`). Units: slave distance (SCLD). Range -999999999.99999 to 999999999.99999."""
        await self._run(values.write(self._session, "FSHFD", self._axis, value))

    async def shift_continuously(self, value: Number) -> None:
        """Continuous following shift (`FSHFC`). Range 0 to 3."""
        await self._run(values.write(self._session, "FSHFC", self._axis, value))

    async def get_slave_position(self) -> float:
        """Report slave position (`TPSLV`)."""
        return await self._run(values.real(self._session, "TPSLV", self._axis))

    async def get_soft_limit_average_deceleration(self) -> float:
        """Soft limit average deceleration (`LSADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return await self._run(values.real(self._session, "LSADA", self._axis))

    async def set_soft_limit_average_deceleration(self, value: Number) -> None:
        """Soft limit average deceleration (`LSADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        await self._run(values.write(self._session, "LSADA", self._axis, value))

    async def get_soft_limit_deceleration(self) -> float:
        """Soft limit deceleration (`LSAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return await self._run(values.real(self._session, "LSAD", self._axis))

    async def set_soft_limit_deceleration(self, value: Number) -> None:
        """Soft limit deceleration (`LSAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        await self._run(values.write(self._session, "LSAD", self._axis, value))

    async def get_soft_limits(self) -> EndOfTravel:
        """Software end-of-travel limit enable (`LS`). Range 0 to 3. Default 0."""
        return await self._run(values.choice(self._session, "LS", self._axis, EndOfTravel))

    async def set_soft_limits(self, value: EndOfTravel) -> None:
        """Software end-of-travel limit enable (`LS`). Range 0 to 3. Default 0."""
        await self._run(values.write(self._session, "LS", self._axis, value))

    async def start_homing(self, *, negative: bool) -> None:
        """Start homing (`HOM`). Values: 0 start in positive direction, 1 start in negative direction, X do not home."""
        await self._run(values.write(self._session, "HOM", self._axis, "1" if negative else "0"))

    async def get_status_text(self) -> tuple[str, ...]:
        """Report axis status as text (`TASF`)."""
        return await self._run(values.lines_of(self._session, "TASF", self._axis))

    async def stop_motion(self) -> None:
        """Stop motion (`S`)."""
        await self._run(values.write(self._session, "S", self._axis))

    async def store_compiled_move_segment(self) -> None:
        """Store compiled move segment (`GOBUF`). Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "GOBUF", self._axis))

    async def get_target_zone_distance(self) -> float:
        """Target distance zone (`STRGTD`). Units: feedback counts (scaled by SCLD). Range 0 to 999999999. Default
        50."""
        return await self._run(values.real(self._session, "STRGTD", self._axis))

    async def set_target_zone_distance(self, value: Number) -> None:
        """Target distance zone (`STRGTD`). Units: feedback counts (scaled by SCLD). Range 0 to 999999999. Default
        50."""
        await self._run(values.write(self._session, "STRGTD", self._axis, value))

    async def get_target_zone_enabled(self) -> bool:
        """Enable target zone settling (`STRGTE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return await self._run(values.flag(self._session, "STRGTE", self._axis))

    async def set_target_zone_enabled(self, value: bool) -> None:
        """Enable target zone settling (`STRGTE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        await self._run(values.write(self._session, "STRGTE", self._axis, value))

    async def get_target_zone_timeout(self) -> int:
        """Target settling time-out (`STRGTT`). Units: milliseconds. Range 0 to 5000. Default 1000."""
        return await self._run(values.whole(self._session, "STRGTT", self._axis))

    async def set_target_zone_timeout(self, value: int) -> None:
        """Target settling time-out (`STRGTT`). Units: milliseconds. Range 0 to 5000. Default 1000."""
        await self._run(values.write(self._session, "STRGTT", self._axis, value))

    async def get_target_zone_velocity(self) -> float:
        """Target velocity zone (`STRGTV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return await self._run(values.real(self._session, "STRGTV", self._axis))

    async def set_target_zone_velocity(self, value: Number) -> None:
        """Target velocity zone (`STRGTV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        await self._run(values.write(self._session, "STRGTV", self._axis, value))

    async def use_gain_set(self, value: Number) -> None:
        """Enable servo gain set (`SGENB`). Units: gain set number. Range 1 to 5."""
        await self._run(values.write(self._session, "SGENB", self._axis, value))

    async def get_velocity(self) -> float:
        """Velocity (`V`). Units: units/sec (revs/sec unscaled). Range 0.0 to 200.0. Default 1.0."""
        return await self._run(values.real(self._session, "V", self._axis))

    async def set_velocity(self, value: Number) -> None:
        """Velocity (`V`). Units: units/sec (revs/sec unscaled). Range 0.0 to 200.0. Default 1.0."""
        await self._run(values.write(self._session, "V", self._axis, value))

    async def get_velocity_feedback_gain(self) -> float:
        """Velocity feedback gain (`SGV`). Units: microvolts/(count/sec). Range 0.0 to 2800000.0. Default 0.0."""
        return await self._run(values.real(self._session, "SGV", self._axis))

    async def set_velocity_feedback_gain(self, value: Number) -> None:
        """Velocity feedback gain (`SGV`). Units: microvolts/(count/sec). Range 0.0 to 2800000.0. Default 0.0."""
        await self._run(values.write(self._session, "SGV", self._axis, value))

    async def get_velocity_feedforward_gain(self) -> float:
        """Velocity feedforward gain (`SGVF`). Units: microvolts/(count/sec). Range 0.0 to 2800000.0. Default 0.0."""
        return await self._run(values.real(self._session, "SGVF", self._axis))

    async def set_velocity_feedforward_gain(self, value: Number) -> None:
        """Velocity feedforward gain (`SGVF`). Units: microvolts/(count/sec). Range 0.0 to 2800000.0. Default 0.0."""
        await self._run(values.write(self._session, "SGVF", self._axis, value))

    async def get_velocity_scale_factor(self) -> int:
        """Velocity scale factor (`SCLV`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return await self._run(values.whole(self._session, "SCLV", self._axis))

    async def set_velocity_scale_factor(self, value: int) -> None:
        """Velocity scale factor (`SCLV`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        await self._run(values.write(self._session, "SCLV", self._axis, value))


class UnitSettings(AwaitableFace):
    """The settings of the whole unit."""

    async def get_analog_override_enabled(self) -> str:
        """Enable analog override (`ANVOEN`). Default 0."""
        return await self._run(values.bits(self._session, "ANVOEN", self._axis))

    async def set_analog_override_enabled(self, value: str) -> None:
        """Enable analog override (`ANVOEN`). Default 0."""
        await self._run(values.write(self._session, "ANVOEN", self._axis, value))

    async def get_axes_in_use(self) -> int:
        """Participating axes (`INDAX`). Range 1 to 2. Default 2."""
        return await self._run(values.whole(self._session, "INDAX", self._axis))

    async def set_axes_in_use(self, value: int) -> None:
        """Participating axes (`INDAX`). Range 1 to 2. Default 2."""
        await self._run(values.write(self._session, "INDAX", self._axis, value))

    async def get_beginning_of_transmission_characters(self) -> tuple[int, ...]:
        """Beginning-of-transmission characters (`BOT`). Range 0 to 256. Default 0,0,0."""
        return await self._run(values.wholes(self._session, "BOT", self._axis))

    async def set_beginning_of_transmission_characters(self, value: Sequence[int]) -> None:
        """Beginning-of-transmission characters (`BOT`). Range 0 to 256. Default 0,0,0."""
        await self._run(values.write(self._session, "BOT", self._axis, *value))

    async def get_condition_inputs(self) -> str:
        """On input condition (`ONIN`). Default X. Values: 0,1,X."""
        return await self._run(values.bits(self._session, "ONIN", self._axis))

    async def set_condition_inputs(self, value: str) -> None:
        """On input condition (`ONIN`). Default X. Values: 0,1,X."""
        await self._run(values.write(self._session, "ONIN", self._axis, value))

    async def get_condition_program(self) -> str:
        """ON condition program (`ONP`)."""
        return await self._run(values.text_of(self._session, "ONP", self._axis))

    async def set_condition_program(self, value: str) -> None:
        """ON condition program (`ONP`)."""
        await self._run(values.write(self._session, "ONP", self._axis, value))

    async def get_condition_user_status(self) -> str:
        """On user status condition (`ONUS`). Default X. Values: 0,1,X."""
        return await self._run(values.bits(self._session, "ONUS", self._axis))

    async def set_condition_user_status(self, value: str) -> None:
        """On user status condition (`ONUS`). Default X. Values: 0,1,X."""
        await self._run(values.write(self._session, "ONUS", self._axis, value))

    async def get_conditions_enabled(self) -> str:
        """Enable ON conditions (`ONCOND`). Default 0."""
        return await self._run(values.bits(self._session, "ONCOND", self._axis))

    async def set_conditions_enabled(self, value: str) -> None:
        """Enable ON conditions (`ONCOND`). Default 0."""
        await self._run(values.write(self._session, "ONCOND", self._axis, value))

    async def get_continuous_command_execution(self) -> bool:
        """Continuous command processing (`COMEXC`). Default 0."""
        return await self._run(values.flag(self._session, "COMEXC", self._axis))

    async def set_continuous_command_execution(self, value: bool) -> None:
        """Continuous command processing (`COMEXC`). Default 0."""
        await self._run(values.write(self._session, "COMEXC", self._axis, value))

    async def get_data_program_size(self) -> tuple[int, ...]:
        """Create data program (`DATSIZ`). Default 1,0."""
        return await self._run(values.wholes(self._session, "DATSIZ", self._axis))

    async def set_data_program_size(self, value: Sequence[int]) -> None:
        """Create data program (`DATSIZ`). Default 1,0."""
        await self._run(values.write(self._session, "DATSIZ", self._axis, *value))

    async def get_echo(self) -> bool:
        """Communication echo (`ECHO`). Default 1."""
        return await self._run(values.flag(self._session, "ECHO", self._axis))

    async def set_echo(self, value: bool) -> None:
        """Communication echo (`ECHO`). Default 1."""
        await self._run(values.write(self._session, "ECHO", self._axis, value))

    async def get_end_of_line_characters(self) -> tuple[int, ...]:
        """End-of-line characters (`EOL`). Range 0 to 256. Default 13,10,0."""
        return await self._run(values.wholes(self._session, "EOL", self._axis))

    async def set_end_of_line_characters(self, value: Sequence[int]) -> None:
        """End-of-line characters (`EOL`). Range 0 to 256. Default 13,10,0."""
        await self._run(values.write(self._session, "EOL", self._axis, *value))

    async def get_end_of_transmission_characters(self) -> tuple[int, ...]:
        """End-of-transmission characters (`EOT`). Range 0 to 256. Default 13,0,0."""
        return await self._run(values.wholes(self._session, "EOT", self._axis))

    async def set_end_of_transmission_characters(self, value: Sequence[int]) -> None:
        """End-of-transmission characters (`EOT`). Range 0 to 256. Default 13,0,0."""
        await self._run(values.write(self._session, "EOT", self._axis, *value))

    async def get_error_checking(self) -> str:
        """Enable error checking (`ERROR`). Default 0. Values: 0,1,X; ERROR.n-b sets one."""
        return await self._run(values.bits(self._session, "ERROR", self._axis))

    async def set_error_checking(self, value: str) -> None:
        """Enable error checking (`ERROR`). Default 0. Values: 0,1,X; ERROR.n-b sets one."""
        await self._run(values.write(self._session, "ERROR", self._axis, value))

    async def get_error_level(self) -> ErrorLevel:
        """Error detection level (`ERRLVL`). Range 0 to 4. Default 4."""
        return await self._run(values.choice(self._session, "ERRLVL", self._axis, ErrorLevel))

    async def set_error_level(self, value: ErrorLevel) -> None:
        """Error detection level (`ERRLVL`). Range 0 to 4. Default 4."""
        await self._run(values.write(self._session, "ERRLVL", self._axis, value))

    async def get_error_program(self) -> str:
        """Error program (`ERRORP`)."""
        return await self._run(values.text_of(self._session, "ERRORP", self._axis))

    async def set_error_program(self, value: str) -> None:
        """Error program (`ERRORP`)."""
        await self._run(values.write(self._session, "ERRORP", self._axis, value))

    async def get_error_prompt(self) -> tuple[int, ...]:
        """Error prompt (`ERRBAD`). Range 0 to 256. Default 13,10,63,32."""
        return await self._run(values.wholes(self._session, "ERRBAD", self._axis))

    async def set_error_prompt(self, value: Sequence[int]) -> None:
        """Error prompt (`ERRBAD`). Range 0 to 256. Default 13,10,63,32."""
        await self._run(values.write(self._session, "ERRBAD", self._axis, *value))

    async def get_good_prompt(self) -> tuple[int, ...]:
        """Good prompt (`ERROK`). Range 0 to 256. Default 13,10,62,32."""
        return await self._run(values.wholes(self._session, "ERROK", self._axis))

    async def set_good_prompt(self, value: Sequence[int]) -> None:
        """Good prompt (`ERROK`). Range 0 to 256. Default 13,10,62,32."""
        await self._run(values.write(self._session, "ERROK", self._axis, *value))

    async def get_hard_limit_input_active_level(self) -> str:
        """Hard limit input active level (`LHLVL`). Default 0. Values: 0 active low, 1 active high, X."""
        return await self._run(values.bits(self._session, "LHLVL", self._axis))

    async def set_hard_limit_input_active_level(self, value: str) -> None:
        """Hard limit input active level (`LHLVL`). Default 0. Values: 0 active low, 1 active high, X."""
        await self._run(values.write(self._session, "LHLVL", self._axis, value))

    async def get_input_active_level(self) -> str:
        """Input active level (`INLVL`). Default 0. Values: 0 active low, 1 active high."""
        return await self._run(values.bits(self._session, "INLVL", self._axis))

    async def set_input_active_level(self, value: str) -> None:
        """Input active level (`INLVL`). Default 0. Values: 0 active low, 1 active high."""
        await self._run(values.write(self._session, "INLVL", self._axis, value))

    async def get_input_debounce_time(self) -> tuple[int, ...]:
        """Input debounce time (`INDEB`). Units: milliseconds. Range 1 to 250. Default 4,24."""
        return await self._run(values.wholes(self._session, "INDEB", self._axis))

    async def set_input_debounce_time(self, value: Sequence[int]) -> None:
        """Input debounce time (`INDEB`). Units: milliseconds. Range 1 to 250. Default 4,24."""
        await self._run(values.write(self._session, "INDEB", self._axis, *value))

    async def get_input_function(self, index: int | None = None) -> tuple[str, ...]:
        """Assign input function (`INFNC`). Syntax: <!>INFNC<i>-<a><c>."""
        return await self._run(values.lines_of(self._session, "INFNC", self._axis, str(index or "")))

    async def set_input_function(self, text: str) -> None:
        """Assign input function (`INFNC`). Syntax: <!>INFNC<i>-<a><c>."""
        await self._run(values.write(self._session, "INFNC", self._axis, text))

    async def get_input_functions_enabled(self) -> bool:
        """Input function enable (`INFEN`). Default 0."""
        return await self._run(values.flag(self._session, "INFEN", self._axis))

    async def set_input_functions_enabled(self, value: bool) -> None:
        """Input function enable (`INFEN`). Default 0."""
        await self._run(values.write(self._session, "INFEN", self._axis, value))

    async def get_input_override(self) -> str:
        """Input override (`INEN`). Default E. Values: 0 force inactive, 1 force active, E enable, X unchanged."""
        return await self._run(values.bits(self._session, "INEN", self._axis))

    async def set_input_override(self, value: str) -> None:
        """Input override (`INEN`). Default E. Values: 0 force inactive, 1 force active, E enable, X unchanged."""
        await self._run(values.write(self._session, "INEN", self._axis, value))

    async def get_joystick_centre_deadband(self) -> tuple[float, ...]:
        """Joystick centre deadband (`JOYCDB`). Units: volts. Range 0.0 to 1.25. Default 0.1."""
        return await self._run(values.reals(self._session, "JOYCDB", self._axis))

    async def set_joystick_centre_deadband(self, value: Sequence[Number]) -> None:
        """Joystick centre deadband (`JOYCDB`). Units: volts. Range 0.0 to 1.25. Default 0.1."""
        await self._run(values.write(self._session, "JOYCDB", self._axis, *value))

    async def get_joystick_centre_voltage(self) -> tuple[float, ...]:
        """Joystick centre voltage (`JOYCTR`). Units: volts. Range 0.0 to 2.5. Default 1.25."""
        return await self._run(values.reals(self._session, "JOYCTR", self._axis))

    async def set_joystick_centre_voltage(self, value: Sequence[Number]) -> None:
        """Joystick centre voltage (`JOYCTR`). Units: volts. Range 0.0 to 2.5. Default 1.25."""
        await self._run(values.write(self._session, "JOYCTR", self._axis, *value))

    async def get_joystick_end_deadband(self) -> tuple[float, ...]:
        """Joystick end deadband (`JOYEDB`). Units: volts. Range 0.0 to 1.25. Default 0.1."""
        return await self._run(values.reals(self._session, "JOYEDB", self._axis))

    async def set_joystick_end_deadband(self, value: Sequence[Number]) -> None:
        """Joystick end deadband (`JOYEDB`). Units: volts. Range 0.0 to 1.25. Default 0.1."""
        await self._run(values.write(self._session, "JOYEDB", self._axis, *value))

    async def get_keep_buffer_on_kill(self) -> bool:
        """Keep buffer on kill (`COMEXK`). Default 0."""
        return await self._run(values.flag(self._session, "COMEXK", self._axis))

    async def set_keep_buffer_on_kill(self, value: bool) -> None:
        """Keep buffer on kill (`COMEXK`). Default 0."""
        await self._run(values.write(self._session, "COMEXK", self._axis, value))

    async def get_keep_buffer_on_stop(self) -> int:
        """Keep buffer on stop (`COMEXS`). Range 0 to 2. Default 0."""
        return await self._run(values.whole(self._session, "COMEXS", self._axis))

    async def set_keep_buffer_on_stop(self, value: int) -> None:
        """Keep buffer on stop (`COMEXS`). Range 0 to 2. Default 0."""
        await self._run(values.write(self._session, "COMEXS", self._axis, value))

    async def get_lock_to_a_port(self) -> int:
        """Lock to a port (`LOCK`). Range 0 to 2. Default 0."""
        return await self._run(values.whole(self._session, "LOCK", self._axis))

    async def set_lock_to_a_port(self, value: int) -> None:
        """Lock to a port (`LOCK`). Range 0 to 2. Default 0."""
        await self._run(values.write(self._session, "LOCK", self._axis, value))

    async def get_memory_partition(self) -> tuple[int, ...]:
        """Partition memory (`MEMORY`). Units: bytes, even numbers: program area, compiled area. Range 1000 to 39000.
        Default 21400,18600."""
        return await self._run(values.wholes(self._session, "MEMORY", self._axis))

    async def set_memory_partition(self, value: Sequence[int]) -> None:
        """Partition memory (`MEMORY`). Units: bytes, even numbers: program area, compiled area. Range 1000 to 39000.
        Default 21400,18600."""
        await self._run(values.write(self._session, "MEMORY", self._axis, *value))

    async def get_on_variable_1_condition(self, index: int | None = None) -> tuple[str, ...]:
        """On variable 1 condition (`ONVARA`). Default 0. Syntax: <!>ONVARA<i>,<r>,<r>."""
        return await self._run(values.lines_of(self._session, "ONVARA", self._axis, str(index or "")))

    async def set_on_variable_1_condition(self, text: str) -> None:
        """On variable 1 condition (`ONVARA`). Default 0. Syntax: <!>ONVARA<i>,<r>,<r>."""
        await self._run(values.write(self._session, "ONVARA", self._axis, text))

    async def get_on_variable_2_condition(self, index: int | None = None) -> tuple[str, ...]:
        """On variable 2 condition (`ONVARB`). Default 0. Syntax: <!>ONVARB<i>,<r>,<r>."""
        return await self._run(values.lines_of(self._session, "ONVARB", self._axis, str(index or "")))

    async def set_on_variable_2_condition(self, text: str) -> None:
        """On variable 2 condition (`ONVARB`). Default 0. Syntax: <!>ONVARB<i>,<r>,<r>."""
        await self._run(values.write(self._session, "ONVARB", self._axis, text))

    async def get_output_active_level(self) -> str:
        """Output active level (`OUTLVL`). Default 0. Values: 0 active low (on sinks), 1 active high."""
        return await self._run(values.bits(self._session, "OUTLVL", self._axis))

    async def set_output_active_level(self, value: str) -> None:
        """Output active level (`OUTLVL`). Default 0. Values: 0 active low (on sinks), 1 active high."""
        await self._run(values.write(self._session, "OUTLVL", self._axis, value))

    async def get_output_function(self, index: int | None = None) -> tuple[str, ...]:
        """Assign output function (`OUTFNC`). Syntax: <!>OUTFNC<i>-<a><c>."""
        return await self._run(values.lines_of(self._session, "OUTFNC", self._axis, str(index or "")))

    async def set_output_function(self, text: str) -> None:
        """Assign output function (`OUTFNC`). Syntax: <!>OUTFNC<i>-<a><c>."""
        await self._run(values.write(self._session, "OUTFNC", self._axis, text))

    async def get_output_functions_enabled(self) -> bool:
        """Output function enable (`OUTFEN`). Default 0."""
        return await self._run(values.flag(self._session, "OUTFEN", self._axis))

    async def set_output_functions_enabled(self, value: bool) -> None:
        """Output function enable (`OUTFEN`). Default 0."""
        await self._run(values.write(self._session, "OUTFEN", self._axis, value))

    async def get_output_on_position_axis_1(self, index: int | None = None) -> tuple[str, ...]:
        """Output on position, axis 1 (`OUTPA`). Syntax: <!>OUTPA<b>,<b>,<r>,<i>."""
        return await self._run(values.lines_of(self._session, "OUTPA", self._axis, str(index or "")))

    async def set_output_on_position_axis_1(self, text: str) -> None:
        """Output on position, axis 1 (`OUTPA`). Syntax: <!>OUTPA<b>,<b>,<r>,<i>."""
        await self._run(values.write(self._session, "OUTPA", self._axis, text))

    async def get_output_on_position_axis_2(self, index: int | None = None) -> tuple[str, ...]:
        """Output on position, axis 2 (`OUTPB`). Syntax: <!>OUTPB<b>,<b>,<r>,<i>."""
        return await self._run(values.lines_of(self._session, "OUTPB", self._axis, str(index or "")))

    async def set_output_on_position_axis_2(self, text: str) -> None:
        """Output on position, axis 2 (`OUTPB`). Syntax: <!>OUTPB<b>,<b>,<r>,<i>."""
        await self._run(values.write(self._session, "OUTPB", self._axis, text))

    async def get_output_override(self) -> str:
        """Output override (`OUTEN`). Default E. Values: 0 force off, 1 force on, E enable normal, X unchanged."""
        return await self._run(values.bits(self._session, "OUTEN", self._axis))

    async def set_output_override(self, value: str) -> None:
        """Output override (`OUTEN`). Default E. Values: 0 force off, 1 force on, E enable normal, X unchanged."""
        await self._run(values.write(self._session, "OUTEN", self._axis, value))

    async def get_outputs(self) -> str:
        """Set programmable outputs (`OUT`). Default 0. Values: 0 off, 1 on, X unchanged; OUT.n-b sets one."""
        return await self._run(values.bits(self._session, "OUT", self._axis))

    async def set_outputs(self, value: str) -> None:
        """Set programmable outputs (`OUT`). Default 0. Values: 0 off, 1 on, X unchanged; OUT.n-b sets one."""
        await self._run(values.write(self._session, "OUT", self._axis, value))

    async def get_panel_jog(self) -> bool:
        """Enable RP240 jog (`DJOG`). Default 0."""
        return await self._run(values.flag(self._session, "DJOG", self._axis))

    async def set_panel_jog(self, value: bool) -> None:
        """Enable RP240 jog (`DJOG`). Default 0."""
        await self._run(values.write(self._session, "DJOG", self._axis, value))

    async def get_panel_leds(self) -> str:
        """Control display LEDs (`DLED`). Default 0."""
        return await self._run(values.bits(self._session, "DLED", self._axis))

    async def set_panel_leds(self, value: str) -> None:
        """Control display LEDs (`DLED`). Default 0."""
        await self._run(values.write(self._session, "DLED", self._axis, value))

    async def get_panel_read_immediate(self) -> bool:
        """Immediate display read (`DREADI`). Default 0."""
        return await self._run(values.flag(self._session, "DREADI", self._axis))

    async def set_panel_read_immediate(self, value: bool) -> None:
        """Immediate display read (`DREADI`). Default 0."""
        await self._run(values.write(self._session, "DREADI", self._axis, value))

    async def get_panel_stop_key(self) -> bool:
        """Enable RP240 stop key (`DSTP`). Default 1."""
        return await self._run(values.flag(self._session, "DSTP", self._axis))

    async def set_panel_stop_key(self, value: bool) -> None:
        """Enable RP240 stop key (`DSTP`). Default 1."""
        await self._run(values.write(self._session, "DSTP", self._axis, value))

    async def get_path_acceleration(self) -> float:
        """Path acceleration (`PA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "PA", self._axis))

    async def set_path_acceleration(self, value: Number) -> None:
        """Path acceleration (`PA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "PA", self._axis, value))

    async def get_path_acceleration_scale_factor(self) -> int:
        """Path acceleration scale factor (`PSCLA`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return await self._run(values.whole(self._session, "PSCLA", self._axis))

    async def set_path_acceleration_scale_factor(self, value: int) -> None:
        """Path acceleration scale factor (`PSCLA`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        await self._run(values.write(self._session, "PSCLA", self._axis, value))

    async def get_path_average_acceleration(self) -> float:
        """Path average acceleration (`PAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "PAA", self._axis))

    async def set_path_average_acceleration(self, value: Number) -> None:
        """Path average acceleration (`PAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "PAA", self._axis, value))

    async def get_path_average_deceleration(self) -> float:
        """Path average deceleration (`PADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "PADA", self._axis))

    async def set_path_average_deceleration(self, value: Number) -> None:
        """Path average deceleration (`PADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "PADA", self._axis, value))

    async def get_path_deceleration(self) -> float:
        """Path deceleration (`PAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return await self._run(values.real(self._session, "PAD", self._axis))

    async def set_path_deceleration(self, value: Number) -> None:
        """Path deceleration (`PAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        await self._run(values.write(self._session, "PAD", self._axis, value))

    async def get_path_distance_scale_factor(self) -> int:
        """Path distance scale factor (`PSCLD`). Units: counts/unit. Range 1 to 999999. Default 1."""
        return await self._run(values.whole(self._session, "PSCLD", self._axis))

    async def set_path_distance_scale_factor(self, value: int) -> None:
        """Path distance scale factor (`PSCLD`). Units: counts/unit. Range 1 to 999999. Default 1."""
        await self._run(values.write(self._session, "PSCLD", self._axis, value))

    async def get_path_velocity(self) -> float:
        """Path velocity (`PV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return await self._run(values.real(self._session, "PV", self._axis))

    async def set_path_velocity(self, value: Number) -> None:
        """Path velocity (`PV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        await self._run(values.write(self._session, "PV", self._axis, value))

    async def get_path_velocity_scale_factor(self) -> int:
        """Path velocity scale factor (`PSCLV`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return await self._run(values.whole(self._session, "PSCLV", self._axis))

    async def set_path_velocity_scale_factor(self, value: int) -> None:
        """Path velocity scale factor (`PSCLV`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        await self._run(values.write(self._session, "PSCLV", self._axis, value))

    async def get_plc_input_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define PLC input set (`INPLC`). Syntax: <!>INPLC<i>,<i-i>,<i>,<i>."""
        return await self._run(values.lines_of(self._session, "INPLC", self._axis, str(index or "")))

    async def set_plc_input_set(self, text: str) -> None:
        """Define PLC input set (`INPLC`). Syntax: <!>INPLC<i>,<i-i>,<i>,<i>."""
        await self._run(values.write(self._session, "INPLC", self._axis, text))

    async def get_plc_output_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define PLC output set (`OUTPLC`). Syntax: <!>OUTPLC<i>,<i-i>,<i>,<i>."""
        return await self._run(values.lines_of(self._session, "OUTPLC", self._axis, str(index or "")))

    async def set_plc_output_set(self, text: str) -> None:
        """Define PLC output set (`OUTPLC`). Syntax: <!>OUTPLC<i>,<i-i>,<i>,<i>."""
        await self._run(values.write(self._session, "OUTPLC", self._axis, text))

    async def get_port_for_port_settings(self) -> int:
        """Select port for port settings (`PORT`). Range 1 to 2. Default 1."""
        return await self._run(values.whole(self._session, "PORT", self._axis))

    async def set_port_for_port_settings(self, value: int) -> None:
        """Select port for port settings (`PORT`). Range 1 to 2. Default 1."""
        await self._run(values.write(self._session, "PORT", self._axis, value))

    async def get_program_definition_prompt(self) -> tuple[int, ...]:
        """Program definition prompt (`ERRDEF`). Range 0 to 256. Default 13,10,45,32."""
        return await self._run(values.wholes(self._session, "ERRDEF", self._axis))

    async def set_program_definition_prompt(self, value: Sequence[int]) -> None:
        """Program definition prompt (`ERRDEF`). Range 0 to 256. Default 13,10,45,32."""
        await self._run(values.write(self._session, "ERRDEF", self._axis, *value))

    async def get_program_selection(self) -> tuple[int, ...]:
        """Select program by inputs (`INSELP`). Units: mode 0 off, 1 BCD (INFNC B), 2 one-to-one (INFNC P); strobe ms
        0-5000. Range 0 to 5000. Default 0."""
        return await self._run(values.wholes(self._session, "INSELP", self._axis))

    async def set_program_selection(self, value: Sequence[int]) -> None:
        """Select program by inputs (`INSELP`). Units: mode 0 off, 1 BCD (INFNC B), 2 one-to-one (INFNC P); strobe ms
        0-5000. Range 0 to 5000. Default 0."""
        await self._run(values.write(self._session, "INSELP", self._axis, *value))

    async def get_radians(self) -> bool:
        """Radian mode (`RADIAN`). Default 0."""
        return await self._run(values.flag(self._session, "RADIAN", self._axis))

    async def set_radians(self, value: bool) -> None:
        """Radian mode (`RADIAN`). Default 0."""
        await self._run(values.write(self._session, "RADIAN", self._axis, value))

    async def get_resume_moves_after_pause(self) -> bool:
        """Resume effect of pause/continue (`COMEXR`). Default 0."""
        return await self._run(values.flag(self._session, "COMEXR", self._axis))

    async def set_resume_moves_after_pause(self, value: bool) -> None:
        """Resume effect of pause/continue (`COMEXR`). Default 0."""
        await self._run(values.write(self._session, "COMEXR", self._axis, value))

    async def get_rp240_check(self) -> int:
        """RP240 check (`DRPCHK`). Range 0 to 3. Default 0."""
        return await self._run(values.whole(self._session, "DRPCHK", self._axis))

    async def set_rp240_check(self, value: int) -> None:
        """RP240 check (`DRPCHK`). Range 0 to 3. Default 0."""
        await self._run(values.write(self._session, "DRPCHK", self._axis, value))

    async def get_scaling(self) -> bool:
        """Enable scaling (`SCALE`). Default 0."""
        return await self._run(values.flag(self._session, "SCALE", self._axis))

    async def set_scaling(self, value: bool) -> None:
        """Enable scaling (`SCALE`). Default 0."""
        await self._run(values.write(self._session, "SCALE", self._axis, value))

    async def get_serial_port_enabled(self) -> bool:
        """Enable serial communication (`E`). Default 1."""
        return await self._run(values.flag(self._session, "E", self._axis))

    async def set_serial_port_enabled(self, value: bool) -> None:
        """Enable serial communication (`E`). Default 1."""
        await self._run(values.write(self._session, "E", self._axis, value))

    async def get_servo_sample_ratio(self) -> int:
        """Servo sampling frequency ratio (`SSFR`). Range 1 to 8. Default 4. Values: 1, 2, 4 or 8; periods:
        emulator/engine/rates.py."""
        return await self._run(values.whole(self._session, "SSFR", self._axis))

    async def set_servo_sample_ratio(self, value: int) -> None:
        """Servo sampling frequency ratio (`SSFR`). Range 1 to 8. Default 4. Values: 1, 2, 4 or 8; periods:
        emulator/engine/rates.py."""
        await self._run(values.write(self._session, "SSFR", self._axis, value))

    async def get_start_up_program(self) -> str:
        """Power-up program (`STARTP`)."""
        return await self._run(values.text_of(self._session, "STARTP", self._axis))

    async def set_start_up_program(self, value: str) -> None:
        """Power-up program (`STARTP`)."""
        await self._run(values.write(self._session, "STARTP", self._axis, value))

    async def get_step_mode(self) -> bool:
        """Step mode (`STEP`). Default 0."""
        return await self._run(values.flag(self._session, "STEP", self._axis))

    async def set_step_mode(self, value: bool) -> None:
        """Step mode (`STEP`). Default 0."""
        await self._run(values.write(self._session, "STEP", self._axis, value))

    async def get_thumbwheel_input_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define thumbwheel input set (`INSTW`). Syntax: <!>INSTW<i>,<i-i>,<i>."""
        return await self._run(values.lines_of(self._session, "INSTW", self._axis, str(index or "")))

    async def set_thumbwheel_input_set(self, text: str) -> None:
        """Define thumbwheel input set (`INSTW`). Syntax: <!>INSTW<i>,<i-i>,<i>."""
        await self._run(values.write(self._session, "INSTW", self._axis, text))

    async def get_thumbwheel_output_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define thumbwheel output set (`OUTTW`). Syntax: <!>OUTTW<i>,<i-i>,<i>,<i>."""
        return await self._run(values.lines_of(self._session, "OUTTW", self._axis, str(index or "")))

    async def set_thumbwheel_output_set(self, text: str) -> None:
        """Define thumbwheel output set (`OUTTW`). Syntax: <!>OUTTW<i>,<i-i>,<i>,<i>."""
        await self._run(values.write(self._session, "OUTTW", self._axis, text))

    async def get_timer_interrupt_value(self) -> tuple[int, ...]:
        """Timer interrupt value (`TIMINT`)."""
        return await self._run(values.wholes(self._session, "TIMINT", self._axis))

    async def set_timer_interrupt_value(self, value: Sequence[int]) -> None:
        """Timer interrupt value (`TIMINT`)."""
        await self._run(values.write(self._session, "TIMINT", self._axis, *value))

    async def get_trace_mode(self) -> bool:
        """Trace mode (`TRACE`). Default 0."""
        return await self._run(values.flag(self._session, "TRACE", self._axis))

    async def set_trace_mode(self, value: bool) -> None:
        """Trace mode (`TRACE`). Default 0."""
        await self._run(values.write(self._session, "TRACE", self._axis, value))

    async def get_translation_mode(self) -> bool:
        """Translation mode (`TRANS`). Default 0."""
        return await self._run(values.flag(self._session, "TRANS", self._axis))

    async def set_translation_mode(self, value: bool) -> None:
        """Translation mode (`TRANS`). Default 0."""
        await self._run(values.write(self._session, "TRANS", self._axis, value))

    async def get_trigger_lockout_time(self) -> int:
        """Trigger lockout time (`TRGLOT`). Units: milliseconds. Range 0 to 250. Default 24."""
        return await self._run(values.whole(self._session, "TRGLOT", self._axis))

    async def set_trigger_lockout_time(self, value: int) -> None:
        """Trigger lockout time (`TRGLOT`). Units: milliseconds. Range 0 to 250. Default 24."""
        await self._run(values.write(self._session, "TRGLOT", self._axis, value))

    async def get_unit_address(self) -> int:
        """Unit address / auto-address (`ADDR`). Range 0 to 99. Default 0."""
        return await self._run(values.whole(self._session, "ADDR", self._axis))

    async def set_unit_address(self, value: int) -> None:
        """Unit address / auto-address (`ADDR`). Range 0 to 99. Default 0."""
        await self._run(values.write(self._session, "ADDR", self._axis, value))

    async def get_user_status_bit(self, index: int | None = None) -> tuple[str, ...]:
        """Define user status bit (`INDUST`). Syntax: <!>INDUST<i>-<i><c>."""
        return await self._run(values.lines_of(self._session, "INDUST", self._axis, str(index or "")))

    async def set_user_status_bit(self, text: str) -> None:
        """Define user status bit (`INDUST`). Syntax: <!>INDUST<i>-<i><c>."""
        await self._run(values.write(self._session, "INDUST", self._axis, text))

    async def get_user_status_enabled(self) -> bool:
        """Enable user status (`INDUSE`). Default 0."""
        return await self._run(values.flag(self._session, "INDUSE", self._axis))

    async def set_user_status_enabled(self, value: bool) -> None:
        """Enable user status (`INDUSE`). Default 0."""
        await self._run(values.write(self._session, "INDUSE", self._axis, value))

    async def get_xon_xoff_handshake(self) -> bool:
        """XON/XOFF handshake (`XONOFF`). Default 1."""
        return await self._run(values.flag(self._session, "XONOFF", self._axis))

    async def set_xon_xoff_handshake(self, value: bool) -> None:
        """XON/XOFF handshake (`XONOFF`). Default 1."""
        await self._run(values.write(self._session, "XONOFF", self._axis, value))


class UnitReports(AwaitableFace):
    """The reports of the whole unit."""

    async def get_active_gains(self) -> tuple[str, ...]:
        """Report active servo gains (`TGAIN`)."""
        return await self._run(values.lines_of(self._session, "TGAIN", self._axis))

    async def get_controller_status(self) -> str:
        """Report controller status bits (`TSC`)."""
        return await self._run(values.bits(self._session, "TSC", self._axis))

    async def get_data_pointer(self) -> tuple[int, ...]:
        """Report data pointer (`TDPTR`)."""
        return await self._run(values.wholes(self._session, "TDPTR", self._axis))

    async def get_error_status_text(self) -> tuple[str, ...]:
        """Report error status as text (`TERF`)."""
        return await self._run(values.lines_of(self._session, "TERF", self._axis))

    async def get_free_segments(self) -> int:
        """Report free compiled segments (`TSEG`)."""
        return await self._run(values.whole(self._session, "TSEG", self._axis))

    async def get_help_text(self) -> tuple[str, ...]:
        """Show support telephone (`HELP`)."""
        return await self._run(values.lines_of(self._session, "HELP", self._axis))

    async def get_inputs(self) -> str:
        """Report programmable inputs (`TIN`)."""
        return await self._run(values.bits(self._session, "TIN", self._axis))

    async def get_joystick_voltages(self) -> tuple[float, ...]:
        """Report joystick analog voltages (`TANV`)."""
        return await self._run(values.reals(self._session, "TANV", self._axis))

    async def get_labels(self) -> tuple[str, ...]:
        """List labels (`TLABEL`)."""
        return await self._run(values.lines_of(self._session, "TLABEL", self._axis))

    async def get_last_bad_command(self) -> str:
        """Report command error (`TCMDER`)."""
        return await self._run(values.text_of(self._session, "TCMDER", self._axis))

    async def get_limit_inputs(self) -> str:
        """Report limit and home inputs (`TLIM`)."""
        return await self._run(values.bits(self._session, "TLIM", self._axis))

    async def get_memory(self) -> tuple[str, ...]:
        """Report free memory (`TMEM`)."""
        return await self._run(values.lines_of(self._session, "TMEM", self._axis))

    async def get_other_inputs_text(self) -> tuple[str, ...]:
        """Report other inputs as text (`TINOF`)."""
        return await self._run(values.lines_of(self._session, "TINOF", self._axis))

    async def get_outputs(self) -> str:
        """Report programmable outputs (`TOUT`)."""
        return await self._run(values.bits(self._session, "TOUT", self._axis))

    async def get_program_directory(self) -> tuple[str, ...]:
        """List stored programs (`TDIR`)."""
        return await self._run(values.lines_of(self._session, "TDIR", self._axis))

    async def get_program_execution(self) -> str:
        """Report program execution (`TEX`)."""
        return await self._run(values.text_of(self._session, "TEX", self._axis))

    async def get_revision(self) -> str:
        """Report firmware revision (`TREV`)."""
        return await self._run(values.text_of(self._session, "TREV", self._axis))

    async def get_statistics(self) -> tuple[str, ...]:
        """Report overall statistics (`TSTAT`)."""
        return await self._run(values.lines_of(self._session, "TSTAT", self._axis))

    async def get_system_status_text(self) -> tuple[str, ...]:
        """Report system status as text (`TSSF`)."""
        return await self._run(values.lines_of(self._session, "TSSF", self._axis))

    async def get_timer(self) -> int:
        """Report timer (`TTIM`)."""
        return await self._run(values.whole(self._session, "TTIM", self._axis))

    async def get_user_status(self) -> str:
        """Report user status bits (`TUS`)."""
        return await self._run(values.bits(self._session, "TUS", self._axis))


class UnitActions(AwaitableFace):
    """The actions of the whole unit."""

    async def analog_voltage_override(self, *fields: Number) -> None:
        """Analog voltage override (`ANVO`). Units: volts. Range 0.0 to 2.5."""
        await self._run(values.write(self._session, "ANVO", self._axis, *fields))

    async def change_menu_password(self, value: Number) -> None:
        """Change menu password (`DPASS`). Range 0 to 9999."""
        await self._run(values.write(self._session, "DPASS", self._axis, value))

    async def clear_display(self, value: Number) -> None:
        """Clear display (`DCLEAR`). Range 0 to 2."""
        await self._run(values.write(self._session, "DCLEAR", self._axis, value))

    async def clear_variables(self) -> None:
        """Clear variables (`VARCLR`)."""
        await self._run(values.write(self._session, "VARCLR", self._axis))

    async def compile_program(self, name: str) -> None:
        """Compile a program (`PCOMP`)."""
        await self._run(values.write(self._session, "PCOMP", self._axis, " " + name))

    async def compiled_output_pattern_axis_1(self, text: str) -> None:
        """Compiled output pattern, axis 1 (`POUTA`)."""
        await self._run(values.write(self._session, "POUTA", self._axis, text))

    async def compiled_output_pattern_axis_2(self, text: str) -> None:
        """Compiled output pattern, axis 2 (`POUTB`)."""
        await self._run(values.write(self._session, "POUTB", self._axis, text))

    async def delete_program(self, name: str) -> None:
        """Delete program (`DEL`)."""
        await self._run(values.write(self._session, "DEL", self._axis, " " + name))

    async def display_text(self, text: str) -> None:
        """Display text (`DWRITE`)."""
        await self._run(values.write(self._session, "DWRITE", self._axis, values.quoted(text)))

    async def display_variable(self, *fields: Number) -> None:
        """Display variable (`DVAR`)."""
        await self._run(values.write(self._session, "DVAR", self._axis, *fields))

    async def erase_all_programs(self) -> None:
        """Erase all programs (`ERASE`)."""
        await self._run(values.write(self._session, "ERASE", self._axis))

    async def go_when(self, text: str) -> None:
        """Conditional GO (`GOWHEN`)."""
        await self._run(values.write(self._session, "GOWHEN", self._axis, text))

    async def halt_program(self) -> None:
        """Terminate program execution (`HALT`)."""
        await self._run(values.write(self._session, "HALT", self._axis))

    async def joystick_zero(self, text: str) -> None:
        """Joystick zero (centre) (`JOYZ`)."""
        await self._run(values.write(self._session, "JOYZ", self._axis, text))

    async def line_segment(self, *fields: Number) -> None:
        """Line segment (`PLIN`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PLIN", self._axis, *fields))

    async def local_coordinate_origin(self, *fields: Number) -> None:
        """Local coordinate origin (`PLC`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PLC", self._axis, *fields))

    async def local_coordinate_system_enable(self, value: Number) -> None:
        """Local coordinate system enable (`PL`). Range 0 to 1."""
        await self._run(values.write(self._session, "PL", self._axis, value))

    async def origin_arc_clockwise(self, *fields: Number) -> None:
        """Origin arc, clockwise (`PARCOM`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PARCOM", self._axis, *fields))

    async def origin_arc_counter_clockwise(self, *fields: Number) -> None:
        """Origin arc, counter-clockwise (`PARCOP`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PARCOP", self._axis, *fields))

    async def path_absolute_mode(self, value: Number) -> None:
        """Path absolute mode (`PAB`). Range 0 to 1."""
        await self._run(values.write(self._session, "PAB", self._axis, value))

    async def path_output_pattern(self, text: str) -> None:
        """Path output pattern (`POUT`)."""
        await self._run(values.write(self._session, "POUT", self._axis, text))

    async def pause(self) -> None:
        """Pause program (`PS`)."""
        await self._run(values.write(self._session, "PS", self._axis))

    async def position_cursor(self, *fields: Number) -> None:
        """Position cursor (`DPCUR`)."""
        await self._run(values.write(self._session, "DPCUR", self._axis, *fields))

    async def radius_arc_clockwise(self, *fields: Number) -> None:
        """Radius arc (M sense) (`PARCM`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PARCM", self._axis, *fields))

    async def radius_arc_counter_clockwise(self, *fields: Number) -> None:
        """Radius arc (P sense) (`PARCP`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PARCP", self._axis, *fields))

    async def radius_tolerance(self, value: Number) -> None:
        """Radius tolerance (`PRTOL`). Units: counts. Range 0 to 999999999."""
        await self._run(values.write(self._session, "PRTOL", self._axis, value))

    async def reset(self) -> None:
        """Reset to power-up state (`RESET`)."""
        await self._run(values.write(self._session, "RESET", self._axis))

    async def reset_data_pointer(self, *fields: Number) -> None:
        """Reset data pointer (`DATRST`)."""
        await self._run(values.write(self._session, "DATRST", self._axis, *fields))

    async def resume(self) -> None:
        """Continue (`C`)."""
        await self._run(values.write(self._session, "C", self._axis))

    async def run_compiled_profile(self, name: str) -> None:
        """Run compiled profile (`PRUN`)."""
        await self._run(values.write(self._session, "PRUN", self._axis, " " + name))

    async def run_program(self, name: str) -> None:
        """Run a program (`RUN`)."""
        await self._run(values.write(self._session, "RUN", self._axis, " " + name))

    async def save_servo_gain_set(self, value: Number) -> None:
        """Save servo gain set (`SGSET`). Range 1 to 5."""
        await self._run(values.write(self._session, "SGSET", self._axis, value))

    async def set_contour_axes(self, *fields: Number) -> None:
        """Set contour axes (`PAXES`). Range 1 to 2."""
        await self._run(values.write(self._session, "PAXES", self._axis, *fields))

    async def set_data_pointer(self, *fields: Number) -> None:
        """Set data pointer (`DATPTR`)."""
        await self._run(values.write(self._session, "DATPTR", self._axis, *fields))

    async def set_outputs(self, *fields: Number) -> None:
        """Set a range of outputs (`OUTALL`)."""
        await self._run(values.write(self._session, "OUTALL", self._axis, *fields))

    async def start_timer(self, value: Number) -> None:
        """Start timer (`TIMST`). Values: 0 start from zero, 1 resume."""
        await self._run(values.write(self._session, "TIMST", self._axis, value))

    async def stop_timer(self) -> None:
        """Stop timer (`TIMSTP`)."""
        await self._run(values.write(self._session, "TIMSTP", self._axis))

    async def teach_data(self, *fields: Number) -> None:
        """Teach data (`DATTCH`). Units: VAR numbers. Range 1 to 150."""
        await self._run(values.write(self._session, "DATTCH", self._axis, *fields))

    async def transmit(self, text: str) -> None:
        """Transmit a string (`WRITE`)."""
        await self._run(values.write(self._session, "WRITE", self._axis, values.quoted(text)))

    async def transmit_binary_variable(self, value: Number) -> None:
        """Transmit binary variable (`WRVARB`). Range 1 to 25."""
        await self._run(values.write(self._session, "WRVARB", self._axis, value))

    async def transmit_numeric_variable(self, *fields: Number) -> None:
        """Transmit numeric variable (`WRVAR`)."""
        await self._run(values.write(self._session, "WRVAR", self._axis, *fields))

    async def transmit_string_variable(self, value: Number) -> None:
        """Transmit string variable (`WRVARS`). Range 1 to 25."""
        await self._run(values.write(self._session, "WRVARS", self._axis, value))

    async def uncompile_program(self, name: str) -> None:
        """Uncompile a program (`PUCOMP`)."""
        await self._run(values.write(self._session, "PUCOMP", self._axis, " " + name))

    async def work_coordinate_origin(self, *fields: Number) -> None:
        """Work coordinate origin (`PWC`). Units: counts. Range -999999999 to 999999999."""
        await self._run(values.write(self._session, "PWC", self._axis, *fields))
