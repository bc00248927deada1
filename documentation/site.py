"""The tree of pages that Sphinx reads, put together in a build folder, and the run of Sphinx itself."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Final

from documentation import commands, machine_file, python_api, replies, surface

REPOSITORY: Final = Path(__file__).resolve().parents[1]
PAGES: Final = REPOSITORY / "docs"
CONFIGURATION: Final = Path(__file__).parent / "sphinx"
REFERENCE: Final = "reference"
"""The folder of the generated pages, beside the written ones."""


@cache
def generated_pages() -> Mapping[str, str]:
    """File name -> text of every page of the reference folder."""
    groups = commands.pages()
    return {
        "commands.md": commands.index(list(groups)),
        **groups,
        "status-words.md": replies.status_page(),
        "errors.md": replies.errors_page(),
        "io-functions.md": replies.io_page(),
        "machine-file.md": machine_file.reference(),
        "control-surface.md": surface.reference(),
        "python.md": python_api.reference(),
    }


def assemble(target: Path, pages: Path = PAGES) -> None:
    """Make `target` the tree of all pages: the written ones copied, the generated ones beside them.

    A page that has not changed keeps its time, so that Sphinx reads only what has.
    """
    generated = {Path(REFERENCE, name): text for name, text in generated_pages().items()}
    written = {path.relative_to(pages) for path in pages.rglob("*") if path.is_file()}
    if clash := written & generated.keys():
        raise ValueError(f"{min(clash)} is a generated page; {pages} must not have one of that name")
    _remove_others(target, written | generated.keys())
    for name in sorted(written):
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(pages / name, target / name)
    _write_changed(target, generated)


def _remove_others(target: Path, wanted: set[Path]) -> None:
    for path in list(target.rglob("*")):
        if path.is_file() and path.relative_to(target) not in wanted:
            path.unlink()


def _write_changed(target: Path, texts: Mapping[Path, str]) -> None:
    for name, text in texts.items():
        path = target / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def build(source: Path, out: Path) -> int:
    """Have Sphinx make the site in `out`; its exit status. A warning is an error."""
    options = ["--builder", "html", "--fail-on-warning", "--quiet", "--jobs", "auto", "--conf-dir", str(CONFIGURATION)]
    doctrees = ["--doctree-dir", str(out.with_name(out.name + ".doctrees"))]
    return subprocess.call([sys.executable, "-m", "sphinx", *options, *doctrees, str(source), str(out)], cwd=REPOSITORY)
