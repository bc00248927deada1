"""The code blocks of the README and of docs/, and what the comment before each says about running it.

A page is written for people; what a test must know stands in an HTML comment before the block, which no reader sees:

    <!-- test: server; with axis.toml -->

Instructions, separated by semicolons:

    server [M.toml] [N]  Python: an emulator on real ports, of this machine file, of so many units in a chain
    rmc M.toml        Python, sh: an emulated RMC151 of this machine file on port 1502, in virtual time
    unit              Python: `emu`, an `Emulator`, and its first `unit`
    pytest            Python: a test module, with the fixtures of our plugin
    continues         Python: after the block of Python before it on the page, in the same names; doctests
                      always go on from the doctests before them
    with NAME NAME    run in a folder in which these files are; see material.py
    file NAME         this block is the text of a file that later blocks of the page use; run as its language says
    needs PROGRAM     sh: skipped where this program of other people is not installed
    status N          console: the last command ends with this exit status
    say A => B        run with B in place of A: a smaller job, a place that exists here
    machine TEXT      oem6250: lines of a machine file, separated by |
    none: REASON      cannot be run here, and why
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from markdown_it import MarkdownIt
from markdown_it.token import Token

REPOSITORY: Final = Path(__file__).resolve().parents[2]
_COMMENT: Final = re.compile(r"<!--\s*test:\s*(.*?)\s*-->", re.DOTALL)
_WORDS: Final = (
    "server", "rmc", "unit", "pytest", "continues", "with", "file", "needs", "status", "say", "machine", "none:"
)  # fmt: skip
_NEXT: Final = re.compile(rf";\s*(?={'|'.join(_WORDS)})")
"""What parts two instructions; a reason may have semicolons of its own."""


@dataclass(frozen=True, slots=True)
class Block:
    """A block with where it stands, its language and its instructions (word -> what follows it, a list)."""

    page: Path
    line: int
    language: str
    text: str
    instructions: dict[str, list[str]]

    @property
    def place(self) -> str:
        return f"{self.page.relative_to(REPOSITORY)}:{self.line}"

    def has(self, word: str) -> bool:
        return word in self.instructions

    def values(self, word: str) -> list[str]:
        return self.instructions.get(word, [])


def pages() -> list[Path]:
    """The README and every page of docs/."""
    return [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]


def blocks_of(page: Path) -> list[Block]:
    """Every block of a page, in order."""
    return blocks_in(page.read_text(encoding="utf-8"), page)


def blocks_in(text: str, page: Path) -> list[Block]:
    """Every block of the text of a page but directives of the site; ValueError for an instruction that is none."""
    return list(_blocks(MarkdownIt().parse(text), page))


def _blocks(tokens: Sequence[Token], page: Path) -> Iterator[Block]:
    comment = ""
    for token in tokens:
        if token.type == "html_block" and (found := _COMMENT.search(token.content)):
            comment = found[1]
        elif token.type in ("fence", "code_block") and not token.info.startswith("{"):
            assert token.map is not None
            line = token.map[0] + 1
            yield Block(page, line, token.info.strip(), token.content, _instructions(comment, f"{page.name}:{line}"))
            comment = ""


def _instructions(comment: str, place: str) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for part in filter(None, (part.strip() for part in _NEXT.split(comment))):
        word, _, rest = part.partition(" ")
        if word not in _WORDS or (word == "none:" and not rest):
            raise ValueError(f"{place}: {part!r} is no instruction; see tests/docs/blocks.py")
        found.setdefault(word, []).append(rest.strip())
    return found
