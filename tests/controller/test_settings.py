"""Every setting of the groups communications, motion, servo, drive, limits and scaling, as the reference gives it.

The tables below are copied from the reference (settled, commands), not from the catalogue the program reads: default as
it is reported, lowest and highest value accepted.  A row of the catalogue that is missing here fails a test.
"""

from __future__ import annotations

from decimal import Decimal
from typing import NamedTuple

import pytest

from protocol.catalogue import CommandRow, rows
from tests.controller.session import Session

GROUPS = {"communications", "motion", "servo", "drive", "limits", "scaling"}


class Number(NamedTuple):
    """A numeric setting: each field's default as printed, its range, and a value inside that prints back as typed."""

    default: str
    low: str
    high: str
    inside: str


ACCELERATION = Number("10.0000", "0.00025", "24999975", "12.3400")
LIMIT_DECELERATION = Number("100.0000", "0.00025", "24999975", "55.5000")
SOFT_LIMIT = Number("+0", "-999999999", "999999999", "-12345")
GAIN = Number("0", "0", "2800000", "0.00000125")
FACTOR = Number("4000", "1", "999999", "250")

AXIS_NUMBERS = {
    "A": ACCELERATION,
    "AA": ACCELERATION,
    "AD": ACCELERATION,
    "ADA": ACCELERATION,
    "V": Number("1.0000", "0", "200", "2.5000"),
    "D": Number("+4000", "-999999999", "999999999", "-77"),
    "LH": Number("3", "0", "3", "1"),
    "LS": Number("0", "0", "3", "2"),
    "LHAD": LIMIT_DECELERATION,
    "LHADA": LIMIT_DECELERATION,
    "LSAD": LIMIT_DECELERATION,
    "LSADA": LIMIT_DECELERATION,
    "LSPOS": SOFT_LIMIT,
    "LSNEG": SOFT_LIMIT,
    "SCLA": FACTOR,
    "SCLV": FACTOR,
    "SCLD": FACTOR._replace(default="1"),
    "SCLMAS": FACTOR._replace(default="1"),
    "ERES": Number("4000", "1", "65535", "8192"),
    "SGP": GAIN._replace(default="0.5"),
    "SGI": GAIN,
    "SGV": GAIN,
    "SGVF": GAIN,
    "SGAF": GAIN,
    "SGILIM": Number("200", "0", "200", "7.5"),
    "SFB": Number("1", "0", "1", "0"),
    "SMPER": Number("4000", "0", "200000000", "123"),
    "SOFFS": Number("0.000", "-10", "10", "-1.250"),
    "DACLIM": Number("10.000", "0", "10", "5.125"),
    "STRGTD": Number("50", "0", "999999999", "20"),
    "STRGTV": Number("1.0000", "0", "200", "0.2500"),
    "STRGTT": Number("1000", "0", "5000", "250"),
    "SDTAMP": Number("0.000", "0", "10", "0.500"),
    "SDTFR": Number("0", "0", "99", "50"),
}

UNIT_NUMBERS = {
    # default fields, lowest and highest value of a field, fields to set
    "EOL": ("13,10,0", 0, 256, "1,2,3"),
    "EOT": ("13,0,0", 0, 256, "13,10,0"),
    "BOT": ("0,0,0", 0, 256, "4,0,0"),
    "ERRLVL": ("4", 0, 4, "4"),
    "ERROK": ("13,10,62,32", 0, 256, "13,10,62,0"),
    "ERRBAD": ("13,10,63,32", 0, 256, "13,10,33,0"),
    "ERRDEF": ("13,10,45,32", 0, 256, "13,10,58,0"),
    "ADDR": ("0", 0, 99, "9"),
    "PORT": ("1", 1, 2, "2"),
    "LOCK": ("0", 0, 2, "1"),
    "DRPCHK": ("0", 0, 3, "3"),
    "COMEXS": ("0", 0, 2, "2"),
    "INDAX": ("2", 1, 2, "1"),
    "PSCLA": ("4000", 1, 999999, "10"),
    "PSCLV": ("4000", 1, 999999, "10"),
    "PSCLD": ("1", 1, 999999, "10"),
    "SSFR": ("4", 1, 8, "2"),
}

AXIS_MASKS = ("MA", "MC", "KDRIVE", "CMDDIR", "COMEXL", "ENCPOL", "STRGTE", "DRFLVL", "DRIVE")
UNIT_MASKS = {"ECHO": "1", "E": "1", "XONOFF": "1", "COMEXC": "0", "COMEXR": "0", "COMEXK": "0", "SCALE": "0"}
LIMIT_MASKS = {"LHLVL": "0000"}

AT_REST = (
    "CMDDIR",
    "ENCPOL",
    "SCALE",
    "SCLA",
    "SCLV",
    "SCLD",
    "SCLMAS",
    "PSCLA",
    "PSCLV",
    "PSCLD",
    "ERES",
    "SFB",
    "SSFR",
)
AT_REST_TOO = ("LHLVL", "INDAX", "DRIVE")


def setting_rows() -> list[CommandRow]:
    return [row for row in rows() if row.kind == "setting" and row.group in GROUPS and row.applies_to_oem6250]


def test_every_setting_is_here() -> None:
    known = {*AXIS_NUMBERS, *UNIT_NUMBERS, *AXIS_MASKS, *UNIT_MASKS, *LIMIT_MASKS}
    assert {row.name for row in setting_rows()} == known


class TestAxisNumbers:
    @pytest.mark.parametrize("name", AXIS_NUMBERS)
    def test_default(self, name: str) -> None:
        session, default = Session(), AXIS_NUMBERS[name].default
        assert session.query(name) == f"{name}{default},{default}"
        assert session.query(f"1{name}") == f"1{name}{default}"
        assert session.query(f"2{name}") == f"2{name}{default}"

    @pytest.mark.parametrize("name", AXIS_NUMBERS)
    def test_set_and_asked(self, name: str) -> None:
        session, row = Session(), AXIS_NUMBERS[name]
        session.ok(f"2{name}{row.inside}")
        assert session.query(name) == f"{name}{row.default},{row.inside}"
        session.ok(f"{name}{row.inside},")
        assert session.query(f"1{name}") == f"1{name}{row.inside}"
        session.ok(f"!{name},{row.default.removeprefix('+')}")
        assert session.query(f"!{name}") == f"{name}{row.inside},{row.default}"
        session.ok(f"@{name}{row.inside}")
        assert session.query(name) == f"{name}{row.inside},{row.inside}"

    @pytest.mark.parametrize("name", AXIS_NUMBERS)
    def test_ends_of_the_range(self, name: str) -> None:
        session, row = Session(), AXIS_NUMBERS[name]
        session.ok(f"{name}{row.low},{row.high}")
        stored = session.query(name).removeprefix(name).split(",")
        assert Decimal(stored[1]) == Decimal(row.high)
        if Decimal(row.low) != Decimal("0.00025"):
            assert Decimal(stored[0]) == Decimal(row.low)

    @pytest.mark.parametrize("name", AXIS_NUMBERS)
    def test_beyond_the_range(self, name: str) -> None:
        """Refused with the field's number, and nothing of the line is stored."""
        session, row = Session(), AXIS_NUMBERS[name]
        before = session.query(name)
        good = row.inside
        low, high = Decimal(row.low), Decimal(row.high)
        below = "0.0001" if low == Decimal("0.00025") else str(low - 1)
        for bad in (below, str(high + 1), "9" * 40, "-" + "9" * 40):
            assert session.error(f"{name}{bad},{good}") == "INVALID DATA-FIELD 1"
            assert session.error(f"{name}{good},{bad}") == "INVALID DATA-FIELD 2"
            assert session.error(f"2{name}{bad}") == "INVALID DATA-FIELD 2"
            assert session.error(f"@{name}{bad}").startswith("INVALID DATA-FIELD")
        assert session.query(name) == before

    @pytest.mark.parametrize("name", AXIS_NUMBERS)
    def test_axes_the_unit_has_not(self, name: str) -> None:
        session, row = Session(), AXIS_NUMBERS[name]
        before = session.query(name)
        for text in (f"3{name}", f"0{name}", f"9{name}{row.inside}", f"{name}{row.inside},{row.inside},{row.inside}"):
            assert session.error(text) == "INCORRECT AXIS"
        session.ok(f"{name}{row.default},{row.default},,,,,,")
        assert session.query(name) == before

    @pytest.mark.parametrize("name", AXIS_NUMBERS)
    def test_malformed(self, name: str) -> None:
        """Not a number: the unit's error, and nothing is stored."""
        session = Session()
        before = session.query(name)
        for field in ("1.2.3", "1E3", "--1", "1-", "1$2", ",,x"):
            assert session.ask(f"{name}{field}").startswith("\r\n*"), field
        assert session.query(name) == before

    @pytest.mark.parametrize("name", [name for name in AXIS_NUMBERS if "." in AXIS_NUMBERS[name].default])
    def test_truncated_not_rounded(self, name: str) -> None:
        if name == "SGP":
            return
        session = Session()
        places = len(AXIS_NUMBERS[name].default.partition(".")[2])
        session.ok(f"1{name}1.{'9' * 9}")
        assert session.query(f"1{name}") == f"1{name}1.{'9' * places}"

    def test_c_style_numbers(self) -> None:
        session = Session()
        session.ok("1V5.000000", "1D25000.000000", "1SGP10.000000", "LH3.000000,0")
        assert session.query("1V") == "1V5.0000"
        assert session.query("1D") == "1D+25000"
        assert session.query("1SGP") == "1SGP10"
        assert session.query("LH") == "LH3,0"


class TestUnitNumbers:
    @pytest.mark.parametrize("name", UNIT_NUMBERS)
    def test_default(self, name: str) -> None:
        assert Session().query(name) == f"{name}{UNIT_NUMBERS[name][0]}"

    @pytest.mark.parametrize("name", UNIT_NUMBERS)
    def test_set_and_asked(self, name: str) -> None:
        fields = UNIT_NUMBERS[name][3]
        session = Session()
        session.ask(f"{name}{fields}")
        assert f"*{name}{fields}" in session.ask(name)

    @pytest.mark.parametrize("name", UNIT_NUMBERS)
    def test_beyond_the_range(self, name: str) -> None:
        default, low, high, _ = UNIT_NUMBERS[name]
        count = default.count(",") + 1
        session = Session()
        for bad in (low - 1, high + 1, 10**30):
            for field in range(count):
                fields = "," * field + str(bad)
                text = "INVALID DATA" if count == 1 else f"INVALID DATA-FIELD {field + 1}"
                assert session.error(name + fields) == text
        assert session.query(name) == f"{name}{default}"

    @pytest.mark.parametrize("name", UNIT_NUMBERS)
    def test_surplus_fields(self, name: str) -> None:
        session = Session()
        default = UNIT_NUMBERS[name][0]
        assert session.ask(f"{name}{default},1").startswith("\r\n*INCORRECT DATA")
        assert session.query(name) == f"{name}{default}"

    def test_empty_fields_stay(self) -> None:
        session = Session()
        session.ok("ERRBAD,,33")
        assert session.query("ERRBAD") == "ERRBAD13,10,33,32"

    @pytest.mark.parametrize("value", [0, 3, 5, 6, 7, 9])
    def test_ssfr_has_four_values(self, value: int) -> None:
        session = Session()
        assert session.error(f"SSFR{value}") == "INVALID DATA"
        assert session.query("SSFR") == "SSFR4"

    def test_analogue_feedback_is_an_option(self) -> None:
        assert Session().error("SFB1,2") == "INVALID DATA-FIELD 2"


class TestMasks:
    @pytest.mark.parametrize("name", [name for name in AXIS_MASKS if name != "DRIVE"])
    def test_axis_masks(self, name: str) -> None:
        session = Session()
        assert session.query(name) == f"{name}00"
        session.ok(f"{name}X1")
        assert session.query(name) == f"{name}01"
        session.ok(f"1{name}1", f"2{name}0")
        assert session.query(f"1{name}") == f"1{name}1"
        assert session.query(f"2{name}") == f"2{name}0"
        session.ok(f"@{name}0")
        session.ok(f"!{name}1,1")
        assert session.query(name) == f"{name}11"

    @pytest.mark.parametrize("name", AXIS_MASKS)
    def test_surplus_digits(self, name: str) -> None:
        """Hosts send eight digits to every unit: surplus 0 and X are ignored, a surplus 1 is refused."""
        session = Session()
        session.ok(f"{name}00XXXXXX", f"{name}00000000")
        assert session.error(f"{name}11000001") == "INCORRECT AXIS"
        assert session.error(f"3{name}1") == "INCORRECT AXIS"
        assert session.query(name) == f"{name}00"

    @pytest.mark.parametrize(("name", "default"), [*UNIT_MASKS.items()])
    def test_unit_masks(self, name: str, default: str) -> None:
        session = Session()
        if name != "ECHO":
            assert session.query(name) == f"{name}{default}"
        session.ask(f"{name}1")
        assert f"*{name}1" in session.ask(name)
        assert session.ask(f"{name}2").find("*") >= 0

    def test_limit_levels(self) -> None:
        session = Session()
        assert session.query("LHLVL") == "LHLVL0000"
        session.ok("LHLVLX1X1")
        assert session.query("LHLVL") == "LHLVL0101"
        assert session.error("LHLVL00001") == "INCORRECT DATA"

    def test_drive(self) -> None:
        session = Session()
        session.ok("DRIVE01")
        assert session.query("DRIVE") == "DRIVE01"
        session.ok("@DRIVE1", "1DRIVE0")
        assert session.query("DRIVE") == "DRIVE01"
        assert session.query("2DRIVE") == "2DRIVE1"


class TestAtRest:
    """Commands that need the axes at rest answer MOTION IN PROGRESS and change nothing."""

    @pytest.mark.parametrize("name", [*AT_REST, *AT_REST_TOO])
    def test_refused_in_motion(self, name: str) -> None:
        session = Session()
        session.ok("DRIVE11", "COMEXC1", "GO1")
        session.advance(0.3)
        before = session.query(name)
        value = {"SFB": "0", "SSFR": "2", "INDAX": "1", "DRIVE": "0"}.get(name, "1")
        assert session.error(f"{name}{value}") == "MOTION IN PROGRESS"
        assert session.query(name) == before
        session.until_rest()
        session.ok(f"{name}{value}")

    @pytest.mark.parametrize("name", ["ERES", "SCLD", "SFB", "ENCPOL"])
    def test_the_axis_at_rest_is_free(self, name: str) -> None:
        session = Session()
        session.ok("DRIVE10", "COMEXC1", "GO1")
        session.advance(0.3)
        session.ok(f"2{name}1")
        assert session.error(f"1{name}1") == "MOTION IN PROGRESS"

    @pytest.mark.parametrize("name", ["A", "V", "D", "SGP", "LHAD", "SMPER", "MA", "KDRIVE", "LH"])
    def test_the_rest_may_change_in_motion(self, name: str) -> None:
        session = Session()
        session.ok("DRIVE11", "COMEXC1", "GO1")
        session.advance(0.3)
        session.ok(f"{name}1")

    def test_pset(self) -> None:
        session = Session()
        session.ok("DRIVE11", "COMEXC1", "GO1")
        session.advance(0.3)
        assert session.error("PSET0,0") == "MOTION IN PROGRESS"
        session.ok("2PSET5")


class TestFollowing:
    """AA follows A, AD follows A, ADA follows AD, each until entered; 0 returns it (settled, section 7)."""

    def test_until_entered(self) -> None:
        session = Session()
        session.ok("1A20")
        assert [session.query(f"1{name}") for name in ("AA", "AD", "ADA")] == [
            "1AA20.0000",
            "1AD20.0000",
            "1ADA20.0000",
        ]
        session.ok("1AD5")
        assert session.query("1ADA") == "1ADA5.0000"
        session.ok("1A30")
        assert session.query("1AD") == "1AD5.0000"
        session.ok("1AA25", "1A40")
        assert session.query("1AA") == "1AA25.0000"

    def test_zero_returns_it(self) -> None:
        session = Session()
        session.ok("AD5,5", "A20,20", "AD0")
        assert session.query("AD") == "AD20.0000,5.0000", "the value in force, never 0"

    def test_the_deceleration_copies_the_ramp(self) -> None:
        session = Session()
        session.ok("1A20", "1AA12")
        assert session.query("1ADA") == "1ADA12.0000"

    def test_limit_ramps(self) -> None:
        session = Session()
        session.ok("1LHAD50")
        assert session.query("1LHADA") == "1LHADA50.0000"


class TestOneAxis:
    """INDAX1: reports shorten, the second axis is not there."""

    def test_reports(self) -> None:
        session = Session()
        session.ok("INDAX1")
        assert session.query("V") == "V1.0000"
        assert session.query("TPE") == "TPE+0"
        assert session.query("DRIVE") == "DRIVE0"
        assert session.query("TLIM") == "TLIM110"
        for text in ("2V", "V,5", "DRIVE01", "2TPE", "GO01"):
            assert session.error(text) == "INCORRECT AXIS"
        session.ok("INDAX2")
        assert session.query("V") == "V1.0000,1.0000"

    def test_plus_sign_one_host_insists_on(self) -> None:
        session = Session(INDAX=1)
        session.ok("D+1000")
        assert session.query("D") == "D+1000"


OTHER_PRODUCTS = {
    "FMAXA": "COMMAND NOT IMPLEMENTED",
    "OUTPC": "INCORRECT AXIS",
    "REGD": "INCORRECT AXIS",
    "POUTC": "INCORRECT AXIS",
}
LATER_FAMILIES = ("FVMFRQ100", "OPTEN1", "BAUD9600")


class TestNotThere:
    @pytest.mark.parametrize("name", OTHER_PRODUCTS)
    def test_other_products(self, name: str) -> None:
        assert Session().error(f"{name}1") == OTHER_PRODUCTS[name]

    @pytest.mark.parametrize("text", LATER_FAMILIES)
    def test_later_families(self, text: str) -> None:
        assert Session().error(text) == "UNDEFINED LABEL"
