"""The wires: pseudo-terminal and TCP. A port moves bytes between a host and a channel and knows nothing of commands.

`PtyPort` is not re-exported: its module needs termios, which Windows has not.
"""

from emulator.ports.errors import PortError
from emulator.ports.tcp import TcpPort

__all__ = ["PortError", "TcpPort"]
