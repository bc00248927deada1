"""A real serial port, stood in for by a pair of pseudo-terminals with socat as the cable and pyserial as the host."""

from __future__ import annotations

import errno
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial

from emulator.ports.serial_link import open_link
from emulator.serial_address import SerialAddress, parse_serial
from tests.ports.serial_pair import SerialPair, needs_socat
from tests.ports.served import OEM6250, PATIENCE_S, REPOSITORY, TOY, Served, wait_until

PING_S = 0.2
"""How long an answer to a question on a line that may not be back yet is waited for."""


class TestAddress:
    @pytest.mark.parametrize(
        ("text", "address"),
        [
            ("/dev/ttyUSB0", ("/dev/ttyUSB0", 9600, 8, "N", 1)),
            ("/dev/ttyUSB0:19200", ("/dev/ttyUSB0", 19200, 8, "N", 1)),
            ("/dev/ttyS0:4800:7e2", ("/dev/ttyS0", 4800, 7, "E", 2)),
            ("COM3", ("COM3", 9600, 8, "N", 1)),
            ("COM3:19200", ("COM3", 19200, 8, "N", 1)),
            (r"\\.\COM12:19200:8O1.5", (r"\\.\COM12", 19200, 8, "O", 1.5)),
            ("rfc2217://localhost:4001", ("rfc2217://localhost:4001", 9600, 8, "N", 1)),
            ("rfc2217://localhost:4001:19200:8N1", ("rfc2217://localhost:4001", 19200, 8, "N", 1)),
            ("socket://[::1]:4001:19200", ("socket://[::1]:4001", 19200, 8, "N", 1)),
            ("spy:///dev/ttyS0?file=/x:9600", ("spy:///dev/ttyS0?file=/x", 9600, 8, "N", 1)),
            ("/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0", None),
            ("/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0:9600", None),
        ],
    )
    def test_device_baud_and_framing(self, text: str, address: tuple[str, int, int, str, float] | None) -> None:
        by_path = "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0"
        assert parse_serial(text) == (address or SerialAddress(by_path))

    def test_a_device_that_exists_is_not_taken_apart(self, tmp_path: Path) -> None:
        path = tmp_path / "usb-0:9600"
        path.touch()
        assert parse_serial(str(path)) == SerialAddress(str(path))

    @pytest.mark.parametrize(
        ("text", "complaint"),
        [
            ("", "names no device"),
            (":9600", "names no device"),
            ("/dev/ttyS0:50", "50 is not a baud rate"),
            ("COM3:9600000", "9600000 is not a baud rate"),
            ("/dev/ttyS0:9600:9N1", "'9N1' is not a framing"),
            ("/dev/ttyS0:9600:8X1", "'8X1' is not a framing"),
            ("/dev/ttyS0:9600:", "'' is not a framing"),
            ("/dev/ttyS0:8N1", "a framing comes after a baud rate"),
        ],
    )
    def test_mistakes_are_named(self, text: str, complaint: str) -> None:
        with pytest.raises(ValueError, match=complaint):
            parse_serial(text)


def refused(*options: str) -> str:
    """The one line of a server that does not start."""
    arguments = [*TOY, "serve", "--no-tcp", "--pty", "none", *options]
    result = subprocess.run(arguments, cwd=REPOSITORY, capture_output=True, text=True, timeout=20, check=False)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1, result.stderr
    return result.stderr


class TestRefusals:
    def test_a_device_that_is_missing_at_the_start(self, tmp_path: Path) -> None:
        missing = tmp_path / "ttyUSB7"
        assert refused("--serial", str(missing)) == f"oem6250: --serial {missing}: there is no such device\n"

    def test_what_is_no_serial_port(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        assert refused("--serial", str(tmp_path / "file")).startswith(f"oem6250: --serial {tmp_path / 'file'}: ")

    def test_a_protocol_nobody_knows(self) -> None:
        assert "xyz" in refused("--serial", "xyz://there")

    def test_a_mistake_in_the_option(self) -> None:
        assert "'9X9' is not a framing" in refused("--serial", "/dev/ttyS0:9600:9X9")

    @needs_socat
    def test_a_device_another_emulator_has(self, tmp_path: Path) -> None:
        options = ("--no-tcp", "--pty", "none", "--serial", str(tmp_path / "unit"))
        with SerialPair(tmp_path), Served(*options, announce=tmp_path / "announce"):
            assert "another program has it open" in refused("--serial", str(tmp_path / "unit"))


WAYS = ["descriptor", "threads"]


def device_of(pair: SerialPair, way: str) -> str:
    """Both ways of reaching a device: an address with a protocol takes the way of Windows."""
    return str(pair.unit) if way == "descriptor" else f"alt://{pair.unit}?class=Serial"


def served_on(pair: SerialPair, way: str, folder: Path) -> Served:
    device = device_of(pair, way)
    options = ("--tcp", "127.0.0.1:0", "--pty", "none", "--serial", f"{device}:19200:8N1")
    served = Served(*options, announce=folder / "announce")
    assert served.announced["serial"] == [device]
    return served


def opened(pair: SerialPair) -> serial.Serial:
    return serial.Serial(str(pair.host), 19200, timeout=PATIENCE_S)


def ask(port: serial.Serial, text: bytes) -> bytes:
    port.write(text + b"\r")
    return bytes(port.read_until(b"> "))


def back(pair: SerialPair, question: bytes = b"PING") -> serial.Serial:
    """The host's end of a cable that was put back, as soon as the unit answers on it; nothing is left unread."""
    port = opened(pair)
    port.timeout = PING_S
    wait_until(lambda: ask(port, question).endswith(b"> "))
    while port.read_until(b"> "):
        pass
    port.timeout = PATIENCE_S
    return port


def seen(served: Served) -> int:
    """How many lines the toy has executed, asked over TCP."""
    with served.connect() as host:
        host.sock.sendall(b"SEEN\r")
        return int(host.read_until(b"> ").split(b"\r")[0][1:])


@pytest.fixture(scope="module", params=WAYS)
def line(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Served, SerialPair]]:
    """One server and its cable, for tests that leave both as they were."""
    folder = tmp_path_factory.mktemp("line")
    with SerialPair(folder) as pair, served_on(pair, request.param, folder) as served:
        yield served, pair


@needs_socat
class TestLine:
    def test_a_host_is_answered_byte_for_byte(self, line: tuple[Served, SerialPair]) -> None:
        with opened(line[1]) as port:
            for number in range(200):
                assert ask(port, b"%d" % number) == b"*%d\r\n> " % number

    def test_all_bytes_pass_unchanged_both_ways(self, line: tuple[Served, SerialPair]) -> None:
        """XON, XOFF, 0x03 and 0xff are data: the driver keeps out of it."""
        text = bytes(byte for byte in range(256) if byte not in b"\r\n")
        with opened(line[1]) as port:
            for part in (text[:90], text[90:180], text[180:]):
                assert ask(port, part) == b"*" + part + b"\r\n> "

    def test_a_long_answer_arrives_whole(self, line: tuple[Served, SerialPair]) -> None:
        with opened(line[1]) as port:
            assert ask(port, b"FILL 50000") == b"*" + b"x" * 50_000 + b"\r\n> "

    def test_a_host_that_never_reads_does_not_stop_its_commands(self, line: tuple[Served, SerialPair]) -> None:
        before = seen(line[0])
        with opened(line[1]) as port:
            for _ in range(100):
                port.write(b"FILL 5000\r" * 5)
            wait_until(lambda: seen(line[0]) >= before + 500)
            port.timeout = PING_S
            while port.read(65536):
                pass

    def test_a_host_may_close_and_open_again(self, line: tuple[Served, SerialPair]) -> None:
        for number in range(20):
            with opened(line[1]) as port:
                assert ask(port, b"%d" % number) == b"*%d\r\n> " % number


@needs_socat
class TestUnplugging:
    @pytest.fixture
    def pair(self, tmp_path: Path) -> Iterator[SerialPair]:
        with SerialPair(tmp_path) as pair:
            yield pair

    @pytest.fixture(params=WAYS)
    def served(self, request: pytest.FixtureRequest, tmp_path: Path, pair: SerialPair) -> Iterator[Served]:
        with served_on(pair, request.param, tmp_path) as served:
            yield served

    def test_it_ends_cleanly_with_the_line_connected(self, served: Served, pair: SerialPair) -> None:
        with opened(pair) as port:
            ask(port, b"A")
            status, seconds, errors = served.stop()
        assert (status, errors) == (0, "")
        assert seconds < 2.0

    def test_a_device_that_goes_is_waited_for(self, served: Served, pair: SerialPair) -> None:
        for _ in range(3):
            pair.unplug()
            with served.connect() as host:
                assert host.ask(b"A\r", 6) == b"*A\r\n> ", "the other ways in go on"
            pair.plug()
            with back(pair) as port:
                assert ask(port, b"B") == b"*B\r\n> "

    def test_each_episode_is_logged_once(self, served: Served, pair: SerialPair) -> None:
        for _ in range(2):
            pair.unplug()
            pair.plug()
            back(pair).close()
        status, _, errors = served.stop()
        events = [line.split('event="')[1].split('"')[0] for line in errors.splitlines()]
        assert (status, events) == (0, ["serial port gone, waiting for it", "serial port back"] * 2)

    def test_half_a_command_is_forgotten(self, served: Served, pair: SerialPair) -> None:
        with opened(pair) as port:
            assert ask(port, b"A") == b"*A\r\n> "
            port.write(b"HAL")
        seen(served)
        pair.unplug()
        pair.plug()
        with back(pair, b"F") as port:
            assert ask(port, b"G") == b"*G\r\n> "

    def test_output_of_before_is_not_sent_again(self, served: Served, pair: SerialPair) -> None:
        with opened(pair) as port:
            port.write(b"FILL 60000\r" * 4)
            wait_until(lambda: seen(served) >= 4)
        pair.unplug()
        pair.plug()
        with back(pair) as port:
            assert ask(port, b"A") == b"*A\r\n> "

    def test_what_comes_later_finds_the_line_again(self, served: Served, pair: SerialPair) -> None:
        """The unit does not know that its cable was out: an answer under way reaches the same line."""
        with opened(pair) as port:
            port.write(b"HOLD 1500\r")
            assert ask(port, b"A") == b"*A\r\n> "
        pair.unplug()
        pair.plug()
        with back(pair) as port:
            assert port.read_until(b"HELD\r\n> ").endswith(b"*HELD\r\n> ")

    def test_it_ends_cleanly_while_it_waits(self, served: Served, pair: SerialPair) -> None:
        pair.unplug()
        seen(served)
        status, seconds, _ = served.stop()
        assert status == 0
        assert seconds < 2.0

    def test_nothing_is_left_behind(self, served: Served, pair: SerialPair) -> None:
        seen(served)
        before = served.descriptors()
        for _ in range(3):
            pair.unplug()
            pair.plug()
            back(pair).close()
        wait_until(lambda: served.descriptors() <= before)


@needs_socat
@pytest.mark.parametrize("cuts", [4, pytest.param(60, marks=pytest.mark.slow)])
def test_no_command_is_lost_or_carried_out_twice(tmp_path: Path, cuts: int) -> None:
    """What the unit acknowledged happened once; what was on the wire when it was cut, once or not at all."""
    options = ("--tcp", "127.0.0.1:0", "--pty", "none", "--serial", str(tmp_path / "unit"))
    with SerialPair(tmp_path) as pair, Served(*options, announce=tmp_path / "announce", command=OEM6250) as served:
        with served.connect() as host:
            host.sock.sendall(b"ECHO0\rVAR1=0\r")
            host.read_until(b"> ")
        acknowledged, unsure = 0, 0
        for number in range(cuts):
            with back(pair, b"1TPE") as port:
                for _ in range(50):
                    assert ask(port, b"VAR1=VAR1+1") == b"\r\n> "
                    acknowledged += 1
                if number % 2:
                    port.write(b"VAR1=VAR1+1\r")
                    unsure += 1
                pair.unplug()
            pair.plug()
        with back(pair, b"1TPE") as port:
            value = float(ask(port, b"VAR1").split(b"=")[1].split(b"\r")[0])
        assert acknowledged <= value <= acknowledged + unsure


@needs_socat
@pytest.mark.parametrize(("baud", "understood"), [(9600, True), (19200, False)])
def test_with_strict_baud_a_port_at_another_rate_carries_garbage(tmp_path: Path, baud: int, understood: bool) -> None:
    machine = tmp_path / "strict.toml"
    machine.write_text('[serial]\nstrict_baud = true\nempty_prompt = false\n[defaults]\nECHO = "0"\n')
    line = f"{tmp_path / 'unit'}:{baud}"
    options = (str(machine), "--no-tcp", "--pty", "none", "--serial", line)
    with SerialPair(tmp_path) as pair, Served(*options, announce=tmp_path / "announce", command=OEM6250):
        if understood:
            back(pair, b"1TPE").close()
        with opened(pair) as port:
            port.timeout = PATIENCE_S if understood else PING_S
            assert (ask(port, b"1TPE") == b"*1TPE+0\r\r\n> ") == understood


def test_a_device_that_goes_while_it_is_opened_is_an_os_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only such an error has the port look again."""
    termios = pytest.importorskip("termios")

    def vanishing(*arguments: object, **options: object) -> None:
        raise termios.error(errno.EIO, "Input/output error")

    monkeypatch.setattr(serial, "serial_for_url", vanishing)
    with pytest.raises(OSError, match="Input/output error") as raised:
        open_link(SerialAddress("/dev/ttyS0"))
    assert raised.value.errno == errno.EIO
