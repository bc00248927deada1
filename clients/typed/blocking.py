"""Typed commands, blocking. Written by `python -m clients.generate`; do not edit."""

# ruff: noqa
# fmt: off

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from clients import values
from clients.choices import EndOfTravel, ErrorLevel, FeedbackSource
from clients.faces import BlockingFace
from clients.values import Number


class AxisCommands(BlockingFace):
    """The settings, reports and actions of one axis."""

    @property
    def absolute_positioning(self) -> bool:
        """Absolute/incremental positioning (`MA`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "MA", self._axis))

    @absolute_positioning.setter
    def absolute_positioning(self, value: bool) -> None:
        self._run(values.write(self._session, "MA", self._axis, value))

    @property
    def acceleration(self) -> float:
        """Acceleration (`A`). Units: units/sec^2 (revs/sec^2 unscaled: counts = value*ERES). Range 0.00025 to 24999975.
        Default 10.0."""
        return self._run(values.real(self._session, "A", self._axis))

    @acceleration.setter
    def acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "A", self._axis, value))

    @property
    def acceleration_feedforward_gain(self) -> float:
        """Acceleration feedforward gain (`SGAF`). Units: microvolts/(count/sec^2). Range 0.0 to 2800000.0. Default
        0.0."""
        return self._run(values.real(self._session, "SGAF", self._axis))

    @acceleration_feedforward_gain.setter
    def acceleration_feedforward_gain(self, value: Number) -> None:
        self._run(values.write(self._session, "SGAF", self._axis, value))

    @property
    def acceleration_scale_factor(self) -> int:
        """Acceleration scale factor (`SCLA`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return self._run(values.whole(self._session, "SCLA", self._axis))

    @acceleration_scale_factor.setter
    def acceleration_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "SCLA", self._axis, value))

    @property
    def actual_velocity(self) -> float:
        """Report actual velocity (`TVELA`)."""
        return self._run(values.real(self._session, "TVELA", self._axis))

    def advance_by(self, value: Number) -> None:
        """Geared advance (`FGADV`). Units: slave distance (SCLD). Range -999999999.99999 to 999999999.99999."""
        self._run(values.write(self._session, "FGADV", self._axis, value))

    @property
    def analog_output(self) -> float:
        """Report analog output voltage (`TDAC`)."""
        return self._run(values.real(self._session, "TDAC", self._axis))

    @property
    def ani_polarity(self) -> bool:
        """ANI polarity (`ANIPOL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "ANIPOL", self._axis))

    @ani_polarity.setter
    def ani_polarity(self, value: bool) -> None:
        self._run(values.write(self._session, "ANIPOL", self._axis, value))

    @property
    def ani_position(self) -> float:
        """Report ANI position (`TPANI`)."""
        return self._run(values.real(self._session, "TPANI", self._axis))

    @property
    def ani_voltage(self) -> float:
        """Report ANI voltage (`TANI`)."""
        return self._run(values.real(self._session, "TANI", self._axis))

    @property
    def average_acceleration(self) -> float:
        """Average acceleration (S-curve) (`AA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "AA", self._axis))

    @average_acceleration.setter
    def average_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "AA", self._axis, value))

    @property
    def average_deceleration(self) -> float:
        """Average deceleration (S-curve) (`ADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "ADA", self._axis))

    @average_deceleration.setter
    def average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "ADA", self._axis, value))

    def begin_compiled_loop(self, value: Number) -> None:
        """Begin compiled loop (`PLOOP`). Units: loop count, 0 endless. Range 0 to 999999999."""
        self._run(values.write(self._session, "PLOOP", self._axis, value))

    def captured_analog_input_position(self, trigger: Literal["A", "B"] = "A") -> float:
        """Report captured analog input position (`TPCA`)."""
        return self._run(values.real(self._session, "TPCA", self._axis, trigger))

    def captured_commanded_position(self, trigger: Literal["A", "B"] = "A") -> float:
        """Report captured commanded position (`TPCC`)."""
        return self._run(values.real(self._session, "TPCC", self._axis, trigger))

    def captured_encoder_position(self, trigger: Literal["A", "B"] = "A") -> float:
        """Report captured encoder position (`TPCE`)."""
        return self._run(values.real(self._session, "TPCE", self._axis, trigger))

    @property
    def commanded_direction_reversed(self) -> bool:
        """Commanded direction polarity (`CMDDIR`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "CMDDIR", self._axis))

    @commanded_direction_reversed.setter
    def commanded_direction_reversed(self, value: bool) -> None:
        self._run(values.write(self._session, "CMDDIR", self._axis, value))

    @property
    def commanded_position(self) -> float:
        """Report commanded position (`TPC`)."""
        return self._run(values.real(self._session, "TPC", self._axis))

    @property
    def commanded_velocity(self) -> float:
        """Report commanded velocity (`TVEL`)."""
        return self._run(values.real(self._session, "TVEL", self._axis))

    @property
    def continuous_motion(self) -> bool:
        """Preset/continuous move mode (`MC`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "MC", self._axis))

    @continuous_motion.setter
    def continuous_motion(self, value: bool) -> None:
        self._run(values.write(self._session, "MC", self._axis, value))

    @property
    def deceleration(self) -> float:
        """Deceleration (`AD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "AD", self._axis))

    @deceleration.setter
    def deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "AD", self._axis, value))

    @property
    def distance(self) -> float:
        """Distance / destination (`D`). Units: distance units (encoder counts unscaled). Range -999999999.99999 to
        999999999.99999. Default 4000."""
        return self._run(values.real(self._session, "D", self._axis))

    @distance.setter
    def distance(self, value: Number) -> None:
        self._run(values.write(self._session, "D", self._axis, value))

    @property
    def distance_scale_factor(self) -> int:
        """Distance scale factor (`SCLD`). Units: counts/unit. Range 1 to 999999. Default 1."""
        return self._run(values.whole(self._session, "SCLD", self._axis))

    @distance_scale_factor.setter
    def distance_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "SCLD", self._axis, value))

    @property
    def dither_amplitude(self) -> float:
        """Dither amplitude (`SDTAMP`). Units: volts. Range 0.0 to 10.0. Default 0.0."""
        return self._run(values.real(self._session, "SDTAMP", self._axis))

    @dither_amplitude.setter
    def dither_amplitude(self, value: Number) -> None:
        self._run(values.write(self._session, "SDTAMP", self._axis, value))

    @property
    def dither_frequency_ratio(self) -> int:
        """Dither frequency ratio (`SDTFR`). Range 0 to 99. Default 0."""
        return self._run(values.whole(self._session, "SDTFR", self._axis))

    @dither_frequency_ratio.setter
    def dither_frequency_ratio(self, value: int) -> None:
        self._run(values.write(self._session, "SDTFR", self._axis, value))

    @property
    def drive_enabled(self) -> bool:
        """Drive shutdown control (`DRIVE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "DRIVE", self._axis))

    @drive_enabled.setter
    def drive_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "DRIVE", self._axis, value))

    @property
    def drive_fault_active_high(self) -> bool:
        """Drive fault input active level (`DRFLVL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "DRFLVL", self._axis))

    @drive_fault_active_high.setter
    def drive_fault_active_high(self, value: bool) -> None:
        self._run(values.write(self._session, "DRFLVL", self._axis, value))

    @property
    def drive_off_on_kill(self) -> bool:
        """Disable drive on kill (`KDRIVE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "KDRIVE", self._axis))

    @drive_off_on_kill.setter
    def drive_off_on_kill(self, value: bool) -> None:
        self._run(values.write(self._session, "KDRIVE", self._axis, value))

    @property
    def encoder_resolution(self) -> int:
        """Encoder resolution (`ERES`). Units: counts/rev (after 4x decode). Range 1 to 65535. Default 4000."""
        return self._run(values.whole(self._session, "ERES", self._axis))

    @encoder_resolution.setter
    def encoder_resolution(self, value: int) -> None:
        self._run(values.write(self._session, "ERES", self._axis, value))

    @property
    def encoder_reversed(self) -> bool:
        """Encoder polarity (`ENCPOL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "ENCPOL", self._axis))

    @encoder_reversed.setter
    def encoder_reversed(self, value: bool) -> None:
        self._run(values.write(self._session, "ENCPOL", self._axis, value))

    def end_compiled_loop(self) -> None:
        """End compiled loop (`PLN`). Values: 0, 1 or X (X = leave unchanged)."""
        self._run(values.write(self._session, "PLN", self._axis))

    @property
    def extended_status_text(self) -> tuple[str, ...]:
        """Report extended axis status as text (`TASXF`)."""
        return self._run(values.lines_of(self._session, "TASXF", self._axis))

    @property
    def feedback_position(self) -> float:
        """Report selected feedback position (`TFB`)."""
        return self._run(values.real(self._session, "TFB", self._axis))

    @property
    def feedback_source(self) -> FeedbackSource:
        """Select servo feedback source (`SFB`). Range 0 to 2. Default 1."""
        return self._run(values.choice(self._session, "SFB", self._axis, FeedbackSource))

    @feedback_source.setter
    def feedback_source(self, value: FeedbackSource) -> None:
        self._run(values.write(self._session, "SFB", self._axis, value))

    @property
    def final_home_velocity(self) -> float:
        """Final home velocity (`HOMVF`). Units: units/sec. Range 0.0 to 200.0. Default 0.1."""
        return self._run(values.real(self._session, "HOMVF", self._axis))

    @final_home_velocity.setter
    def final_home_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "HOMVF", self._axis, value))

    @property
    def final_ratio_numerator(self) -> float:
        """Final ratio numerator (`FOLRNF`). Units: slave distance. Range 0.0 to 999999999.99999. Default 0."""
        return self._run(values.real(self._session, "FOLRNF", self._axis))

    @final_ratio_numerator.setter
    def final_ratio_numerator(self, value: Number) -> None:
        self._run(values.write(self._session, "FOLRNF", self._axis, value))

    @property
    def final_velocity_of_compiled_segment(self) -> float:
        """Final velocity of compiled segment (`VF`). Units: units/sec. Range 0 to 200.0. Default 0."""
        return self._run(values.real(self._session, "VF", self._axis))

    @final_velocity_of_compiled_segment.setter
    def final_velocity_of_compiled_segment(self, value: Number) -> None:
        self._run(values.write(self._session, "VF", self._axis, value))

    @property
    def following_enabled(self) -> bool:
        """Following mode enable (`FOLEN`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "FOLEN", self._axis))

    @following_enabled.setter
    def following_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "FOLEN", self._axis, value))

    @property
    def following_filter(self) -> int:
        """Following filter (`FFILT`). Range 0 to 4. Default 0."""
        return self._run(values.whole(self._session, "FFILT", self._axis))

    @following_filter.setter
    def following_filter(self, value: int) -> None:
        self._run(values.write(self._session, "FFILT", self._axis, value))

    @property
    def following_kill(self) -> bool:
        """Following kill (`FOLK`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "FOLK", self._axis))

    @following_kill.setter
    def following_kill(self, value: bool) -> None:
        self._run(values.write(self._session, "FOLK", self._axis, value))

    @property
    def following_status_text(self) -> tuple[str, ...]:
        """Report Following status as text (`TFSF`)."""
        return self._run(values.lines_of(self._session, "TFSF", self._axis))

    def go(self) -> None:
        """Start motion (`GO`). Values: 1 go, 0 or X no effect."""
        self._run(values.write(self._session, "GO", self._axis))

    def go_linear(self) -> None:
        """Start linear interpolated move (`GOL`)."""
        self._run(values.write(self._session, "GOL", self._axis))

    @property
    def hard_limit_average_deceleration(self) -> float:
        """Hard limit average deceleration (`LHADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return self._run(values.real(self._session, "LHADA", self._axis))

    @hard_limit_average_deceleration.setter
    def hard_limit_average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "LHADA", self._axis, value))

    @property
    def hard_limit_deceleration(self) -> float:
        """Hard limit deceleration (`LHAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return self._run(values.real(self._session, "LHAD", self._axis))

    @hard_limit_deceleration.setter
    def hard_limit_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "LHAD", self._axis, value))

    @property
    def hard_limits(self) -> EndOfTravel:
        """Hardware end-of-travel limit enable (`LH`). Range 0 to 3. Default 3."""
        return self._run(values.choice(self._session, "LH", self._axis, EndOfTravel))

    @hard_limits.setter
    def hard_limits(self, value: EndOfTravel) -> None:
        self._run(values.write(self._session, "LH", self._axis, value))

    @property
    def home_acceleration(self) -> float:
        """Home acceleration (`HOMA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "HOMA", self._axis))

    @home_acceleration.setter
    def home_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "HOMA", self._axis, value))

    @property
    def home_average_acceleration(self) -> float:
        """Home average acceleration (`HOMAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "HOMAA", self._axis))

    @home_average_acceleration.setter
    def home_average_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "HOMAA", self._axis, value))

    @property
    def home_average_deceleration(self) -> float:
        """Home average deceleration (`HOMADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "HOMADA", self._axis))

    @home_average_deceleration.setter
    def home_average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "HOMADA", self._axis, value))

    @property
    def home_backs_up(self) -> bool:
        """Back up to home (`HOMBAC`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "HOMBAC", self._axis))

    @home_backs_up.setter
    def home_backs_up(self, value: bool) -> None:
        self._run(values.write(self._session, "HOMBAC", self._axis, value))

    @property
    def home_deceleration(self) -> float:
        """Home deceleration (`HOMAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "HOMAD", self._axis))

    @home_deceleration.setter
    def home_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "HOMAD", self._axis, value))

    @property
    def home_edge_negative(self) -> bool:
        """Home reference edge (`HOMEDG`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "HOMEDG", self._axis))

    @home_edge_negative.setter
    def home_edge_negative(self, value: bool) -> None:
        self._run(values.write(self._session, "HOMEDG", self._axis, value))

    @property
    def home_final_direction_negative(self) -> bool:
        """Final home direction (`HOMDF`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "HOMDF", self._axis))

    @home_final_direction_negative.setter
    def home_final_direction_negative(self, value: bool) -> None:
        self._run(values.write(self._session, "HOMDF", self._axis, value))

    @property
    def home_input_active_high(self) -> bool:
        """Home input active level (`HOMLVL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "HOMLVL", self._axis))

    @home_input_active_high.setter
    def home_input_active_high(self, value: bool) -> None:
        self._run(values.write(self._session, "HOMLVL", self._axis, value))

    @property
    def home_to_z_channel(self) -> bool:
        """Home to encoder Z (`HOMZ`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "HOMZ", self._axis))

    @home_to_z_channel.setter
    def home_to_z_channel(self, value: bool) -> None:
        self._run(values.write(self._session, "HOMZ", self._axis, value))

    @property
    def home_velocity(self) -> float:
        """Home velocity (`HOMV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return self._run(values.real(self._session, "HOMV", self._axis))

    @home_velocity.setter
    def home_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "HOMV", self._axis, value))

    @property
    def initial_master_cycle_position(self) -> float:
        """Initial master cycle position (`FMCP`). Units: master distance (SCLMAS). Range -999999999.0 to 999999999.0.
        Default 0."""
        return self._run(values.real(self._session, "FMCP", self._axis))

    @initial_master_cycle_position.setter
    def initial_master_cycle_position(self, value: Number) -> None:
        self._run(values.write(self._session, "FMCP", self._axis, value))

    @property
    def integral_feedback_gain(self) -> float:
        """Integral feedback gain (`SGI`). Units: millivolts/(count*sec). Range 0.0 to 2800000.0. Default 0.0."""
        return self._run(values.real(self._session, "SGI", self._axis))

    @integral_feedback_gain.setter
    def integral_feedback_gain(self, value: Number) -> None:
        self._run(values.write(self._session, "SGI", self._axis, value))

    @property
    def integral_limit(self) -> float:
        """Integral windup limit (`SGILIM`). Units: volts. Range 0 to 200. Default 200."""
        return self._run(values.real(self._session, "SGILIM", self._axis))

    @integral_limit.setter
    def integral_limit(self, value: Number) -> None:
        self._run(values.write(self._session, "SGILIM", self._axis, value))

    @property
    def jog_acceleration(self) -> float:
        """Jog acceleration (`JOGA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOGA", self._axis))

    @jog_acceleration.setter
    def jog_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOGA", self._axis, value))

    @property
    def jog_average_acceleration(self) -> float:
        """Jog average acceleration (`JOGAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOGAA", self._axis))

    @jog_average_acceleration.setter
    def jog_average_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOGAA", self._axis, value))

    @property
    def jog_average_deceleration(self) -> float:
        """Jog average deceleration (`JOGADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOGADA", self._axis))

    @jog_average_deceleration.setter
    def jog_average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOGADA", self._axis, value))

    @property
    def jog_deceleration(self) -> float:
        """Jog deceleration (`JOGAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOGAD", self._axis))

    @jog_deceleration.setter
    def jog_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOGAD", self._axis, value))

    @property
    def jog_high_velocity(self) -> float:
        """Jog high velocity (`JOGVH`). Units: units/sec. Range 0.0 to 200.0. Default 10.0."""
        return self._run(values.real(self._session, "JOGVH", self._axis))

    @jog_high_velocity.setter
    def jog_high_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "JOGVH", self._axis, value))

    @property
    def jog_low_velocity(self) -> float:
        """Jog low velocity (`JOGVL`). Units: units/sec. Range 0.0 to 200.0. Default 0.5."""
        return self._run(values.real(self._session, "JOGVL", self._axis))

    @jog_low_velocity.setter
    def jog_low_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "JOGVL", self._axis, value))

    @property
    def jog_mode(self) -> bool:
        """Jog mode enable (`JOG`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "JOG", self._axis))

    @jog_mode.setter
    def jog_mode(self, value: bool) -> None:
        self._run(values.write(self._session, "JOG", self._axis, value))

    @property
    def joystick_acceleration(self) -> float:
        """Joystick acceleration (`JOYA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOYA", self._axis))

    @joystick_acceleration.setter
    def joystick_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOYA", self._axis, value))

    @property
    def joystick_analog_channel_select_high(self) -> int:
        """Joystick analog channel, select high (`JOYAXH`). Range 0 to 3. Default 0."""
        return self._run(values.whole(self._session, "JOYAXH", self._axis))

    @joystick_analog_channel_select_high.setter
    def joystick_analog_channel_select_high(self, value: int) -> None:
        self._run(values.write(self._session, "JOYAXH", self._axis, value))

    @property
    def joystick_analog_channel_select_low(self) -> int:
        """Joystick analog channel, select low (`JOYAXL`). Range 0 to 3. Default 0."""
        return self._run(values.whole(self._session, "JOYAXL", self._axis))

    @joystick_analog_channel_select_low.setter
    def joystick_analog_channel_select_low(self, value: int) -> None:
        self._run(values.write(self._session, "JOYAXL", self._axis, value))

    @property
    def joystick_average_acceleration(self) -> float:
        """Joystick average acceleration (`JOYAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOYAA", self._axis))

    @joystick_average_acceleration.setter
    def joystick_average_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOYAA", self._axis, value))

    @property
    def joystick_average_deceleration(self) -> float:
        """Joystick average deceleration (`JOYADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOYADA", self._axis))

    @joystick_average_deceleration.setter
    def joystick_average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOYADA", self._axis, value))

    @property
    def joystick_deceleration(self) -> float:
        """Joystick deceleration (`JOYAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "JOYAD", self._axis))

    @joystick_deceleration.setter
    def joystick_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "JOYAD", self._axis, value))

    @property
    def joystick_high_velocity(self) -> float:
        """Joystick high velocity (`JOYVH`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return self._run(values.real(self._session, "JOYVH", self._axis))

    @joystick_high_velocity.setter
    def joystick_high_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "JOYVH", self._axis, value))

    @property
    def joystick_low_velocity(self) -> float:
        """Joystick low velocity (`JOYVL`). Units: units/sec. Range 0.0 to 200.0. Default 0.2."""
        return self._run(values.real(self._session, "JOYVL", self._axis))

    @joystick_low_velocity.setter
    def joystick_low_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "JOYVL", self._axis, value))

    @property
    def joystick_mode(self) -> bool:
        """Joystick mode enable (`JOY`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "JOY", self._axis))

    @joystick_mode.setter
    def joystick_mode(self, value: bool) -> None:
        self._run(values.write(self._session, "JOY", self._axis, value))

    @property
    def keep_buffer_on_limit(self) -> bool:
        """Keep buffer on limit (`COMEXL`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "COMEXL", self._axis))

    @keep_buffer_on_limit.setter
    def keep_buffer_on_limit(self, value: bool) -> None:
        self._run(values.write(self._session, "COMEXL", self._axis, value))

    def kill_motion(self) -> None:
        """Kill motion (`K`)."""
        self._run(values.write(self._session, "K", self._axis))

    @property
    def master(self) -> int:
        """Assign master to slave axis (`FOLMAS`). Units: sign, master axis number, source digit. Default +0."""
        return self._run(values.whole(self._session, "FOLMAS", self._axis))

    @master.setter
    def master(self, value: int) -> None:
        self._run(values.write(self._session, "FOLMAS", self._axis, value))

    @property
    def master_cycle_length(self) -> float:
        """Master cycle length (`FMCLEN`). Units: master distance (SCLMAS). Range 0.0 to 999999999.0. Default 0."""
        return self._run(values.real(self._session, "FMCLEN", self._axis))

    @master_cycle_length.setter
    def master_cycle_length(self, value: Number) -> None:
        self._run(values.write(self._session, "FMCLEN", self._axis, value))

    @property
    def master_cycle_number(self) -> int:
        """Report master cycle number (`TNMCY`)."""
        return self._run(values.whole(self._session, "TNMCY", self._axis))

    @property
    def master_cycle_position(self) -> float:
        """Report master cycle position (`TPMAS`)."""
        return self._run(values.real(self._session, "TPMAS", self._axis))

    @property
    def master_distance(self) -> float:
        """Master distance (`FOLMD`). Units: master distance (SCLMAS). Range 0 to 999999999. Default 0."""
        return self._run(values.real(self._session, "FOLMD", self._axis))

    @master_distance.setter
    def master_distance(self, value: Number) -> None:
        self._run(values.write(self._session, "FOLMD", self._axis, value))

    @property
    def master_prediction_enabled(self) -> bool:
        """Master position prediction enable (`FPPEN`). Default 1. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "FPPEN", self._axis))

    @master_prediction_enabled.setter
    def master_prediction_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "FPPEN", self._axis, value))

    @property
    def master_scale_factor(self) -> int:
        """Master scale factor (`SCLMAS`). Units: counts/unit. Range 1 to 999999. Default 1."""
        return self._run(values.whole(self._session, "SCLMAS", self._axis))

    @master_scale_factor.setter
    def master_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "SCLMAS", self._axis, value))

    @property
    def master_velocity(self) -> float:
        """Report master velocity (`TVMAS`)."""
        return self._run(values.real(self._session, "TVMAS", self._axis))

    @property
    def maximum_position_error(self) -> float:
        """Maximum allowable position error (`SMPER`). Units: feedback counts (scaled by SCLD). Range 0 to 200000000.
        Default 4000."""
        return self._run(values.real(self._session, "SMPER", self._axis))

    @maximum_position_error.setter
    def maximum_position_error(self, value: Number) -> None:
        self._run(values.write(self._session, "SMPER", self._axis, value))

    @property
    def motor_position(self) -> float:
        """Report motor position (stepper report, answered for hosts) (`TPM`)."""
        return self._run(values.real(self._session, "TPM", self._axis))

    @property
    def negative_soft_limit(self) -> float:
        """Negative software limit (`LSNEG`). Units: distance units (SCLD). Range -999999999.99999 to 999999999.99999.
        Default 0."""
        return self._run(values.real(self._session, "LSNEG", self._axis))

    @negative_soft_limit.setter
    def negative_soft_limit(self, value: Number) -> None:
        self._run(values.write(self._session, "LSNEG", self._axis, value))

    @property
    def net_shift(self) -> float:
        """Report net shift (`TPSHF`)."""
        return self._run(values.real(self._session, "TPSHF", self._axis))

    @property
    def output_limit(self) -> float:
        """Analog output limit (`DACLIM`). Units: volts. Range 0.0 to 10.0. Default 10.0."""
        return self._run(values.real(self._session, "DACLIM", self._axis))

    @output_limit.setter
    def output_limit(self, value: Number) -> None:
        self._run(values.write(self._session, "DACLIM", self._axis, value))

    @property
    def output_offset(self) -> float:
        """Servo output offset (`SOFFS`). Units: volts. Range -10.0 to 10.0. Default 0.0."""
        return self._run(values.real(self._session, "SOFFS", self._axis))

    @output_offset.setter
    def output_offset(self, value: Number) -> None:
        self._run(values.write(self._session, "SOFFS", self._axis, value))

    @property
    def position(self) -> float:
        """Report encoder position (`TPE`)."""
        return self._run(values.real(self._session, "TPE", self._axis))

    @property
    def position_error(self) -> float:
        """Report position error (`TPER`)."""
        return self._run(values.real(self._session, "TPER", self._axis))

    @property
    def positive_soft_limit(self) -> float:
        """Positive software limit (`LSPOS`). Units: distance units (SCLD). Range -999999999.99999 to 999999999.99999.
        Default 0."""
        return self._run(values.real(self._session, "LSPOS", self._axis))

    @positive_soft_limit.setter
    def positive_soft_limit(self, value: Number) -> None:
        self._run(values.write(self._session, "LSPOS", self._axis, value))

    @property
    def proportional_feedback_gain(self) -> float:
        """Proportional feedback gain (`SGP`). Units: millivolts/count (6000 text: millivolts/step). Range 0.0 to
        2800000.0. Default 0.5."""
        return self._run(values.real(self._session, "SGP", self._axis))

    @proportional_feedback_gain.setter
    def proportional_feedback_gain(self, value: Number) -> None:
        self._run(values.write(self._session, "SGP", self._axis, value))

    @property
    def ratio_denominator(self) -> float:
        """Slave-to-master ratio denominator (`FOLRD`). Units: master distance (SCLMAS). Range 1.0 to 999999999. Default
        1."""
        return self._run(values.real(self._session, "FOLRD", self._axis))

    @ratio_denominator.setter
    def ratio_denominator(self, value: Number) -> None:
        self._run(values.write(self._session, "FOLRD", self._axis, value))

    @property
    def ratio_numerator(self) -> float:
        """Slave-to-master ratio numerator (`FOLRN`). Units: slave distance (SCLD). Range 0.0 to 999999999.99999.
        Default 1."""
        return self._run(values.real(self._session, "FOLRN", self._axis))

    @ratio_numerator.setter
    def ratio_numerator(self, value: Number) -> None:
        self._run(values.write(self._session, "FOLRN", self._axis, value))

    @property
    def registration_distance_for_trigger_a(self) -> float:
        """Registration distance for trigger A (`REGA`). Units: distance units (SCLD). Range 0 to 999999999.99999.
        Default 0."""
        return self._run(values.real(self._session, "REGA", self._axis))

    @registration_distance_for_trigger_a.setter
    def registration_distance_for_trigger_a(self, value: Number) -> None:
        self._run(values.write(self._session, "REGA", self._axis, value))

    @property
    def registration_distance_for_trigger_b(self) -> float:
        """Registration distance for trigger B (`REGB`). Units: distance units (SCLD). Range 0 to 999999999.99999.
        Default 0."""
        return self._run(values.real(self._session, "REGB", self._axis))

    @registration_distance_for_trigger_b.setter
    def registration_distance_for_trigger_b(self, value: Number) -> None:
        self._run(values.write(self._session, "REGB", self._axis, value))

    @property
    def registration_enabled(self) -> bool:
        """Registration enable (`RE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "RE", self._axis))

    @registration_enabled.setter
    def registration_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "RE", self._axis, value))

    @property
    def registration_lockout(self) -> float:
        """Registration lockout distance (`REGLOD`). Units: distance units (SCLD). Range 0 to 999999999.99999. Default
        0."""
        return self._run(values.real(self._session, "REGLOD", self._axis))

    @registration_lockout.setter
    def registration_lockout(self, value: Number) -> None:
        self._run(values.write(self._session, "REGLOD", self._axis, value))

    @property
    def registration_single_shot(self) -> bool:
        """Registration single shot (`REGSS`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "REGSS", self._axis))

    @registration_single_shot.setter
    def registration_single_shot(self, value: bool) -> None:
        self._run(values.write(self._session, "REGSS", self._axis, value))

    def restart_master_cycle(self) -> None:
        """Restart master cycle counting (`FMCNEW`). Values: 0, 1 or X (X = leave unchanged)."""
        self._run(values.write(self._session, "FMCNEW", self._axis))

    def set_position(self, value: Number) -> None:
        """Establish absolute position (`PSET`). Units: distance units. Range -999999999.99999 to 999999999.99999."""
        self._run(values.write(self._session, "PSET", self._axis, value))

    @property
    def settling_time(self) -> int:
        """Report settling time (`TSTLT`)."""
        return self._run(values.whole(self._session, "TSTLT", self._axis))

    def shift_by(self, value: Number) -> None:
        """Preset following shift (`FSHFD`). Units: slave distance (SCLD). Range -999999999.99999 to 999999999.99999."""
        self._run(values.write(self._session, "FSHFD", self._axis, value))

    def shift_continuously(self, value: Number) -> None:
        """Continuous following shift (`FSHFC`). Range 0 to 3."""
        self._run(values.write(self._session, "FSHFC", self._axis, value))

    @property
    def slave_position(self) -> float:
        """Report slave position (`TPSLV`)."""
        return self._run(values.real(self._session, "TPSLV", self._axis))

    @property
    def soft_limit_average_deceleration(self) -> float:
        """Soft limit average deceleration (`LSADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return self._run(values.real(self._session, "LSADA", self._axis))

    @soft_limit_average_deceleration.setter
    def soft_limit_average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "LSADA", self._axis, value))

    @property
    def soft_limit_deceleration(self) -> float:
        """Soft limit deceleration (`LSAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 100.0."""
        return self._run(values.real(self._session, "LSAD", self._axis))

    @soft_limit_deceleration.setter
    def soft_limit_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "LSAD", self._axis, value))

    @property
    def soft_limits(self) -> EndOfTravel:
        """Software end-of-travel limit enable (`LS`). Range 0 to 3. Default 0."""
        return self._run(values.choice(self._session, "LS", self._axis, EndOfTravel))

    @soft_limits.setter
    def soft_limits(self, value: EndOfTravel) -> None:
        self._run(values.write(self._session, "LS", self._axis, value))

    def start_homing(self, *, negative: bool) -> None:
        """Start homing (`HOM`). Values: 0 start in positive direction, 1 start in negative direction, X do not home."""
        self._run(values.write(self._session, "HOM", self._axis, "1" if negative else "0"))

    @property
    def status_text(self) -> tuple[str, ...]:
        """Report axis status as text (`TASF`)."""
        return self._run(values.lines_of(self._session, "TASF", self._axis))

    def stop_motion(self) -> None:
        """Stop motion (`S`)."""
        self._run(values.write(self._session, "S", self._axis))

    def store_compiled_move_segment(self) -> None:
        """Store compiled move segment (`GOBUF`). Values: 0, 1 or X (X = leave unchanged)."""
        self._run(values.write(self._session, "GOBUF", self._axis))

    @property
    def target_zone_distance(self) -> float:
        """Target distance zone (`STRGTD`). Units: feedback counts (scaled by SCLD). Range 0 to 999999999. Default
        50."""
        return self._run(values.real(self._session, "STRGTD", self._axis))

    @target_zone_distance.setter
    def target_zone_distance(self, value: Number) -> None:
        self._run(values.write(self._session, "STRGTD", self._axis, value))

    @property
    def target_zone_enabled(self) -> bool:
        """Enable target zone settling (`STRGTE`). Default 0. Values: 0, 1 or X (X = leave unchanged)."""
        return self._run(values.flag(self._session, "STRGTE", self._axis))

    @target_zone_enabled.setter
    def target_zone_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "STRGTE", self._axis, value))

    @property
    def target_zone_timeout(self) -> int:
        """Target settling time-out (`STRGTT`). Units: milliseconds. Range 0 to 5000. Default 1000."""
        return self._run(values.whole(self._session, "STRGTT", self._axis))

    @target_zone_timeout.setter
    def target_zone_timeout(self, value: int) -> None:
        self._run(values.write(self._session, "STRGTT", self._axis, value))

    @property
    def target_zone_velocity(self) -> float:
        """Target velocity zone (`STRGTV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return self._run(values.real(self._session, "STRGTV", self._axis))

    @target_zone_velocity.setter
    def target_zone_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "STRGTV", self._axis, value))

    def use_gain_set(self, value: Number) -> None:
        """Enable servo gain set (`SGENB`). Units: gain set number. Range 1 to 5."""
        self._run(values.write(self._session, "SGENB", self._axis, value))

    @property
    def velocity(self) -> float:
        """Velocity (`V`). Units: units/sec (revs/sec unscaled). Range 0.0 to 200.0. Default 1.0."""
        return self._run(values.real(self._session, "V", self._axis))

    @velocity.setter
    def velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "V", self._axis, value))

    @property
    def velocity_feedback_gain(self) -> float:
        """Velocity feedback gain (`SGV`). Units: microvolts/(count/sec). Range 0.0 to 2800000.0. Default 0.0."""
        return self._run(values.real(self._session, "SGV", self._axis))

    @velocity_feedback_gain.setter
    def velocity_feedback_gain(self, value: Number) -> None:
        self._run(values.write(self._session, "SGV", self._axis, value))

    @property
    def velocity_feedforward_gain(self) -> float:
        """Velocity feedforward gain (`SGVF`). Units: microvolts/(count/sec). Range 0.0 to 2800000.0. Default 0.0."""
        return self._run(values.real(self._session, "SGVF", self._axis))

    @velocity_feedforward_gain.setter
    def velocity_feedforward_gain(self, value: Number) -> None:
        self._run(values.write(self._session, "SGVF", self._axis, value))

    @property
    def velocity_scale_factor(self) -> int:
        """Velocity scale factor (`SCLV`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return self._run(values.whole(self._session, "SCLV", self._axis))

    @velocity_scale_factor.setter
    def velocity_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "SCLV", self._axis, value))


class UnitSettings(BlockingFace):
    """The settings of the whole unit."""

    @property
    def analog_override_enabled(self) -> str:
        """Enable analog override (`ANVOEN`). Default 0."""
        return self._run(values.bits(self._session, "ANVOEN", self._axis))

    @analog_override_enabled.setter
    def analog_override_enabled(self, value: str) -> None:
        self._run(values.write(self._session, "ANVOEN", self._axis, value))

    @property
    def axes_in_use(self) -> int:
        """Participating axes (`INDAX`). Range 1 to 2. Default 2."""
        return self._run(values.whole(self._session, "INDAX", self._axis))

    @axes_in_use.setter
    def axes_in_use(self, value: int) -> None:
        self._run(values.write(self._session, "INDAX", self._axis, value))

    @property
    def beginning_of_transmission_characters(self) -> tuple[int, ...]:
        """Beginning-of-transmission characters (`BOT`). Range 0 to 256. Default 0,0,0."""
        return self._run(values.wholes(self._session, "BOT", self._axis))

    @beginning_of_transmission_characters.setter
    def beginning_of_transmission_characters(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "BOT", self._axis, *value))

    @property
    def condition_inputs(self) -> str:
        """On input condition (`ONIN`). Default X. Values: 0,1,X."""
        return self._run(values.bits(self._session, "ONIN", self._axis))

    @condition_inputs.setter
    def condition_inputs(self, value: str) -> None:
        self._run(values.write(self._session, "ONIN", self._axis, value))

    @property
    def condition_program(self) -> str:
        """ON condition program (`ONP`)."""
        return self._run(values.text_of(self._session, "ONP", self._axis))

    @condition_program.setter
    def condition_program(self, value: str) -> None:
        self._run(values.write(self._session, "ONP", self._axis, value))

    @property
    def condition_user_status(self) -> str:
        """On user status condition (`ONUS`). Default X. Values: 0,1,X."""
        return self._run(values.bits(self._session, "ONUS", self._axis))

    @condition_user_status.setter
    def condition_user_status(self, value: str) -> None:
        self._run(values.write(self._session, "ONUS", self._axis, value))

    @property
    def conditions_enabled(self) -> str:
        """Enable ON conditions (`ONCOND`). Default 0."""
        return self._run(values.bits(self._session, "ONCOND", self._axis))

    @conditions_enabled.setter
    def conditions_enabled(self, value: str) -> None:
        self._run(values.write(self._session, "ONCOND", self._axis, value))

    @property
    def continuous_command_execution(self) -> bool:
        """Continuous command processing (`COMEXC`). Default 0."""
        return self._run(values.flag(self._session, "COMEXC", self._axis))

    @continuous_command_execution.setter
    def continuous_command_execution(self, value: bool) -> None:
        self._run(values.write(self._session, "COMEXC", self._axis, value))

    @property
    def data_program_size(self) -> tuple[int, ...]:
        """Create data program (`DATSIZ`). Default 1,0."""
        return self._run(values.wholes(self._session, "DATSIZ", self._axis))

    @data_program_size.setter
    def data_program_size(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "DATSIZ", self._axis, *value))

    @property
    def echo(self) -> bool:
        """Communication echo (`ECHO`). Default 1."""
        return self._run(values.flag(self._session, "ECHO", self._axis))

    @echo.setter
    def echo(self, value: bool) -> None:
        self._run(values.write(self._session, "ECHO", self._axis, value))

    @property
    def end_of_line_characters(self) -> tuple[int, ...]:
        """End-of-line characters (`EOL`). Range 0 to 256. Default 13,10,0."""
        return self._run(values.wholes(self._session, "EOL", self._axis))

    @end_of_line_characters.setter
    def end_of_line_characters(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "EOL", self._axis, *value))

    @property
    def end_of_transmission_characters(self) -> tuple[int, ...]:
        """End-of-transmission characters (`EOT`). Range 0 to 256. Default 13,0,0."""
        return self._run(values.wholes(self._session, "EOT", self._axis))

    @end_of_transmission_characters.setter
    def end_of_transmission_characters(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "EOT", self._axis, *value))

    @property
    def error_checking(self) -> str:
        """Enable error checking (`ERROR`). Default 0. Values: 0,1,X; ERROR.n-b sets one."""
        return self._run(values.bits(self._session, "ERROR", self._axis))

    @error_checking.setter
    def error_checking(self, value: str) -> None:
        self._run(values.write(self._session, "ERROR", self._axis, value))

    @property
    def error_level(self) -> ErrorLevel:
        """Error detection level (`ERRLVL`). Range 0 to 4. Default 4."""
        return self._run(values.choice(self._session, "ERRLVL", self._axis, ErrorLevel))

    @error_level.setter
    def error_level(self, value: ErrorLevel) -> None:
        self._run(values.write(self._session, "ERRLVL", self._axis, value))

    @property
    def error_program(self) -> str:
        """Error program (`ERRORP`)."""
        return self._run(values.text_of(self._session, "ERRORP", self._axis))

    @error_program.setter
    def error_program(self, value: str) -> None:
        self._run(values.write(self._session, "ERRORP", self._axis, value))

    @property
    def error_prompt(self) -> tuple[int, ...]:
        """Error prompt (`ERRBAD`). Range 0 to 256. Default 13,10,63,32."""
        return self._run(values.wholes(self._session, "ERRBAD", self._axis))

    @error_prompt.setter
    def error_prompt(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "ERRBAD", self._axis, *value))

    @property
    def good_prompt(self) -> tuple[int, ...]:
        """Good prompt (`ERROK`). Range 0 to 256. Default 13,10,62,32."""
        return self._run(values.wholes(self._session, "ERROK", self._axis))

    @good_prompt.setter
    def good_prompt(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "ERROK", self._axis, *value))

    @property
    def hard_limit_input_active_level(self) -> str:
        """Hard limit input active level (`LHLVL`). Default 0. Values: 0 active low, 1 active high, X."""
        return self._run(values.bits(self._session, "LHLVL", self._axis))

    @hard_limit_input_active_level.setter
    def hard_limit_input_active_level(self, value: str) -> None:
        self._run(values.write(self._session, "LHLVL", self._axis, value))

    @property
    def input_active_level(self) -> str:
        """Input active level (`INLVL`). Default 0. Values: 0 active low, 1 active high."""
        return self._run(values.bits(self._session, "INLVL", self._axis))

    @input_active_level.setter
    def input_active_level(self, value: str) -> None:
        self._run(values.write(self._session, "INLVL", self._axis, value))

    @property
    def input_debounce_time(self) -> tuple[int, ...]:
        """Input debounce time (`INDEB`). Units: milliseconds. Range 1 to 250. Default 4,24."""
        return self._run(values.wholes(self._session, "INDEB", self._axis))

    @input_debounce_time.setter
    def input_debounce_time(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "INDEB", self._axis, *value))

    def get_input_function(self, index: int | None = None) -> tuple[str, ...]:
        """Assign input function (`INFNC`). Syntax: <!>INFNC<i>-<a><c>."""
        return self._run(values.lines_of(self._session, "INFNC", self._axis, str(index or "")))

    def set_input_function(self, text: str) -> None:
        """Assign input function (`INFNC`). Syntax: <!>INFNC<i>-<a><c>."""
        self._run(values.write(self._session, "INFNC", self._axis, text))

    @property
    def input_functions_enabled(self) -> bool:
        """Input function enable (`INFEN`). Default 0."""
        return self._run(values.flag(self._session, "INFEN", self._axis))

    @input_functions_enabled.setter
    def input_functions_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "INFEN", self._axis, value))

    @property
    def input_override(self) -> str:
        """Input override (`INEN`). Default E. Values: 0 force inactive, 1 force active, E enable, X unchanged."""
        return self._run(values.bits(self._session, "INEN", self._axis))

    @input_override.setter
    def input_override(self, value: str) -> None:
        self._run(values.write(self._session, "INEN", self._axis, value))

    @property
    def joystick_centre_deadband(self) -> tuple[float, ...]:
        """Joystick centre deadband (`JOYCDB`). Units: volts. Range 0.0 to 1.25. Default 0.1."""
        return self._run(values.reals(self._session, "JOYCDB", self._axis))

    @joystick_centre_deadband.setter
    def joystick_centre_deadband(self, value: Sequence[Number]) -> None:
        self._run(values.write(self._session, "JOYCDB", self._axis, *value))

    @property
    def joystick_centre_voltage(self) -> tuple[float, ...]:
        """Joystick centre voltage (`JOYCTR`). Units: volts. Range 0.0 to 2.5. Default 1.25."""
        return self._run(values.reals(self._session, "JOYCTR", self._axis))

    @joystick_centre_voltage.setter
    def joystick_centre_voltage(self, value: Sequence[Number]) -> None:
        self._run(values.write(self._session, "JOYCTR", self._axis, *value))

    @property
    def joystick_end_deadband(self) -> tuple[float, ...]:
        """Joystick end deadband (`JOYEDB`). Units: volts. Range 0.0 to 1.25. Default 0.1."""
        return self._run(values.reals(self._session, "JOYEDB", self._axis))

    @joystick_end_deadband.setter
    def joystick_end_deadband(self, value: Sequence[Number]) -> None:
        self._run(values.write(self._session, "JOYEDB", self._axis, *value))

    @property
    def keep_buffer_on_kill(self) -> bool:
        """Keep buffer on kill (`COMEXK`). Default 0."""
        return self._run(values.flag(self._session, "COMEXK", self._axis))

    @keep_buffer_on_kill.setter
    def keep_buffer_on_kill(self, value: bool) -> None:
        self._run(values.write(self._session, "COMEXK", self._axis, value))

    @property
    def keep_buffer_on_stop(self) -> int:
        """Keep buffer on stop (`COMEXS`). Range 0 to 2. Default 0."""
        return self._run(values.whole(self._session, "COMEXS", self._axis))

    @keep_buffer_on_stop.setter
    def keep_buffer_on_stop(self, value: int) -> None:
        self._run(values.write(self._session, "COMEXS", self._axis, value))

    @property
    def lock_to_a_port(self) -> int:
        """Lock to a port (`LOCK`). Range 0 to 2. Default 0."""
        return self._run(values.whole(self._session, "LOCK", self._axis))

    @lock_to_a_port.setter
    def lock_to_a_port(self, value: int) -> None:
        self._run(values.write(self._session, "LOCK", self._axis, value))

    @property
    def memory_partition(self) -> tuple[int, ...]:
        """Partition memory (`MEMORY`). Units: bytes, even numbers: program area, compiled area. Range 1000 to 39000.
        Default 21400,18600."""
        return self._run(values.wholes(self._session, "MEMORY", self._axis))

    @memory_partition.setter
    def memory_partition(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "MEMORY", self._axis, *value))

    def get_on_variable_1_condition(self, index: int | None = None) -> tuple[str, ...]:
        """On variable 1 condition (`ONVARA`). Default 0. Syntax: <!>ONVARA<i>,<r>,<r>."""
        return self._run(values.lines_of(self._session, "ONVARA", self._axis, str(index or "")))

    def set_on_variable_1_condition(self, text: str) -> None:
        """On variable 1 condition (`ONVARA`). Default 0. Syntax: <!>ONVARA<i>,<r>,<r>."""
        self._run(values.write(self._session, "ONVARA", self._axis, text))

    def get_on_variable_2_condition(self, index: int | None = None) -> tuple[str, ...]:
        """On variable 2 condition (`ONVARB`). Default 0. Syntax: <!>ONVARB<i>,<r>,<r>."""
        return self._run(values.lines_of(self._session, "ONVARB", self._axis, str(index or "")))

    def set_on_variable_2_condition(self, text: str) -> None:
        """On variable 2 condition (`ONVARB`). Default 0. Syntax: <!>ONVARB<i>,<r>,<r>."""
        self._run(values.write(self._session, "ONVARB", self._axis, text))

    @property
    def output_active_level(self) -> str:
        """Output active level (`OUTLVL`). Default 0. Values: 0 active low (on sinks), 1 active high."""
        return self._run(values.bits(self._session, "OUTLVL", self._axis))

    @output_active_level.setter
    def output_active_level(self, value: str) -> None:
        self._run(values.write(self._session, "OUTLVL", self._axis, value))

    def get_output_function(self, index: int | None = None) -> tuple[str, ...]:
        """Assign output function (`OUTFNC`). Syntax: <!>OUTFNC<i>-<a><c>."""
        return self._run(values.lines_of(self._session, "OUTFNC", self._axis, str(index or "")))

    def set_output_function(self, text: str) -> None:
        """Assign output function (`OUTFNC`). Syntax: <!>OUTFNC<i>-<a><c>."""
        self._run(values.write(self._session, "OUTFNC", self._axis, text))

    @property
    def output_functions_enabled(self) -> bool:
        """Output function enable (`OUTFEN`). Default 0."""
        return self._run(values.flag(self._session, "OUTFEN", self._axis))

    @output_functions_enabled.setter
    def output_functions_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "OUTFEN", self._axis, value))

    def get_output_on_position_axis_1(self, index: int | None = None) -> tuple[str, ...]:
        """Output on position, axis 1 (`OUTPA`). Syntax: <!>OUTPA<b>,<b>,<r>,<i>."""
        return self._run(values.lines_of(self._session, "OUTPA", self._axis, str(index or "")))

    def set_output_on_position_axis_1(self, text: str) -> None:
        """Output on position, axis 1 (`OUTPA`). Syntax: <!>OUTPA<b>,<b>,<r>,<i>."""
        self._run(values.write(self._session, "OUTPA", self._axis, text))

    def get_output_on_position_axis_2(self, index: int | None = None) -> tuple[str, ...]:
        """Output on position, axis 2 (`OUTPB`). Syntax: <!>OUTPB<b>,<b>,<r>,<i>."""
        return self._run(values.lines_of(self._session, "OUTPB", self._axis, str(index or "")))

    def set_output_on_position_axis_2(self, text: str) -> None:
        """Output on position, axis 2 (`OUTPB`). Syntax: <!>OUTPB<b>,<b>,<r>,<i>."""
        self._run(values.write(self._session, "OUTPB", self._axis, text))

    @property
    def output_override(self) -> str:
        """Output override (`OUTEN`). Default E. Values: 0 force off, 1 force on, E enable normal, X unchanged."""
        return self._run(values.bits(self._session, "OUTEN", self._axis))

    @output_override.setter
    def output_override(self, value: str) -> None:
        self._run(values.write(self._session, "OUTEN", self._axis, value))

    @property
    def outputs(self) -> str:
        """Set programmable outputs (`OUT`). Default 0. Values: 0 off, 1 on, X unchanged; OUT.n-b sets one."""
        return self._run(values.bits(self._session, "OUT", self._axis))

    @outputs.setter
    def outputs(self, value: str) -> None:
        self._run(values.write(self._session, "OUT", self._axis, value))

    @property
    def panel_jog(self) -> bool:
        """Enable RP240 jog (`DJOG`). Default 0."""
        return self._run(values.flag(self._session, "DJOG", self._axis))

    @panel_jog.setter
    def panel_jog(self, value: bool) -> None:
        self._run(values.write(self._session, "DJOG", self._axis, value))

    @property
    def panel_leds(self) -> str:
        """Control display LEDs (`DLED`). Default 0."""
        return self._run(values.bits(self._session, "DLED", self._axis))

    @panel_leds.setter
    def panel_leds(self, value: str) -> None:
        self._run(values.write(self._session, "DLED", self._axis, value))

    @property
    def panel_read_immediate(self) -> bool:
        """Immediate display read (`DREADI`). Default 0."""
        return self._run(values.flag(self._session, "DREADI", self._axis))

    @panel_read_immediate.setter
    def panel_read_immediate(self, value: bool) -> None:
        self._run(values.write(self._session, "DREADI", self._axis, value))

    @property
    def panel_stop_key(self) -> bool:
        """Enable RP240 stop key (`DSTP`). Default 1."""
        return self._run(values.flag(self._session, "DSTP", self._axis))

    @panel_stop_key.setter
    def panel_stop_key(self, value: bool) -> None:
        self._run(values.write(self._session, "DSTP", self._axis, value))

    @property
    def path_acceleration(self) -> float:
        """Path acceleration (`PA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "PA", self._axis))

    @path_acceleration.setter
    def path_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "PA", self._axis, value))

    @property
    def path_acceleration_scale_factor(self) -> int:
        """Path acceleration scale factor (`PSCLA`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return self._run(values.whole(self._session, "PSCLA", self._axis))

    @path_acceleration_scale_factor.setter
    def path_acceleration_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "PSCLA", self._axis, value))

    @property
    def path_average_acceleration(self) -> float:
        """Path average acceleration (`PAA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "PAA", self._axis))

    @path_average_acceleration.setter
    def path_average_acceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "PAA", self._axis, value))

    @property
    def path_average_deceleration(self) -> float:
        """Path average deceleration (`PADA`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "PADA", self._axis))

    @path_average_deceleration.setter
    def path_average_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "PADA", self._axis, value))

    @property
    def path_deceleration(self) -> float:
        """Path deceleration (`PAD`). Units: units/sec^2. Range 0.00025 to 24999975. Default 10.0."""
        return self._run(values.real(self._session, "PAD", self._axis))

    @path_deceleration.setter
    def path_deceleration(self, value: Number) -> None:
        self._run(values.write(self._session, "PAD", self._axis, value))

    @property
    def path_distance_scale_factor(self) -> int:
        """Path distance scale factor (`PSCLD`). Units: counts/unit. Range 1 to 999999. Default 1."""
        return self._run(values.whole(self._session, "PSCLD", self._axis))

    @path_distance_scale_factor.setter
    def path_distance_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "PSCLD", self._axis, value))

    @property
    def path_velocity(self) -> float:
        """Path velocity (`PV`). Units: units/sec. Range 0.0 to 200.0. Default 1.0."""
        return self._run(values.real(self._session, "PV", self._axis))

    @path_velocity.setter
    def path_velocity(self, value: Number) -> None:
        self._run(values.write(self._session, "PV", self._axis, value))

    @property
    def path_velocity_scale_factor(self) -> int:
        """Path velocity scale factor (`PSCLV`). Units: counts/unit. Range 1 to 999999. Default 4000."""
        return self._run(values.whole(self._session, "PSCLV", self._axis))

    @path_velocity_scale_factor.setter
    def path_velocity_scale_factor(self, value: int) -> None:
        self._run(values.write(self._session, "PSCLV", self._axis, value))

    def get_plc_input_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define PLC input set (`INPLC`). Syntax: <!>INPLC<i>,<i-i>,<i>,<i>."""
        return self._run(values.lines_of(self._session, "INPLC", self._axis, str(index or "")))

    def set_plc_input_set(self, text: str) -> None:
        """Define PLC input set (`INPLC`). Syntax: <!>INPLC<i>,<i-i>,<i>,<i>."""
        self._run(values.write(self._session, "INPLC", self._axis, text))

    def get_plc_output_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define PLC output set (`OUTPLC`). Syntax: <!>OUTPLC<i>,<i-i>,<i>,<i>."""
        return self._run(values.lines_of(self._session, "OUTPLC", self._axis, str(index or "")))

    def set_plc_output_set(self, text: str) -> None:
        """Define PLC output set (`OUTPLC`). Syntax: <!>OUTPLC<i>,<i-i>,<i>,<i>."""
        self._run(values.write(self._session, "OUTPLC", self._axis, text))

    @property
    def port_for_port_settings(self) -> int:
        """Select port for port settings (`PORT`). Range 1 to 2. Default 1."""
        return self._run(values.whole(self._session, "PORT", self._axis))

    @port_for_port_settings.setter
    def port_for_port_settings(self, value: int) -> None:
        self._run(values.write(self._session, "PORT", self._axis, value))

    @property
    def program_definition_prompt(self) -> tuple[int, ...]:
        """Program definition prompt (`ERRDEF`). Range 0 to 256. Default 13,10,45,32."""
        return self._run(values.wholes(self._session, "ERRDEF", self._axis))

    @program_definition_prompt.setter
    def program_definition_prompt(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "ERRDEF", self._axis, *value))

    @property
    def program_selection(self) -> tuple[int, ...]:
        """Select program by inputs (`INSELP`). Units: mode 0 off, 1 BCD (INFNC B), 2 one-to-one (INFNC P); strobe ms
        0-5000. Range 0 to 5000. Default 0."""
        return self._run(values.wholes(self._session, "INSELP", self._axis))

    @program_selection.setter
    def program_selection(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "INSELP", self._axis, *value))

    @property
    def radians(self) -> bool:
        """Radian mode (`RADIAN`). Default 0."""
        return self._run(values.flag(self._session, "RADIAN", self._axis))

    @radians.setter
    def radians(self, value: bool) -> None:
        self._run(values.write(self._session, "RADIAN", self._axis, value))

    @property
    def resume_moves_after_pause(self) -> bool:
        """Resume effect of pause/continue (`COMEXR`). Default 0."""
        return self._run(values.flag(self._session, "COMEXR", self._axis))

    @resume_moves_after_pause.setter
    def resume_moves_after_pause(self, value: bool) -> None:
        self._run(values.write(self._session, "COMEXR", self._axis, value))

    @property
    def rp240_check(self) -> int:
        """RP240 check (`DRPCHK`). Range 0 to 3. Default 0."""
        return self._run(values.whole(self._session, "DRPCHK", self._axis))

    @rp240_check.setter
    def rp240_check(self, value: int) -> None:
        self._run(values.write(self._session, "DRPCHK", self._axis, value))

    @property
    def scaling(self) -> bool:
        """Enable scaling (`SCALE`). Default 0."""
        return self._run(values.flag(self._session, "SCALE", self._axis))

    @scaling.setter
    def scaling(self, value: bool) -> None:
        self._run(values.write(self._session, "SCALE", self._axis, value))

    @property
    def serial_port_enabled(self) -> bool:
        """Enable serial communication (`E`). Default 1."""
        return self._run(values.flag(self._session, "E", self._axis))

    @serial_port_enabled.setter
    def serial_port_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "E", self._axis, value))

    @property
    def servo_sample_ratio(self) -> int:
        """Servo sampling frequency ratio (`SSFR`). Range 1 to 8. Default 4. Values: 1, 2, 4 or 8; periods:
        emulator/engine/rates.py."""
        return self._run(values.whole(self._session, "SSFR", self._axis))

    @servo_sample_ratio.setter
    def servo_sample_ratio(self, value: int) -> None:
        self._run(values.write(self._session, "SSFR", self._axis, value))

    @property
    def start_up_program(self) -> str:
        """Power-up program (`STARTP`)."""
        return self._run(values.text_of(self._session, "STARTP", self._axis))

    @start_up_program.setter
    def start_up_program(self, value: str) -> None:
        self._run(values.write(self._session, "STARTP", self._axis, value))

    @property
    def step_mode(self) -> bool:
        """Step mode (`STEP`). Default 0."""
        return self._run(values.flag(self._session, "STEP", self._axis))

    @step_mode.setter
    def step_mode(self, value: bool) -> None:
        self._run(values.write(self._session, "STEP", self._axis, value))

    def get_thumbwheel_input_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define thumbwheel input set (`INSTW`). Syntax: <!>INSTW<i>,<i-i>,<i>."""
        return self._run(values.lines_of(self._session, "INSTW", self._axis, str(index or "")))

    def set_thumbwheel_input_set(self, text: str) -> None:
        """Define thumbwheel input set (`INSTW`). Syntax: <!>INSTW<i>,<i-i>,<i>."""
        self._run(values.write(self._session, "INSTW", self._axis, text))

    def get_thumbwheel_output_set(self, index: int | None = None) -> tuple[str, ...]:
        """Define thumbwheel output set (`OUTTW`). Syntax: <!>OUTTW<i>,<i-i>,<i>,<i>."""
        return self._run(values.lines_of(self._session, "OUTTW", self._axis, str(index or "")))

    def set_thumbwheel_output_set(self, text: str) -> None:
        """Define thumbwheel output set (`OUTTW`). Syntax: <!>OUTTW<i>,<i-i>,<i>,<i>."""
        self._run(values.write(self._session, "OUTTW", self._axis, text))

    @property
    def timer_interrupt_value(self) -> tuple[int, ...]:
        """Timer interrupt value (`TIMINT`)."""
        return self._run(values.wholes(self._session, "TIMINT", self._axis))

    @timer_interrupt_value.setter
    def timer_interrupt_value(self, value: Sequence[int]) -> None:
        self._run(values.write(self._session, "TIMINT", self._axis, *value))

    @property
    def trace_mode(self) -> bool:
        """Trace mode (`TRACE`). Default 0."""
        return self._run(values.flag(self._session, "TRACE", self._axis))

    @trace_mode.setter
    def trace_mode(self, value: bool) -> None:
        self._run(values.write(self._session, "TRACE", self._axis, value))

    @property
    def translation_mode(self) -> bool:
        """Translation mode (`TRANS`). Default 0."""
        return self._run(values.flag(self._session, "TRANS", self._axis))

    @translation_mode.setter
    def translation_mode(self, value: bool) -> None:
        self._run(values.write(self._session, "TRANS", self._axis, value))

    @property
    def trigger_lockout_time(self) -> int:
        """Trigger lockout time (`TRGLOT`). Units: milliseconds. Range 0 to 250. Default 24."""
        return self._run(values.whole(self._session, "TRGLOT", self._axis))

    @trigger_lockout_time.setter
    def trigger_lockout_time(self, value: int) -> None:
        self._run(values.write(self._session, "TRGLOT", self._axis, value))

    @property
    def unit_address(self) -> int:
        """Unit address / auto-address (`ADDR`). Range 0 to 99. Default 0."""
        return self._run(values.whole(self._session, "ADDR", self._axis))

    @unit_address.setter
    def unit_address(self, value: int) -> None:
        self._run(values.write(self._session, "ADDR", self._axis, value))

    def get_user_status_bit(self, index: int | None = None) -> tuple[str, ...]:
        """Define user status bit (`INDUST`). Syntax: <!>INDUST<i>-<i><c>."""
        return self._run(values.lines_of(self._session, "INDUST", self._axis, str(index or "")))

    def set_user_status_bit(self, text: str) -> None:
        """Define user status bit (`INDUST`). Syntax: <!>INDUST<i>-<i><c>."""
        self._run(values.write(self._session, "INDUST", self._axis, text))

    @property
    def user_status_enabled(self) -> bool:
        """Enable user status (`INDUSE`). Default 0."""
        return self._run(values.flag(self._session, "INDUSE", self._axis))

    @user_status_enabled.setter
    def user_status_enabled(self, value: bool) -> None:
        self._run(values.write(self._session, "INDUSE", self._axis, value))

    @property
    def xon_xoff_handshake(self) -> bool:
        """XON/XOFF handshake (`XONOFF`). Default 1."""
        return self._run(values.flag(self._session, "XONOFF", self._axis))

    @xon_xoff_handshake.setter
    def xon_xoff_handshake(self, value: bool) -> None:
        self._run(values.write(self._session, "XONOFF", self._axis, value))


class UnitReports(BlockingFace):
    """The reports of the whole unit."""

    @property
    def active_gains(self) -> tuple[str, ...]:
        """Report active servo gains (`TGAIN`)."""
        return self._run(values.lines_of(self._session, "TGAIN", self._axis))

    @property
    def controller_status(self) -> str:
        """Report controller status bits (`TSC`)."""
        return self._run(values.bits(self._session, "TSC", self._axis))

    @property
    def data_pointer(self) -> tuple[int, ...]:
        """Report data pointer (`TDPTR`)."""
        return self._run(values.wholes(self._session, "TDPTR", self._axis))

    @property
    def error_status_text(self) -> tuple[str, ...]:
        """Report error status as text (`TERF`)."""
        return self._run(values.lines_of(self._session, "TERF", self._axis))

    @property
    def free_segments(self) -> int:
        """Report free compiled segments (`TSEG`)."""
        return self._run(values.whole(self._session, "TSEG", self._axis))

    @property
    def help_text(self) -> tuple[str, ...]:
        """Show support telephone (`HELP`)."""
        return self._run(values.lines_of(self._session, "HELP", self._axis))

    @property
    def inputs(self) -> str:
        """Report programmable inputs (`TIN`)."""
        return self._run(values.bits(self._session, "TIN", self._axis))

    @property
    def joystick_voltages(self) -> tuple[float, ...]:
        """Report joystick analog voltages (`TANV`)."""
        return self._run(values.reals(self._session, "TANV", self._axis))

    @property
    def labels(self) -> tuple[str, ...]:
        """List labels (`TLABEL`)."""
        return self._run(values.lines_of(self._session, "TLABEL", self._axis))

    @property
    def last_bad_command(self) -> str:
        """Report command error (`TCMDER`)."""
        return self._run(values.text_of(self._session, "TCMDER", self._axis))

    @property
    def limit_inputs(self) -> str:
        """Report limit and home inputs (`TLIM`)."""
        return self._run(values.bits(self._session, "TLIM", self._axis))

    @property
    def memory(self) -> tuple[str, ...]:
        """Report free memory (`TMEM`)."""
        return self._run(values.lines_of(self._session, "TMEM", self._axis))

    @property
    def other_inputs_text(self) -> tuple[str, ...]:
        """Report other inputs as text (`TINOF`)."""
        return self._run(values.lines_of(self._session, "TINOF", self._axis))

    @property
    def outputs(self) -> str:
        """Report programmable outputs (`TOUT`)."""
        return self._run(values.bits(self._session, "TOUT", self._axis))

    @property
    def program_directory(self) -> tuple[str, ...]:
        """List stored programs (`TDIR`)."""
        return self._run(values.lines_of(self._session, "TDIR", self._axis))

    @property
    def program_execution(self) -> str:
        """Report program execution (`TEX`)."""
        return self._run(values.text_of(self._session, "TEX", self._axis))

    @property
    def revision(self) -> str:
        """Report firmware revision (`TREV`)."""
        return self._run(values.text_of(self._session, "TREV", self._axis))

    @property
    def statistics(self) -> tuple[str, ...]:
        """Report overall statistics (`TSTAT`)."""
        return self._run(values.lines_of(self._session, "TSTAT", self._axis))

    @property
    def system_status_text(self) -> tuple[str, ...]:
        """Report system status as text (`TSSF`)."""
        return self._run(values.lines_of(self._session, "TSSF", self._axis))

    @property
    def timer(self) -> int:
        """Report timer (`TTIM`)."""
        return self._run(values.whole(self._session, "TTIM", self._axis))

    @property
    def user_status(self) -> str:
        """Report user status bits (`TUS`)."""
        return self._run(values.bits(self._session, "TUS", self._axis))


class UnitActions(BlockingFace):
    """The actions of the whole unit."""

    def analog_voltage_override(self, *fields: Number) -> None:
        """Analog voltage override (`ANVO`). Units: volts. Range 0.0 to 2.5."""
        self._run(values.write(self._session, "ANVO", self._axis, *fields))

    def change_menu_password(self, value: Number) -> None:
        """Change menu password (`DPASS`). Range 0 to 9999."""
        self._run(values.write(self._session, "DPASS", self._axis, value))

    def clear_display(self, value: Number) -> None:
        """Clear display (`DCLEAR`). Range 0 to 2."""
        self._run(values.write(self._session, "DCLEAR", self._axis, value))

    def clear_variables(self) -> None:
        """Clear variables (`VARCLR`)."""
        self._run(values.write(self._session, "VARCLR", self._axis))

    def compile_program(self, name: str) -> None:
        """Compile a program (`PCOMP`)."""
        self._run(values.write(self._session, "PCOMP", self._axis, " " + name))

    def compiled_output_pattern_axis_1(self, text: str) -> None:
        """Compiled output pattern, axis 1 (`POUTA`)."""
        self._run(values.write(self._session, "POUTA", self._axis, text))

    def compiled_output_pattern_axis_2(self, text: str) -> None:
        """Compiled output pattern, axis 2 (`POUTB`)."""
        self._run(values.write(self._session, "POUTB", self._axis, text))

    def delete_program(self, name: str) -> None:
        """Delete program (`DEL`)."""
        self._run(values.write(self._session, "DEL", self._axis, " " + name))

    def display_text(self, text: str) -> None:
        """Display text (`DWRITE`)."""
        self._run(values.write(self._session, "DWRITE", self._axis, values.quoted(text)))

    def display_variable(self, *fields: Number) -> None:
        """Display variable (`DVAR`)."""
        self._run(values.write(self._session, "DVAR", self._axis, *fields))

    def erase_all_programs(self) -> None:
        """Erase all programs (`ERASE`)."""
        self._run(values.write(self._session, "ERASE", self._axis))

    def go_when(self, text: str) -> None:
        """Conditional GO (`GOWHEN`)."""
        self._run(values.write(self._session, "GOWHEN", self._axis, text))

    def halt_program(self) -> None:
        """Terminate program execution (`HALT`)."""
        self._run(values.write(self._session, "HALT", self._axis))

    def joystick_zero(self, text: str) -> None:
        """Joystick zero (centre) (`JOYZ`)."""
        self._run(values.write(self._session, "JOYZ", self._axis, text))

    def line_segment(self, *fields: Number) -> None:
        """Line segment (`PLIN`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PLIN", self._axis, *fields))

    def local_coordinate_origin(self, *fields: Number) -> None:
        """Local coordinate origin (`PLC`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PLC", self._axis, *fields))

    def local_coordinate_system_enable(self, value: Number) -> None:
        """Local coordinate system enable (`PL`). Range 0 to 1."""
        self._run(values.write(self._session, "PL", self._axis, value))

    def origin_arc_clockwise(self, *fields: Number) -> None:
        """Origin arc, clockwise (`PARCOM`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PARCOM", self._axis, *fields))

    def origin_arc_counter_clockwise(self, *fields: Number) -> None:
        """Origin arc, counter-clockwise (`PARCOP`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PARCOP", self._axis, *fields))

    def path_absolute_mode(self, value: Number) -> None:
        """Path absolute mode (`PAB`). Range 0 to 1."""
        self._run(values.write(self._session, "PAB", self._axis, value))

    def path_output_pattern(self, text: str) -> None:
        """Path output pattern (`POUT`)."""
        self._run(values.write(self._session, "POUT", self._axis, text))

    def pause(self) -> None:
        """Pause program (`PS`)."""
        self._run(values.write(self._session, "PS", self._axis))

    def position_cursor(self, *fields: Number) -> None:
        """Position cursor (`DPCUR`)."""
        self._run(values.write(self._session, "DPCUR", self._axis, *fields))

    def radius_arc_clockwise(self, *fields: Number) -> None:
        """Radius arc (M sense) (`PARCM`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PARCM", self._axis, *fields))

    def radius_arc_counter_clockwise(self, *fields: Number) -> None:
        """Radius arc (P sense) (`PARCP`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PARCP", self._axis, *fields))

    def radius_tolerance(self, value: Number) -> None:
        """Radius tolerance (`PRTOL`). Units: counts. Range 0 to 999999999."""
        self._run(values.write(self._session, "PRTOL", self._axis, value))

    def reset(self) -> None:
        """Reset to power-up state (`RESET`)."""
        self._run(values.write(self._session, "RESET", self._axis))

    def reset_data_pointer(self, *fields: Number) -> None:
        """Reset data pointer (`DATRST`)."""
        self._run(values.write(self._session, "DATRST", self._axis, *fields))

    def resume(self) -> None:
        """Continue (`C`)."""
        self._run(values.write(self._session, "C", self._axis))

    def run_compiled_profile(self, name: str) -> None:
        """Run compiled profile (`PRUN`)."""
        self._run(values.write(self._session, "PRUN", self._axis, " " + name))

    def run_program(self, name: str) -> None:
        """Run a program (`RUN`)."""
        self._run(values.write(self._session, "RUN", self._axis, " " + name))

    def save_servo_gain_set(self, value: Number) -> None:
        """Save servo gain set (`SGSET`). Range 1 to 5."""
        self._run(values.write(self._session, "SGSET", self._axis, value))

    def set_contour_axes(self, *fields: Number) -> None:
        """Set contour axes (`PAXES`). Range 1 to 2."""
        self._run(values.write(self._session, "PAXES", self._axis, *fields))

    def set_data_pointer(self, *fields: Number) -> None:
        """Set data pointer (`DATPTR`)."""
        self._run(values.write(self._session, "DATPTR", self._axis, *fields))

    def set_outputs(self, *fields: Number) -> None:
        """Set a range of outputs (`OUTALL`)."""
        self._run(values.write(self._session, "OUTALL", self._axis, *fields))

    def start_timer(self, value: Number) -> None:
        """Start timer (`TIMST`). Values: 0 start from zero, 1 resume."""
        self._run(values.write(self._session, "TIMST", self._axis, value))

    def stop_timer(self) -> None:
        """Stop timer (`TIMSTP`)."""
        self._run(values.write(self._session, "TIMSTP", self._axis))

    def teach_data(self, *fields: Number) -> None:
        """Teach data (`DATTCH`). Units: VAR numbers. Range 1 to 150."""
        self._run(values.write(self._session, "DATTCH", self._axis, *fields))

    def transmit(self, text: str) -> None:
        """Transmit a string (`WRITE`)."""
        self._run(values.write(self._session, "WRITE", self._axis, values.quoted(text)))

    def transmit_binary_variable(self, value: Number) -> None:
        """Transmit binary variable (`WRVARB`). Range 1 to 25."""
        self._run(values.write(self._session, "WRVARB", self._axis, value))

    def transmit_numeric_variable(self, *fields: Number) -> None:
        """Transmit numeric variable (`WRVAR`)."""
        self._run(values.write(self._session, "WRVAR", self._axis, *fields))

    def transmit_string_variable(self, value: Number) -> None:
        """Transmit string variable (`WRVARS`). Range 1 to 25."""
        self._run(values.write(self._session, "WRVARS", self._axis, value))

    def uncompile_program(self, name: str) -> None:
        """Uncompile a program (`PUCOMP`)."""
        self._run(values.write(self._session, "PUCOMP", self._axis, " " + name))

    def work_coordinate_origin(self, *fields: Number) -> None:
        """Work coordinate origin (`PWC`). Units: counts. Range -999999999 to 999999999."""
        self._run(values.write(self._session, "PWC", self._axis, *fields))
