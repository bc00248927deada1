"""Move axis 1 by two revolutions with pyserial alone: `python pyserial_move.py /dev/ttyUSB0`.

The port may be anything pyserial opens: `COM3`, `socket://127.0.0.1:6250`, the emulator's virtual serial port.
"""

import sys

import serial

COUNTS = 8000
MOVING, IN_TARGET_ZONE = 1, 24  # bits of the axis status, 1 first


class Refused(Exception):
    """The controller's own message."""


def ask(port: serial.Serial, command: str) -> str:
    """Send a command and return its reply, "" if it has none; the prompt ends it, `> ` or, after a refusal, `? `."""
    port.write(command.encode() + b"\r")
    answer = b""
    while not answer.endswith((b"\r\n> ", b"\r\n? ")):
        received = port.read(max(1, port.in_waiting))
        if not received:
            raise TimeoutError(f"{command}: no prompt, only {answer!r}")
        answer += received
    reply = answer[:-4].decode().strip().lstrip("*")
    if answer.endswith(b"? "):
        raise Refused(f"{command}: {reply}")
    return reply


def status_bit(port: serial.Serial, number: int) -> bool:
    bits = ask(port, "!1TAS").removeprefix("1TAS").replace("_", "")
    return bits[number - 1] == "1"


def main(url: str) -> None:
    with serial.serial_for_url(url, baudrate=9600, timeout=1.0) as port:
        # Backspaces take back whatever the last program may have left half typed. After them nothing is certain about
        # echo and prompts, so this one answer is read until the line is quiet.
        port.write(b"\x08" * 100 + b"!ERRLVL4:!ECHO0\r")
        port.timeout = 0.2
        while port.read(1000):
            pass
        port.timeout = 1.0

        ask(port, "DRIVE1X")
        for setting in ("1PSET0", "1MA1", "1MC0", "1A50", "1AD50", "1V5", f"1D{COUNTS}"):
            ask(port, setting)
        ask(port, "!1GO")  # answered at once; without ! the prompt would come when the move is over
        while status_bit(port, MOVING) or not status_bit(port, IN_TARGET_ZONE):
            pass
        print("position:", int(ask(port, "1TPE").removeprefix("1TPE")))
        ask(port, "DRIVE0X")


if __name__ == "__main__":
    main(sys.argv[1])
