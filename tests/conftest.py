"""Settings for the whole suite: `slow` tests run only when asked for."""

from __future__ import annotations

from importlib.metadata import entry_points

import pytest
from hypothesis import settings

_INSTALLED = any(point.value == "clients.pytest_plugin" for point in entry_points(group="pytest11"))
pytest_plugins = ["pytester"] if _INSTALLED else ["pytester", "clients.pytest_plugin"]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--runslow", action="store_true", help="run the soak and fuzz tests as well (minutes)")


def pytest_configure(config: pytest.Config) -> None:
    """Properties that ask for no number of examples get a third of hypothesis's own in the default run."""
    settings.register_profile("default run", max_examples=35)
    if not config.getoption("--runslow"):
        settings.load_profile("default run")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect what is marked slow, unless --runslow or a -m expression asks for it."""
    if config.getoption("--runslow") or "slow" in config.getoption("-m"):
        return
    slow = [item for item in items if item.get_closest_marker("slow")]
    if slow:
        config.hook.pytest_deselected(items=slow)
        items[:] = [item for item in items if not item.get_closest_marker("slow")]
