"""The RMC: what a loop of an axis costs beside a sample of the OEM6250's, and register reads beside bare pymodbus."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from pymodbus.client import ModbusTcpClient

from emulator.machine import Machine
from emulator.rmc.device import RmcDevice
from tests.bench import kernel
from tests.bench.figures import Effort, Figure, Reach, Reference

NS_PER_S = 1_000_000_000
AXES = 2
MODES = {"Position PID": 0, "Position I-PD": 1, "Velocity PID": 4, "Velocity I-PD": 5}
WORDS = 20
STATUS = 4096
START_PATIENCE_S = 180.0

MACHINE = """
[rmc]
axes = 2
enabled_at_start = true
[axis1.rmc.parameters]
PosScale = 0.00025
VelocityFF = 1.0
PositionErrorTolerance = 1e6
VelocityErrorTolerance = 1e6
[axis2.rmc.parameters]
PosScale = 0.00025
VelocityFF = 1.0
PositionErrorTolerance = 1e6
VelocityErrorTolerance = 1e6
"""

BARE_SERVER = f"""
import asyncio, socket
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

async def main():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    device = SimDevice(0, [SimData({STATUS}, count=200, datatype=DataType.REGISTERS)])
    server = ModbusTcpServer(device, address=("127.0.0.1", port))
    await server.serve_forever(background=True)
    print(port, flush=True)
    await asyncio.Event().wait()

asyncio.run(main())
"""


def measure(effort: Effort) -> list[Figure]:
    """Processor nanoseconds per axis and loop in each mode, and reads a second."""
    return [*(_loops(effort, name, code) for name, code in MODES.items()), _reads(effort)]


def _loops(effort: Effort, name: str, code: int) -> Figure:
    """Both axes at constant velocity, every filter at its default, against two OEM6250 axes moving."""
    device, engine = moving(code), kernel.closed_loop(moving=True)
    span_ns = int(effort.of(10, 60) * NS_PER_S)
    own, other = [], []
    for _ in range(effort.times(5, 15)):
        began_ns = time.process_time_ns()
        device.advance(device.now_ns + span_ns)
        own.append((time.process_time_ns() - began_ns) * device.loop_ns / (AXES * span_ns))
        other.append(kernel.cpu_ns_of(engine, span_ns) * engine.rates.servo_ns / (AXES * span_ns))
    if any(axis.integer("errors") for axis in device.axes):
        raise RuntimeError(f"{name}: an axis has stopped: not what was to be measured")
    return Figure(
        name=f"RMC loop, {name}",
        unit="ns/axis-loop",
        samples=own,
        reference=Reference(name="OEM6250 axis-sample, moving", samples=other),
        reach=Reach(bound=3, of="ratio"),
    )


def moving(code: int) -> RmcDevice:
    """Both axes running at a constant velocity in a control mode."""
    device = RmcDevice(Machine.parse(MACHINE))
    for axis in range(AXES):
        device.execute({axis: [68.0, float(code)]})
        device.execute({axis: [37.0, 2.0, 10.0, 10.0, 4.0]})
    device.advance(NS_PER_S)
    return device


def _reads(effort: Effort) -> Figure:
    with ExitStack() as stack:
        own_port = stack.enter_context(emulator_port())
        bare_port = stack.enter_context(bare_server_port())
        clients = [ModbusTcpClient("127.0.0.1", port=port) for port in (own_port, bare_port)]
        for client in clients:
            client.connect()
            stack.callback(client.close)
        count = round(effort.of(300, 2000))
        pairs = [[reads_per_s(client, count) for client in clients] for _ in range(effort.times(5, 15))]
    return Figure(
        name=f"Modbus reads of {WORDS} words, one master",
        unit="1/s",
        samples=[pair[0] for pair in pairs],
        reference=Reference(name="bare pymodbus server", samples=[pair[1] for pair in pairs]),
        reach=Reach(bound=0.5, of="ratio", at_least=True),
    )


def reads_per_s(client: ModbusTcpClient, count: int) -> float:
    """How many reads one after another a second takes."""
    began = time.perf_counter()
    for _ in range(count):
        if client.read_holding_registers(STATUS, count=WORDS, device_id=0).isError():
            raise RuntimeError("a read was refused")
    return count / (time.perf_counter() - began)


@contextmanager
def emulator_port() -> Iterator[int]:
    """An RMC151 in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        announce = Path(folder) / "announce"
        options = ["--device", "rmc151", "--modbus", "127.0.0.1:0", "--announce", str(announce)]
        process = subprocess.Popen([sys.executable, "-m", "emulator", "serve", *options], stderr=subprocess.DEVNULL)
        try:
            until = time.monotonic() + START_PATIENCE_S
            while not announce.exists() and process.poll() is None and time.monotonic() < until:
                time.sleep(0.05)  # another process writes the file
            yield int(json.loads(announce.read_text())["modbus"][0].rpartition(":")[2])
        finally:
            process.terminate()
            process.wait()


@contextmanager
def bare_server_port() -> Iterator[int]:
    """pymodbus's own server with its own registers, in a process of its own."""
    process = subprocess.Popen([sys.executable, "-c", BARE_SERVER], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        yield int(process.stdout.readline())
    finally:
        process.kill()
        process.communicate()
