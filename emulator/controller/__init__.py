"""One OEM6250: interpreter, settings, faults and reports here, the rest in folders named for what they do.

`programs` stores and runs programs, `variables` holds what they reckon with, `wires` is the terminals, `motion` moves
the axes, `paths` moves them together.  A controller knows nothing of ports.
"""

from emulator.controller import communications, faults, line, reports, timing
from emulator.controller.compiled import commands as compiled_commands
from emulator.controller.compiled import profile_builder
from emulator.controller.controller import Controller
from emulator.controller.motion import gain_sets, go, homing, jogging, joystick, limits, servo, stopping
from emulator.controller.motion.following import advance, assignment, cycles, sampling, shifts
from emulator.controller.output import Output
from emulator.controller.paths import definition, linear
from emulator.controller.programs import debugging, flow, listings, on_conditions, program_select
from emulator.controller.programs import store as program_store
from emulator.controller.registration import captures, gowhen, registering, segment_holds, trigger_functions
from emulator.controller.variables import data_programs, reading, timers, writing
from emulator.controller.variables import store as variable_store
from emulator.controller.wires import (
    analog,
    input_effects,
    input_functions,
    inputs,
    output_functions,
    output_on_position,
    outputs,
    panel_commands,
    thumbwheels,
    user_status,
)

COMMAND_MODULES = (
    *(communications, faults, line, reports, timing),
    *(compiled_commands, profile_builder),
    *(gain_sets, go, homing, jogging, joystick, limits, servo, stopping),
    *(advance, assignment, cycles, sampling, shifts),
    *(definition, linear),
    *(captures, gowhen, registering, segment_holds, trigger_functions),
    *(debugging, flow, listings, on_conditions, program_select, program_store),
    *(data_programs, reading, timers, variable_store, writing),
    *(analog, input_effects, input_functions, inputs, output_functions, output_on_position, outputs),
    *(panel_commands, thumbwheels, user_status),
)
"""The modules whose functions carry out commands; importing them registers the functions with `dispatch`."""

__all__ = ["COMMAND_MODULES", "Controller", "Output"]
