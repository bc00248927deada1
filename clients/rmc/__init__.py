"""A client for a Delta RMC75, RMC150 or RMC151 over Modbus/TCP, emulated or physical.

    from clients import RMC

    with RMC("192.168.0.42") as rmc:
        axis = rmc.axis[0]
        axis.enable()
        axis.move_absolute(10.0, speed=5.0, accel=50.0, decel=50.0)
        axis.wait_in_position()
        print(axis.read("ActPos"))

Underneath is pymodbus (`pip install 'oem6250[rmc]'`), imported when the first connection is made. docs/rmc.md is the
guide.
"""

from __future__ import annotations

from clients.rmc.axis import RmcAxis
from clients.rmc.controller import RMC
from clients.rmc.errors import RmcFault, RmcLost, RmcRefused, RmcTimeout
from clients.rmc.link import RmcLink, TcpLink

__all__ = ["RMC", "RmcAxis", "RmcFault", "RmcLink", "RmcLost", "RmcRefused", "RmcTimeout", "TcpLink"]
