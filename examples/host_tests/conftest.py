"""Where the tests run: on the emulator in this process, or with `--real PORT` on a machine.

This is a project's own business rather than the plugin's, because only the project knows what has to be done to a
machine before a test and after it.
"""

from collections.abc import Iterator

import pytest
from gantry import Gantry

from clients import OEM6250


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--real", metavar="PORT", help="run on the controller at this port; IT WILL MOVE")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Tests that break something are for the emulator alone."""
    if config.getoption("real"):
        for item in items:
            # Meant: what only the emulator can do, such as opening a limit, cannot be asked of hardware.
            if "oem6250" in getattr(item, "fixturenames", ()):
                item.add_marker(pytest.mark.skip(reason="needs the emulator"))


@pytest.fixture
def ctl(request: pytest.FixtureRequest) -> Iterator[OEM6250]:
    """A connected controller."""
    port = request.config.getoption("real")
    if port is None:
        yield request.getfixturevalue("oem6250").client
        return
    with OEM6250.open(port) as real:
        yield real


@pytest.fixture
def gantry(ctl: OEM6250) -> Iterator[Gantry]:
    """The machine, switched on; switched off again whatever the test does."""
    machine = Gantry(ctl)
    machine.switch_on()
    yield machine
    machine.switch_off()
