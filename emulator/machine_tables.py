"""The tables of a machine file, each value with its provenance.

Manuals for this unit survive only in part. Whatever no page confirms lives here, in one named
field with a documented unit, and says where it comes from; nothing of the kind is buried in a
formula. The same annotations make the fidelity ledger (`emulator.fidelity`), so a value cannot
be added without being listed there.

Page keys: PG = 6000 Series Programmer's Guide, UG = 6250 Servo Controller User Guide, APEX =
APEX615n Installation Guide, GemCR = Gemini Command Reference, KB = Parker knowledge base, 6KCR =
6K Command Reference. Host programs are named by their project.
"""

from __future__ import annotations

import math
from typing import Annotated, Final, Literal

import msgspec

from emulator.encoder_motion_tables import EncoderMotionTable, Shaft
from emulator.plant_tables import PlantTable, VelocityDrive
from emulator.rmc.tables import RmcAxis
from emulator.table_fields import Table, known

Contact = Literal["closed", "open"]

Line = Annotated[str, msgspec.Meta(pattern=r"^[ -~]*\Z")]


class Identity(Table, frozen=True):
    """What the unit says about itself."""

    sign_on: Annotated[
        tuple[Line, ...],
        known(
            "power-up lines, stars included; BOT before the first, EOL between, EOT after the last",
            "assumed",
            "L",
            "shape PG 72; product words assumed",
            min_length=1,
        ),
    ] = ("*PARKER OEM6250 MOTION CONTROLLER", "*NO REMOTE PANEL")
    revision: Annotated[
        Line, known("text after *TREV; a placeholder part number and revision", "assumed", "L", "shape: EPICS drvPC6K")
    ] = "92-000000-01-4.7 OEM6250"


class Rp240(Table, frozen=True):
    """The optional operator panel."""

    fitted: Annotated[bool, known("panel connected: second sign-on line and TSS bit 21", "assumed", "H")] = False
    sign_on_line: Annotated[Line, known("last sign-on line when the panel is fitted", "assumed", "H")] = (
        "*RP240 CONNECTED"
    )


class Options(Table, frozen=True):
    """What the order code of the unit includes."""

    following: Annotated[
        bool, known("Following fitted; without it its commands are not implemented", "assumed", "M")
    ] = True
    ani: Annotated[bool, known("analog feedback fitted; without it SFB2 is refused", "assumed", "M")] = False
    expanded_memory: Annotated[bool, known("-M expanded memory fitted", "assumed", "M", acts=False)] = False


class ReplyForm(Table, frozen=True):
    """What the unit sends at one error level."""

    star: Annotated[bool, known("replies begin with *", "assumed", "L")] = True
    names: Annotated[bool, known("replies repeat axis number and command name", "assumed", "L")] = True
    error_text: Annotated[bool, known("error messages are sent", "assumed", "L")] = True
    ok_prompt: Annotated[bool, known("ERROK after a good command", "assumed", "L")] = True
    bad_prompt: Annotated[bool, known("ERRBAD after a bad command", "assumed", "L")] = True
    define_prompt: Annotated[bool, known("ERRDEF while a program is being defined", "assumed", "L")] = True


class ErrorLevels(Table, frozen=True):
    """The error levels no page describes; levels 4 and 1 are fixed (GemCR 117; PG 72 and the MX driver)."""

    level_3: Annotated[ReplyForm, known("ERRLVL3: as 4, without error text", "assumed", "L")] = msgspec.field(
        name="3", default=ReplyForm(error_text=False)
    )
    level_2: Annotated[ReplyForm, known("ERRLVL2: names, and only the ERRBAD prompt", "assumed", "L")] = msgspec.field(
        name="2", default=ReplyForm(error_text=False, ok_prompt=False, define_prompt=False)
    )
    level_0: Annotated[ReplyForm, known("ERRLVL0: requested data only, without *", "assumed", "L")] = msgspec.field(
        name="0",
        default=ReplyForm(
            star=False, names=False, error_text=False, ok_prompt=False, bad_prompt=False, define_prompt=False
        ),
    )

    def form(self, level: int) -> ReplyForm:
        """What is sent at ERRLVL `level` (0 to 4)."""
        return (self.level_0, _LEVEL_1, self.level_2, self.level_3, ReplyForm())[level]


_LEVEL_1 = ReplyForm(names=False, error_text=False, ok_prompt=False, bad_prompt=False, define_prompt=False)


LOWEST_BAUD: Final = 110
FASTEST_BAUD: Final = 921_600
"""Speeds a line can have besides instant (design choice: from a teletype to the usual adapters)."""


class InputBuffer(Table, frozen=True):
    """The command buffer behind the serial receiver, in bytes."""

    size: Annotated[int, known("capacity, bytes; acts with a line speed", "assumed", "L", ge=64)] = 2000
    xoff_at_left: Annotated[int, known("XOFF goes out when this many bytes are left", "assumed", "L", ge=0)] = 200
    xon_at_left: Annotated[int, known("XON goes out when this many bytes are free again", "assumed", "L", ge=0)] = 1000


class Serial(Table, frozen=True):
    """How commands and answers travel on the line."""

    prompt_per: Annotated[
        Literal["command", "line"],
        known("one prompt per command, or one per line of colon-separated commands", "assumed", "M"),
    ] = "command"
    empty_prompt: Annotated[
        bool, known("an empty line at ERRLVL3 and 4 draws the OK prompt", "assumed", "M", "bare CR: KB")
    ] = True
    echo_terminator: Annotated[
        Literal["eol", "received"],
        known(
            "the CR or LF that ends a command is echoed as the EOL characters, or as received",
            "host",
            source="a C host of ZETA6104 chains needs the LF",
        ),
    ] = "eol"
    error_lead: Annotated[
        Literal["crlf", "none"],
        known("what stands between BOT and the * of an error", "documented", source="GemCR 117; some hosts saw none"),
    ] = "crlf"
    max_command: Annotated[
        int, known("longest command between delimiters, characters, blanks not counted", "assumed", "L", ge=16, le=4096)
    ] = 100
    buffer: Annotated[InputBuffer, known("the command buffer", "assumed", "L")] = InputBuffer()
    go_prompt: Annotated[
        Literal["when_done", "at_once"],
        known(
            "when the prompt of GO, GOL, HOM leaves in COMEXC0: when the move is over, or at once",
            "host",
            "M",
            "several hosts wait for it; form assumed",
        ),
    ] = "when_done"
    baud: Annotated[
        int,
        known("speed of the line, 110 to 921600 baud; 0 = instant, no wire time", "design", ge=0, le=FASTEST_BAUD),
    ] = 0
    framing: Annotated[
        Literal["8N1", "8N2", "8E1", "8O1", "8E2", "8O2", "7N1", "7N2", "7E1", "7O1", "7E2", "7O2"],
        known("data bits, parity, stop bits: how long a character takes; the data pass whole", "assumed", "H"),
    ] = "8N1"
    output_buffer: Annotated[
        int,
        known("characters waiting to be sent at which no further command is taken", "assumed", "L", ge=16),
    ] = 1000
    host_obeys_xoff: Annotated[
        bool,
        known("on a timed line the host's driver keeps XON and XOFF to itself and obeys them", "design"),
    ] = False
    strict_baud: Annotated[
        bool,
        known("a host at another baud rate (RFC 2217, real serial port) reads and writes garbage", "design"),
    ] = False


class InputsOutputs(Table, frozen=True):
    """Programmable inputs and outputs; the two triggers and OUT-A, OUT-B are the next two bits of each word."""

    inputs: Annotated[Literal[24, 16, 8], known("programmable inputs", "assumed", "M")] = 24
    outputs: Annotated[Literal[24, 16, 8], known("programmable outputs", "assumed", "M")] = 24


class Range(Table, frozen=True):
    """A closed range of a command field."""

    minimum: Annotated[float, known("smallest value accepted", "assumed", "M", ge=0)]
    maximum: Annotated[float, known("largest value accepted", "assumed", "M", gt=0)]


class Limits(Table, frozen=True):
    """Field ranges on which the sources disagree."""

    accel: Annotated[
        Range, known("A AA AD ADA and their kin, rev/s2 unscaled", "assumed", "M", "GemCR 19 has 0.001 to 999.9999")
    ] = Range(minimum=0.00025, maximum=24_999_975.0)


class Paths(Table, frozen=True):
    """Contour paths."""

    radius_tolerance: Annotated[
        float,
        known(
            "counts by which the radii at both ends of an arc may differ where its path has no PRTOL",
            "assumed",
            "L",
            "as much as whole counts make them differ",
            ge=0.0,
        ),
    ] = 2.0


class Memory(Table, frozen=True):
    """User memory and its counts."""

    total_bytes: Annotated[int, known("user memory, bytes", "documented", source="UG 83", ge=2000)] = 40_000
    program_bytes: Annotated[
        int, known("program part at start, bytes", "documented", source="UG 83", ge=1000, multiple_of=2)
    ] = 21_400
    compiled_bytes: Annotated[
        int,
        known(
            "compiled-path part at start, bytes", "inferred", "H", "UG 83: the rest of 40,000", ge=1000, multiple_of=2
        ),
    ] = 18_600
    minimum_part_bytes: Annotated[
        int,
        known(
            "smallest part MEMORY accepts, bytes",
            "documented",
            source="UG 83: up to 39,000 for programs",
            ge=2,
            acts=False,
        ),
    ] = 1000
    segment_bytes: Annotated[int, known("compiled memory per segment, bytes", "assumed", "L", ge=1)] = 76
    programs: Annotated[int, known("programs", "documented", source="UG 83", ge=1)] = 100
    var: Annotated[int, known("numeric variables", "documented", source="UG 74", ge=1)] = 150
    varb: Annotated[int, known("binary variables", "documented", source="UG 74", ge=1)] = 25
    vars: Annotated[int, known("string variables", "documented", source="UG 74", ge=1)] = 25
    string_characters: Annotated[int, known("longest string, characters", "documented", source="UG 74", ge=1)] = 20
    labels: Annotated[int, known("labels", "assumed", "M", ge=1)] = 250
    compiled: Annotated[int, known("compiled programs", "assumed", "M", ge=1)] = 100
    nest_levels: Annotated[int, known("nesting of IF, loops and GOSUB", "assumed", "H", ge=1)] = 16


CommandMicroseconds = Annotated[int, msgspec.Meta(ge=0, le=60_000_000)]

REALISTIC_TIMING: Final = {"command_us": 2000, "at_updates": True}
"""The realistic preset (assumed L: no page gives the time of a command; design notes: handled at system updates)."""


class Timing(Table, frozen=True):
    """How fast the unit carries out commands and programs."""

    preset: Annotated[
        Literal["instant", "realistic"],
        known(
            "instant, or realistic: command_us 2000 and at_updates, so one command an update; other keys win",
            "assumed",
            "L",
        ),
    ] = "instant"
    commands_per_update: Annotated[
        int, known("commands a program carries out in one system update", "assumed", "L", ge=1)
    ] = 8
    command_us: Annotated[
        CommandMicroseconds, known("time a command takes before it acts and answers, us", "design")
    ] = 0
    at_updates: Annotated[bool, known("a command acts at the next system update after its time", "design")] = False
    commands: Annotated[dict[str, CommandMicroseconds], known("time of single commands, us, by name", "design")] = (
        msgspec.field(default_factory=dict)
    )


class UnitFactors(Table, frozen=True):
    """What one unit of each gain command means; 1.0 is the product family's unit."""

    sgp: Annotated[
        float, known("mV per count of position error", "assumed", "H", "6K axis configurations", gt=0, le=1e6)
    ] = 1.0
    sgi: Annotated[float, known("mV per count second", "assumed", "H", "6K axis configurations", gt=0, le=1e6)] = 1.0
    sgv: Annotated[float, known("uV per count/s", "assumed", "H", "6K axis configurations", gt=0, le=1e6)] = 1.0
    sgvf: Annotated[float, known("uV per count/s", "assumed", "H", "6K axis configurations", gt=0, le=1e6)] = 1.0
    sgaf: Annotated[float, known("uV per count/s2", "assumed", "H", "6K axis configurations", gt=0, le=1e6)] = 1.0


Microseconds = Annotated[int, msgspec.Meta(gt=0, le=1_000_000)]


class RateRow(Table, frozen=True):
    """The three periods of one SSFR value, microseconds."""

    ssfr: Literal[1, 2, 4, 8]
    servo_us: Microseconds
    trajectory_us: Microseconds
    system_us: Microseconds


def _row(ssfr: Literal[1, 2, 4, 8], servo_us: int, trajectory_us: int, system_us: int) -> RateRow:
    return RateRow(ssfr=ssfr, servo_us=servo_us, trajectory_us=trajectory_us, system_us=system_us)


class RateTable(Table, frozen=True):
    """Servo sample, trajectory update and system update for INDAX1 and INDAX2."""

    indax1: Annotated[
        tuple[RateRow, ...],
        known("periods with one axis", "documented", source="APEX 83, a one-axis unit", min_length=4, max_length=4),
    ] = (_row(1, 330, 330, 1320), _row(2, 185, 370, 1480), _row(4, 160, 640, 1920), _row(8, 150, 1200, 2400))
    indax2: Annotated[
        tuple[RateRow, ...],
        known("periods with two axes; no page survives", "assumed", "L", min_length=4, max_length=4),
    ] = (_row(1, 580, 580, 2320), _row(2, 325, 650, 1950), _row(4, 280, 1120, 2240), _row(8, 265, 2120, 2120))

    def row(self, *, indax: int, ssfr: int) -> RateRow:
        """The periods in force for `indax` axes (1 or 2) at `ssfr` (1, 2, 4 or 8)."""
        return next(row for row in (self.indax1 if indax == 1 else self.indax2) if row.ssfr == ssfr)


class Servo(Table, frozen=True):
    """The servo processor."""

    dac_bits: Annotated[int, known("resolution of the output over +-10 V, bits", "assumed", "L", ge=8, le=24)] = 16
    output_delay_us: Annotated[
        float,
        known(
            "from a servo sample to the output computed in it, us; at most one sample",
            "assumed",
            "L",
            "no page tells; 0 is the ideal loop",
            ge=0,
        ),
    ] = 0.0
    unit_factors: Annotated[UnitFactors, known("units of the gain commands", "assumed", "H")] = UnitFactors()
    ssfr_table: Annotated[RateTable, known("update periods", "assumed", "L")] = RateTable()


class Following(Table, frozen=True):
    """How a master is measured, where the guide leaves it open."""

    predictor: Annotated[
        Literal["two_samples", "one_sample"],
        known(
            "over what FPPEN1 measures the master velocity: 2 m(k) - m(k-2), or 3 m(k) - 2 m(k-1)",
            "inferred",
            "M",
            "PG 214: over 2 sample periods",
        ),
    ] = "two_samples"
    filter_order: Annotated[
        Literal[1, 2],
        known("order of the low-pass of FFILT, its corner (-3 dB) kept", "assumed", "M", "corners PG 215"),
    ] = 1


class EncoderInput(Table, frozen=True):
    """The encoder input stage, common to both axes."""

    max_rate: Annotated[
        float, known("post-quadrature counts per second; counts beyond are lost, inf = none", "assumed", "L", gt=0)
    ] = 1_600_000.0


class Encoder(Table, frozen=True):
    """The encoder of one axis."""

    counts_per_rev: Annotated[int, known("post-quadrature counts per revolution", "design", ge=1, le=100_000_000)] = (
        4000
    )
    phase: Annotated[float, known("where in a count the shaft stands at start, counts", "design", ge=0, lt=1)] = 0.0
    index_phase: Annotated[float, known("where in a revolution the Z pulse lies, rev", "design", ge=0, lt=1)] = 0.5
    counts_per_unit: Annotated[
        int,
        known(
            "counts per inch, mm or whatever a hydraulic cylinder moves in, in place of counts_per_rev; 0 = not given",
            "design",
            ge=0,
            le=100_000_000,
        ),
    ] = 0
    at: Annotated[Literal["motor", "load"], known("which end of coupling and backlash it sits on", "design")] = "motor"
    noise_counts: Annotated[
        float, known("noise of its position, counts rms, drawn anew every servo sample", "design", ge=0, le=1_000_000)
    ] = 0.0
    noise_seed: Annotated[
        int, known("which noise; the same seed gives the same run again", "design", ge=0, le=2_147_483_647)
    ] = 0

    @property
    def counts(self) -> int:
        """Counts per revolution, or per unit of a linear axis."""
        return self.counts_per_unit or self.counts_per_rev


class AnalogSensor(Table, frozen=True):
    """The position sensor at the ANI feedback input of one axis (`options.ani`); it follows the load."""

    volts_at_zero: Annotated[float, known("voltage where the load stands at start, V", "design", ge=-10, le=10)] = 0.0
    volts_per_rev: Annotated[
        float, known("what one revolution of the load adds, V", "design", ge=-1_000_000, le=1_000_000)
    ] = 1.0


class Travel(Table, frozen=True):
    """Where the switches of one axis sit, revolutions of the load from where it stands at start.

    An operated switch changes its contact over from the state `wires` gives it.
    """

    positive_limit_rev: Annotated[
        float, known("positive limit switch, operated from here on, rev; inf = none", "design")
    ] = math.inf
    negative_limit_rev: Annotated[
        float, known("negative limit switch, operated up to here, rev; -inf = none", "design")
    ] = -math.inf
    home_from_rev: Annotated[float, known("negative-side edge of the home switch, rev; inf = none", "design")] = (
        math.inf
    )
    home_to_rev: Annotated[
        float, known("positive-side edge of the home switch, rev; -inf = none", "design")
    ] = -math.inf


class AxisWires(Table, frozen=True):
    """The contacts of one axis: closed = grounded, open = pulled high."""

    positive_limit: Annotated[Contact, known("positive end-of-travel switch; bare: open", "design")] = "closed"
    negative_limit: Annotated[Contact, known("negative end-of-travel switch; bare: open", "design")] = "closed"
    home: Annotated[Contact, known("home switch", "design")] = "open"
    drive_fault: Annotated[Contact, known("drive-fault input; open (high) is inactive with DRFLVL0", "design")] = "open"


class Axis(Table, frozen=True):
    """What is connected to one axis."""

    plant: Annotated[PlantTable, known("drive, motor and load", "design")] = VelocityDrive()
    encoder: Annotated[Encoder, known("the encoder", "design")] = Encoder()
    encoder_motion: Annotated[EncoderMotionTable, known("what turns the encoder", "design")] = Shaft()
    wires: Annotated[AxisWires, known("its contacts", "design")] = AxisWires()
    travel: Annotated[Travel, known("its switches along the travel", "design")] = Travel()
    ani: Annotated[AnalogSensor, known("its analog position sensor", "design")] = AnalogSensor()
    rmc: Annotated[RmcAxis, known("what an RMC knows of it", "design")] = RmcAxis()


Volts = Annotated[float, msgspec.Meta(ge=0.0, le=2.5)]


class Trigger(Table, frozen=True):
    """What a trigger input is connected to: a contact alone, or a sensor that sees marks on an axis.

    Positions are revolutions of the load from where it stands at start, or of what else turns the encoder of the axis;
    over a mark the contact changes over.
    """

    marks_on: Annotated[
        Literal["none", "axis1", "axis2"], known("axis whose marks the trigger's sensor sees", "design")
    ] = "none"
    at_rev: Annotated[float, known("where a mark begins, rev", "design", gt=-1e9, lt=1e9)] = 0.0
    every_rev: Annotated[
        float, known("from mark to mark, either way, rev; 0 = one mark only", "design", ge=0.0, le=1e9)
    ] = 0.0
    width_rev: Annotated[float, known("width of a mark, rev", "design", gt=0.0, le=1e9)] = 0.01


class Triggers(Table, frozen=True):
    """The trigger inputs."""

    a: Annotated[Trigger, known("TRG-A", "design")] = Trigger()
    b: Annotated[Trigger, known("TRG-B", "design")] = Trigger()


class Wires(Table, frozen=True):
    """Contacts and voltages common to the unit."""

    enable: Annotated[Contact, known("ENABLE input; closed = grounded = motion allowed; bare: open", "design")] = (
        "closed"
    )
    inputs: Annotated[
        tuple[int, ...],
        known("numbers of the inputs that are closed; the triggers follow the programmable ones", "design"),
    ] = ()
    analog: Annotated[
        tuple[Volts, Volts, Volts],
        known("joystick channels 1 to 3, V; at rest in the middle", "design", source="0 to 2.5 V: UG 67"),
    ] = (1.25, 1.25, 1.25)
