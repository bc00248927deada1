"""What `socat -x` wrote about a serial line, as a recording of that line.

socat stands between a host and a unit and prints what passes in hexadecimal, host on the left:

    socat -x PTY,link=/tmp/host,raw,echo=0 /dev/ttyUSB0,raw,echo=0,b9600 2>session.txt

    > 2026/11/22 17:37:33.000392176  length=5 from=0 to=4
     31 54 50 45 0d
    < 2026/11/22 17:37:33.000412551  length=3 from=0 to=2
     0d 0a 3e

With `-v` too, each line of hexadecimal is followed by its text, and a packet ends with `--`. The fraction of a second
counts microseconds; socat 1.7 pads it to nine digits, later ones to six.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType

from emulator.recording.format import Entry, Received, RecordingError, Sent
from emulator.recording.header import Header

_PACKET = re.compile(r"([<>]) (\d{4}/\d\d/\d\d \d\d:\d\d:\d\d)\.(\d{6}|\d{9})  length=(\d+) from=\d+ to=\d+\s*")
_NS_PER_S, _NS_PER_US = 1_000_000_000, 1_000
_BYTES_A_LINE = re.compile(r"((?: [0-9a-f]{2})+)(?:  .*)?")


class SocatReader:
    """Has the face of a `Reader`. Raises RecordingError if the file cannot be read."""

    complete = True

    def __init__(self, path: str | Path) -> None:
        self.path = str(path)
        try:
            self._text = Path(path).read_text(encoding="latin-1")
        except OSError as error:
            raise RecordingError(f"{path}: cannot be read ({error.strerror})") from None
        self.header = Header({"source": "line"})

    def __enter__(self) -> SocatReader:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        return None

    def __iter__(self) -> Iterator[Entry]:
        """The packets. Raises RecordingError where the file is not what socat writes."""
        packet: re.Match[str] | None = None
        first, data = 0, b""
        for number, line in enumerate(self._text.split("\n"), start=1):
            found = _PACKET.fullmatch(line)
            if found is None:
                data += self._bytes(line, number, within=packet is not None)
                continue
            if packet is not None:
                yield self._entry(packet, data, first)
            packet, first, data = found, number, b""
        if packet is None:
            raise RecordingError(f"{self.path}: holds no packet as `socat -x` writes it")
        yield self._entry(packet, data, first)

    def _bytes(self, line: str, number: int, *, within: bool) -> bytes:
        found = _BYTES_A_LINE.fullmatch(line.rstrip())
        if found is not None and within:
            return bytes.fromhex(found[1])
        if line.rstrip() in ("", "--") or not within:
            return b""
        raise RecordingError(f"{self.path}:{number}: {line[:40]!r} is no line of hexadecimal; was it socat -x?")

    def _entry(self, packet: re.Match[str], data: bytes, line: int) -> Entry:
        direction, second, fraction, length = packet.groups()
        if len(data) != int(length):
            raise RecordingError(f"{self.path}:{line}: a packet of {length} bytes has {len(data)}")
        moment = datetime.strptime(second, "%Y/%m/%d %H:%M:%S").replace(tzinfo=UTC)
        at_ns = int(moment.timestamp()) * _NS_PER_S + int(fraction) * _NS_PER_US
        if direction == ">":
            return Received(at_ns, 0, 0, data, line)
        return Sent(at_ns, 0, None, data, line)
