"""Random sessions of motion: every kind of it started, and something else done while it is under way.

Lines beginning with ``;`` are comments to the unit and stage directions to whoever plays the session:
``;wire trigger.a 1`` closes a contact, ``;turn 2 500`` turns encoder 2 by counts, ``;wait 0.1`` lets seconds pass.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

WIRES = ("trigger.a", "trigger.b", "input.1", "input.2", "axis1.home", "axis2.home")
WIRES_THAT_STOP = (
    *("enable", "axis1.drive_fault"),
    *(f"axis{axis}.{end}_limit" for axis in (1, 2) for end in ("positive", "negative")),
)
MASTERS = (
    *("+21,0", "-21,0", "+21,0", "+24,0", "-24,0", "0,+11", "0,-14", "+21,+11", "-21,-11", "+24,+14", "+24,-14"),
    *("+22,0", "+12,0", "+11,0", "0,+24"),
)
"""Who follows whom, among it each other's commanded position; the last ones are refused."""
RATIOS = ("0", "1", "1", "2.5", "127", ".001", "3")
DISTANCES = ("0", "1", "-1", "500", "4000", "-25000", "1000000", "-999999999", "999999999")
PROFILES = ("PROF", "GEAR", "PATH")

Scene = Callable[[Random], list[str]]


def motion_session(random: Random, commands: int) -> list[str]:
    """About `commands` lines: scenes of motion, each disturbed."""
    lines = list(_START)
    while len(lines) < commands:
        lines += [] if random.random() < 0.3 else [*_ORDER]
        lines += random.choice(SCENES)(random)
        for _ in range(random.randint(1, 5)):
            lines += random.choice((disturbance, disturbance, pause, world))(random)
        if random.random() < 0.4:
            lines += recovery(random)
    return lines


_START = ("COMEXC1", "COMEXL1", "COMEXS1", "DRIVE11", "LH0,0", "SMPER0,0")


def recovery(random: Random) -> list[str]:
    """All contacts as they were, everything stopped or not, drives on again."""
    ending = random.choice((("!K",), ("!S", "!C"), ("!K", "JOG00", "JOY00"), ()))
    contacts = [f";wire {wire} {int(wire not in WIRES)}" for wire in (*WIRES, *WIRES_THAT_STOP) if "fault" not in wire]
    return [*contacts, ";wire axis1.drive_fault 0", *ending, ";wait 0.3", "JOG00", "DRIVE11", *random.choice(_AGAIN)]


_ORDER = (
    *("!K", "END", ";wire enable 1", ";wait 0.3", "INDAX2", "COMEXC1", "JOG00", "JOY00", "SFB1,1", "FOLEN00", "LH0,0"),
    *("LS0,0", "SMPER0,0", "SGP5,5", "KDRIVE00", "DRIVE11", "A100,100", "AA100,100", "AD100,100", "ADA100,100"),
)
_AGAIN = (("FOLEN00", "FOLMAS0,0"), ("LH0,0", "COMEXC1"), ("SFB1,1",), ("RESET", ";wait 0.2", *_START), ())


def number(random: Random, *texts: str) -> str:
    """One of some fields."""
    return random.choice(texts)


def ramps(random: Random) -> list[str]:
    """V, A, AD, D and modes of both axes."""
    rate = random.choice(("1", "10", "100", "999", ".01"))
    lines = [f"A{rate},{rate}", f"AD{rate},{rate}", f"V{random.choice(('1', '20', '.01', '0', '200'))},2"]
    lines += [f"AA{rate},{rate}", f"ADA{rate},{rate}"]
    return [*lines, f"D{number(random, *DISTANCES)},{number(random, *DISTANCES)}", *modes(random)]


def modes(random: Random) -> list[str]:
    """MC and MA."""
    return [f"MC{random.choice(('00', '11', '10', '01'))}", f"MA{random.choice(('00', '00', '10', '11'))}"]


def plain_moves(random: Random) -> list[str]:
    """Moves in time."""
    return [*ramps(random), *condition(random), random.choice(("GO11", "1GO", "2GO", "GO01"))]


def condition(random: Random) -> list[str]:
    """Something the next start waits for, now and then."""
    if random.random() < 0.6:
        return []
    where = random.choice(("1PC", "2PC", "1PMAS", "2PMAS", "1PE", "1PSHF", "1PSLV", "1FB"))
    relation = random.choice(("=", ">", "<", ">=", "<="))
    return [
        random.choice(
            (
                f"{random.randint(1, 2)}GOWHEN({where}{relation}{random.choice(DISTANCES)})",
                f"GOWHEN(T={random.choice((0, 5, 200))})",
                f"GOWHEN(T>{random.choice((0, 5, 200))}),(T>1)",
                "1GOWHEN(IN=bX1)",
                f"1TRGFN{random.choice('AB')}{random.choice(('1', '11', '01'))}",
                f"@TRGFNA{random.choice(('1', '11', 'X1'))}",
            )
        )
    ]


def following(random: Random) -> list[str]:
    """One or two slaves in a ratio move, perhaps shifted."""
    lines = [f"FOLMAS{random.choice(MASTERS)}", "FOLEN1X", "FOLENX1"]
    lines += [f"FOLRN{random.choice(RATIOS)},{random.choice(RATIOS)}", f"FOLRD{random.choice(('1', '3', '7.7'))},1"]
    lines += [f"FOLMD{random.choice(('0', '1', '1000', '4000', '999999999'))},100", *ramps(random)]
    lines += random.choice(([], [f"FFILT{random.randint(0, 4)},2"], ["FPPEN0X"], ["FMCLEN1000,50", "FMCP10"]))
    if random.random() < 0.4:
        lines += slave_moves_by(random)
    return [*lines, *condition(random), random.choice(("GO11", "1GO", "2GO")), *shifting(random)]


def slave_moves_by(random: Random) -> list[str]:
    """The other axis, whose encoder or command is the master, moves in time."""
    return ["FOLENX0", "MCX1", "V,5", *_FAST, "D,1", "2GO", "MCX0"]


def shifting(random: Random) -> list[str]:
    """Shifts and advances, or none."""
    kind = random.random()
    if kind < 0.4:
        return []
    lines = [";wait 0.05"] if random.random() < 0.7 else []
    texts = ("1FSHFC1", "2FSHFC2", "1FSHFC0", "FSHFC3,3", "FSHFD500,-500", "1FSHFD-4000", "1FGADV200", "FGADV-10,5")
    return [*lines, *condition(random), *(random.choice(texts) for _ in range(random.randint(1, 3)))]


def profile(random: Random) -> list[str]:
    """A compiled profile of one axis or two, in time or over master travel, compiled and run."""
    name, slave = random.choice((("PROF", False), ("GEAR", True)))
    lines = [f"FOLMAS+21,{random.choice(('0', '+14'))}", "FOLEN1X"] if slave else ["FOLEN00"]
    lines += [f"DEL {name}", f"DEF {name}", *profile_body(random, slave=slave), "END"]
    return [*lines, f"PCOMP {name}", *ramps(random)[-1:], f"PRUN {name}"]


_FAST = ("A100,100", "AA100,100", "AD100,100", "ADA100,100")


def profile_body(random: Random, *, slave: bool) -> list[str]:
    """GOBUFs, loops, outputs and waits."""
    lines, depth = [f"MC{random.choice('01')}{random.choice('01')}", "MA00", *_FAST], 0
    for _ in range(random.randint(1, 8)):
        kind = random.random()
        if kind < 0.15 and depth < 3:
            depth += 1
            lines.append(f"PLOOP{random.choice(('0', '1', '2', '1000000000'))},{random.choice(('', '2'))}")
        elif kind < 0.25 and depth:
            depth -= 1
            lines.append(random.choice(("PLN11", "PLN1", "PLN")))
        elif kind < 0.4:
            lines += condition(random) or ["POUT1X0"]
        else:
            lines += segment(random, slave=slave)
    return [*lines, *("PLN" for _ in range(depth)), *(["VF0", "FOLRNF0", "GOBUF11"] if random.random() < 0.6 else [])]


def segment(random: Random, *, slave: bool) -> list[str]:
    """One GOBUF with what it is made of."""
    distance = random.choice(("1", "100", "4000", "-4000", "50000"))
    speed = [f"FOLRN{random.choice(RATIOS)}", f"FOLMD{random.choice(('100', '4000', '50000'))}"] if slave else []
    speed = speed or [f"V{random.choice(('1', '5', '.1', '50'))}"]
    stop = random.choice(([], ["VF0"], ["FOLRNF0"]))
    return [*speed, f"D{distance},{distance}", *stop, random.choice(("GOBUF1", "GOBUF11", "2GOBUF"))]


def path(random: Random) -> list[str]:
    """A contour that can be travelled."""
    lines = ["FOLEN00", "DEL PATH", "DEF PATH", "PAXES1,2", f"PV{random.choice(('1', '10', '.1'))}", "PA50", "PAD50"]
    texts = ("PLIN4000,3000", "PLIN-500,0", "PARCM4000,4000,4000", "PARCOP0,0,2000,0", "POUT101", "PLIN100000,1")
    lines += [random.choice(texts) for _ in range(random.randint(1, 6))]
    return [*lines, "END", "PCOMP PATH", "PRUN PATH"]


def linear(random: Random) -> list[str]:
    """GOL."""
    return ["FOLEN00", *ramps(random), "MC00", f"PV{random.choice(('1', '20'))}", *condition(random), "GOL"]


def homing(random: Random) -> list[str]:
    """HOM with any of its settings."""
    lines = [
        f"HOMV{random.choice(('1', '.1', '20'))},1",
        f"HOMBAC{random.choice('01')}0",
        f"HOMZ{random.choice('01')}1",
    ]
    return [*lines, random.choice(("HOM01", "HOM0X", "HOMX1", "HOM11"))]


def by_hand(random: Random) -> list[str]:
    """Jogging by inputs or the joystick."""
    return ["INFNC1-1J", "INFNC2-1K", "INFEN1", random.choice(("JOG10", "JOG11", "JOY10", "JOG00")), ";wire input.1 1"]


def registration(random: Random) -> list[str]:
    """A move with a trigger that registers."""
    lines = [
        "INFNC25-H",
        "INFNC26-H",
        "INFEN1",
        "RE11",
        f"REGLOD{random.choice(('0', '100'))}",
        f"REGSS{random.choice('01')}0",
    ]
    lines += [f"REGA{random.choice(('0', '50', '4000', '100000'))},10", "REGB500,500", *plain_moves(random)]
    return [*lines, ";wait 0.1", ";wire trigger.a 1", ";wait 0.02", ";wire trigger.a 0"]


SCENES: tuple[Scene, ...] = (
    *(plain_moves, following, following, following, profile, profile, path, linear, homing, by_hand, registration),
)


def disturbance(random: Random) -> list[str]:
    """A command for motion under way."""
    return [random.choice(_DISTURBANCES)]


_DISTURBANCES = (
    *("GO11", "1GO", "GOL", "HOM01", "JOG11", "JOG00", "JOY11", "JOY00", "1FSHFC1", "FSHFC3,3", "FSHFD100,100"),
    *("FGADV50", "PSET0,0", "PSET1000", "FOLMAS0,0", "FOLMAS+21", "FOLMAS+24,+14", "FOLEN00", "FOLEN11", "FMCNEW11"),
    *("SFB2,2", "SFB1,1", "SFB0,0", "DRIVE00", "DRIVE1X", "DRIVE11", "RESET", "SSFR1", "SSFR4", "SSFR8", "INDAX1"),
    *("INDAX2", "MEMORY", "MEMORY20000,20000", "DEL PROF", "DEL PATH", "DEL GEAR", "ERASE", "PUCOMP PROF", "PRUN PROF"),
    *("PRUN GEAR", "PRUN PATH", "PCOMP PATH", "!S", "!K", "!1S", "!2K", "!C", "!PS", "LH3,3", "LH0,0", "LS3,3"),
    *("LSPOS100,100", "LSNEG-100,-100", "SMPER5,5", "SMPER0,0", "SGP0,0", "SGP100,100", "SGP5,5", "CMDDIR1X"),
    *("ENCPOL1", "FPPEN0X", "FPPEN11", "FFILT4,1", "FFILT0,0", "FMCLEN100,0", "FMCLEN0", "FMCP50", "FOLRN2,3"),
    *("FOLRN0,0", "FOLMD0,0", "FOLMD1000", "MC11", "MC00", "D5000,-5000", "COMEXC0", "COMEXC1", "COMEXS0", "KDRIVE11"),
    *("KDRIVE00", "COMEXR1", "REGA10", "TRGLOT0", "TRGLOT250", "ERES4000,1000", "SCALE1", "SCALE0", "DRES4000"),
    *("SCLD200,300", "SCLMAS10", "STRGTE11", "STRGTE00", "1OUTPA1,0,500", "SSV0", "TFS", "TFSF", "TAS", "TPMAS"),
    *("TNMCY", "TVMAS", "TPSHF", "TPSLV", "TSEG", "TPCEA", "TSS", "TER", "DEF X", "END", "WAIT(1AS.1=b0)", "T.05"),
    *(
        "WAIT(1PMAS>100)",
        "WAIT(1FS.4=b1)",
        "INFNC3-D",
        "INFNC4-E",
        "INFNC4-C",
        "INEN",
        "RUN PROF",
        "RUN PATH",
        "1PSET50",
    ),
)


def pause(random: Random) -> list[str]:
    """Time passes."""
    return [f";wait {random.choice(('0.002', '0.01', '0.05', '0.3', '1.5'))}"]


def world(random: Random) -> list[str]:
    """A contact changes, or the master is turned."""
    kind = random.random()
    if kind < 0.5:
        return [f";turn {random.randint(1, 2)} {random.choice((1, -1, 30, 500, -2000, 100000, -1000000))}"]
    wire = random.choice(WIRES if kind < 0.85 else WIRES_THAT_STOP)
    return [f";wire {wire} {random.randint(0, 1)}"]
