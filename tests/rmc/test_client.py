"""The client, on an emulated RMC151 in virtual time."""

from __future__ import annotations

import pytest

from clients import RmcFault, RmcLost, RmcRefused, RmcTimeout
from clients.testing import EmulatedRmc
from protocol.rmc.bits import ControlMode, ErrorBits, StatusBits
from protocol.rmc.maps import Place

MACHINE = """
[rmc]
axes = 3
[axis1]
plant = { preset = "documented_cylinder" }
encoder = { counts_per_unit = 10_000 }
[axis1.rmc.parameters]
PosScale = 0.0001
ProportionalGain = 50.0
VelocityFF = 3.33
VelocityFFNegative = 4.35
PositionErrorTolerance = 1.0
[axis2.rmc]
simulate = "first_order"
[axis2.rmc.parameters]
PosScale = 0.0001
ProportionalGain = 50.0
VelocityFF = 10.0
NaturalFrequency = 0.01
PositionErrorTolerance = 1.0
[axis3.rmc]
simulate = "first_order"
[axis3.rmc.parameters]
PosScale = 0.0001
ProportionalGain = 50.0
VelocityFF = 10.0
NaturalFrequency = 0.01
PositionErrorTolerance = 1.0
"""

pytestmark = pytest.mark.rmc151(machine=MACHINE)


def test_a_move_from_enabling_to_in_position(rmc151: EmulatedRmc) -> None:
    axis = rmc151.axis[0]
    axis.enable()
    axis.move_absolute(10.0, speed=5.0, accel=50.0)
    axis.wait_in_position()
    assert axis.position == pytest.approx(10.0, abs=0.05)
    assert 2.1 < rmc151.now_s < 3.0, "0.1 s up, 1.9 s along, 0.1 s down"
    assert axis.mode == ControlMode.POSITION_PID
    assert axis.errors == ErrorBits(0)
    assert rmc151.device.true_position(0) == pytest.approx(10.0, abs=0.05)


def test_registers_by_tag(rmc151: EmulatedRmc) -> None:
    axis = rmc151.axis[1]
    axis.write("ProportionalGain", 12.5)
    assert axis.read("ProportionalGain") == 12.5
    assert axis.read("PosScale") == pytest.approx(0.0001)
    with pytest.raises(KeyError):
        axis.read("ProportinalGain")
    with pytest.raises(RmcRefused, match="exception 2"):
        axis.write("ActPos", 1.0)


def test_handshake(rmc151: EmulatedRmc) -> None:
    axis = rmc151.axis[0]
    axis.acknowledged("enable_axis", enable=1)
    assert axis.status & StatusBits.ACKNOWLEDGE
    axis.acknowledged("clear_faults")
    assert not axis.status & StatusBits.ACKNOWLEDGE
    axis.acknowledged("no_op")
    other = rmc151.connect()
    assert axis.status & StatusBits.ACKNOWLEDGE
    assert not other.axis[0].status & StatusBits.ACKNOWLEDGE, "each master has its own"
    rmc151.client.write(Place(40, 0), 0.0)
    assert not axis.status & StatusBits.ACKNOWLEDGE, "0.0 resets it"


def test_axes_of_one_write_start_at_one_loop(rmc151: EmulatedRmc) -> None:
    for axis in rmc151.axis:
        axis.enable()
    with rmc151.client.together():
        rmc151.axis[0].move_absolute(1.0, speed=5.0, accel=50.0)
        rmc151.axis[2].move_absolute(1.0, speed=5.0, accel=50.0)
    targets = [float(axis.read("TarPos")) for axis in rmc151.axis]
    assert [rmc151.device.axes[index]["target_position"] for index in (0, 2)] == pytest.approx(
        [targets[2]] * 2, abs=0.1
    )
    assert rmc151.device.axes[0]["generator_loops"] == rmc151.device.axes[2]["generator_loops"] > 0
    assert targets[1] == 0.0, "the one between is skipped"


def test_waiting_for_a_halted_axis_fails_at_once(rmc151: EmulatedRmc) -> None:
    axis = rmc151.axis[0]
    axis.enable()
    axis.move_velocity(1.0, accel=10.0)
    axis.command("direct_output_halt")
    with pytest.raises(RmcFault, match="halted"):
        axis.wait_in_position()


def test_waiting_ends(rmc151: EmulatedRmc) -> None:
    began = rmc151.now_s
    with pytest.raises(RmcTimeout, match="IN_POSITION within 2 s"):
        rmc151.axis[0].wait_in_position(timeout_s=2.0)
    assert rmc151.now_s == pytest.approx(began + 2.0, abs=0.01)


def test_velocity_control(rmc151: EmulatedRmc) -> None:
    axis = rmc151.axis[1]
    axis.enable()
    axis.set_mode(4)
    axis.write("VelocityErrorTolerance", 100.0)
    axis.write("ProportionalGain", 0.1)
    axis.move_velocity(3.0, accel=10.0)
    axis.wait_at_velocity()
    assert axis.mode == ControlMode.VELOCITY_PID
    assert axis.velocity == pytest.approx(3.0, abs=0.1)


def test_unknown_parameters_are_named(rmc151: EmulatedRmc) -> None:
    with pytest.raises(ValueError, match="no parameter sped; it has position, speed"):
        rmc151.axis[0].command("move_absolute", sped=1.0)


def test_variables(rmc151: EmulatedRmc) -> None:
    rmc151.client.set_variable(286, 2.5)
    assert rmc151.client.variable(286) == 2.5
    assert rmc151.client.read(Place(57, 30)) == 2.5, "256 + 30"
    with pytest.raises(ValueError, match="0 to 1023"):
        rmc151.client.variable(1024)


def test_a_closed_connection_says_so(rmc151: EmulatedRmc) -> None:
    rmc151.client.close()
    with pytest.raises(RmcLost):
        rmc151.axis[0].read("ActPos")


def test_through_a_port_of_its_own(rmc151: EmulatedRmc) -> None:
    from clients import RMC

    host, port = rmc151.serve(request_s=0.05)
    with RMC(host, port, axes=3) as rmc:
        rmc.axis[1].enable()
        rmc.axis[1].move_absolute(2.0, speed=5.0, accel=50.0)
        rmc.axis[1].wait_done()
        assert rmc.axis[1].read("TarPos") == 2.0


def test_no_controller_there() -> None:
    import socket

    from clients import RMC

    with socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))
        port = closed.getsockname()[1]
    with pytest.raises(RmcLost, match="no connection"):
        RMC("127.0.0.1", port)
