"""`python -m tests.fuzz [--commands N] [--seed N]`: the long run of the fuzzer, a million commands by default.

Two of three sessions are of commands and programs, the third is of motion. Each has its own seed, which is printed when
it fails; `--seed S --commands 1` plays that one again. Every twentieth session is played twice and must give the same
bytes at the same times.
"""

from __future__ import annotations

import argparse
import sys
import time
import traceback
from collections.abc import Sequence
from random import Random

import psutil

from tests.fuzz.grammar import session
from tests.fuzz.motion_grammar import motion_session
from tests.fuzz.session import MACHINE, TURNING, play

COMMANDS_A_SESSION = 500
MOTION_EVERY = 3
TWICE_EVERY = 20
TOLD_EVERY_S = 30.0
MAX_FAILURES = 5


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status 0 if everything held, 1 if not."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Random programs against a unit.")
    parser.add_argument("--commands", type=int, default=1_000_000, help="how many in all (default: 1000000)")
    parser.add_argument("--seed", type=int, default=6250, help="of the first session (default: 6250)")
    parsed = parser.parse_args(arguments)
    process = psutil.Process()
    done, failures, seed, began_s, told_s = 0, 0, parsed.seed, time.monotonic(), time.monotonic()
    first_bytes = 0
    while done < parsed.commands and failures < MAX_FAILURES:
        commands, held = _one(seed)
        done += commands
        failures += not held
        seed += 1
        first_bytes = first_bytes or process.memory_info().rss
        if time.monotonic() - told_s > TOLD_EVERY_S:
            told_s = time.monotonic()
            print(f"{done} commands, {failures} failures, {time.monotonic() - began_s:.0f} s", flush=True)
    grown_mb = (process.memory_info().rss - first_bytes) / 1e6
    print(f"{done} commands in {seed - parsed.seed} sessions, {failures} failures, memory grew by {grown_mb:.1f} MB, "
          f"{time.monotonic() - began_s:.0f} s")  # fmt: skip
    return 1 if failures else 0


def _one(seed: int) -> tuple[int, bool]:
    """Play the session of a seed; how many commands it had, and whether everything held."""
    of_motion, machine = seed % MOTION_EVERY == 0, TURNING if seed % 2 else MACHINE
    lines = (motion_session if of_motion else session)(Random(seed), COMMANDS_A_SESSION)
    try:
        said = play(lines, machine, of_motion=of_motion)
        same = seed % TWICE_EVERY != 0 or play(lines, machine, of_motion=of_motion) == said
    except Exception:
        print(f"seed {seed}:", file=sys.stderr)
        traceback.print_exc()
        return len(lines), False
    if not same:
        print(f"seed {seed}: the second time was different", file=sys.stderr)
    return len(lines), same


if __name__ == "__main__":
    sys.exit(main())
