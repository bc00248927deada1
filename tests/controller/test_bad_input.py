"""Whatever arrives: the unit's own error text or silence, never an exception, and later commands are answered."""

from __future__ import annotations

import re
import string
import time
import tracemalloc

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from emulator.controller.interpreter import MAX_BUFFERED_CHARACTERS
from protocol.catalogue import commands, error_rows, other_product_names
from tests.controller.session import MS, OK, SIGN_ON, SYSTEM_NS, S, Session

PORTION = 8_000

ANY_ERROR = re.compile(r"\r\n\*([^\r]*)\r\r\n\? ")
NUMBERED = re.compile(r"(FIELD|AXIS) \d+$")
KNOWN_ERRORS = {NUMBERED.sub(r"\1 n", row.text) for row in error_rows()}

RESCUE = b"\x11\r0_!E1\r0_!K\r0_!ADDR0\r0_!STARTPCLR\r0_!ERASE\r0_!RESET\r"
"""Ends whatever a host has left behind: a line stopped by XOFF, half a line, silence, a wait, a definition, an
address, a start-up program."""


def assert_still_answers(session: Session) -> None:
    session.unit.send(RESCUE)
    session.advance(0.05)
    assert session.read().endswith(SIGN_ON)
    session.ask("ECHO0")
    session.ok("ENCPOL00", "CMDDIR00", "MEMORY21400,18600")
    assert session.query("TREV").startswith("TREV")
    session.ok("DRIVE10", "D400", "V5", "A100")
    session.ok("GO1", wait_s=0.5)
    assert session.position() == 400


def errors_in(output: str) -> set[str]:
    return {NUMBERED.sub(r"\1 n", text) for text in ANY_ERROR.findall(output)}


NAMES = sorted({*commands(), *other_product_names()})
SOUND = [
    name for name in NAMES if name not in {"BOT", "EOL", "EOT", "ERROK", "ERRBAD", "ERRDEF", "ERRLVL", "WRITE", "PORT"}
]
"""Commands after which errors can still be told from replies."""

number_texts = st.one_of(
    st.integers(-(10**12), 10**12).map(str),
    st.decimals(allow_nan=False, allow_infinity=False, places=6, min_value=-1000, max_value=1000).map(str),
    st.sampled_from(
        ["", "+", "-", "~", ".", "-0", "1E5", "(VAR1)", "(VAR999)", "0000000000", "9" * 60, "X", "1.", ".5"]
    ),
)
fields = st.one_of(
    st.lists(number_texts, max_size=9).map(",".join),
    st.text("01XE_", max_size=40),
    st.tuples(st.integers(0, 99), st.sampled_from(["", "-0", "-1", "-X", "-E"])).map(lambda t: f".{t[0]}{t[1]}"),
    st.text(string.printable.replace("\r", "").replace("\n", ""), max_size=20),
    st.sampled_from(
        ["(1AS.1=b0)", "(1PC>1 AND 2PE<>1PC)", "(IN=1X)", "(", "()", "(1AS=)", "((((1PC=1))))", "(NOT NOT MOV=0)"]
    ),
)
prefixes = st.sampled_from(
    ["", "", "", "!", "@", "1", "2", "3", "0", "0_", "0_!", "1_", "!1", "2!", "@1", "99_", "[1]", "!!"]
)


def almost_command(names: list[str]) -> st.SearchStrategy[str]:
    """A command of the language, perhaps with wrong fields, a wrong prefix, or one character changed."""
    sound = st.tuples(prefixes, st.sampled_from(names), fields).map("".join)
    return st.one_of(sound, st.tuples(sound, st.integers(0, 30), st.characters(max_codepoint=255)).map(_changed))


def _changed(parts: tuple[str, int, str]) -> str:
    text, place, character = parts
    return text[:place] + character + text[place + 1 :]


def lines(names: list[str]) -> st.SearchStrategy[bytes]:
    ends = st.sampled_from([b"\r", b"\n", b"\r\n", b":", b"\r", b"\r", b";x:y\r", b" : "])
    commands_ = almost_command(names).map(lambda text: text.encode("latin-1", "replace"))
    return st.lists(st.tuples(commands_, ends).map(b"".join), max_size=12).map(b"".join)


def check_noise(data: bytes) -> None:
    session = Session()
    session.unit.send(data)
    session.advance(0.02)
    session.read()
    assert_still_answers(session)


def check_almost_commands(data: bytes) -> None:
    session = Session()
    session.unit.send(data)
    session.advance(0.02)
    assert errors_in(session.read()) <= KNOWN_ERRORS
    assert_still_answers(session)


relaxed = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])


class TestAnything:
    @settings(relaxed, max_examples=60)
    @given(st.binary(max_size=300))
    def test_noise(self, data: bytes) -> None:
        check_noise(data)

    @settings(relaxed, max_examples=150)
    @given(lines(SOUND))
    def test_almost_commands(self, data: bytes) -> None:
        check_almost_commands(data)

    @settings(relaxed, max_examples=60)
    @given(lines(NAMES))
    def test_framing_commands_too(self, data: bytes) -> None:
        check_noise(data)

    @pytest.mark.slow
    @settings(relaxed, max_examples=5_000)
    @given(st.binary(max_size=1000))
    def test_much_noise(self, data: bytes) -> None:
        check_noise(data)

    @pytest.mark.slow
    @settings(relaxed, max_examples=5_000)
    @given(lines(SOUND))
    def test_many_almost_commands(self, data: bytes) -> None:
        check_almost_commands(data)

    @pytest.mark.parametrize("name", NAMES)
    def test_every_name_alone_and_with_noise(self, name: str) -> None:
        session = Session()
        for text in (name, f"{name}1", f"1{name}1", f"!{name}", f"{name},,", f"{name}.1", f"{name}()", f"@{name}X"):
            session.unit.send(text.encode("latin-1") + b"\r")
            session.advance(0.005)
        if name in SOUND:
            assert errors_in(session.read()) <= KNOWN_ERRORS
        session.read()
        assert_still_answers(session)


class TestTexts:
    @pytest.mark.parametrize(
        ("sent", "text"),
        [
            ("XYZZY", "UNDEFINED LABEL"),
            ("V999", "INVALID DATA-FIELD 1"),
            ("V,999", "INVALID DATA-FIELD 2"),
            ("3TPE", "INCORRECT AXIS"),
            ("V1,2,3", "INCORRECT AXIS"),
            ("COMEXS3", "INVALID DATA"),
            ("V1.2.3", "INCORRECT DATA"),
            ("A" * 101, "MAXIMUM COMMAND LENGTH EXCEEDED"),
            ("V1" + " " * 300 + "0" * 99, "MAXIMUM COMMAND LENGTH EXCEEDED"),
            ("#0", "INVALID CONDITIONS FOR COMMAND"),
        ],
    )
    def test_of_the_unit(self, sent: str, text: str) -> None:
        session = Session()
        assert session.error(sent) == text
        assert session.query("1V") == "1V1.0000"

    def test_a_hundred_characters_are_allowed_blanks_not_counted(self) -> None:
        session = Session()
        session.ok("1V5." + "0" * 96)
        session.ok(" 1 V" + " " * 50 + "5." + "0" * 96)

    def test_the_last_bad_command_is_remembered(self) -> None:
        session = Session()
        session.ok("ERROR.16-1")
        assert not session.system_bit(11)
        session.error("V999")
        session.error("XYZZY")
        assert session.system_bit(11)
        assert session.error_bit(16)
        assert session.query("TCMDER") == "XYZZY"
        assert not session.system_bit(11)
        assert not session.error_bit(16)

    def test_over_long_line_spares_the_next(self) -> None:
        session = Session()
        answer = session.ask("A" * 5000 + "\r1V")
        assert answer == f"\r\n*MAXIMUM COMMAND LENGTH EXCEEDED\r\r\n? *1V1.0000\r{OK}"

    def test_nul_and_backspace(self) -> None:
        session = Session()
        session.unit.send(b"\x001\x00V5\x00\b2\x00\r\x00")
        assert session.read() == OK
        assert session.query("1V") == "1V2.0000"


class TestMemory:
    @staticmethod
    def grown(session: Session, data: bytes, *, times: int) -> int:
        """Bytes of Python memory a flood leaves behind."""
        session.unit.send(data)
        session.read()
        session.unit.take_output()
        tracemalloc.start()
        try:
            for _ in range(times):
                session.unit.send(data)
                session.read()
                session.unit.take_output()
            return tracemalloc.get_traced_memory()[0]
        finally:
            tracemalloc.stop()

    @pytest.mark.parametrize(
        "data", [b"A" * PORTION, b" " * PORTION, b";" + b":" * PORTION, b"\b" * PORTION, b"\x00" * PORTION]
    )
    def test_without_a_terminator(self, data: bytes) -> None:
        session = Session()
        assert self.grown(session, data, times=4) < 16_000
        session.ask("")
        assert session.query("1V") == "1V1.0000"

    @pytest.mark.parametrize("data", [b"A", b":", b"\b", b";:", b"\x0b"])
    def test_a_flood_costs_in_proportion(self, data: bytes) -> None:
        """Ten times the bytes take about ten times as long, the echo included; squared it would be a hundred."""

        def cost_s(count: int) -> float:
            session = Session(ECHO=1)
            start_s = time.perf_counter()
            session.unit.send(data * count)
            session.read()
            return time.perf_counter() - start_s

        few = min(cost_s(2_000) for _ in range(3))
        assert min(cost_s(20_000) for _ in range(3)) < 30 * few + 0.01

    def test_errors_without_end(self) -> None:
        session = Session()
        assert self.grown(session, b"XYZZY:V999:\x0b3TPE\r" * 50, times=40) < 200_000

    @pytest.mark.parametrize("flood", [b"\r", b"V\r", b"XYZZY\r", b"V1" + b"0" * 97 + b"\r"])
    def test_a_buffer_that_does_not_drain_says_so(self, flood: bytes) -> None:
        """While the buffer waits the wire must be told to hold the rest, whatever the commands are."""
        session = Session()
        session.ask("T999")
        assert not session.unit.controller.input_full(0)
        session.unit.send(flood * (MAX_BUFFERED_CHARACTERS // len(flood) + 10))
        assert session.unit.controller.input_full(0)
        session.unit.send(b"!K\r")
        assert not session.unit.controller.input_full(0)

    def test_programs_end_when_memory_does(self) -> None:
        session = Session()
        session.ask("DEF BIG")
        answers = [session.ask("V1.2345,2.3456:" * 50) for _ in range(60)]
        assert "INSUFFICIENT MEMORY" in answers[-1]
        session.ask("END")
        assert session.ask("TMEM").startswith("*")
        assert_still_answers(session)


AXES = (1, 2)
WIRES = ["enable", *(f"axis{n}.{w}" for n in AXES for w in ("positive_limit", "negative_limit", "home", "drive_fault"))]

SETTERS = st.one_of(
    st.tuples(st.sampled_from(["A", "AD", "LHAD"]), st.integers(1, 5000)),
    st.tuples(st.sampled_from(["V"]), st.integers(0, 50)),
    st.tuples(st.sampled_from(["D"]), st.integers(-50_000, 50_000)),
    st.tuples(st.sampled_from(["SGP", "SGI", "SGV", "SGVF"]), st.integers(0, 30)),
    st.tuples(st.sampled_from(["MA", "MC", "KDRIVE", "STRGTE", "COMEXL"]), st.integers(0, 1)),
    st.tuples(st.sampled_from(["LH", "LS"]), st.integers(0, 3)),
    st.tuples(st.sampled_from(["SMPER"]), st.integers(0, 5000)),
    st.tuples(st.sampled_from(["PSET", "LSPOS", "LSNEG"]), st.integers(-9000, 9000)),
)
ACTIONS = st.sampled_from(
    ["GO1", "GO11", "GO", "!GO01", "DRIVE11", "DRIVE00", "!DRIVE10", "@DRIVE1", "!S", "S1", "!K", "K01", "\x0b"]
)
QUERIES = st.sampled_from(
    ["TAS", "TPE", "TPC", "TPER", "TSS", "TER", "TLIM", "TDAC", "TVELA", "TGAIN", "1A", "D", "V", ""]
)

AS_REPLY = re.compile(r"[12]TAS([01]{4}_){7}[01]{4}")


class Operation(RuleBasedStateMachine):
    """A host that does anything in any order with a unit in COMEXC1, while somebody pulls at the wires."""

    def __init__(self) -> None:
        super().__init__()
        self.session = Session(COMEXC=1, ERROR="1" * 16)

    def tell(self, text: str) -> str:
        """One command: exactly one prompt, good or bad, and it comes at once."""
        answer = self.session.ask(text) if text != "\x0b" else self.control_k()
        assert answer.count(OK) + len(ANY_ERROR.findall(answer)) == 1, (text, answer)
        assert errors_in(answer) <= KNOWN_ERRORS
        return answer

    def control_k(self) -> str:
        self.session.unit.send(b"\x0b")
        return self.session.read()

    @rule(setter=SETTERS, axis=st.sampled_from(["1", "2", "@", "!2", "!@"]))
    def set(self, setter: tuple[str, int], axis: str) -> None:
        self.tell(f"{axis}{setter[0]}{setter[1]}")

    @rule(action=ACTIONS)
    def act(self, action: str) -> None:
        self.tell(action)

    @rule(query=QUERIES)
    def ask(self, query: str) -> None:
        assert "?" not in self.tell(query)

    @rule(
        text=almost_command(["TPE", "XYZZY", "V", "GO", "LH"]).filter(
            lambda t: not set(t) & set("\r\n:;\x00\b\x0b\x11\x13_")
        )
    )
    def mistype(self, text: str) -> None:
        self.tell(text.encode("latin-1", "replace").decode("latin-1"))

    @rule(ns=st.one_of(st.integers(1, 20 * MS), st.integers(1, S)))
    def wait(self, ns: int) -> None:
        self.session.emulator.advance_to(self.session.now_ns + ns)
        assert self.session.read() == "", "nothing waits in COMEXC1, so nothing is sent unasked"

    @rule(wire=st.sampled_from(WIRES), closed=st.booleans())
    def pull(self, wire: str, closed: bool) -> None:
        self.session.set_wire(wire, closed=closed)

    @precondition(lambda self: self.session.signal("wire.enable"))
    @rule()
    def cycle_power(self) -> None:
        self.session.unit.do("cut_power")
        self.session.advance(0.01)
        self.session.unit.do("restore_power")
        assert self.session.read() == SIGN_ON

    @invariant()
    def status_words_are_well_formed(self) -> None:
        for axis in AXES:
            assert AS_REPLY.fullmatch(self.session.query(f"!{axis}TAS"))

    @invariant()
    def status_words_are_consistent(self) -> None:
        for axis in AXES:
            bits = self.session.axis_bits(axis)
            moving, drive_off, in_zone = bits[0] == "1", bits[12] == "1", bits[23] == "1"
            assert moving == self.session.signal(f"axis{axis}.moving")
            assert drive_off != self.session.signal(f"axis{axis}.drive")
            assert not (moving and drive_off)
            assert not (moving and in_zone)
            assert not (bits[2] == "1" and bits[3] == "1"), "accelerating and at velocity"
            assert bits[28] == bits[30] == bits[31] == "0", "reserved"
            assert self.session.query("!DRIVE")[5:][axis - 1] == ("0" if drive_off else "1")

    @invariant()
    def the_readings_agree(self) -> None:
        for axis in AXES:
            commanded, encoder, error = (
                self.session.number(f"axis{axis}.position.{name}") for name in ("commanded", "encoder", "error")
            )
            assert error == commanded - encoder
            assert abs(self.session.number(f"axis{axis}.dac")) <= 10
            if not self.session.signal(f"axis{axis}.moving"):
                assert self.session.number(f"axis{axis}.velocity.commanded") == 0
            if not self.session.signal(f"axis{axis}.drive"):
                assert error == 0

    @invariant()
    def no_motion_without_enable(self) -> None:
        if not self.session.signal("wire.enable"):
            self.session.advance(SYSTEM_NS / S)
            for axis in AXES:
                assert not self.session.signal(f"axis{axis}.drive")
                assert not self.session.signal(f"axis{axis}.moving")


TestOperation = Operation.TestCase
TestOperation.settings = settings(relaxed, max_examples=25, stateful_step_count=30)


class LongOperation(Operation):
    """The same for minutes."""


TestLongOperation = pytest.mark.slow(LongOperation.TestCase)
TestLongOperation.settings = settings(relaxed, max_examples=500, stateful_step_count=60)
