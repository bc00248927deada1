"""Request and response over TCP beside the bare echo: one client, ten, a hundred, and ten with eight at once.

Eight at once are one write. The echo is given messages of the length of the unit's answer, so that both servers send
the same.
"""

from __future__ import annotations

from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.load import PROMPT, Hammering
from tests.bench.processes import Load, Server, echo, oem6250

QUESTION = b"1TPE\r"
ECHO_NAME = "bare asyncio echo"
CASES = (("1 client", 1, 1), ("10 clients", 10, 1), ("10 clients x 8", 10, 8), ("100 clients", 100, 1))
"""Name, clients, requests under way of each. Hosts send three to eight commands in one write."""
REQUESTS_PER_S = Reach(bound=30_000, at_least=True)


def measure(effort: Effort) -> list[Figure]:
    """Both servers in alternation, all cases."""
    with oem6250() as unit, echo() as reference, Load() as load:
        unit.tell(b"ECHO0\rDRIVE11\r")
        answer = unit.tell(QUESTION)[0] + PROMPT
        figures = []
        for name, clients, depth in CASES:
            pairs = []
            for _ in range(effort.times(3, 9)):
                pairs.append(_pair(load, unit, reference, answer, clients=clients, depth=depth, effort=effort))
            figures += _figures(name, clients, pairs)
        return figures


def _pair(
    load: Load, unit: Server, reference: Server, answer: bytes, *, clients: int, depth: int, effort: Effort
) -> tuple[Hammering, Hammering]:
    seconds = effort.of(0.25, 1.2)
    count = len(answer)
    own = load.hammer(unit, QUESTION, count, clients=clients, depth=depth, seconds=seconds)
    bare = load.hammer(reference, b"." * count, count, clients=clients, depth=depth, seconds=seconds)
    return own, bare


def _figures(name: str, clients: int, pairs: list[tuple[Hammering, Hammering]]) -> list[Figure]:
    own, bare = zip(*pairs, strict=True)
    shares = [
        f"{min(one['cpu_share'] for one in side):.0%}-{max(one['cpu_share'] for one in side):.0%}"
        for side in (own, bare)
    ]
    note = f"load generator computing {shares[0]} of the time, at the echo {shares[1]}"

    def figure(kind: str, unit: str, field: str, reach: Reach | None = None) -> Figure:
        values = [[float(one[field]) for one in side] for side in (own, bare)]
        reference = Reference(name=ECHO_NAME, samples=values[1])
        return Figure(
            name=f"{name}, {kind}",
            unit=unit,
            samples=values[0],
            reference=reference,
            reach=reach,
            note=note if field == "requests_per_s" else "",
        )

    alone = clients == 1
    return [
        figure("p50", "us", "p50_us", Reach(bound=1.5, of="ratio") if alone else None),
        figure("p99", "us", "p99_us"),
        figure("rate", "requests/s", "requests_per_s", None if alone else REQUESTS_PER_S),
    ]
