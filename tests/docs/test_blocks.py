"""Every code block of the pages is run, or says why it cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs import running, screen
from tests.docs.blocks import Block, blocks_in, blocks_of, pages

BLOCKS = [block for page in pages() for block in blocks_of(page)]
RUN = [block for block in BLOCKS if not block.has("none:")]

NOT_RUN_AT_MOST = 30
"""Blocks that need what a test machine has not: other people's programs, root, a container engine, Windows."""


# pyserial's RFC 2217 client, which examples use, has not kept up with Python.
@pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")
@pytest.mark.parametrize("block", RUN, ids=lambda block: block.place)
def test_block(block: Block, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    if block.language not in running.RUNNERS:
        pytest.fail(f"{block.place}: no test for {block.language or 'a block without a language'!r}; see blocks.py")
    before = [other for other in blocks_of(block.page) if other.line < block.line]
    running.run(block, before, tmp_path, request)


def test_few_blocks_are_not_run(record_property: pytest.RecordProperty) -> None:
    reasons = [f"{block.place}: {block.values('none:')[0]}" for block in BLOCKS if block.has("none:")]
    record_property("blocks not run", reasons)
    print("\n".join(reasons))
    assert len(reasons) <= NOT_RUN_AT_MOST, "\n".join(reasons)


def test_a_comment_that_says_nothing_is_noticed() -> None:
    for comment in ("none:", "servre", "unit; whatever"):
        with pytest.raises(ValueError, match="no instruction"):
            blocks_in(f"<!-- test: {comment} -->\n```sh\nls\n```\n", Path("p.md"))


@pytest.mark.parametrize(
    "session",
    [
        "> 1TPE\n*1TPE+1\n",
        "> 1TPE\n",
        "> ECHO0\n> XYZZY\n*UNDEFINED LABEL\n> V1\n",
        "DRIVE11\nXYZZY\n",
    ],
)
def test_a_wrong_session_is_noticed(session: str) -> None:
    with pytest.raises(screen.WrongScreen):
        screen.play(session)


@pytest.mark.parametrize(
    ("language", "text"),
    [
        ("python", "assert False"),
        ("python", ">>> 1 + 1\n3\n"),
        ("sh", "oem6250 check absent.toml\ntrue"),
        ("sh", "oem6250 serve --units 0"),
        ("console", "$ echo yes\nno\n"),
        ("toml", "[servo]\ndac_bit = 12\n"),
        ("recording", 'oem6250 recording 1\nsource = "line"\nbegin\n0.1 > "1TPE\\r"\n0.2 < "*1TPE+9\\r\\r\\n> "\n'),
    ],
)
def test_a_wrong_block_is_noticed(language: str, text: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    block = Block(Path(__file__), 1, language, text, {})
    with pytest.raises((AssertionError, ValueError)):
        running.run(block, [], tmp_path, request)
