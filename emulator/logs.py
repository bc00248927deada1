"""Log lines: one event a line, `key=value`, on stderr.

Quiet by default (warnings), `-v` adds what happens and the traffic, `-vv` everything. An operator greps these lines and
a program splits them, hence one fixed shape: `ts=... level=... log=... event="..." key=value ...`.
"""

from __future__ import annotations

import logging
from datetime import datetime

LEVELS = (logging.WARNING, logging.INFO, logging.DEBUG)


class KeyValueFormatter(logging.Formatter):
    """Puts time, level and logger in front; a traceback follows on lines of its own."""

    def format(self, record: logging.LogRecord) -> str:
        stamp = datetime.fromtimestamp(record.created).isoformat(timespec="milliseconds")
        line = f"ts={stamp} level={record.levelname.lower()} log={record.name} {record.getMessage()}"
        return f"{line}\n{self.formatException(record.exc_info)}" if record.exc_info else line


def set_up_logging(verbosity: int) -> None:
    """Send our own log lines to stderr; `verbosity` counts the -v options."""
    handler = logging.StreamHandler()
    handler.setFormatter(KeyValueFormatter())
    logger = logging.getLogger("oem6250")
    logger.handlers[:] = [handler]
    logger.propagate = False
    logger.setLevel(LEVELS[min(verbosity, len(LEVELS) - 1)])


def event_line(event: str, **fields: object) -> str:
    """`event="port open" port=tcp at=127.0.0.1:6250`; values with blanks or quotes are quoted and escaped."""
    return " ".join([f'event="{event}"', *(f"{key}={_value(value)}" for key, value in fields.items())])


def readable(data: bytes) -> str:
    r"""Bytes as a person reads them: `1TPE\r`, `*1TPE+0\r\r\n> `, `\x00`."""
    return data.decode("latin-1").encode("unicode_escape").decode("ascii")


def _value(value: object) -> str:
    text = readable(value) if isinstance(value, bytes) else str(value)
    return (
        '"' + text.replace('"', '\\"') + '"' if not text or isinstance(value, bytes) or set(text) & set(' "=') else text
    )
