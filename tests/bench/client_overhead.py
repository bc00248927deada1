"""What the client library adds: a query through it beside the same bytes through a bare socket, in one run.

Both ask the same unit the same question over TCP, one at a time; the bare socket counts the bytes of an answer that it
knows beforehand, the client finds and reads it.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Callable

from clients import OEM6250
from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.load import PROMPT, connect
from tests.bench.processes import oem6250

QUESTION = "!1TPE"
MOST = Reach(bound=1.5, of="ratio")
US_PER_S = 1e6


def measure(effort: Effort) -> list[Figure]:
    """Raw query and typed property, each in alternation with the bare exchange."""
    with oem6250() as unit:
        unit.tell(b"ECHO0\r")
        host, port = unit.address
        with OEM6250.open(f"tcp://{host}:{port}") as ctl, connect(unit.address) as sock:
            sock.setblocking(True)
            data = f"{QUESTION}\r".encode()
            answer_bytes = len(b"*1TPE+0\r") + len(PROMPT)
            axis = ctl.axis[1]
            ways: dict[str, Callable[[], object]] = {
                "query, raw": lambda: ctl.query(QUESTION),
                "query, typed position": lambda: axis.position,
            }
            return [_figure(name, ask, lambda: _bare(sock, data, answer_bytes), effort) for name, ask in ways.items()]


def _figure(name: str, ask: Callable[[], object], bare: Callable[[], object], effort: Effort) -> Figure:
    count = effort.times(300, 1500)
    pairs = [(_time_us(ask, count), _time_us(bare, count)) for _ in range(effort.times(5, 11))]
    own, reference = zip(*pairs, strict=True)
    return Figure(
        name=name,
        unit="us",
        samples=list(own),
        reference=Reference(name="bare socket exchange", samples=list(reference)),
        reach=MOST,
        note=f"mean of {count} exchanges, one at a time",
    )


def _time_us(action: Callable[[], object], count: int) -> float:
    began = time.perf_counter()
    for _ in range(count):
        action()
    return (time.perf_counter() - began) / count * US_PER_S


def _bare(sock: socket.socket, question: bytes, answer_bytes: int) -> None:
    sock.sendall(question)
    left = answer_bytes
    while left:
        left -= len(sock.recv(left))
