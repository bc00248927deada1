"""The same question over every transport of one unit: what telnet, RFC 2217 and the pseudo-terminal add to raw TCP.

The client of telnet and RFC 2217 is a bare socket that has negotiated as the real ones do; pyserial's own client, which
hands each byte through a queue, would be what is measured otherwise.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from tests.bench.figures import Effort, Figure, Reference
from tests.bench.load import PROMPT, Hammering
from tests.bench.processes import Load, Server, oem6250

QUESTION = b"1TPE\r"
RAW = "raw TCP"
TELNET_OPENING = b"\xff\xfd\x01\xff\xfd\x03\xff\xfb\x03"
"""DO ECHO, DO and WILL SUPPRESS GO AHEAD."""
RFC2217_OPENING = b"\xff\xfb\x2c\xff\xfd\x2c\xff\xfb\x00\xff\xfd\x00\xff\xfa\x2c\x01\x00\x00\x25\x80\xff\xf0"
"""WILL and DO COM PORT, WILL and DO BINARY, SET-BAUDRATE 9600."""
OPENINGS = {RAW: b"", "telnet": TELNET_OPENING, "RFC 2217": RFC2217_OPENING, "pty": b""}
DEPTH = 8
"""Requests in one write; hosts send three to eight."""


def measure(effort: Effort) -> list[Figure]:
    """Each transport next to raw TCP: one request at a time, then eight in one write."""
    with tempfile.TemporaryDirectory() as folder:
        pty = str(Path(folder) / "pty") if hasattr(os, "openpty") else "none"
        with oem6250("--pty", pty) as unit, Load() as load:
            unit.tell(b"ECHO0\r")
            answer = unit.tell(QUESTION)[0] + PROMPT
            names = [name for name in OPENINGS if name != "pty" or unit.pty]
            return [figure for name in names for figure in _figures(load, unit, name, answer, effort)]


def _figures(load: Load, unit: Server, name: str, answer: bytes, effort: Effort) -> list[Figure]:
    alone, many = [], []
    for _ in range(effort.times(3, 7)):
        for depth, pairs in ((1, alone), (DEPTH, many)):
            pairs.append([_hammer(load, unit, each, answer, depth, effort) for each in (name, RAW)])
    p50 = [[pair[side]["p50_us"] for pair in alone] for side in (0, 1)]
    p99 = [[pair[side]["p99_us"] for pair in alone] for side in (0, 1)]
    rate = [[pair[side]["requests_per_s"] for pair in many] for side in (0, 1)]
    return [
        Figure(
            name=f"{name}, {kind}",
            unit=of,
            samples=own,
            reference=None if name == RAW else Reference(name=RAW, samples=other),
        )
        for kind, of, (own, other) in (("p50", "us", p50), ("p99", "us", p99), (f"{DEPTH} at once", "requests/s", rate))
    ]


def _hammer(load: Load, unit: Server, name: str, answer: bytes, depth: int, effort: Effort) -> Hammering:
    expected = answer.replace(b"\r\r\n", b"\r\0\r\n") if name == "telnet" else answer
    return load.hammer(
        unit,
        QUESTION,
        len(expected),
        clients=1,
        depth=depth,
        seconds=effort.of(0.15, 0.7),
        opening=OPENINGS[name],
        path=unit.pty if name == "pty" else None,
    )
