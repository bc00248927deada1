"""What a host program or a test imports to talk to a unit, emulated or physical.

`OEM6250` blocks, `AsyncOEM6250` is for asyncio; `LineClient` only moves bytes (docs/client.md). `RMC` is for a Delta
RMC over Modbus/TCP (docs/rmc.md). A name's module is
read when the name is first asked for: the pytest plugin lives here and is loaded in every project that has it.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from clients.asynchronous import AsyncOEM6250
    from clients.choices import EndOfTravel, ErrorLevel, FeedbackSource
    from clients.errors import (
        ClientError,
        Garbled,
        InDefinition,
        LineLost,
        LinkError,
        MotionError,
        NoAnswer,
        UnitError,
        VerificationError,
    )
    from clients.gains import Gains
    from clients.line_client import DEFAULT_PROMPTS, LineClient, UnitTimeout
    from clients.lines import Line, open_line
    from clients.plan import Answer
    from clients.programs import StoredProgram
    from clients.rmc import RMC, RmcFault, RmcLost, RmcRefused, RmcTimeout
    from clients.status import (
        AxisFlags,
        ErrorFlags,
        ExtendedAxisFlags,
        FollowingFlags,
        OtherInputFlags,
        StatusWord,
        SystemFlags,
    )
    from clients.sync import OEM6250

__all__ = [
    "DEFAULT_PROMPTS",
    "OEM6250",
    "RMC",
    "Answer",
    "AsyncOEM6250",
    "AxisFlags",
    "ClientError",
    "EndOfTravel",
    "ErrorFlags",
    "ErrorLevel",
    "ExtendedAxisFlags",
    "FeedbackSource",
    "FollowingFlags",
    "Gains",
    "Garbled",
    "InDefinition",
    "Line",
    "LineClient",
    "LineLost",
    "LinkError",
    "MotionError",
    "NoAnswer",
    "OtherInputFlags",
    "RmcFault",
    "RmcLost",
    "RmcRefused",
    "RmcTimeout",
    "StatusWord",
    "StoredProgram",
    "SystemFlags",
    "UnitError",
    "UnitTimeout",
    "VerificationError",
    "open_line",
]

_MODULES = {
    "Answer": "plan",
    "AsyncOEM6250": "asynchronous",
    "AxisFlags": "status",
    "ClientError": "errors",
    "DEFAULT_PROMPTS": "line_client",
    "EndOfTravel": "choices",
    "ErrorFlags": "status",
    "ErrorLevel": "choices",
    "ExtendedAxisFlags": "status",
    "FeedbackSource": "choices",
    "FollowingFlags": "status",
    "Gains": "gains",
    "Garbled": "errors",
    "InDefinition": "errors",
    "Line": "lines",
    "LineClient": "line_client",
    "LineLost": "errors",
    "LinkError": "errors",
    "MotionError": "errors",
    "NoAnswer": "errors",
    "OEM6250": "sync",
    "OtherInputFlags": "status",
    "RMC": "rmc",
    "RmcFault": "rmc",
    "RmcLost": "rmc",
    "RmcRefused": "rmc",
    "RmcTimeout": "rmc",
    "StatusWord": "status",
    "StoredProgram": "programs",
    "SystemFlags": "status",
    "UnitError": "errors",
    "UnitTimeout": "line_client",
    "VerificationError": "errors",
    "open_line": "lines",
}
"""Where each name lives."""


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"clients.{_MODULES[name]}"), name)
    globals()[name] = value
    return value
