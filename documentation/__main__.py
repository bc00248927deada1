"""`python -m documentation [FOLDER]`: put the pages together and build the site (default: build/docs)."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from documentation.site import REPOSITORY, assemble, build


def main(arguments: Sequence[str]) -> int:
    """Build the site in a folder; the exit status."""
    folder = (Path(arguments[0]) if arguments else REPOSITORY / "build" / "docs").resolve()
    assemble(folder / "pages")
    status = build(folder / "pages", folder / "html")
    if status == 0:
        print(f"the site: {folder / 'html' / 'index.html'}")
    return status


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
