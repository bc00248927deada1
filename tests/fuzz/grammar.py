"""Random sessions of valid commands, made from the catalogue and a small grammar of programs.

Everything is drawn from a `random.Random`, so the same grammar serves hypothesis (which hands in a Random that it can
shrink) and the long run (which needs a million commands and a seed). "Valid" means well-formed: a session still draws
errors, because programs are missing, drives off, names taken.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from protocol import catalogue
from protocol.catalogue import CommandRow

LEFT_ALONE = frozenset(
    {
        *("E", "ADDR", "ERRLVL", "BOT", "EOL", "EOT", "ERROK", "ERRBAD", "ERRDEF", "PORT", "LOCK", "XONOFF", "ECHO"),
        *("DRPCHK", "RESET", "INDAX"),
    }
)
"""Settings that would make the checks of a session blind: how the unit speaks, and to whom."""

PROGRAM_NAMES = ("MAIN", "SUB", "LOOP", "MOVE", "ERRP", "A1")
LABELS = ("TOP", "ONE", "TWO")
WORD_OPERANDS = ("1AS", "2AS", "SS", "ER", "IN", "INO", "LIM", "OUT", "US", "MOV")
NUMBER_OPERANDS = ("1PC", "2PE", "1PER", "2FB", "1VEL", "1DAC", "TIM", "1A", "2D", "1V")
RELATIONS = ("=", "<>", "<", ">", "<=", ">=")
MAX_DEPTH = 3

Maker = Callable[[Random], str]


def _usable(kind: str) -> list[CommandRow]:
    rows = [row for row in catalogue.rows() if row.kind == kind and row.applies_to_oem6250]
    return [row for row in rows if row.name not in LEFT_ALONE and not row.name.startswith("<")]


SETTINGS = [row for row in _usable("setting") if row.reply in ("numbers", "mask") and row.fields.type != "mixed"]
REPORTS = [row for row in _usable("report") if row.fields.count == 0]


def session(random: Random, commands: int) -> list[str]:
    """About `commands` commands, one a line: definitions of programs among single commands."""
    lines: list[str] = []
    while len(lines) < commands:
        kind = random.random()
        lines += definition(random) if kind < 0.15 else contour(random) if kind < 0.18 else [statement(random)]
    return lines


def definition(random: Random) -> list[str]:
    """DEF to END, and now and then a run of it."""
    name = random.choice(PROGRAM_NAMES)
    lines = [f"DEL {name}", f"DEF {name}", *block(random, 0), "END"]
    return [*lines, random.choice((name, f"RUN {name}", f"GOSUB {name}"))] if random.random() < 0.7 else lines


def contour(random: Random) -> list[str]:
    """A path, possible or not, compiled and started, and perhaps stopped."""
    name = random.choice(PROGRAM_NAMES)
    lines = [f"DEL {name}", f"DEF {name}", *(path_command(random) for _ in range(random.randint(1, 6))), "END"]
    return [*lines, f"PCOMP {name}", f"PRUN {name}", random.choice(("!S", "!1K", "GOL", "PUCOMP " + name, "TSEG"))]


def path_command(random: Random) -> str:
    """A line or an arc most of the time; distances from none to the largest."""
    if random.random() < 0.3:
        return random.choice(
            (*("PAB1", "PAB0", "PL1", "PLC5,5", "PWC0,0", "PV0.1", "PV100", "PRTOL50", "PA9"), "POUT1X0")
        )
    command, fields = random.choice((("PLIN", 2), ("PARCM", 3), ("PARCP", 3), ("PARCOM", 4), ("PARCOP", 4)))
    return command + ",".join(str(random.choice((0, 1, -7, 100, -4000, 30000, 999999999))) for _ in range(fields))


def block(random: Random, depth: int) -> list[str]:
    """Some lines of a program, properly nested."""
    lines: list[str] = []
    for _ in range(random.randint(1, 4)):
        nested = depth < MAX_DEPTH and random.random() < 0.35
        lines += random.choice(STRUCTURES)(random, depth + 1) if nested else [in_program(random)]
    return lines


def _branch(random: Random, depth: int) -> list[str]:
    otherwise = ["ELSE", *block(random, depth)] if random.random() < 0.5 else []
    return [f"IF({condition(random)})", *block(random, depth), *otherwise, "NIF"]


def _while(random: Random, depth: int) -> list[str]:
    return [f"WHILE({condition(random)})", *block(random, depth), "NWHILE"]


def _repeat(random: Random, depth: int) -> list[str]:
    return ["REPEAT", *block(random, depth), f"UNTIL({condition(random)})"]


def _loop(random: Random, depth: int) -> list[str]:
    return [f"L{random.choice(('', 2, 3, 10))}", *block(random, depth), "LN"]


STRUCTURES = (_branch, _while, _repeat, _loop)


def in_program(random: Random) -> str:
    """A line that only a program is likely to hold, or any other."""
    if random.random() < 0.3:
        return random.choice(_IN_PROGRAM)(random)
    return statement(random)


def statement(random: Random) -> str:
    """One command, sometimes immediate."""
    text = random.choice(_STATEMENTS)(random)
    return f"!{text}" if random.random() < 0.1 and not text[0].isdigit() else text


def setting(random: Random) -> str:
    """A setting with fields in its range, for all axes or one, or asked for."""
    row = random.choice(SETTINGS)
    fields = row.fields
    if random.random() < 0.15:
        return row.name
    if fields.type in ("binary", "bit-pattern"):
        return row.name + "".join(random.choice("01X") for _ in range(fields.count))
    if fields.per_axis and random.random() < 0.3:
        return f"{random.randint(1, 2)}{row.name}{value(random, row)}"
    return row.name + ",".join(value(random, row) for _ in range(fields.count))


def value(random: Random, row: CommandRow) -> str:
    """One field: an end of the range, something small, or a variable."""
    low, high = _range(row)
    if random.random() < 0.05:
        return f"(VAR{random.randint(1, 10)})"
    number = random.choice((low, high, min(high, max(low, random.choice((0, 1, 2, 10, 1000))))))
    return f"{number:g}" if float(number) != int(number) else str(int(number))


def _range(row: CommandRow) -> tuple[float, float]:
    low, high = row.fields.min, row.fields.max
    return (float(low) if low not in (None, "") else 0.0, float(high) if high not in (None, "") else 100.0)


def report(random: Random) -> str:
    """A report of the unit or of one axis."""
    row = random.choice(REPORTS)
    return f"{random.randint(1, 2)}{row.name}" if row.fields.per_axis and random.random() < 0.5 else row.name


def number_expression(random: Random, depth: int = 0) -> str:
    """Arithmetic, worked from left to right."""
    if depth == MAX_DEPTH or random.random() < 0.4:
        return random.choice((str(random.randint(-50, 999)), f"VAR{random.randint(1, 12)}", "PI", _number(random)))
    inner = number_expression(random, depth + 1)
    if random.random() < 0.25:
        return f"{random.choice(('SIN', 'COS', 'TAN', 'ATAN', 'SQRT'))}({inner})"
    if random.random() < 0.3:
        return f"({inner})"
    return f"{inner}{random.choice('+-*/')}{number_expression(random, depth + 1)}"


def _number(random: Random) -> str:
    return random.choice((f"{random.uniform(-99, 99):.3f}", random.choice(NUMBER_OPERANDS)))


def bit_expression(random: Random) -> str:
    """Bit patterns joined by the boolean operators and shifts."""
    first = random.choice((_pattern(random), f"VARB{random.randint(1, 5)}", random.choice(WORD_OPERANDS)))
    if random.random() < 0.5:
        return first
    return f"{first}{random.choice(('&', '|', '^', '<<', '>>'))}{_pattern(random)}"


def _pattern(random: Random) -> str:
    return "b" + "".join(random.choice("01X") for _ in range(random.randint(1, 12)))


def condition(random: Random) -> str:
    """A condition of IF, WHILE, UNTIL or WAIT."""
    one = _relation(random)
    if random.random() < 0.25:
        one = f"{one} {random.choice(('AND', 'OR'))} {_relation(random)}"
    return one


def _relation(random: Random) -> str:
    kind = random.random()
    if kind < 0.4:
        return f"VAR{random.randint(1, 10)}{random.choice(RELATIONS)}{random.randint(-5, 50)}"
    if kind < 0.7:
        return f"{random.choice(WORD_OPERANDS)}={_pattern(random)}"
    if kind < 0.8:
        return f"1AS.{random.randint(1, 32)}=b{random.randint(0, 1)}"
    return f"{random.choice(NUMBER_OPERANDS)}{random.choice(RELATIONS)}{random.randint(-5000, 5000)}"


def _of(*texts: str) -> Maker:
    return lambda random: random.choice(texts)


def _assignment(random: Random) -> str:
    return f"VAR{random.randint(1, 12)}={number_expression(random)}"


def _bits(random: Random) -> str:
    return f"VARB{random.randint(1, 5)}={bit_expression(random)}"


def _text(random: Random) -> str:
    return f'VARS{random.randint(1, 4)}="{"".join(random.choice("ABC xyz:;") for _ in range(random.randint(0, 12)))}"'


def _call(random: Random) -> str:
    return random.choice(("GOSUB", "GOTO", "JUMP", "RUN")) + " " + random.choice((*PROGRAM_NAMES, *LABELS))


def _program_command(random: Random) -> str:
    return f"{random.choice(('TPROG', 'DEL', 'ERRORP', 'ONP', 'RUN', 'STARTP'))} {random.choice(PROGRAM_NAMES)}"


def _wires(random: Random) -> str:
    number = random.randint(1, 26)
    return random.choice(
        (
            f"OUT.{number}-{random.randint(0, 1)}",
            f"OUTFNC{number}-{random.choice('ABCDFGH')}",
            f"INFNC{number}-{random.choice('ABCDEFHIJKLMNOPQ')}",
            f"ERROR.{random.randint(1, 16)}-1",
        )
    )


_IN_PROGRAM: tuple[Maker, ...] = (
    lambda random: f"${random.choice(LABELS)}",
    _call,
    _of("BREAK", "HALT", "LX", "C", "T.01", "T0.1", "1GO", "GO11"),
    lambda random: f"WAIT({condition(random)})",
)

_STATEMENTS: tuple[Maker, ...] = (
    setting,
    setting,
    report,
    _assignment,
    _assignment,
    _bits,
    _text,
    _wires,
    _program_command,
    _of("GOL", "GOL10", "1GOL", "PV5", "PCOMP MAIN", "PRUN MAIN"),
    _of("GO11", "1GO", "2GO", "S", "K", "1S", "PSET0,0", "DRIVE11", "DRIVE00", "COMEXC1", "COMEXC0", "HOM00", "@V2"),
    _of(
        "VAR1", "VARB1", "VARS1", "TIMST0", "TIMSTP", "TTIM", "T.02", "DATRST1,1", "DATPTR1,1,1", "VAR3=DAT1", "PS", "C"
    ),
    _of('WRITE"X"', "WRVAR1", "WRVARB1", "WRVARS1", "VARCLR", "TDIR", "ERASE", "HALT", "MEMORY", "DATSIZ1,10"),
)
