"""What a Delta RMC75, RMC150 or RMC151 looks like from outside: registers, commands, bits, and their words on Modbus.

Like the rest of `protocol` it is used on both ends of the wire and does no I/O. Page numbers are those of the digital
copy of the "Delta RMC151 User Manual" (M); H is Delta's online help. docs/rmc.md lists what is built.
"""
