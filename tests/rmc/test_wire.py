"""The registers over TCP: raw frames, pymodbus, and a master nobody here wrote (pyModbusTCP; mbpoll where it is)."""

from __future__ import annotations

import shutil
import socket
import struct
import subprocess
from collections.abc import Iterator

import pytest
from pymodbus.client import ModbusTcpClient

from clients.testing import EmulatedRmc
from protocol.rmc.bits import ErrorBits, StatusBits
from protocol.rmc.words import bits_of, from_words, reals, to_words, value_of
from tests.rmc.test_vectors import FRAME

MACHINE = """
[rmc]
axes = 2
enabled_at_start = true
[axis1.rmc]
simulate = "first_order"
[axis1.rmc.parameters]
PosScale = 0.001
ProportionalGain = 20.0
VelocityFF = 10.0
NaturalFrequency = 0.01
PositionErrorTolerance = 2.0
"""

STATUS, ERRORS, COMMANDS, PARAMETERS, VARIABLES = 4096, 4098, 20480, 12288, 28672


class Raw:
    """Frames on a socket."""

    def __init__(self, address: tuple[str, int]) -> None:
        self.sock = socket.create_connection(address, timeout=10.0)

    def ask(self, frame: bytes) -> bytes:
        self.sock.sendall(frame)
        return self.answer()

    def answer(self) -> bytes:
        """The next answer without its header's first six bytes."""
        head = self._exactly(6)
        return self._exactly(struct.unpack(">HHH", head)[2])

    def _exactly(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            more = self.sock.recv(count - len(data))
            assert more, "the connection was closed"
            data += more
        return data


def frame(function: int, body: bytes, *, transaction: int = 1, unit: int = 0) -> bytes:
    return struct.pack(">HHHBB", transaction, 0, len(body) + 2, unit, function) + body


@pytest.fixture
def served() -> Iterator[tuple[str, int]]:
    """A device of two axes behind a port; each request takes a millisecond of virtual time."""
    with EmulatedRmc(MACHINE) as emu:
        yield emu.serve()


@pytest.fixture
def raw(served: tuple[str, int]) -> Iterator[Raw]:
    host = Raw(served)
    yield host
    host.sock.close()


@pytest.fixture
def master(served: tuple[str, int]) -> Iterator[ModbusTcpClient]:
    client = ModbusTcpClient(served[0], port=served[1])
    assert client.connect()
    yield client
    client.close()


def status(master: ModbusTcpClient, axis: int = 0) -> StatusBits:
    return StatusBits(from_words(master.read_holding_registers(STATUS + 512 * axis, count=2).registers)[0])


def errors(master: ModbusTcpClient, axis: int = 0) -> ErrorBits:
    return ErrorBits(from_words(master.read_holding_registers(ERRORS + 512 * axis, count=2).registers)[0])


def test_the_frame_of_a_move_moves(raw: Raw) -> None:
    assert raw.ask(bytes.fromhex(FRAME)) == bytes.fromhex("00 10 50 00 00 0c")
    poll = bytes.fromhex("00 02 00 00 00 06 00 03 10 00 00 02")
    answer = raw.ask(poll)
    assert answer[:3] == bytes.fromhex("00 03 04")
    low, high = struct.unpack(">HH", answer[3:])
    assert high & 0x8000, "ACK is the top bit of the high word"
    assert not low & StatusBits.TARGET_DONE
    while not struct.unpack(">HH", raw.ask(poll)[3:])[0] & StatusBits.TARGET_DONE:
        pass
    target = raw.ask(frame(3, struct.pack(">HH", 4202, 2)))[3:]
    assert value_of(from_words(struct.unpack(">HH", target))[0]) == 10.0


def test_the_duplicate_area_and_the_other_one_are_the_same(raw: Raw) -> None:
    data = bytearray.fromhex(FRAME)
    data[8:10] = b"\x04\x00"
    assert raw.ask(bytes(data)) == bytes.fromhex("00 10 04 00 00 0c")
    command_position = raw.ask(frame(3, struct.pack(">HH", 4208, 2)))[3:]
    assert value_of(from_words(struct.unpack(">HH", command_position))[0]) == 10.0


@pytest.mark.parametrize("function", [3, 4])
def test_both_reads_see_the_same_space(raw: Raw, function: int) -> None:
    answer = raw.ask(frame(function, struct.pack(">HH", PARAMETERS, 2)))
    assert value_of(from_words(struct.unpack(">HH", answer[3:]))[0]) == pytest.approx(0.001)


def test_read_write_in_one(raw: Raw) -> None:
    body = struct.pack(">HHHHB", VARIABLES, 2, VARIABLES, 2, 4) + struct.pack(">HH", 0x1EB8, 0x4055)
    assert raw.ask(frame(23, body)) == bytes.fromhex("00 17 04 1e b8 40 55")


def test_diagnostics_echo(raw: Raw) -> None:
    assert raw.ask(frame(8, bytes.fromhex("00 00 12 34"))) == bytes.fromhex("00 08 00 00 12 34")


@pytest.mark.parametrize("unit", [0, 1, 17, 255])
def test_any_unit_id_is_this_device(raw: Raw, unit: int) -> None:
    answer = raw.ask(frame(3, struct.pack(">HH", STATUS, 2), unit=unit))
    assert answer[:2] == bytes([unit, 3])


@pytest.mark.parametrize("function", [1, 2, 5, 15, 22, 20, 99])
def test_other_functions_are_refused(raw: Raw, function: int) -> None:
    bodies = {15: bytes.fromhex("00 00 00 01 01 01"), 22: bytes(6)}
    answer = raw.ask(frame(function, bodies.get(function, bytes.fromhex("00 00 00 01"))))
    assert answer == bytes([0, function | 0x80, 1])


def test_requests_sent_without_waiting_are_all_answered_in_order(raw: Raw) -> None:
    frames = [frame(3, struct.pack(">HH", VARIABLES + 2 * n, 1 + n), transaction=n) for n in range(10)]
    raw.sock.sendall(b"".join(frames))
    assert [raw.answer()[2] for _ in frames] == [2 * (1 + n) for n in range(10)]


def test_what_is_no_request_does_not_spoil_the_next(raw: Raw) -> None:
    raw.sock.sendall(frame(3, struct.pack(">HH", 0, 0)) + frame(99, b"abc") + frame(3, struct.pack(">HH", STATUS, 2)))
    assert raw.answer() == bytes.fromhex("00 83 03")
    assert raw.answer() == bytes.fromhex("00 e3 01")
    assert raw.answer()[:3] == bytes.fromhex("00 03 04")


def test_a_frame_in_pieces(raw: Raw) -> None:
    data = frame(3, struct.pack(">HH", STATUS, 2))
    for place in range(len(data)):
        raw.sock.sendall(data[place : place + 1])
    assert raw.answer()[:3] == bytes.fromhex("00 03 04")


# Bad input


@pytest.mark.parametrize("count", [0, 126, 65_535])
def test_a_count_that_no_request_can_have(raw: Raw, count: int) -> None:
    assert raw.ask(frame(3, struct.pack(">HH", VARIABLES, count))) == bytes.fromhex("00 83 03")


@pytest.mark.parametrize("address", [STATUS, STATUS + 16, 3584, 4096 + 512 * 2, 22016, 65534], ids=str)
def test_what_is_read_only_or_absent_is_not_written(master: ModbusTcpClient, address: int) -> None:
    answer = master.write_registers(address, [1, 2])
    assert (answer.isError(), answer.exception_code) == (True, 2)


@pytest.mark.parametrize("address", [4096 + 512 * 2, 12288 + 512 * 2, 20480 + 40, 60000, 65534])
def test_what_is_absent_is_not_read(master: ModbusTcpClient, address: int) -> None:
    answer = master.read_holding_registers(address, count=2)
    assert (answer.isError(), answer.exception_code) == (True, 2)


def test_a_block_over_the_end_of_the_commands_does_nothing_at_all(master: ModbusTcpClient) -> None:
    block = reals(37.0, 1.0, 10.0, 10.0, 4.0) + [0] * 15 + reals(37.0, 1.0)
    answer = master.write_registers(COMMANDS, to_words(block))
    assert answer.exception_code == 2
    assert StatusBits.TARGET_DONE in status(master), "not even the axes that are there have started"


def test_a_write_into_the_middle_of_read_only_registers_writes_none(master: ModbusTcpClient) -> None:
    last_variable = 60 * 512 - 2
    answer = master.write_registers(last_variable, to_words(reals(1.0, 2.0)))
    assert answer.exception_code == 2
    assert master.read_holding_registers(last_variable, count=2).registers == [0, 0]


def test_half_a_register_waits_for_its_other_half(master: ModbusTcpClient, served: tuple[str, int]) -> None:
    low, high = to_words(reals(3.33))
    master.write_register(VARIABLES, low)
    assert master.read_holding_registers(VARIABLES, count=2).registers == [0, 0]
    other = ModbusTcpClient(served[0], port=served[1])
    other.write_register(VARIABLES + 1, high)
    assert master.read_holding_registers(VARIABLES, count=2).registers == [0, 0], "halves of two masters do not meet"
    other.close()
    assert master.write_register(VARIABLES + 1, high).registers == [high]
    assert master.read_holding_registers(VARIABLES, count=2).registers == [low, high]


def test_a_master_that_disconnects_between_words_leaves_nothing(served: tuple[str, int]) -> None:
    first, second = ModbusTcpClient(served[0], port=served[1]), ModbusTcpClient(served[0], port=served[1])
    low, high = to_words(reals(37.0))
    first.write_register(COMMANDS, low)
    first.close()
    second.write_register(COMMANDS + 1, high)
    assert StatusBits.TARGET_DONE in status(second)
    assert errors(second) == ErrorBits(0)
    second.close()


def test_a_master_that_leaves_in_the_middle_of_a_frame(served: tuple[str, int], master: ModbusTcpClient) -> None:
    half = socket.create_connection(served)
    half.sendall(bytes.fromhex(FRAME)[:25])
    half.close()
    assert StatusBits.TARGET_DONE in status(master)
    assert master.read_holding_registers(4208, count=2).registers == [0, 0]


@pytest.mark.parametrize(
    "numbers",
    [
        (137.0,),
        (20.5,),
        (-1.0,),
        (float("nan"),),
        (float("inf"),),
        (72.0,),
        (20.0, 10.0, -5.0, 50.0, 50.0),
        (20.0, float("nan"), 5.0, 50.0, 50.0),
        (20.0, 10.0, 5.0, 0.0, 50.0),
        (9.0, 11.0, 100.0),
        (68.0, 2.0),
        (30.0, 1.0, 0.0, 32801.0, 1.0),
        (30.0, 1.0, 1.0, 99.0, 1.0),
    ],
    ids=str,
)
def test_a_command_that_cannot_be_done_is_an_error_bit(master: ModbusTcpClient, numbers: tuple[float, ...]) -> None:
    assert not master.write_registers(COMMANDS, to_words(reals(*numbers))).isError()
    assert errors(master) == ErrorBits.COMMAND
    assert StatusBits.HALTED in status(master), "the AutoStop of every error bit is Direct Output Halt by default"
    position = from_words(master.read_holding_registers(4208, count=2).registers)[0]
    assert value_of(position) == 0.0
    master.write_registers(COMMANDS, to_words(reals(97.0, 1.0)))
    master.write_registers(COMMANDS, to_words(reals(4.0)))
    assert errors(master) == ErrorBits(0)
    master.write_registers(COMMANDS, to_words(reals(20.0, 1.0, 5.0, 50.0, 50.0)))
    while StatusBits.IN_POSITION not in status(master):
        pass


@pytest.mark.parametrize(
    ("element", "bits"),
    [
        (38, bits_of(0.0)),
        (33, bits_of(10.5)),
        (61, bits_of(-1.0)),
        (62, bits_of(float("nan"))),
        (9, 1),
        (106, 0xFFFF_FFFF),
        (106, 0),
    ],
)
def test_a_parameter_out_of_range_is_refused(master: ModbusTcpClient, element: int, bits: int) -> None:
    before = master.read_holding_registers(PARAMETERS + 2 * element, count=2).registers
    assert not master.write_registers(PARAMETERS + 2 * element, to_words([bits])).isError()
    assert master.read_holding_registers(PARAMETERS + 2 * element, count=2).registers == before
    assert errors(master) == ErrorBits.CONFIGURATION


def test_the_scale_stays_while_the_axis_is_enabled(master: ModbusTcpClient) -> None:
    master.write_registers(PARAMETERS, to_words(reals(0.5)))
    assert errors(master) == ErrorBits.CONFIGURATION
    master.write_registers(COMMANDS, to_words(reals(97.0, 0.0)))
    master.write_registers(PARAMETERS, to_words(reals(0.5)))
    assert master.read_holding_registers(PARAMETERS, count=2).registers == to_words(reals(0.5))


def test_commands_are_read_as_zeros(master: ModbusTcpClient) -> None:
    master.write_registers(COMMANDS, to_words(reals(4.0)))
    assert master.read_holding_registers(COMMANDS, count=20).registers == [0] * 20


def test_indirect_data(master: ModbusTcpClient) -> None:
    """Two registers of different axes, gathered into one read; 42.0 and its duplicate at address 1."""
    master.write_registers(41 * 512, to_words([8 * 4096 + 53, 9 * 4096 + 53, 57 * 4096 + 30]))
    master.write_registers(57 * 512 + 60, to_words(reals(7.5)))
    master.write_registers(COMMANDS, to_words(reals(23.0, 1.0, 0.0)))
    gathered = [value_of(bits) for bits in from_words(master.read_holding_registers(42 * 512, count=6).registers)]
    assert gathered == [1.0, 0.0, 7.5]
    assert master.read_holding_registers(0, count=6).registers == to_words(reals(*gathered))
    master.write_registers(42 * 512 + 4, to_words(reals(-1.0)))
    assert master.read_holding_registers(57 * 512 + 60, count=2).registers == to_words(reals(-1.0))
    assert master.write_registers(42 * 512, [0, 0]).exception_code == 2, "what it points to is read-only"


def test_the_other_word_order_and_the_other_map() -> None:
    with EmulatedRmc(MACHINE.replace("axes = 2", 'axes = 2\nword_order = "high_first"\nmap = "rmc75"')) as emu:
        address, port = emu.serve()
        host = ModbusTcpClient(address, port=port)
        assert host.read_holding_registers(12 * 512, count=2).registers == to_words(reals(0.001), "high_first")
        block = to_words(reals(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 23.0, 2.0, 0.0), "high_first")
        assert not host.write_registers(16 * 512, block).isError()
        command_position = host.read_holding_registers(9 * 512 + 112, count=2).registers
        assert command_position == to_words(reals(2.0), "high_first"), "small command area: six registers an axis"
        host.close()


def test_several_masters_at_once(served: tuple[str, int]) -> None:
    masters = [ModbusTcpClient(served[0], port=served[1]) for _ in range(8)]
    for number, each in enumerate(masters):
        each.write_registers(VARIABLES + 2 * number, to_words(reals(float(number))))
    for each in masters:
        words = each.read_holding_registers(VARIABLES, count=16).registers
        assert [value_of(bits) for bits in from_words(words)] == [float(number) for number in range(8)]
        each.close()


def test_a_master_by_somebody_else(served: tuple[str, int]) -> None:
    client = pytest.importorskip("pyModbusTCP.client")
    master = client.ModbusClient(host=served[0], port=served[1], auto_open=True)
    assert master.write_multiple_registers(COMMANDS, to_words(reals(20.0, 3.0, 5.0, 50.0, 50.0)))
    while not master.read_holding_registers(STATUS, 1)[0] & StatusBits.IN_POSITION:
        pass
    assert value_of(from_words(master.read_input_registers(4112, 2))[0]) == pytest.approx(3.0, abs=0.05)
    assert master.read_holding_registers(60000, 2) is None
    assert master.last_except == 2
    master.close()


@pytest.mark.skipif(shutil.which("mbpoll") is None, reason="mbpoll is not installed (apt install mbpoll)")
def test_mbpoll_reads_and_commands(served: tuple[str, int]) -> None:
    def mbpoll(*arguments: str) -> str:
        command = ["mbpoll", "-m", "tcp", "-p", str(served[1]), "-a", "1", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=20).stdout

    # -0 is not given: references count from 1, as the manual prints addresses; 4:float is a REAL, low word first.
    mbpoll("-t", "4:float", "-r", "20481", served[0], "23.0", "2.5", "0.0")
    assert "[4209]: \t2.5" in mbpoll("-t", "4:float", "-r", "4209", "-c", "1", "-1", served[0])
    assert "1E300" not in mbpoll("-t", "4:hex", "-r", "4097", "-c", "2", "-1", served[0])
