"""Whatever a peer sends, and however it is cut: an answer or one of our exceptions, in bounded time and memory."""

from __future__ import annotations

import contextlib

from hypothesis import given, settings
from hypothesis import strategies as st

from clients import OEM6250, ClientError
from clients.exchange import Exchange
from clients.link import Link, Prompts
from clients.plan import Plan, make_plan
from clients.session import KEPT_OUTPUT
from tests.clients.peers import Answers, FamilyUnit, ScriptedLine

PIECES = [
    b"*",
    b"\r",
    b"\n",
    b"\r\n> ",
    b"\r\n? ",
    b"\r\n- ",
    b"*1TPE+5",
    b"1TPE",
    b"+",
    b"0",
    b"*UNDEFINED LABEL",
    b"\x00",
]
CHUNKS = st.lists(st.one_of(st.sampled_from(PIECES), st.binary(max_size=12)), max_size=12)
UNIT = {"1TPE": "+5", "1TAS": "0000_" * 7 + "0000", "TDIR": " NO PROGRAMS"}
COMMANDS = ["!1TPE", "1V5", "!TDIR", "TAS.1", "ECHO0", "1V", "VARS1", "A5:V5", "", "nonsense(", "TASF"]
ENOUGH_READS = 20_000


@given(st.lists(CHUNKS, max_size=6))
@settings(max_examples=60, deadline=None)
def test_connecting_to_anything(answers: list[list[bytes]]) -> None:
    turns = iter(answers)

    def answer(data: bytes) -> Answers:
        return [(0.001 * n, part) for n, part in enumerate(next(turns, []))]

    line = ScriptedLine(answer)
    try:
        OEM6250(line, timeout_s=0.2)
    except ClientError as error:
        assert str(error)
    assert line.clock() < 30
    assert line.reads < ENOUGH_READS


@given(st.sampled_from(COMMANDS), CHUNKS, st.integers(0, 4), st.booleans())
@settings(max_examples=150, deadline=None)
def test_any_answer_to_any_command(command: str, chunks: list[bytes], level: int, echo: bool) -> None:
    unit = FamilyUnit(level=level, echo=echo, values=UNIT)
    spoilt = False

    def answer(data: bytes) -> Answers:
        return [(0.001 * n, part) for n, part in enumerate(chunks)] if spoilt else unit.answer(data)

    line = ScriptedLine(answer)
    ctl = OEM6250(line, timeout_s=0.2)
    spoilt, began = True, line.clock()
    for action in (lambda: ctl.send(command), ctl.check, ctl.take_output, lambda: ctl.axis[1].velocity):
        try:
            action()
        except ClientError as error:
            assert str(error)
    assert line.clock() - began < 60
    spoilt = False
    ctl.synchronise()
    assert ctl.axis[1].position == 5


LINKS = [Link(), Link(echo=False), Link().with_level(2), Link(echo=False).with_level(0), Link().with_codes("EOT", (0,))]


@given(st.sampled_from(LINKS), st.sampled_from(["!1TPE", "1V", "VAR1", "TAS.1"]), st.data())
@settings(max_examples=150, deadline=None)
def test_an_answer_is_the_same_however_it_is_cut(link: Link, command: str, data: st.DataObject) -> None:
    plan = make_plan(command, "", link)
    framing = link.framing
    value = {"!1TPE": b"+123", "1V": b"5.0000", "VAR1": b"+2.5", "TAS.1": b"1"}[command]
    echo = command.upper().encode() + b"\r\n" if link.echo else b""
    whole = echo + framing.bot + plan.heads[0] + value + framing.eot + link.good_prompt
    cuts = sorted(data.draw(st.sets(st.integers(1, len(whole) - 1), max_size=6)))
    parts = [whole[a:b] for a, b in zip([0, *cuts], [*cuts, len(whole)], strict=True)]
    assert _value(plan, link, parts) == value.decode()


def _value(plan: Plan, link: Link, parts: list[bytes]) -> str | None:
    exchange = Exchange(plan, link, Prompts(link), [])
    for part in parts:
        if answer := exchange.take(part):
            return answer.value
    answer = exchange.quiet()
    return answer.value if answer else None


def test_a_flood_is_given_up_and_not_kept() -> None:
    flooding = False

    def answer(data: bytes) -> Answers:
        return [(0.0, b"*" * 5000)] * 200 if flooding else FamilyUnit().answer(data)

    ctl = OEM6250(ScriptedLine(answer), retries=0)
    flooding = True
    for _ in range(3):
        with contextlib.suppress(ClientError):
            ctl.send("!TDIR")
    assert len(ctl.session.wire.output) <= KEPT_OUTPUT
