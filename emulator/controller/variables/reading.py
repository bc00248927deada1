"""READ: a program asks the host for a number, and goes on when it has come (GemCR p.334)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.variables.store import Store, supplies
from emulator.controller.waits import NEVER
from protocol.arithmetic import ENTERED_PLACES, LARGEST
from protocol.command import Command
from protocol.errors import INVALID_DATA, CommandError
from protocol.expression import Operand
from protocol.numbers import truncate
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)", re.ASCII)


@dataclass(slots=True)
class ReadWait:
    """Until the host has sent ``!'value``."""

    store: Store
    answered: bool = False
    look_again_ns: int = NEVER
    status_bit: SystemStatus | None = SystemStatus.WAITING_FOR_DATA

    def over(self, controller: Controller) -> bool:
        return self.answered


@supplies("READ")
def read_from_host(controller: Controller, operand: Operand, store: Store) -> None:
    """VARn=READi: send string variable i as it stands (no asterisk, no EOT: assumed L) and wait for the answer."""
    prompt = controller.variables.text(operand.index or 0)
    controller.send(prompt.encode("latin-1"), controller.interpreter.channel)
    controller.interpreter.wait_for(ReadWait(store))


@handles("'")
def answer(controller: Controller, command: Command) -> Lines:
    """!'value: what a pending READ waits for; discarded when there is none.  Refused data: it waits on (assumed)."""
    wait = controller.interpreter.wait
    if isinstance(wait, ReadWait):
        wait.store(_number(command.argument))
        wait.answered = True
    return None


def _number(text: str) -> Decimal:
    if _NUMBER.fullmatch(text) is None:
        raise CommandError(INVALID_DATA)
    value = truncate(Decimal(text), ENTERED_PLACES)
    if abs(value) > LARGEST:
        raise CommandError(INVALID_DATA)
    return value
