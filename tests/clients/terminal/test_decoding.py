"""Replies in words."""

from __future__ import annotations

import pytest

from clients.terminal.decoding import Detail, command_of, decode, error_row, hint, summary
from protocol.catalogue import error_rows, status_words
from protocol.reply import group_bits

IDLE = "0000_0000_0000_1000_0000_0001_0000_0000"


def word(*bits: int, count: int = 32) -> str:
    return group_bits("".join("1" if number in bits else "0" for number in range(1, count + 1)), 4)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (f"*1TAS{IDLE}", "axis 1: 13 Drive Shutdown; 24 In Target Zone"),
        (f"*2TAS{word(1, 2, 4)}", "axis 2: 1 Moving; 2 Direction NEG; 4 At Velocity"),
        (f"*TSS{word(1, 3, 7)}", "1 System Ready; 3 Executing Program; 7 Defining Program"),
        (f"*TER{word(9)}", "9 Enable Input Open"),
        (f"*TER{word()}", "no bit set"),
        ("*TINO0000_0100", "6 Enable Input"),
        ("*TLIM100_011", "1 axis 1 positive limit input; 5 axis 2 negative limit input; 6 axis 2 home input"),
        (f"*TIN{word(3, 25, count=26)}", "3 programmable input 3; 25 trigger A"),
        (f"*1TFS{word(6)}", "axis 1: 6 FOLEN Active"),
    ],
)
def test_status_words(line: str, said: str) -> None:
    (told,) = decode(line)
    assert told.lower() == said.lower()


@pytest.mark.parametrize("name", [word.name for word in status_words().values() if word.report.startswith("T")])
@pytest.mark.parametrize("detail", ["set", "all"])
def test_every_word_of_the_catalogue_is_decoded(name: str, detail: Detail) -> None:
    row = status_words()[name]
    if not row.bit:
        return
    count = max(bit.last_number or bit.number for bit in row.bit)
    lines = decode(f"*{row.report}{'1' * count}", detail=detail)
    numbers = {bit.number for bit in row.bit}
    assert all(f"{number} " in " ".join(lines) for number in numbers)


def test_all_bits_and_none() -> None:
    lines = decode(f"*1TAS{IDLE}", detail="all")
    assert "axis 1:  1 0 Moving" in lines
    assert "axis 1: 13 1 Drive Shutdown" in lines
    assert decode(f"*1TAS{IDLE}", detail="off") == []


@pytest.mark.parametrize(
    ("asked", "line", "said"),
    [
        ("1TAS", f"*{IDLE}", "axis 1: 13 Drive Shutdown; 24 In Target Zone"),
        ("1TAS", IDLE, "axis 1: 13 Drive Shutdown; 24 In Target Zone"),
        ("2_!1TAS.13", "*1", "axis 1: bit 13, Drive Shutdown: on"),
        ("V5:TSS.3", "*0", "bit 3, Executing Program: off"),
    ],
)
def test_a_reply_without_a_name_is_read_by_what_was_asked(asked: str, line: str, said: str) -> None:
    assert decode(line, asked=command_of(asked)) == [said]


@pytest.mark.parametrize("line", ["*TPE+0,+0", "*1V5.0000", "hello", "*DRIVE01", "", "*1", "*TAS", "*OUT0101"])
def test_what_is_no_status_word_is_left_alone(line: str) -> None:
    assert decode(line, asked=command_of("TPE")) == []


@pytest.mark.parametrize("row", error_rows(), ids=lambda row: row.text)
def test_every_error_message_is_known(row: object) -> None:
    text = row.text  # type: ignore[attr-defined]
    assert error_row("*" + text.replace(" n", " 2")) is row
    assert error_row(text.replace(" ", "_").replace("_n", "_1")) is row


def test_a_refusal_says_what_draws_it_and_what_the_command_takes() -> None:
    told = hint("*INVALID DATA-FIELD 1", command_of("1V99999")) or ""
    assert "V<r>,<r>" in told
    assert "0.0 to 200.0" in told
    assert "drive is disabled" in (hint("DRIVE SHUTDOWN", command_of("GO")) or "")
    assert "present mode" in (hint("INVALID CONDITIONS FOR COMMAND-AXIS 2", None) or "")
    assert hint("HELLO", None) is None


def test_a_command_in_one_line() -> None:
    assert summary("v") == "Velocity: <!><@><a>V<r>,<r>; 0.0 to 200.0 units/sec (revs/sec unscaled); default 1.0"
    assert summary("NOSUCH") is None
