"""Programs as a host sees them: what is stored comes back, random programs neither crash nor hang nor differ, an
endless loop starves nothing, a definition survives its connection."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.controller.session import OK, SYSTEM_NS, S, Session

DEFINING = "\r\n- "
COMMANDS_PER_UPDATE = 8

PLAIN = st.sampled_from(
    ["V2", "D7", "1TPE", "A5", "TSS.3", "T.01", "VAR1=VAR1+1", "TREV", "WAIT(1PE=0)", "SUBR", "GOSUB SUBR", "GO1", "PS"]
)
CONDITION = st.sampled_from(["1PE=0", "1PE>0", "VAR1<3", "1AS.1=b0", "NOT(1PE=0)"])


def blocks(inner: st.SearchStrategy[list[str]]) -> st.SearchStrategy[list[str]]:
    """IFs and loops around programs."""
    return st.one_of(
        st.tuples(CONDITION, inner).map(lambda p: [f"IF({p[0]})", *p[1], "NIF"]),
        st.tuples(CONDITION, inner, inner).map(lambda p: [f"IF({p[0]})", *p[1], "ELSE", *p[2], "NIF"]),
        st.tuples(CONDITION, inner).map(lambda p: [f"WHILE({p[0]})", *p[1], "NWHILE"]),
        st.tuples(CONDITION, inner).map(lambda p: ["REPEAT", *p[1], f"UNTIL({p[0]})"]),
        st.tuples(st.integers(0, 3), inner).map(lambda p: [f"L{p[0]}", *p[1], "LN"]),
        st.tuples(inner, inner).map(lambda p: [*p[0], *p[1]]),
    )


PROGRAMS = st.recursive(st.lists(PLAIN, max_size=4), blocks, max_leaves=8)
ODD = st.lists(
    st.one_of(
        PLAIN, st.sampled_from(["NIF", "LN", "L2", "IF(1PE=0)", "ELSE", "NWHILE", "LX", "GOTO A", "$A", "JUMP A"])
    ),
    max_size=12,
)


def define(session: Session, name: str, *commands: str) -> None:
    """Store a program, whatever each line answers."""
    session.ask(f"DEF {name}")
    for command in commands:
        session.ask(command)
    session.ok("END")


def stored(session: Session, name: str) -> list[str]:
    """The commands TPROG lists."""
    listing = session.ask(f"TPROG {name}").removesuffix("\r" + OK)
    return [line.removeprefix("*") for line in listing.split("\r\n") if line != "*"]


class TestText:
    @given(PROGRAMS)
    @settings(max_examples=25, deadline=None)
    def test_what_tprog_prints_defines_the_same_program(self, commands: list[str]) -> None:
        session = Session()
        define(session, "ONE", *commands)
        define(session, "TWO", *stored(session, "ONE"))
        assert stored(session, "ONE") == stored(session, "TWO")
        printed = [command.replace(" ", "") for command in stored(session, "ONE")]
        assert printed == [command.upper().replace(" ", "") for command in commands]

    def test_a_name_keeps_its_distance(self) -> None:
        session = Session()
        define(session, "ONE", "gosub   two", "GOTOAGAIN")
        assert stored(session, "ONE") == ["GOSUB TWO", "GOTO AGAIN"]

    def test_memory_is_given_back(self) -> None:
        session = Session()
        before = session.ask("TMEM")
        define(session, "ONE", "V2", "D100", "$AA")
        assert session.ask("TMEM") != before
        session.ok("DEL ONE")
        assert session.ask("TMEM") == before
        assert session.query("TLABEL") == "NO LABELS DEFINED"


class TestAnyProgram:
    def play(self, commands: list[str]) -> str:
        session = Session()
        session.ok("VAR1=0", "DRIVE10", "COMEXC0")
        define(session, "SUBR", "D3", "1TPC")
        define(session, "MAIN", *commands)
        session.ask("MAIN", wait_s=0.5)
        heard = session.read()
        heard += session.ask("!C", wait_s=0.5)
        heard += session.ask("!K", wait_s=0.5)
        heard += session.ask("1TPE", wait_s=0.5)
        assert heard.endswith(OK)
        assert session.query("TSS.3") == "0"
        return heard

    @given(PROGRAMS)
    @settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
    def test_it_ends_with_kill_and_runs_the_same_twice(self, commands: list[str]) -> None:
        assert self.play(commands) == self.play(commands)

    @given(ODD)
    @settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
    def test_blocks_that_do_not_match(self, commands: list[str]) -> None:
        assert self.play(commands) == self.play(commands)


class TestPace:
    def count_in(self, seconds: float, *loop: str) -> int:
        session = Session()
        define(session, "MAIN", "VAR1=0", "L", *loop, "LN")
        session.ask("MAIN", wait_s=seconds)
        return round(float(session.query("!VAR1").removeprefix("VAR1=")))

    def test_a_program_does_eight_commands_a_system_update(self) -> None:
        passes = self.count_in(1.0, "VAR1=VAR1+1")
        assert abs(passes - S / SYSTEM_NS * COMMANDS_PER_UPDATE / 2) < COMMANDS_PER_UPDATE

    def test_waits_that_are_over_at_once_count_too(self) -> None:
        passes = self.count_in(1.0, "VAR1=VAR1+1", "WAIT(1PE=0)")
        assert abs(passes - S / SYSTEM_NS * COMMANDS_PER_UPDATE / 3) < COMMANDS_PER_UPDATE

    def test_the_share_is_a_machine_option(self) -> None:
        session = Session("[timing]\ncommands_per_update = 2")
        define(session, "MAIN", "VAR1=0", "L", "VAR1=VAR1+1", "LN")
        session.ask("MAIN", wait_s=1.0)
        passes = round(float(session.query("!VAR1").removeprefix("VAR1=")))
        assert abs(passes - S / SYSTEM_NS) < COMMANDS_PER_UPDATE

    def test_an_error_program_that_clears_nothing_leaves_time_to_others(self) -> None:
        session = Session()
        define(session, "FIX")
        session.ok("ERRORP FIX", "ERROR.16-1")
        session.error("NOSUCH")
        session.advance(1.0)
        assert session.query("!TSS.3") == "1"
        session.ok("!ERROR.16-0")
        session.advance(0.1)
        assert session.query("TSS.3") == "0"


class TestDefinition:
    def test_it_outlives_the_connection_that_began_it(self) -> None:
        session = Session()
        assert session.ask("DEF MAIN", channel=1) == DEFINING
        assert session.ask("V2", channel=1) == DEFINING
        session.unit.controller.detach(1)
        assert session.query("!TSS.7") == "1"
        assert session.ask("V3", channel=2) == DEFINING
        assert session.ask("END", channel=2) == OK
        assert stored(session, "MAIN") == ["V2", "V3"]

    def test_reset_closes_it(self) -> None:
        session = Session()
        session.ask("DEF MAIN")
        session.ask("V2")
        session.ask("!RESET")
        session.ask("ECHO0")
        session.advance(0.1)
        assert session.look("!TSS.7") == "0"

    def test_a_start_program_that_was_deleted_does_not_run(self) -> None:
        session = Session()
        define(session, "MAIN", "V2")
        session.ok("STARTP MAIN", "DEL MAIN")
        session.ask("RESET", wait_s=0.1)
        assert session.look("1V").startswith("1V1")
