"""Recording what a server's units do (`serve --record FILE`)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from emulator.channel import ControllerLike
from emulator.recording.format import RecordingError
from emulator.recording.recorded import RecordedUnit, finish
from emulator.recording.recorder import Recorder
from emulator.recording.session import describe

if TYPE_CHECKING:
    from collections.abc import Callable

    from emulator.options import ServeOptions


def record(
    options: ServeOptions, controllers: Sequence[ControllerLike], *, state: str | None
) -> tuple[list[RecordedUnit], Callable[[], None]]:
    """The units to serve instead of `controllers`, and what to call when they have stopped.

    Args:
        options: the server's; `record` names the file.
        controllers: switched on, nothing taken from them yet.
        state: the non-volatile memory of the one line before it was switched on, as text.

    Raises:
        RecordingError: the file exists or cannot be written.
    """
    header = describe(
        [_machine_text(options.machine)] * len(controllers),
        speed="max" if options.speed is None else f"{options.speed:g}",
        chain=options.units,
        options={} if options.line_baud is None else {"line": str(options.line_baud)},
        states={} if state is None else {0: state},
    )
    recorder = Recorder(options.record or "", header)
    units = [RecordedUnit(controller, recorder, unit=unit) for unit, controller in enumerate(controllers)]
    return units, partial(finish, recorder, units)


def _machine_text(path: str | None) -> str:
    """The machine file as it stands."""
    if path is None:
        return ""
    try:
        return Path(path).read_bytes().decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RecordingError(f"{path}: cannot be read again ({error})") from None
