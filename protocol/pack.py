"""Packs the catalogue's TOML files into the one JSON file the program reads.

People read and change the TOML under ``catalogue_data/``; reading its 380 rows takes a tenth of a whole start, JSON a
hundredth.  After a change run

    python -m protocol.pack

(a test compares the two).
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

FOLDER = Path(__file__).parent / "catalogue_data"
PACKED = FOLDER / "packed.json"

TABLES = {
    "status_words": "status_words.toml",
    "error_messages": "error_messages.toml",
    "other_products": "other_products.toml",
    "io_functions": "io_functions.toml",
}
"""The files that hold something else than commands."""


def pack() -> str:
    """The packed catalogue: every command with its group (the name of its file), and the other tables."""
    packed: dict[str, object] = {key: _read(FOLDER / name) for key, name in TABLES.items()}
    packed["commands"] = [
        {**row, "group": path.stem}
        for path in sorted(FOLDER.glob("*.toml"))
        if path.name not in TABLES.values()
        for row in _read(path)["command"]
    ]
    return json.dumps(packed, ensure_ascii=False, indent=0, sort_keys=True) + "\n"


def _read(path: Path) -> dict[str, list[dict[str, object]]]:
    return tomllib.loads(path.read_text("utf-8"))


if __name__ == "__main__":
    PACKED.write_text(pack(), encoding="utf-8")
