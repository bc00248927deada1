"""Move axis 1 by two revolutions with pyvisa: `python pyvisa_move.py ASRL/dev/ttyUSB0::INSTR`.

Also `ASRLCOM3::INSTR`, and `TCPIP::127.0.0.1::6250::SOCKET` for a terminal server or the emulator. pyvisa-py does (the
`@py` below); leave it out for the vendor's VISA library.

VISA ends a message with a character. At ERRLVL1 a reply is a star, the value and CR, and a setting is not answered at
all, so that fits; what was refused is asked for at the end.
"""

import sys

import pyvisa
from pyvisa.resources import MessageBasedResource, SerialInstrument

COUNTS = 8000
MOVING, IN_TARGET_ZONE = 1, 24  # bits of the axis status, 1 first


def ask(unit: MessageBasedResource, query: str) -> str:
    return unit.query(query).strip("*\r\n ")


def listen_until_quiet(unit: MessageBasedResource) -> None:
    usual, unit.timeout = unit.timeout, 200
    try:
        while True:
            unit.read_bytes(1)
    except pyvisa.VisaIOError:
        unit.timeout = usual


def status_bit(unit: MessageBasedResource, number: int) -> bool:
    return ask(unit, "!1TAS").replace("_", "")[number - 1] == "1"


def main(resource: str) -> None:
    manager = pyvisa.ResourceManager("@py")
    unit = manager.open_resource(resource)
    assert isinstance(unit, MessageBasedResource)
    unit.timeout = 2000
    unit.write_termination = unit.read_termination = "\r"
    if isinstance(unit, SerialInstrument):
        unit.baud_rate = 9600
    try:
        unit.write("\x08" * 100 + "!ECHO0:!ERRLVL1")  # backspaces: whatever was left half typed
        listen_until_quiet(unit)
        for setting in ("DRIVE1X", "1PSET0", "1MA1", "1MC0", "1A50", "1AD50", "1V5", f"1D{COUNTS}", "!1GO"):
            unit.write(setting)
        if refused := ask(unit, "!TCMDER"):
            raise SystemExit(f"the unit refused {refused}")
        while status_bit(unit, MOVING) or not status_bit(unit, IN_TARGET_ZONE):
            pass
        print("position:", int(ask(unit, "1TPE")))
        unit.write("DRIVE0X")
    finally:
        unit.write("!ECHO1:!ERRLVL4")
        unit.close()
        manager.close()


if __name__ == "__main__":
    main(sys.argv[1])
