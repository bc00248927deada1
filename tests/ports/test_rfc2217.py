"""RFC 2217: the option by itself, then pyserial's client against the toy controller over a real socket."""

from __future__ import annotations

import struct
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial
from hypothesis import given
from hypothesis import strategies as st

from clients import LineClient
from emulator.ports.com_port import SIGNATURE
from emulator.ports.telnet import COM_PORT, DO, IAC, SB, SE, WILL
from tests.ports.served import OEM6250, Served, wait_until
from tests.ports.test_telnet import Peer

ANSWER = 100


def request(code: int, value: bytes = b"") -> bytes:
    """One subnegotiation of the option."""
    return bytes((IAC, SB, COM_PORT, code)) + value.replace(b"\xff", b"\xff\xff") + bytes((IAC, SE))


def agreed(strict_baud: int | None = None) -> Peer:
    """A session whose client has negotiated the option."""
    peer = Peer(strict_baud)
    peer.session.receive(bytes((IAC, WILL, COM_PORT)))
    peer.take()
    return peer


@pytest.mark.parametrize("verb", [WILL, DO])
def test_the_option_is_agreed_with_binary(verb: int) -> None:
    peer = Peer()
    peer.session.receive(bytes((IAC, verb, COM_PORT)))
    told = peer.take()
    assert bytes((IAC, WILL, COM_PORT)) in told
    assert (bytes((IAC, DO, COM_PORT)) in told) == (verb == WILL)
    assert bytes((IAC, WILL, 0)) in told and bytes((IAC, DO, 0)) in told
    peer.session.receive(bytes((IAC, DO, 0, IAC, WILL, 0, IAC, verb, COM_PORT)))
    assert peer.take() == b""


@pytest.mark.parametrize(
    ("code", "value", "answer"),
    [
        (1, struct.pack("!I", 19200), struct.pack("!I", 19200)),
        (1, bytes(4), struct.pack("!I", 9600)),
        (1, b"\xff\xff\xff\xff", struct.pack("!I", 9600)),
        (1, b"\x01", struct.pack("!I", 9600)),
        (2, b"\x07", b"\x07"),
        (2, b"\x09", b"\x08"),
        (3, b"\x03", b"\x03"),
        (3, b"\x63", b"\x01"),
        (4, b"\x02", b"\x02"),
        (4, b"\x63", b"\x01"),
        (4, b"", b"\x01"),
        (5, b"\x00", b"\x01"),
        (5, b"\x02", b"\x02"),
        (5, b"\x03", b"\x03"),
        (5, b"\x04", b"\x06"),
        (5, b"\x05", b"\x05"),
        (5, b"\x07", b"\x08"),
        (5, b"\x09", b"\x09"),
        (5, b"\x0a", b"\x0b"),
        (5, b"\x0c", b"\x0c"),
        (5, b"\x0d", b"\x0e"),
        (5, b"\x10", b"\x0e"),
        (0, b"", SIGNATURE),
        (6, b"", b"\x00"),
        (10, b"\xff", b"\xff\xff"),
        (11, b"\x10", b"\x10"),
        (12, b"\x01", b"\x01"),
        (12, b"\x03", b"\x03"),
    ],
)
def test_requests_are_answered(code: int, value: bytes, answer: bytes) -> None:
    """Each with the value in force afterwards (RFC 2217 section 2), so nonsense with the one before."""
    peer = agreed()
    assert peer.session.receive(request(code, value)) == b""
    assert peer.take() == bytes((IAC, SB, COM_PORT, code + ANSWER)) + answer + bytes((IAC, SE))


def test_lines_are_remembered() -> None:
    peer = agreed()
    peer.session.receive(request(5, b"\x09") + request(5, b"\x0c") + request(5, b"\x05"))
    peer.take()
    peer.session.receive(request(5, b"\x07") + request(5, b"\x0a") + request(5, b"\x04"))
    assert peer.take() == b"".join(request(5 + ANSWER, bytes((state,))) for state in (9, 12, 5))


def test_modem_lines_are_those_of_a_three_wire_cable() -> None:
    """CTS, DSR and CD are active, there is no ring."""
    peer = agreed()
    peer.session.receive(request(7))
    assert peer.take()[4] & 0xF0 == 0x10 | 0x20 | 0x80


@pytest.mark.parametrize("code", [13, 77, 101, 254])
def test_unknown_requests_are_passed_over(code: int) -> None:
    peer = agreed()
    assert peer.session.receive(request(code, b"xyz") + b"1TPE\r") == b"1TPE\r"
    assert peer.take() == b""


@given(st.lists(st.tuples(st.integers(0, 15), st.binary(max_size=6)), max_size=20))
def test_nonsense_never_raises(requests: list[tuple[int, bytes]]) -> None:
    peer = agreed()
    stream = b"".join(request(code, value) for code, value in requests)
    assert peer.session.receive(stream + b"1TPE\r") == b"1TPE\r"
    peer.session.receive(request(1, bytes(4)))
    assert peer.take().endswith(bytes((IAC, SE)))


def test_output_waits_while_the_client_has_suspended_it() -> None:
    peer = agreed()
    peer.session.receive(request(8))
    peer.session.send(b"*1TPE+0\r")
    assert peer.take() == b""
    peer.session.receive(request(9))
    assert peer.take() == b"*1TPE+0\r"


def test_what_is_held_is_bounded_and_purged() -> None:
    peer = agreed()
    peer.session.receive(request(8))
    for _ in range(100):
        peer.session.send(b"x" * 10_000)
    assert len(peer.session._held) <= 256 * 1024
    peer.session.receive(request(12, b"\x01") + request(9))
    assert peer.take() == request(12 + ANSWER, b"\x01")


def test_characters_pass_as_they_are_in_both_directions() -> None:
    """Clients of RFC 2217 take CR NUL for two characters."""
    peer = agreed()
    peer.session.send(b"A\r\xff")
    assert peer.take() == b"A\r\xff\xff"
    assert peer.session.receive(b"A\r\0B") == b"A\r\0B"


def test_a_client_at_another_rate_and_the_unit_do_not_understand_each_other() -> None:
    peer = agreed(strict_baud=9600)
    assert peer.session.receive(b"1TPE\r") == b"1TPE\r"
    peer.session.receive(request(1, struct.pack("!I", 19200)))
    peer.take()
    assert b"TPE" not in peer.session.receive(b"1TPE\r")
    peer.session.send(b"*1TPE+0\r")
    assert b"TPE" not in peer.take()
    peer.session.receive(request(1, struct.pack("!I", 9600)))
    peer.take()
    assert peer.session.receive(b"1TPE\r") == b"1TPE\r"


def test_without_strict_baud_every_rate_is_understood() -> None:
    peer = agreed()
    peer.session.receive(request(1, struct.pack("!I", 300)))
    assert peer.session.receive(b"1TPE\r") == b"1TPE\r"


# With pyserial.


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    announce = tmp_path_factory.mktemp("rfc2217") / "announce"
    with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=announce) as served:
        yield served


def opened(served: Served, **settings: object) -> serial.SerialBase:
    """pyserial's client; it names its thread in a way Python discourages, which is not our affair."""
    host, port = served.address
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        return serial.serial_for_url(f"rfc2217://{host}:{port}", timeout=5, **settings)


def test_pyserial_changes_everything_and_goes_on(served: Served) -> None:
    with opened(served, baudrate=9600) as line:
        for baud, parity in ((19200, "E"), (1200, "O"), (115200, "N")):
            line.baudrate, line.parity = baud, parity
            line.write(b"A\r")
            assert line.read(6) == b"*A\r\n> "
        line.bytesize, line.stopbits, line.rts, line.dtr = 7, 2, False, False
        line.rts = True
        line.xonxoff = True
        assert (line.cts, line.dsr, line.ri, line.cd) == (True, True, False, True)
        line.write(b"B\xff\r")
        assert line.read(7) == b"*B\xff\r\n> "


def test_pyserial_discards_its_input(served: Served) -> None:
    with opened(served) as line:
        line.write(b"A\r")
        wait_until(lambda: line.in_waiting == 6)
        line.reset_input_buffer()
        assert line.in_waiting == 0
        line.reset_output_buffer()
        line.break_condition = True
        line.break_condition = False
        line.write(b"B\r")
        assert line.read(6) == b"*B\r\n> "


def test_pyserial_comes_and_goes(served: Served) -> None:
    before = served.descriptors()
    for _ in range(3):
        with opened(served, rtscts=True) as line:
            line.write(b"A\r")
            assert line.read(6) == b"*A\r\n> "
    wait_until(lambda: served.descriptors() <= before)


def test_raw_and_rfc2217_share_the_port(served: Served) -> None:
    with opened(served) as line, served.connect() as raw:
        line.write(b"A\r")
        assert raw.ask(b"B\r", 6) == b"*B\r\n> "
        assert line.read(6) == b"*A\r\n> "


def test_nonsense_on_one_connection_leaves_it_and_the_others_alive(served: Served) -> None:
    with served.connect() as mad, served.connect() as other:
        mad.sock.sendall(bytes((IAC, WILL, COM_PORT)))
        for code in range(256):
            for value in (b"", b"\x00", b"\x63", b"\xff\xff\xff\xff", b"x" * 600):
                mad.sock.sendall(request(code, value) if code != IAC else b"")
            assert other.ask(b"A\r", 6) == b"*A\r\n> "
        mad.sock.sendall(b"MAD\r")
        assert b"*MAD\r\n> " in mad.read_until(b"> ")


def test_pyserial_is_not_loaded_for_others(tmp_path_factory: pytest.TempPathFactory) -> None:
    if sys.platform != "linux":
        # Meant: what another process has loaded is only to be seen there.
        pytest.skip("looks into /proc")
    announce = tmp_path_factory.mktemp("lazy") / "announce"
    with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=announce) as served, served.connect() as host:
        host.sock.sendall(bytes((IAC, WILL, 31)) + b"A\r")
        host.read_until(b"> ")
        assert not uses_termios(served)
        host.sock.sendall(bytes((IAC, WILL, COM_PORT)) + b"A\r")
        host.read_until(b"> ")
        wait_until(lambda: uses_termios(served))


def uses_termios(served: Served) -> bool:
    """pyserial needs termios, which the server without a pseudo-terminal does not."""
    with open(f"/proc/{served.process.pid}/maps") as maps:
        return "termios" in maps.read()


def test_the_line_client_of_hosts_works_and_notices_the_end(tmp_path: Path) -> None:
    with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=tmp_path / "announce") as served:
        host, port = served.address
        with LineClient.open(f"rfc2217://{host}:{port}", timeout_s=5) as client:
            assert client.exchange(b"A") == b"*A\r\n> "
            served.stop()
            with pytest.raises(OSError, match=r"closed|died"):
                client.receive(5.0)


@pytest.mark.parametrize(("baud", "understood"), [(9600, True), (19200, False)])
def test_the_machine_file_makes_rates_matter(tmp_path: Path, baud: int, understood: bool) -> None:
    machine = tmp_path / "strict.toml"
    machine.write_text("[serial]\nstrict_baud = true\n")
    options = (str(machine), "--tcp", "127.0.0.1:0", "--pty", "none")
    with Served(*options, announce=tmp_path / "announce", command=OEM6250) as served, served.connect() as raw:
        with opened(served, baudrate=baud) as line:
            line.timeout = 1
            line.write(b"1TPE\r")
            assert (line.read_until(b"> ") == b"1TPE\r\n*1TPE+0\r\r\n> ") == understood
        assert raw.ask(b"1TPE\r", 18) == b"1TPE\r\n*1TPE+0\r\r\n> "
