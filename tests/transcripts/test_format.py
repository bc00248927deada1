"""The transcript format itself: what the files say is what the runners get."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.transcripts.format import Expect, Match, Pass, Send, Timing, TranscriptError, load, parse, unescape

HEAD = "title: t\nsource: s\n"
HERE = Path(__file__).parent


def steps(text: str) -> tuple[object, ...]:
    return parse(HEAD + text, path=Path("x.txt")).steps


def test_steps_carry_bytes_lines_and_times() -> None:
    got = steps("> GO\\r\n@ 2.5s\n< {ok}\nat 1.1s +-0.003s\n")
    assert got == (Send(3, b"GO\r"), Pass(4, 2.5), Expect(5, b"\r\n> ", Timing(1.1, 0.003)))


def test_consecutive_expectations_join() -> None:
    assert steps("< *A\\r\\n\n< *B\\r{bad}\n") == (Expect(3, b"*A\r\n*B\r\r\n? "),)


def test_trailing_blank_needs_an_escape() -> None:
    assert steps("< >\\s   \n") == (Expect(3, b"> "),)


def test_pattern_is_a_bytes_expression_with_prompts() -> None:
    (step,) = steps("~ \\*1TPE\\+400[0-2]\\r{ok}\n")
    assert isinstance(step, Match)
    assert step.pattern.fullmatch(b"*1TPE+4001\r\r\n> ")
    assert not step.pattern.fullmatch(b"*1TPE+4003\r\r\n> ")


def test_machine_block_and_flags() -> None:
    machine = "machine:\n    bare = true\n    [defaults]\n    ECHO = 0\n"
    text = "title: t\nsource: a\nsource: b\n" + machine + "sign-on: shown\n> A\\r\n"
    got = parse(text, path=Path("x.txt"))
    assert got.machine == "bare = true\n[defaults]\nECHO = 0"
    assert got.sources == ("a", "b")
    assert got.sign_on_shown and got.virtual_only


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("> A\\q\n", r"x.txt:3: .*escape"),
        ("? A\n", r"x.txt:3: .*neither"),
        ("> A\nat 1s\n", r"x.txt:4: .*'at' follows"),
        ("< A\nat 1s\n", r"x.txt:4: .*'at' follows"),
        ("~ (\n", r"x.txt:3: "),
        ("@ soon\n", r"x.txt:3: "),
        ("sign-on: hidden\n", r"x.txt:3: sign-on"),
    ],
)
def test_errors_name_file_and_line(text: str, said: str) -> None:
    with pytest.raises(TranscriptError, match=said):
        steps(text)


def test_a_transcript_without_source_is_refused() -> None:
    with pytest.raises(TranscriptError, match="title and a source"):
        parse("title: t\n> A\n", path=Path("x.txt"))


@pytest.mark.parametrize("path", sorted(HERE.glob("*.txt")), ids=lambda path: path.stem)
def test_every_file_reads_and_ends_with_an_expectation(path: Path) -> None:
    transcript = load(path)
    assert transcript.steps
    assert isinstance(transcript.steps[-1], Expect | Match | Pass)


def test_unescape_knows_every_escape() -> None:
    assert unescape(r"\r\n\t\b\0\\\{\x41\s{def}", where="w") == b"\r\n\t\b\0\\{A \r\n- "


def test_no_file_waits_on_an_empty_match() -> None:
    for path in HERE.glob("*.txt"):
        for step in load(path).steps:
            if isinstance(step, Match):
                assert not re.match(step.pattern, b""), f"{path.name}:{step.line} matches nothing at all"
