"""The guide's two kinds of Following application as stored programs, a thousand cycles each, without drift.

The master is axis 2, run at a constant speed by its own profile, so that nothing but the unit itself moves anything.
"""

from __future__ import annotations

import pytest

from tests.controller.session import SYSTEM_NS, S, Session, both_on

MASTER_COUNTS_S = 25_000
UPDATE_COUNTS = MASTER_COUNTS_S * SYSTEM_NS / S
CYCLES = 1000

CUT_LENGTH = 10_000
"""Master counts from cut to cut."""

CUT_TO_LENGTH = f"""
DEF CUT
L{CYCLES}
WAIT(1PMAS>={CUT_LENGTH})
1MC1:1FOLRN1:1FOLMD1000:1D+:1GO1
WAIT(1FS.4=b1)
OUT1
VAR1=1PMAS-1PSLV
IF(VAR1<VAR2):VAR2=VAR1:NIF
IF(VAR1>VAR3):VAR3=VAR1:NIF
WAIT(1PSLV>=3000)
OUT0
1FOLRN0:1GO1
WAIT(1FS.1=b0)
1MC0:1MA1:1D0:1FOLRN4:1FOLMD3000:1GO1
WAIT(1FS.1=b0)
VAR5=VAR5+1
IF(1PSLV<>0):VAR6=VAR6+1:NIF
LN
END
"""
"""The slave matches the conveyor's speed for the cut and returns to its start, once a product length.

VAR2 and VAR3: least and most of the place of the cut on the product; VAR5: cuts made; VAR6: returns that missed.
"""

CYCLIC = f"""
DEF INDEX
L{CYCLES}
WAIT(1PMAS>=4500)
1GO1
WAIT(1FS.1=b0)
LN
END
"""
"""An index of D slave counts in every master cycle of 4000, from position 500 on."""


def conveyor(*commands: str) -> Session:
    session = both_on("COMEXC1", "SMPER0", "FOLMAS+24", "FOLEN10", "2MC1", "2V6.25", "2A100", *commands)
    return session


def store(session: Session, program: str) -> None:
    for line in program.strip().splitlines():
        assert "*" not in session.ask(line)


def run(session: Session, name: str, *, seconds: float) -> None:
    session.ask(name)
    session.ok("!2GO")
    session.advance(seconds)
    assert session.look("!TSS.3") == "0", "the program has come to its end"
    session.read()


def variable(session: Session, number: int) -> float:
    return float(session.look(f"VAR{number}").partition("=")[2])


def test_cut_to_length_for_a_thousand_cuts() -> None:
    session = conveyor(f"FMCLEN{CUT_LENGTH}", "VAR2=999999", "VAR3=-999999", "VAR5=0", "VAR6=0")
    store(session, CUT_TO_LENGTH)
    run(session, "CUT", seconds=(CYCLES + 2) * CUT_LENGTH / MASTER_COUNTS_S)
    assert variable(session, 5) == CYCLES
    assert variable(session, 6) == 0, "every return ends exactly at the start"
    assert session.position() == 0
    assert variable(session, 3) - variable(session, 2) <= 4 * UPDATE_COUNTS, "the program's own uncertainty, no more"
    assert variable(session, 2) == pytest.approx(500, abs=4 * UPDATE_COUNTS), "half of FOLMD1000"


@pytest.mark.parametrize("distance", [1333, -2999])
def test_an_index_a_cycle_for_a_thousand_cycles(distance: int) -> None:
    session = conveyor("FMCLEN4000", "1MC0", f"1D{distance}", "1FOLRN3", "1FOLMD2900")
    store(session, CYCLIC)
    run(session, "INDEX", seconds=(CYCLES + 2) * 4000 / MASTER_COUNTS_S)
    assert session.position() == CYCLES * distance
    assert int(session.look("1TNMCY").removeprefix("1TNMCY")) >= CYCLES
