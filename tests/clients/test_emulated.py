"""The client against the emulator at every ERRLVL, ECHO and EOT, and in every state in which a host may find a unit."""

from __future__ import annotations

import itertools

import pytest

from clients import (
    OEM6250,
    ClientError,
    EndOfTravel,
    Gains,
    Garbled,
    InDefinition,
    LineLost,
    MotionError,
    NoAnswer,
    UnitError,
    VerificationError,
)
from clients.programs import commands_of
from emulator.chain import build_chain
from emulator.emulator import Emulator
from emulator.machine import Machine
from tests.clients.peers import EmulatedLine

EOTS = ("13,0,0", "13,10,0", "10,0,0", "0,0,0", "3,0,0")
PROGRAM = """
; moves and tells
DEF CYCLE
L2
D1000 : GO1
WRITE"Hi \\126"
LN
END
"""


def connected(line: EmulatedLine, *first: str, **options: object) -> OEM6250:
    """A client that connects after another host has left the unit in some state."""
    line.unit.send("".join(f"{text}\r" for text in first).encode())
    line.emulator.advance(0.02)
    line.unit.read()
    return OEM6250(line, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(("level", "echo"), list(itertools.product(range(5), (0, 1))), ids=str)
def test_several_commands_in_a_line(level: int, echo: int) -> None:
    """Each is answered at its colon, so replies and prompts come among the echoes."""
    ctl = connected(EmulatedLine(), f"ECHO{echo}", f"ERRLVL{level}")
    ctl.send("A20:V5:D400")
    ctl.send("1D:1V" if level > 1 else "MA0:MC0")
    assert (ctl.query("1A"), ctl.query("1V"), ctl.query("1D")) == ("20.0000", "5.0000", "+400")


def test_the_lines_of_several_replies() -> None:
    ctl = connected(EmulatedLine())
    assert ctl.send("1TPE:1TPE").lines == ("*1TPE+0", "*1TPE+0")
    assert ctl.send("D8:1TPE").lines == ("*1TPE+0",)
    with pytest.raises(UnitError, match="UNDEFINED LABEL"):
        ctl.send("A10:XYZZY:V1")
    assert ctl.query("1TPE") == "+0"


@pytest.mark.parametrize(("level", "echo", "eot"), list(itertools.product(range(5), (0, 1), EOTS)), ids=str)
def test_every_level_echo_and_eot(level: int, echo: int, eot: str) -> None:
    line = EmulatedLine()
    ctl = connected(line, f"EOT{eot}", f"ECHO{echo}", f"ERRLVL{level}")
    assert (ctl.session.link.level, ctl.session.link.echo) == (level, bool(echo))
    axis = ctl.axis[1]
    axis.drive_enabled = True
    axis.velocity, axis.acceleration = 2.5, 100
    assert (axis.velocity, axis.drive_enabled, axis.hard_limits) == (2.5, True, EndOfTravel.BOTH)
    axis.move_to(4000)
    assert abs(axis.position - 4000) <= 50
    assert ctl.status.axis(1).in_target_zone
    assert ctl.status.system().system_ready
    assert ctl.query("!TAS.1") == "0"
    ctl.var[3], ctl.varb[2], ctl.vars[1] = -2.5, "10X1", "part *7"
    assert (float(ctl.var[3]), ctl.varb[2][:5], ctl.vars[1]) == (-2.5, "10X1X", "part *7")
    assert ctl.gains()[0].proportional == 0.5
    assert len(ctl.send("!TAS").lines) == 2
    ctl.programs.download("CYCLE", PROGRAM)
    assert ctl.programs.upload("CYCLE") == ["L2", "D1000", "GO1", 'WRITE"Hi \\126"', "LN"]
    assert [entry.name for entry in ctl.programs.directory()] == ["CYCLE"]
    ctl.programs.run("CYCLE", wait=True)
    assert "Hi ~Hi ~" in ctl.take_output().replace("\r", "")
    assert ctl.changed == ()


@pytest.mark.parametrize("level", range(5))
def test_refusals_at_every_level(level: int) -> None:
    ctl = connected(EmulatedLine(), f"ERRLVL{level}")
    with pytest.raises(ClientError) as refusal:
        ctl.send("!TPROG NONE")
    assert isinstance(refusal.value, UnitError)
    assert refusal.value.command == "!TPROG NONE"
    assert refusal.value.text == ("UNDEFINED LABEL" if level == 4 else "")
    if level >= 3:
        with pytest.raises(UnitError):
            ctl.axis[1].velocity = 99999
        return
    with pytest.raises(UnitError, match="1V99999"):
        ctl.axis[1].velocity = 99999
        ctl.check()
    assert ctl.axis[1].velocity == 1.0


@pytest.mark.parametrize(
    "state",
    [
        ["ERROK0,0,0,0", "ERRBAD0,0,0,0", "EOT10,0,0", "EOL13,0,0"],
        ["ERROK62,0,0,0", "ERRBAD63,0,0,0", "ERRDEF45,0,0,0"],
        ["BOT2,0,0", "EOT3,0,0"],
        ["EOL10,0,0", "EOT10,0,0", "ECHO0"],
        ["EOT256,0,0"],
        ["COMEXC1"],
        ["TRACE1", "STEP0"],
    ],
    ids=" ".join,
)
def test_other_framings(state: list[str]) -> None:
    ctl = connected(EmulatedLine(), *state)
    ctl.axis[1].velocity = 3
    assert (ctl.axis[1].velocity, ctl.axis[2].position) == (3.0, 0.0)
    with pytest.raises(UnitError, match="INVALID DATA"):
        ctl.axis[1].velocity = 99999


@pytest.mark.parametrize("typed", [b"GO", b"D40", b'WRITE"abc', b"DEL EVERYT", b"V5;comm", b"1TPE+", b"X" * 90])
def test_a_half_typed_line_is_taken_back_and_not_run(typed: bytes) -> None:
    line = EmulatedLine()
    line.unit.send(b"DRIVE11\r" + typed)
    ctl = OEM6250(line)
    assert ctl.axis[1].position == 0
    assert not ctl.status.axis(1).moving
    assert ctl.query("1D") == "+4000"


@pytest.mark.parametrize("level", [0, 1, 2, 4])
@pytest.mark.parametrize("body", [["L", 'WRITE"Q"', "T.004", "LN"], ["L", 'WRITE"*1TPE+7\\13\\10"', "T.02", "LN"]])
def test_a_running_program_that_keeps_talking(body: list[str], level: int) -> None:
    line = EmulatedLine()
    ctl = connected(line, "DEF TALKS", *body, "END", f"ERRLVL{level}", "!RUN TALKS", timeout_s=0.5)
    assert ctl.status.system().executing_program
    ctl.kill()
    line.emulator.advance(0.1)
    ctl.take_output()
    assert ctl.axis[1].position == 0
    assert not ctl.status.system().executing_program


@pytest.mark.parametrize("level", range(5))
def test_a_unit_in_the_middle_of_a_definition(level: int) -> None:
    line = EmulatedLine()
    with pytest.raises(InDefinition, match="end_definition"):
        connected(line, f"ERRLVL{level}", "DEF HALF", "D5")
    ctl = OEM6250(line, end_definition=True)
    assert ctl.changed == ("END",)
    assert ctl.programs.upload("HALF") == ["D5"]


def test_a_definition_opened_later_is_noticed() -> None:
    ctl = OEM6250(EmulatedLine())
    ctl.send("DEF OOPS")
    with pytest.raises(InDefinition):
        ctl.programs.delete("OTHER")
    ctl.end_definition()
    assert "OOPS" in ctl.programs


def test_wishes_for_echo_and_level_are_told() -> None:
    line = EmulatedLine()
    ctl = connected(line, "ERRLVL1", echo=False, error_level=4)
    assert ctl.changed == ("ECHO0", "ERRLVL4")
    assert (ctl.query("ECHO"), ctl.query("ERRLVL")) == ("0", "4")


def test_changing_the_line_by_hand_is_followed() -> None:
    ctl = OEM6250(EmulatedLine())
    for command in ("ECHO0", "ERRLVL1", "EOT10,13,0", "ERRLVL3", "ECHO1", "!ERROK33,0,0,0", "ERRLVL0", "RESET"):
        ctl.send(command)
        assert ctl.axis[1].position == 0
    ctl.settings.echo = False
    assert ctl.settings.echo is False


def test_settings_changed_behind_its_back_are_found_again() -> None:
    line = EmulatedLine()
    ctl = OEM6250(line, timeout_s=0.2)
    line.unit.send(b"ECHO0:ERRLVL1:EOT10,0,0\r")
    line.emulator.advance(0.01)
    assert ctl.axis[1].position == 0


def test_moves_fail_with_the_status_that_says_why() -> None:
    line = EmulatedLine()
    ctl = OEM6250(line)
    axis = ctl.axis[1]
    with pytest.raises(UnitError, match="DRIVE SHUTDOWN: refused '!1GO'"):
        axis.move_to(1000)
    axis.drive_enabled = True
    axis.positive_soft_limit, axis.negative_soft_limit, axis.soft_limits = 2000, -2000, EndOfTravel.BOTH
    with pytest.raises(MotionError, match="positive soft limit hit") as failure:
        axis.move_to(9000)
    assert failure.value.axis == 1
    axis.soft_limits = EndOfTravel.NONE
    with pytest.raises(NoAnswer, match=r"allow more than 0\.1 s"):
        axis.move_to(90000, velocity=1, timeout_s=0.1)
    axis.stop(wait=True)
    assert not axis.status.moving


def test_jogging_homing_and_moves_together() -> None:
    line = EmulatedLine()
    ctl = OEM6250(line)
    ctl.axis[1].drive_enabled = ctl.axis[2].drive_enabled = True
    ctl.axis[1].jog(-2.0, acceleration=50)
    line.emulator.advance(0.5)
    assert ctl.axis[1].commanded_velocity == pytest.approx(-2.0, abs=0.01)
    ctl.axis[1].stop(wait=True)
    ctl.move_to({1: 500, 2: -700})
    assert (ctl.axis[1].commanded_position, ctl.axis[2].commanded_position) == (500, -700)
    ctl.move_by({2: 100})
    assert ctl.axis[2].commanded_position == -600
    ctl.axis[1].set_position(0)
    assert ctl.axis[1].commanded_position == 0
    ctl.axis[1].home(negative=True, wait=False)
    assert ctl.status.axis(1).moving
    ctl.stop()


def test_a_go_posted_in_comexc0_leaves_its_prompt_to_be_sorted_out() -> None:
    line = EmulatedLine()
    ctl = OEM6250(line)
    ctl.axis[1].drive_enabled = True
    ctl.post("1D4000:GO1")
    for _ in range(200):
        assert 0 <= ctl.axis[1].position <= 4100
        assert ctl.axis[1].velocity == 1.0
        line.emulator.advance(0.0063)
    ctl.send("1D-4000")
    assert ctl.query("1D") == "-4000"


def test_a_posted_command_that_is_refused_is_raised_by_the_next() -> None:
    ctl = OEM6250(EmulatedLine())
    ctl.post("GO1")
    with pytest.raises(UnitError, match="DRIVE SHUTDOWN") as refusal:
        ctl.axis[1].position  # noqa: B018
    assert (refusal.value.command, refusal.value.late) == ("GO1", True)
    assert ctl.axis[1].position == 0


def test_gain_sets() -> None:
    ctl = OEM6250(EmulatedLine())
    gains = Gains(2, 0.5, 3, 1, 0.25, 100)
    ctl.axis[2].gains = gains
    assert ctl.axis[2].gains == gains
    ctl.save_gains(3)
    assert ctl.saved_gains(3)[1] == Gains(2, 0.5, 3, 1, 0.25, 100, 0.0, 4000.0)
    ctl.axis[2].proportional_feedback_gain = 9
    ctl.axis[2].use_gain_set(3)
    assert ctl.axis[2].gains == gains


def test_a_download_that_is_refused_leaves_nothing_behind() -> None:
    ctl = OEM6250(EmulatedLine())
    with pytest.raises(UnitError, match="NOT ALLOWED IN PROGRAM"):
        ctl.programs.download("PART", ["D5", "DEF INNER", "GO"])
    assert not ctl.session.defining
    assert ctl.programs.directory() == []
    with pytest.raises(UnitError):
        ctl.programs.download("GO", ["D5"])
    with pytest.raises(ValueError, match="not a program name"):
        ctl.programs.download("far too long", [])


def test_a_download_damaged_on_the_way_is_found_out() -> None:
    class Noisy(EmulatedLine):
        def write(self, data: bytes) -> None:
            super().write(data.replace(b"D1000", b"D1007"))

    ctl = OEM6250(Noisy(), echo=False)
    with pytest.raises(VerificationError, match="sent 'D1000', stored 'D1007'"):
        ctl.programs.download("CYCLE", PROGRAM)


def test_echo_shows_what_was_damaged_on_the_way() -> None:
    class Noisy(EmulatedLine):
        def write(self, data: bytes) -> None:
            super().write(data.replace(b"1V5", b"1V7"))

    ctl = OEM6250(Noisy())
    with pytest.raises(Garbled):
        ctl.axis[1].velocity = 5


def test_program_texts_are_read_as_the_unit_lists_them() -> None:
    assert commands_of(PROGRAM) == ["L2", "D1000", "GO1", 'WRITE"Hi \\126"', "LN"]
    assert commands_of("; nothing\n\n") == []


def test_a_line_lost_during_a_move() -> None:
    class Cut(EmulatedLine):
        cut = False

        def read(self, timeout_s: float) -> bytes:
            if self.cut and self.unit.signals["axis1.position.commanded"]:
                raise ConnectionResetError("connection reset by peer")
            return super().read(timeout_s)

    line = Cut()
    ctl = OEM6250(line)
    ctl.axis[1].drive_enabled = True
    line.cut = True
    with pytest.raises(LineLost, match="the unit goes on with whatever it was doing") as failure:
        ctl.axis[1].move_to(40000)
    assert isinstance(failure.value, ConnectionError)
    line.cut = False
    again = OEM6250(line)
    again.axis[1].wait_until_settled()
    assert again.axis[1].commanded_position == 40000


class ChainedLine(EmulatedLine):
    """Three units in a daisy chain, with ERRLVL1 as the manual asks."""

    def __init__(self) -> None:
        super().__init__(Emulator())
        self.chain = build_chain(Machine.parse("[defaults]\nERRLVL = 1"), 3)
        self.chain.power_up()
        self._out = bytearray()

    def write(self, data: bytes) -> None:
        self.chain.receive(data, at_ns=self.chain.now_ns, channel=0)

    def clock(self) -> float:
        return self.chain.now_ns / 1e9

    def read(self, timeout_s: float) -> bytes:
        end = self.clock() + timeout_s
        while True:
            data = b"".join(output.data for output in self.chain.take_output())
            if data or self.clock() >= end:
                return data
            self.chain.advance(self.chain.now_ns + 2_000_000)


def test_a_daisy_chain() -> None:
    first = OEM6250(ChainedLine(), address=1)
    units = [first, first.unit(2), first.unit(3)]
    for number, unit in enumerate(units, start=1):
        unit.axis[1].velocity = number + 0.5
        unit.var[1] = number * 10
    assert [unit.axis[1].velocity for unit in units] == [1.5, 2.5, 3.5]
    assert [int(unit.var[1]) for unit in units] == [10, 20, 30]
    units[1].axis[1].drive_enabled = True
    units[1].axis[1].move_to(2000)
    assert [round(unit.axis[1].commanded_position) for unit in units] == [0, 2000, 0]
