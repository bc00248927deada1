"""The protocol core: one unit on a line, without I/O. Both faces of the library drive the procedures made here.

What the unit says without being asked (WRITE in a program, sign-on, late prompts) is kept apart and can be read with
`take_output`. After anything that left the line in doubt (no answer, a cancelled wait, garbage) the next command first
finds its footing again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from clients.effects import Converse, Procedure, Receive, Send
from clients.errors import Garbled, InDefinition, LinkError, NoAnswer, UnitError
from clients.exchange import Exchange, last_message
from clients.link import Link, Prompts
from clients.plan import Answer, Kind, Plan, make_plan
from clients.synchronising import Synchronised, find_link

DEFAULT_TIMEOUT_S = 1.0
DEFAULT_QUIET_S = 0.05
"""So long nothing must come where only silence ends an answer: three times the latency of a slow USB adapter."""

KEPT_OUTPUT = 65_536
"""So much of what was not asked for is kept, the newest."""

PLANS_KEPT = 512


@dataclass
class Wire:
    """What all units of a line share."""

    clock: Callable[[], float]
    timeout_s: float = DEFAULT_TIMEOUT_S
    quiet_s: float = DEFAULT_QUIET_S
    retries: int = 1
    output: bytearray = field(default_factory=bytearray)
    in_doubt: bool = False

    def keep(self, data: bytes) -> None:
        """Put aside what nobody asked for."""
        self.output += data
        if len(self.output) > KEPT_OUTPUT:
            del self.output[: len(self.output) - KEPT_OUTPUT]


class Session:
    """The conversation with one unit; `address` is its number in a daisy chain."""

    def __init__(self, wire: Wire, *, address: int | None = None, link: Link | None = None) -> None:
        self.wire, self.address = wire, address
        self.prefix = "" if address is None else f"{address}_"
        self.changed: list[str] = []
        self.defining = False
        self.owed: list[str] = []
        self._plans: dict[str, Plan] = {}
        self.link = link or Link()

    @property
    def link(self) -> Link:
        """The serial settings the unit is believed to have."""
        return self._link

    @link.setter
    def link(self, link: Link) -> None:
        self._link, self._prompts = link, Prompts(link)
        self._plans.clear()

    def take_output(self) -> str:
        """What the unit has said unasked since last time; prompts are left out."""
        text = self.wire.output.decode("latin-1")
        self.wire.output.clear()
        return text

    def synchronise(self) -> Procedure[Synchronised]:
        """Find out the unit's settings whatever state it is in; bounded in time.

        Raises:
            NoAnswer, Garbled: nobody there, or nobody of this family.
        """
        self.wire.in_doubt = False
        self.owed.clear()
        found = yield from find_link(self.wire, self.prefix)
        self.link, self.defining = found.link, found.defining
        return found

    def command(self, line: str, *, timeout_s: float | None = None) -> Procedure[Answer]:
        """Send a line and wait for its answer.

        Raises:
            UnitError: the unit refused it. NoAnswer, Garbled: see there; a query is asked again `retries` times.
        """
        plan, wire = self._plans.get(line) or self._plan(line), self.wire
        patience_s, begun = wire.timeout_s if timeout_s is None else timeout_s, None
        if plan.tells_itself and not (wire.in_doubt or self.owed):
            wire.in_doubt = True
            begun = yield Converse(plan.data, patience_s)
            if answer := plan.quick(begun):
                wire.in_doubt = self.defining = False
                return answer
        answer = yield from self._persistently(plan, patience_s, begun)
        return answer

    def _persistently(self, plan: Plan, timeout_s: float, begun: bytes | None) -> Procedure[Answer]:
        """Anything but the usual answer; `begun`: what has come of an exchange already begun."""
        left = self.wire.retries if plan.kind in (Kind.REPLY, Kind.LINES) else 0
        while True:
            try:
                return (yield from self._exchange(plan, timeout_s, begun))
            except LinkError as error:
                self.wire.in_doubt = True
                if not isinstance(error, (NoAnswer, Garbled)):
                    raise
                if left <= 0:
                    yield from self._look_for_refusal(plan, error)
                    raise
            left -= 1
            yield from self._recover()
            plan, begun = self._plan(plan.line), None

    def immediate(self, line: str) -> Procedure[Answer]:
        """The same with `!`: carried out and answered at once, whatever the unit is busy with."""
        answer = yield from self.command("!" + line)
        return answer

    def buffered(self, line: str) -> Procedure[Answer]:
        """A command without `!` that must be carried out: not in the middle of a program definition.

        Raises:
            InDefinition: it was stored instead.
        """
        answer = yield from self.command(line)
        if answer.prompt == "defining":
            raise InDefinition(f"{line!r} was stored, not carried out")
        return answer

    def post(self, line: str) -> Procedure[None]:
        """Send a line and do not wait; its prompt or refusal is sorted out by the exchanges that follow."""
        plan = self._plan(line)
        yield from self._tidy()
        yield Send(plan.data)
        if self._link.prompting or self._link.bad_prompt:
            self.owed += [line] * plan.count

    def listen(self) -> Procedure[None]:
        """Take in what has come unasked."""
        data = yield Receive(0.0)
        if data:
            self._take_stale(data)

    def idle(self, data: bytes) -> None:
        """Bytes that came while nothing was asked."""
        if data:
            prompts = self._prompts
            found = sum(data.count(text) for text in prompts.kinds)
            del self.owed[:found]
            self.wire.keep(prompts.removed(data))

    def _plan(self, line: str) -> Plan:
        plan = self._plans.get(line)
        if plan is None:
            if len(self._plans) >= PLANS_KEPT:
                self._plans.clear()
            plan = self._plans[line] = make_plan(line, self.prefix, self._link)
        return plan

    def _tidy(self) -> Procedure[None]:
        """Before a line is sent: in doubt, find the footing; take in what has come."""
        if self.wire.in_doubt:
            yield from self._recover()
        yield from self.listen()

    def _take_stale(self, data: bytes) -> None:
        bad = self._link.bad_prompt
        if bad and bad in data and self.owed:
            said = data[: data.find(bad)].removesuffix(self._link.framing.eot)
            names, text = ", ".join(self.owed), last_message(said)
            self.owed.clear()
            raise UnitError(text, names, late=True)
        self.idle(data)

    def _exchange(self, plan: Plan, timeout_s: float, begun: bytes | None = None) -> Procedure[Answer]:
        wire = self.wire
        if begun is None:
            yield from self._tidy()
            wire.in_doubt = True
            yield Send(plan.data)
        exchange = Exchange(plan, self._link, self._prompts, self.owed)
        try:
            answer = exchange.begin() or (yield from self._await(exchange, timeout_s, begun or b""))
        except UnitError:
            wire.in_doubt = False
            raise
        except (NoAnswer, Garbled):
            wire.keep(exchange.received)
            raise
        finally:
            wire.keep(exchange.other)
        wire.in_doubt = False
        return self._noted(plan, answer)

    def _await(self, exchange: Exchange, timeout_s: float, data: bytes) -> Procedure[Answer]:
        clock, quiet_s = self.wire.clock, self.wire.quiet_s
        deadline = clock() + timeout_s
        left, settles = timeout_s, 0
        while True:
            if b"\x00" in data and not self._link.uses_nul:
                data = data.replace(b"\x00", b"")
            answer = exchange.take(data) if data else exchange.quiet() if settles else None
            if answer is not None:
                return answer
            settles = exchange.settles
            left = deadline - clock()
            if left <= 0:
                break
            data = yield Receive(min(left, settles * quiet_s) if settles else left)
        if (answer := exchange.quiet() if exchange.settles else None) is not None:
            return answer
        raise exchange.expired(timeout_s)

    def _noted(self, plan: Plan, answer: Answer) -> Answer:
        """Keep up with what the command changed about the line."""
        if plan.kind is Kind.LINK:
            for command in plan.commands:
                if command.name in ("ECHO", "ERRLVL", "EOT", "EOL", "BOT", "ERROK", "ERRBAD", "ERRDEF"):
                    self.link = self._link.after(command)
                self.wire.in_doubt = self.wire.in_doubt or command.name == "RESET"
        elif plan.kind is Kind.SETTING and not self._link.prompting and self._link.bad_prompt:
            self.owed.append(plan.line)
            del self.owed[:-8]
        if answer.prompt:
            self.defining = answer.prompt == "defining"
        return answer

    def _recover(self) -> Procedure[None]:
        """Find the footing again: the settings may have changed, too."""
        yield from self.synchronise()

    def _look_for_refusal(self, plan: Plan, error: LinkError) -> Procedure[None]:
        """Below ERRLVL2 a refusal is silence; TCMDER tells the last command refused.

        Raises:
            UnitError: it is this one.
        """
        if self._link.level > 1 or plan.kind is Kind.LINK or not plan.commands or plan.line.endswith("TCMDER"):
            return
        try:
            yield from self._recover()
            told = yield from self._exchange(self._plan("!TCMDER"), self.wire.timeout_s)
        except LinkError:
            raise error from None
        if told.lines and _bare(told.lines[0]) == _bare(plan.line):
            raise UnitError("", plan.line) from None

    def check(self) -> Procedure[None]:
        """Ask for the last command refused (TCMDER), which below ERRLVL3 is the only way to know.

        Raises:
            UnitError: there is one; asking clears it.
        """
        yield from self.listen()
        told = yield from self.command("!TCMDER")
        if told.lines and told.lines[0].strip():
            raise UnitError("", told.lines[0].strip(), late=True)


def _bare(line: str) -> str:
    return line.upper().replace(" ", "").removeprefix("!")
