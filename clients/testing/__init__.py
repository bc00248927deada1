"""Tests of host programs without hardware and without waiting.

    from clients.testing import emulated

    with emulated() as emu:
        emu.client.send("DRIVE1")
        emu.advance(2.5)

Under pytest the same comes as fixtures (``clients.pytest_plugin``).  This package and the plugin are the one place in
``clients`` that starts an emulator; nothing of it is imported before it is used, because pytest loads the plugin in
every project it is installed beside.  docs/testing.md is the guide.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from clients.testing.behind_ports import Served, served
    from clients.testing.errors import NotReached
    from clients.testing.in_process import Emulated, emulated
    from clients.testing.rmc import EmulatedRmc
    from clients.testing.unittests import EmulatedMixin
    from clients.testing.virtual_line import VirtualLine

__all__ = ["Emulated", "EmulatedMixin", "EmulatedRmc", "NotReached", "Served", "VirtualLine", "emulated", "served"]

_HOME_OF = {
    "Emulated": "clients.testing.in_process",
    "EmulatedMixin": "clients.testing.unittests",
    "EmulatedRmc": "clients.testing.rmc",
    "NotReached": "clients.testing.errors",
    "Served": "clients.testing.behind_ports",
    "VirtualLine": "clients.testing.virtual_line",
    "emulated": "clients.testing.in_process",
    "served": "clients.testing.behind_ports",
}


def __getattr__(name: str) -> Any:
    """Import the module that holds a name the first time it is asked for."""
    if name not in _HOME_OF:
        raise AttributeError(f"module 'clients.testing' has no attribute {name!r}")
    import importlib

    value = getattr(importlib.import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value
