"""Two axes at work and a supervisor that watches over them: `python two_axes.py tcp://127.0.0.1:6250`.

Each axis has a task of its own that shuttles between its stations. A third task reads the error word of the unit; when
one of the bits it looks for comes up, it kills all motion and the others are cancelled. One client serves all three:
while one waits for its move the others use the line.
"""

import asyncio
import sys
from typing import Any

from clients import AsyncOEM6250, ErrorFlags

STATIONS = {1: (0, 4000, 12_000), 2: (0, -6000)}
ROUNDS = 3
POLL_S = 0.1
FATAL = (
    ErrorFlags.DRIVE_FAULT
    | ErrorFlags.ENABLE_INPUT_OPEN
    | ErrorFlags.HARD_LIMIT_HIT
    | ErrorFlags.POSITION_ERROR_EXCEEDED
)


class Stopped(Exception):
    """The supervisor has stopped the machine; the text says why."""


async def prepare(ctl: AsyncOEM6250) -> None:
    # Bits of the error word come up only for what ERROR asks for; stopping is the supervisor's business, so no
    # error program is set.
    await ctl.send("ERROR" + "".join("1" if FATAL & (1 << bit) else "0" for bit in range(32)))
    for number in STATIONS:
        axis = ctl.axis[number]
        await axis.set_drive_enabled(True)
        await axis.set_velocity(8)
        await axis.set_acceleration(100)
        await axis.set_deceleration(100)
        await axis.set_position(0)


async def shuttle(ctl: AsyncOEM6250, number: int) -> None:
    for _ in range(ROUNDS):
        for station in STATIONS[number]:
            await ctl.axis[number].move_to(station)
            print(f"axis {number} is at {await ctl.axis[number].get_position():.0f}")


async def supervise(ctl: AsyncOEM6250) -> None:
    while True:
        seen = (await ctl.status.error()).flags & FATAL
        if seen:
            await ctl.kill()
            raise Stopped(", ".join(flag.name.lower().replace("_", " ") for flag in seen if flag.name))
        await asyncio.sleep(POLL_S)


async def run(url: str) -> None:
    async with await AsyncOEM6250.open(url) as ctl:
        await prepare(ctl)
        watching = asyncio.create_task(supervise(ctl))
        working = asyncio.gather(*(shuttle(ctl, number) for number in STATIONS))
        both: list[asyncio.Future[Any]] = [watching, working]
        await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
        # A move that was killed may be noticed by its own task first; the supervisor knows why.
        if working.done() and working.exception() is not None:
            await asyncio.wait([watching], timeout=5 * POLL_S)
        stopped = watching.exception() if watching.done() else None
        watching.cancel()
        working.cancel()
        await asyncio.gather(watching, working, return_exceptions=True)
        if stopped is not None:
            raise stopped
        if not working.cancelled():
            working.result()


def main(url: str) -> int:
    try:
        asyncio.run(run(url))
    except Stopped as reason:
        print(f"stopped: {reason}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
