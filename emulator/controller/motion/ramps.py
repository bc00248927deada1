"""Ramps that follow another until they are entered: deceleration follows acceleration, averages follow their maximum.

``AD`` follows ``A`` until entered; ``AA`` follows ``A``; ``ADA`` copies ``AA`` while neither ``AD`` nor ``ADA`` was
entered, after that it follows ``AD`` (assumed H/M; AD from the Gemini Programmer's Reference).  Entering 0 returns a
ramp to following.  The other families of the language (homing, jog, joystick, limits, path) have the same partners.
"""

from __future__ import annotations

from collections.abc import Callable

FAMILIES = ("", "HOM", "JOG", "JOY", "P")

FOLLOWED: dict[str, str] = {"LHADA": "LHAD", "LSADA": "LSAD"}
"""A ramp and what it follows while it has not been entered."""

for _family in FAMILIES:
    FOLLOWED[f"{_family}AA"] = f"{_family}A"
    FOLLOWED[f"{_family}AD"] = f"{_family}A"
    FOLLOWED[f"{_family}ADA"] = f"{_family}AD"


def followed_setting(name: str, entered: Callable[[str], bool]) -> str:
    """The setting whose value is in force for ``name``; ``entered`` tells which ramps the host has given."""
    while name in FOLLOWED and not entered(name):
        partner = FOLLOWED[name]
        if name.endswith("ADA") and partner in FOLLOWED and not entered(partner):
            partner = f"{name.removesuffix('ADA')}AA"
        name = partner
    return name
