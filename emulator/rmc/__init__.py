"""A Delta RMC151 motion controller on the engine of the OEM6250: axes, control modes, registers, Modbus/TCP.

`layout` names every variable, `laws`, `output_stage`, `ramps`, `target`, `halts` are what a loop is made of, `cycle`
runs loops in a compiled kernel of its own. `device` is one controller in virtual time, `registers` what a master sees
of it, `modbus` the one place that knows pymodbus. Importing this package imports none of them.
"""
