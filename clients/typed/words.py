"""Status words with a property a bit. Written by `python -m clients.generate`; do not edit."""

# ruff: noqa
# fmt: off

from __future__ import annotations

from clients.status import AxisFlags, ErrorFlags, ExtendedAxisFlags, FollowingFlags, OtherInputFlags, SystemFlags, StatusWord


class AxisWord(StatusWord[AxisFlags]):
    """AS, reported by TAS."""

    __slots__ = ()

    @property
    def moving(self) -> bool:
        """Axis in commanded motion (bit 1)."""
        return self.bit(1)

    @property
    def direction_negative(self) -> bool:
        """Direction is negative (bit 2)."""
        return self.bit(2)

    @property
    def accelerating(self) -> bool:
        """Accelerating (not decelerating) (bit 3)."""
        return self.bit(3)

    @property
    def at_velocity(self) -> bool:
        """At programmed velocity (bit 4)."""
        return self.bit(4)

    @property
    def home_successful(self) -> bool:
        """Last home was successful (bit 5)."""
        return self.bit(5)

    @property
    def mode_absolute(self) -> bool:
        """Absolute mode (MA1) (bit 6)."""
        return self.bit(6)

    @property
    def mode_continuous(self) -> bool:
        """Continuous mode (MC1) (bit 7)."""
        return self.bit(7)

    @property
    def jog_mode(self) -> bool:
        """Jog mode enabled (bit 8)."""
        return self.bit(8)

    @property
    def joystick_mode(self) -> bool:
        """Joystick mode enabled (bit 9)."""
        return self.bit(9)

    @property
    def encoder_step_mode(self) -> bool:
        """Encoder step mode (stepper only, 0) (bit 10)."""
        return self.bit(10)

    @property
    def position_maintenance_on(self) -> bool:
        """Position maintenance on (stepper only, 0) (bit 11)."""
        return self.bit(11)

    @property
    def stall_detected(self) -> bool:
        """Stall detected (stepper only, 0) (bit 12)."""
        return self.bit(12)

    @property
    def drive_shutdown(self) -> bool:
        """Drive shut down (DRIVE0) (bit 13)."""
        return self.bit(13)

    @property
    def drive_faulted(self) -> bool:
        """Drive fault occurred (bit 14)."""
        return self.bit(14)

    @property
    def positive_hard_limit_hit(self) -> bool:
        """Positive hardware limit hit (bit 15)."""
        return self.bit(15)

    @property
    def negative_hard_limit_hit(self) -> bool:
        """Negative hardware limit hit (bit 16)."""
        return self.bit(16)

    @property
    def positive_soft_limit_hit(self) -> bool:
        """Positive software limit hit (bit 17)."""
        return self.bit(17)

    @property
    def negative_soft_limit_hit(self) -> bool:
        """Negative software limit hit (bit 18)."""
        return self.bit(18)

    @property
    def within_deadband(self) -> bool:
        """Within deadband (stepper only, 0) (bit 19)."""
        return self.bit(19)

    @property
    def in_position(self) -> bool:
        """In position (stepper COMEXP only, 0) (bit 20)."""
        return self.bit(20)

    @property
    def distance_streaming(self) -> bool:
        """Distance streaming mode (bus stepper, 0) (bit 21)."""
        return self.bit(21)

    @property
    def velocity_streaming(self) -> bool:
        """Velocity streaming mode (bus stepper, 0) (bit 22)."""
        return self.bit(22)

    @property
    def position_error_exceeded(self) -> bool:
        """Position error exceeded SMPER (bit 23)."""
        return self.bit(23)

    @property
    def in_target_zone(self) -> bool:
        """In target zone (STRGTD and STRGTV) (bit 24)."""
        return self.bit(24)

    @property
    def target_zone_timeout(self) -> bool:
        """Target zone time-out occurred (bit 25)."""
        return self.bit(25)

    @property
    def gowhen_pending(self) -> bool:
        """GOWHEN pending (bit 26)."""
        return self.bit(26)

    @property
    def ldt_read_error(self) -> bool:
        """LDT read error (6270 only, 0) (bit 27)."""
        return self.bit(27)

    @property
    def registration_move_commanded(self) -> bool:
        """Registration move started / pending (bit 28)."""
        return self.bit(28)

    @property
    def preset_move_overshot(self) -> bool:
        """Pre-emptive GO or registration not possible (bit 30)."""
        return self.bit(30)


class ExtendedAxisWord(StatusWord[ExtendedAxisFlags]):
    """ASX, reported by TASX."""

    __slots__ = ()

    @property
    def motor_fault(self) -> bool:
        """Motor fault (products with internal drive) (bit 1)."""
        return self.bit(1)

    @property
    def low_voltage_fault(self) -> bool:
        """Low voltage fault (internal drive) (bit 2)."""
        return self.bit(2)

    @property
    def over_temperature_fault(self) -> bool:
        """Over temperature (internal drive) (bit 3)."""
        return self.bit(3)

    @property
    def drive_fault_input(self) -> bool:
        """Drive fault input active (bit 4)."""
        return self.bit(4)

    @property
    def encoder_failure(self) -> bool:
        """Encoder failure (bit 5)."""
        return self.bit(5)

    @property
    def z_channel(self) -> bool:
        """Encoder Z channel state (bit 6)."""
        return self.bit(6)


class SystemWord(StatusWord[SystemFlags]):
    """SS, reported by TSS."""

    __slots__ = ()

    @property
    def system_ready(self) -> bool:
        """System ready (bit 1)."""
        return self.bit(1)

    @property
    def executing_program(self) -> bool:
        """Executing a program (bit 3)."""
        return self.bit(3)

    @property
    def immediate_command(self) -> bool:
        """Last command was immediate (bit 4)."""
        return self.bit(4)

    @property
    def ascii_mode(self) -> bool:
        """ASCII mode (bit 5)."""
        return self.bit(5)

    @property
    def echo_mode(self) -> bool:
        """Echo mode (ECHO1) (bit 6)."""
        return self.bit(6)

    @property
    def defining_program(self) -> bool:
        """Defining a program (bit 7)."""
        return self.bit(7)

    @property
    def trace_mode(self) -> bool:
        """Trace mode (bit 8)."""
        return self.bit(8)

    @property
    def step_mode(self) -> bool:
        """Step mode (bit 9)."""
        return self.bit(9)

    @property
    def translation_mode(self) -> bool:
        """Translation mode (bit 10)."""
        return self.bit(10)

    @property
    def command_error(self) -> bool:
        """Command error occurred (cleared by TCMDER) (bit 11)."""
        return self.bit(11)

    @property
    def break_point_active(self) -> bool:
        """Break point active (bit 12)."""
        return self.bit(12)

    @property
    def pause_active(self) -> bool:
        """Pause active (bit 13)."""
        return self.bit(13)

    @property
    def wait_active(self) -> bool:
        """Wait active (bit 14)."""
        return self.bit(14)

    @property
    def monitoring_on_condition(self) -> bool:
        """Monitoring ON condition (bit 15)."""
        return self.bit(15)

    @property
    def waiting_for_data(self) -> bool:
        """Waiting for data (READ) (bit 16)."""
        return self.bit(16)

    @property
    def loading_thumbwheel_data(self) -> bool:
        """Loading thumbwheel data (bit 17)."""
        return self.bit(17)

    @property
    def external_program_select(self) -> bool:
        """External program select mode (INSELP) (bit 18)."""
        return self.bit(18)

    @property
    def dwell_in_progress(self) -> bool:
        """Dwell in progress (T) (bit 19)."""
        return self.bit(19)

    @property
    def waiting_for_rp240(self) -> bool:
        """Waiting for RP240 data (bit 20)."""
        return self.bit(20)

    @property
    def rp240_connected(self) -> bool:
        """RP240 connected (bit 21)."""
        return self.bit(21)

    @property
    def nonvolatile_memory_error(self) -> bool:
        """Non-volatile memory error (bit 22)."""
        return self.bit(22)

    @property
    def gathering_servo_data(self) -> bool:
        """Servo data gathering transmission active (bit 23)."""
        return self.bit(23)

    @property
    def trigger_a_captured(self) -> bool:
        """Position captured with TRG-A (bit 25)."""
        return self.bit(25)

    @property
    def trigger_b_captured(self) -> bool:
        """Position captured with TRG-B (bit 26)."""
        return self.bit(26)

    @property
    def trigger_c_captured(self) -> bool:
        """Position captured with TRG-C (absent, 0) (bit 27)."""
        return self.bit(27)

    @property
    def trigger_d_captured(self) -> bool:
        """Position captured with TRG-D (absent, 0) (bit 28)."""
        return self.bit(28)

    @property
    def compiled_memory_75_percent_full(self) -> bool:
        """Compiled memory 75 percent full (bit 29)."""
        return self.bit(29)

    @property
    def compiled_memory_full(self) -> bool:
        """Compiled memory 100 percent full (bit 30)."""
        return self.bit(30)

    @property
    def compile_failed(self) -> bool:
        """Compile failed (bit 31)."""
        return self.bit(31)


class ErrorWord(StatusWord[ErrorFlags]):
    """ER, reported by TER."""

    __slots__ = ()

    @property
    def stall_detected(self) -> bool:
        """Stall detected (stepper only), never set (bit 1)."""
        return self.bit(1)

    @property
    def hard_limit_hit(self) -> bool:
        """Hard limit hit (bit 2)."""
        return self.bit(2)

    @property
    def soft_limit_hit(self) -> bool:
        """Soft limit hit (bit 3)."""
        return self.bit(3)

    @property
    def drive_fault(self) -> bool:
        """Drive fault (bit 4)."""
        return self.bit(4)

    @property
    def stop_or_kill_issued(self) -> bool:
        """Commanded stop or kill (bit 5)."""
        return self.bit(5)

    @property
    def kill_input_active(self) -> bool:
        """Kill input (INFNC C) (bit 6)."""
        return self.bit(6)

    @property
    def user_fault_input(self) -> bool:
        """User fault input (INFNC F) (bit 7)."""
        return self.bit(7)

    @property
    def stop_input_active(self) -> bool:
        """Stop input (INFNC D) (bit 8)."""
        return self.bit(8)

    @property
    def enable_input_open(self) -> bool:
        """ENABLE input opened (bit 9)."""
        return self.bit(9)

    @property
    def preset_move_overshot(self) -> bool:
        """Pre-emptive GO or registration move not possible (bit 10)."""
        return self.bit(10)

    @property
    def target_zone_timeout(self) -> bool:
        """Target zone time-out (bit 11)."""
        return self.bit(11)

    @property
    def position_error_exceeded(self) -> bool:
        """Maximum position error exceeded (bit 12)."""
        return self.bit(12)

    @property
    def gowhen_already_true(self) -> bool:
        """GOWHEN condition already true at GO (bit 14)."""
        return self.bit(14)

    @property
    def ldt_read_error(self) -> bool:
        """LDT read error (6270), never set (bit 15)."""
        return self.bit(15)

    @property
    def bad_command(self) -> bool:
        """Bad command detected (cleared by TCMDER) (bit 16)."""
        return self.bit(16)

    @property
    def encoder_failure(self) -> bool:
        """Encoder failure (EFAIL products), never set (bit 17)."""
        return self.bit(17)


class FollowingWord(StatusWord[FollowingFlags]):
    """FS, reported by TFS."""

    __slots__ = ()

    @property
    def slave_in_ratio_move(self) -> bool:
        """Slave performing a ratio move (bit 1)."""
        return self.bit(1)

    @property
    def ratio_negative(self) -> bool:
        """Current ratio negative (bit 2)."""
        return self.bit(2)

    @property
    def ratio_changing(self) -> bool:
        """Ratio changing (bit 3)."""
        return self.bit(3)

    @property
    def at_ratio(self) -> bool:
        """At constant ratio (bit 4)."""
        return self.bit(4)

    @property
    def folmas_active(self) -> bool:
        """FOLMAS assigned (bit 5)."""
        return self.bit(5)

    @property
    def folen_active(self) -> bool:
        """FOLEN active (bit 6)."""
        return self.bit(6)

    @property
    def master_moving(self) -> bool:
        """Master moving (bit 7)."""
        return self.bit(7)

    @property
    def master_direction_negative(self) -> bool:
        """Master direction negative (bit 8)."""
        return self.bit(8)

    @property
    def ok_to_shift(self) -> bool:
        """Shift allowed (bit 9)."""
        return self.bit(9)

    @property
    def shifting(self) -> bool:
        """Shift in progress (bit 10)."""
        return self.bit(10)

    @property
    def shift_continuous(self) -> bool:
        """Continuous shift (bit 11)."""
        return self.bit(11)

    @property
    def shift_direction_negative(self) -> bool:
        """Shift direction negative (bit 12)."""
        return self.bit(12)

    @property
    def master_cycle_trigger_pending(self) -> bool:
        """Master cycle restart pending on trigger (bit 13)."""
        return self.bit(13)

    @property
    def master_cycle_length_given(self) -> bool:
        """Master cycle length given (bit 14)."""
        return self.bit(14)

    @property
    def master_cycle_position_negative(self) -> bool:
        """Master cycle position negative (bit 15)."""
        return self.bit(15)

    @property
    def master_cycle_number_above_zero(self) -> bool:
        """Master cycle number greater than 0 (bit 16)."""
        return self.bit(16)

    @property
    def position_prediction_on(self) -> bool:
        """Position prediction on (bit 17)."""
        return self.bit(17)

    @property
    def master_filtering_on(self) -> bool:
        """Master filter on (bit 18)."""
        return self.bit(18)

    @property
    def ok_for_geared_advance(self) -> bool:
        """Geared advance allowed (bit 23)."""
        return self.bit(23)

    @property
    def geared_advance_under_way(self) -> bool:
        """Geared advance in progress (bit 24)."""
        return self.bit(24)


class OtherInputWord(StatusWord[OtherInputFlags]):
    """INO, reported by TINO."""

    __slots__ = ()

    @property
    def joystick_auxiliary(self) -> bool:
        """Joystick auxiliary (bit 1)."""
        return self.bit(1)

    @property
    def joystick_trigger(self) -> bool:
        """Joystick trigger (bit 2)."""
        return self.bit(2)

    @property
    def joystick_axes_select(self) -> bool:
        """Joystick axes select (bit 3)."""
        return self.bit(3)

    @property
    def joystick_velocity_select(self) -> bool:
        """Joystick velocity select (bit 4)."""
        return self.bit(4)

    @property
    def joystick_release(self) -> bool:
        """Joystick release (bit 5)."""
        return self.bit(5)

    @property
    def enable(self) -> bool:
        """ENABLE input, 1 = closed/enabled (bit 6)."""
        return self.bit(6)
