"""A process that writes a state file as fast as it can and says what has been confirmed; the test kills it.

`python -m tests.state.writer FILE`: one line `N` on stdout each time the contents made of N are durable.
"""

from __future__ import annotations

import sys
import threading
from decimal import Decimal

from emulator.state.contents import Contents, ProgramText
from emulator.state.keeper import Keeper
from emulator.state.store import Store

PROGRAM_LINES = 40


def contents_made_of(number: int) -> Contents:
    """Contents whose parts all tell the same number, so that half of a change shows."""
    lines = tuple(f"VAR1={number}" for _ in range(number % PROGRAM_LINES + 1))
    name = f"P{number % 3}"
    return Contents(
        settings=(("ADDR", str(number % 99 + 1)),),
        numbers=(Decimal(number),),
        texts=("", str(number)),
        programs=(ProgramText(name, lines),),
    )


def main(path: str) -> None:
    store = Store(path)
    number = int(store.contents(0).texts[1]) if store.units else 0
    store.adopt(0, store.contents(0))
    keeper = Keeper(store)
    keeper.start()
    while True:
        number += 1
        durable = threading.Event()
        keeper.submit({0: contents_made_of(number)}, durable.set)
        durable.wait()
        print(number, flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
