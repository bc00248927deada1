"""What a host program or a test imports to talk to a unit, emulated or physical.

`OEM6250` blocks, `AsyncOEM6250` is for asyncio; `LineClient` only moves bytes. See docs/client.md.
"""

from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    from clients.asynchronous import AsyncOEM6250

__all__ = [
    "DEFAULT_PROMPTS",
    "OEM6250",
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
    "StatusWord",
    "StoredProgram",
    "SystemFlags",
    "UnitError",
    "UnitTimeout",
    "VerificationError",
    "open_line",
]


def __getattr__(name: str) -> object:
    """The asyncio face when it is first asked for: asyncio takes a third of the time of the whole import."""
    if name != "AsyncOEM6250":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from clients.asynchronous import AsyncOEM6250

    return AsyncOEM6250
