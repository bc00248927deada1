"""What can go wrong with an RMC."""

from __future__ import annotations

from clients.errors import ClientError


class RmcRefused(ClientError):
    """The controller answered with a Modbus exception, such as 2 for a register that is not there."""

    def __init__(self, doing: str, code: int) -> None:
        self.code = code
        super().__init__(f"{doing}: Modbus exception {code}")


class RmcLost(ClientError, ConnectionError):
    """There is no connection, or it has been lost."""


class RmcFault(ClientError):
    """An axis that was waited for has been halted or shows error bits."""


class RmcTimeout(ClientError):
    """What was waited for has not come in time."""
