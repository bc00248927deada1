"""User units: how many decimals, how far, how fast, and what truncation costs."""

from __future__ import annotations

import pytest

from tests.controller.session import Session


class TestScaling:
    """Vectors of the 6250 guide p.47 and the resolution tables (following-and-profiles 5.5)."""

    @staticmethod
    def scaled(*commands: str) -> Session:
        session = Session()
        session.ok("SCALE1", *commands)
        return session

    @pytest.mark.parametrize(
        ("factor", "typed", "printed"),
        [
            ("SCLV10", "1V9.9999", "1V9.9"),
            ("SCLA10", "1A9.9999", "1A9.9"),
            ("SCLD4000", "1D105.2776", "1D+105.277"),
            ("SCLD25000", "1D1.99999", "1D+1.9999"),
            ("SCLD9", "1D12.9", "1D+12"),
            ("SCLD10", "1D-12.99", "1D-12.9"),
            ("SCLD999999", "1D1.123456", "1D+1.12345"),
            ("SCLV999", "1V1.239", "1V1.23"),
            ("SCLD100", "1SMPER2.559", "1SMPER2.55"),
            ("SCLD1000", "1STRGTD0.1239", "1STRGTD0.123"),
            ("SCLD4000", "1LSPOS1.5", "1LSPOS+1.500"),
        ],
    )
    def test_truncated_to_the_decade(self, factor: str, typed: str, printed: str) -> None:
        session = self.scaled(factor)
        session.ok(typed)
        name = printed.rstrip("0123456789.+-")
        assert session.query(name) == printed

    @pytest.mark.parametrize(
        ("factor", "highest", "beyond"),
        [
            (1, "999999999", "1000000000"),
            (10, "99999999.9", "100000000.0"),
            (100, "9999999.99", "10000000.00"),
            (4000, "999999.999", "1000000.000"),
            (10000, "99999.9999", "100000.0000"),
            (999999, "9999.99999", "10000.00000"),
        ],
    )
    def test_distance_range(self, factor: int, highest: str, beyond: str) -> None:
        session = self.scaled(f"SCLD{factor}")
        session.ok(f"1D{highest}", f"1D-{highest}")
        assert session.error(f"1D{beyond}") == "INVALID DATA-FIELD 1"
        assert session.query("1D") == f"1D-{highest}"

    def test_velocity_cap(self) -> None:
        """200 rev/s: 200 x ERES / SCLV."""
        session = self.scaled("SCLV8000,4000")
        session.ok("V100,200")
        assert session.error("V101") == "INVALID DATA-FIELD 1"
        assert session.error("V,201") == "INVALID DATA-FIELD 2"

    def test_distance_in_user_units(self) -> None:
        """SCLD10000, D75: 750,000 counts."""
        session = self.scaled("SCLD10000", "SCLV4000", "SCLA4000", "DRIVE1", "SMPER0", "A500", "V100", "D75")
        session.ok("GO1", wait_s=3)
        assert session.signal("axis1.position.commanded") == 750_000
        assert session.query("1TPC") == "1TPC+75.0000"

    def test_fraction_of_a_count_is_lost_in_each_incremental_move(self) -> None:
        session = self.scaled("SCLD3", "DRIVE1", "V5", "A100")
        session.ok("SCALE0", "SCALE1", "SCLD15", "D.1")
        for _ in range(3):
            session.ok("GO1", wait_s=0.2)
        assert session.signal("axis1.position.commanded") == 3, "0.1 x 15 = 1.5 counts: one each time"

    def test_off_again(self) -> None:
        session = self.scaled("SCLD4000", "D2")
        session.ok("SCALE0")
        assert session.query("1D") == "1D+8000"

    def test_readings(self) -> None:
        session = self.scaled("SCLD4000", "DRIVE1")
        session.ok("PSET1.5")
        assert session.query("1TPC") == "1TPC+1.500"
        assert session.query("TPER") == "TPER+0.000,+0"
