"""A small blocking client for a unit on a line: a serial port, a virtual one, or TCP.

It knows the three prompts, nothing else: moving bytes is the business of `clients.lines`, what a reply means that of
`protocol`. Because it depends on nothing of the emulator it works just as well with a physical unit.

    with LineClient.open("/dev/ttyUSB0", timeout_s=1.0) as unit:
        unit.exchange(b"ECHO0")
        print(unit.exchange(b"1TPE"))        # b"*1TPE+0\\r\\r\\n> "
"""

from __future__ import annotations

import time
from types import TracebackType
from typing import Final

from clients.lines import Line, close_quietly, open_line

DEFAULT_PROMPTS: Final = (b"\r\n> ", b"\r\n? ", b"\r\n- ")
"""ERROK, ERRBAD and ERRDEF as a unit powers up (documented: EPICS README_PC6K, Gemini Command Reference p.116)."""

_DELIMITERS: Final = (b"\r", b"\n", b":")


class UnitTimeout(TimeoutError):
    """The unit did not finish in time; `received` holds what had arrived."""

    def __init__(self, waited_for: str, received: bytes, timeout_s: float) -> None:
        self.received = received
        super().__init__(f"no {waited_for} within {timeout_s:g} s; received {received!r}")


class LineClient:
    """A blocking connection to one unit; not for several threads at once."""

    def __init__(self, line: Line, *, timeout_s: float, prompts: tuple[bytes, ...] = DEFAULT_PROMPTS) -> None:
        """Talk over `line`; `prompts` are the texts that end an answer (see ERROK, ERRBAD, ERRDEF)."""
        self._line = line
        self._pending = b""
        self.timeout_s = timeout_s
        self.prompts = prompts

    @classmethod
    def open(cls, url: str, *, timeout_s: float = 1.0, prompts: tuple[bytes, ...] = DEFAULT_PROMPTS) -> LineClient:
        """Connect to `url`: `tcp://host:port`, `rfc2217://host:port`, `/dev/ttyUSB0`, `COM3`, or any other URL of
        pyserial's.

        `timeout_s` bounds every wait for a prompt. Raises LineLost, an OSError, if the port cannot be opened,
        ValueError if the URL is not understood.
        """
        return cls(open_line(url), timeout_s=timeout_s, prompts=prompts)

    def write(self, data: bytes) -> None:
        """Send `data` as it is, without a delimiter."""
        self._line.write(data)

    def receive(self, timeout_s: float) -> bytes:
        """What arrives next within `timeout_s` seconds, however little; b"" if nothing does."""
        pending, self._pending = self._pending, b""
        return pending or self._line.read(timeout_s)

    def read_until_prompt(self) -> bytes:
        """Everything up to and including the next prompt; UnitTimeout if none comes within `timeout_s`."""
        received, deadline = b"", time.monotonic() + self.timeout_s
        while not (end := self._prompt_end(received)):
            left = deadline - time.monotonic()
            data = self.receive(left) if left > 0 else b""
            if not data:
                raise UnitTimeout("prompt", received, self.timeout_s)
            received += data
        self._pending = received[end:]
        return received[:end]

    def exchange(self, line: bytes | str) -> bytes:
        """Send one command line (a CR is added if no delimiter ends it) and return its answer, prompt included.

        With ECHO1 the answer begins with the echo. UnitTimeout if no prompt comes, as always below ERRLVL2.
        """
        data = line.encode("ascii") if isinstance(line, str) else line
        self.write(data if data.endswith(_DELIMITERS) else data + b"\r")
        return self.read_until_prompt()

    def read_available(self, quiet_s: float = 0.1) -> bytes:
        """Everything that arrives until the line has been quiet for `quiet_s` seconds; may be b""."""
        received = b""
        while data := self.receive(quiet_s):
            received += data
        return received

    def close(self) -> None:
        """Close the port; the unit goes on by itself."""
        close_quietly(self._line)

    def _prompt_end(self, received: bytes) -> int:
        ends = [at + len(prompt) for prompt in self.prompts if (at := received.find(prompt)) >= 0]
        return min(ends, default=0)

    def __enter__(self) -> LineClient:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
