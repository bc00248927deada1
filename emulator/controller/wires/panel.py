"""The RP240 operator panel as an object: what it shows, which lamps are lit, which keys have been pressed.

Tests (and later a page) hold it; the unit writes to it whether one is fitted or not, and only a fitted one has keys.
"""

from __future__ import annotations

from collections.abc import Callable

LINES, COLUMNS, LEDS = 2, 40, 8

DIGIT_KEYS = tuple("0123456789")
FUNCTION_KEYS = {"F1": 1, "F2": 2, "F3": 3, "F4": 4, "F5": 5, "F6": 6}
"""The keys DREADF waits for and the numbers it returns (assumed L)."""

ENTRY_KEYS = (*DIGIT_KEYS, ".", "+/-", "C/E", "ENTER")
ARROW_KEYS = {"RIGHT": (0, 1), "LEFT": (0, -1), "UP": (1, 1), "DOWN": (1, -1)}
"""Axis index and direction that each arrow key jogs (assumed L)."""

STOP, PAUSE, CONTINUE = "STOP", "PAUSE", "CONTINUE"
KEYS = (*ENTRY_KEYS, *FUNCTION_KEYS, *ARROW_KEYS, STOP, PAUSE, CONTINUE)
"""Every key of the panel by its label (assumed L)."""

MENU = ("OEM6250", "RUN   JOG   STATUS  DRIVE  DISPLAY  ETC")
"""What the panel shows after power-up: product name and menu (installation procedure; layout assumed L)."""

LONGEST_ENTRY = 17
"""Characters of a number that may be keyed in: sign, nine digits, point, six more (assumed L)."""


class OperatorPanel:
    """A 2 x 40 character display with a cursor, eight lamps, and the number being keyed in."""

    def __init__(self, *, fitted: bool) -> None:
        self.fitted = fitted
        self.leds = "0" * LEDS
        """The lamps, first lamp first: 1 = lit."""
        self.entered_number: str = ""
        """The number last finished with ENTER; empty before the first."""
        self.function_key = 0
        """The function key last pressed; 0 before the first."""
        self._rows: list[str] = []
        self._line, self._column = 0, 0
        self._entry = ""
        self._held: set[str] = set()
        self.on_number: Callable[[str], None] | None = None
        self.on_function_key: Callable[[int], None] | None = None
        self.power_up()

    def power_up(self) -> None:
        """The menu on the display, lamps dark, nothing keyed in."""
        self.clear()
        self.leds = "0" * LEDS
        self.entered_number, self.function_key, self._entry = "", 0, ""
        self._held = set()
        self.on_number = self.on_function_key = None
        if self.fitted:
            for line, text in enumerate(MENU):
                self._rows[line] = text.ljust(COLUMNS)[:COLUMNS]

    @property
    def text(self) -> tuple[str, str]:
        """The two lines of the display, 40 characters each."""
        return self._rows[0], self._rows[1]

    @property
    def cursor(self) -> tuple[int, int]:
        """Line from 1 and column from 0, as DPCUR counts them."""
        return self._line + 1, self._column

    def clear(self, line: int = 0) -> None:
        """Blank a line (1, 2) or, with 0, both; the cursor goes to its beginning (assumed)."""
        self._rows = [
            " " * COLUMNS if line in (0, number) else row
            for number, row in enumerate(self._rows or [""] * LINES, start=1)
        ]
        self._line, self._column = max(line, 1) - 1, 0

    def move_cursor(self, line: int, column: int) -> None:
        """Put the cursor at a line (1, 2) and column (0 to 39)."""
        self._line, self._column = line - 1, column

    def write(self, text: str) -> None:
        """Write from the cursor on; what does not fit on the line is lost (assumed)."""
        row = self._rows[self._line]
        shown = text[: COLUMNS - self._column]
        self._rows[self._line] = row[: self._column] + shown + row[self._column + len(shown) :]
        self._column = min(self._column + len(shown), COLUMNS - 1)

    def hold(self, key: str, *, held: bool) -> None:
        """An arrow key goes down, or up again."""
        if held:
            self._held.add(key)
        else:
            self._held.discard(key)

    def jog_direction(self, axis_index: int) -> int:
        """What the arrow keys held now ask of an axis: +1, -1 or 0."""
        return sum(
            direction for key, (axis, direction) in ARROW_KEYS.items() if key in self._held and axis == axis_index
        )

    def press_function_key(self, key: str) -> None:
        """F1 to F6: remembered, and handed to a DREADF that waits."""
        self.function_key = FUNCTION_KEYS[key]
        waiting, self.on_function_key = self.on_function_key, None
        if waiting is not None:
            waiting(self.function_key)

    def press_entry_key(self, key: str) -> None:
        """A key of the number pad; ENTER hands the number to a DREAD that waits."""
        if key == "ENTER":
            self._finish_entry()
        elif key == "C/E":
            self._show_entry("")
        elif key == "+/-":
            self._show_entry(self._entry[1:] if self._entry.startswith("-") else "-" + self._entry)
        elif len(self._entry) < LONGEST_ENTRY and not (key == "." and "." in self._entry):
            self._show_entry(self._entry + key)

    def _show_entry(self, entry: str) -> None:
        """Write what has been keyed in where the cursor stands."""
        column = self._column
        self.write(entry.ljust(len(self._entry)))
        self._column, self._entry = column, entry

    def _finish_entry(self) -> None:
        entry, self._entry = self._entry, ""
        if not entry.strip("-."):
            return
        self.entered_number = entry
        waiting, self.on_number = self.on_number, None
        if waiting is not None:
            waiting(entry)
