"""Links between pages, and from pages to files and headings, lead somewhere."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from markdown_it import MarkdownIt
from markdown_it.token import Token

from tests.docs.blocks import pages


def links_in(text: str) -> Iterator[str]:
    """Targets of the links and pictures of a page."""
    for token in _all(MarkdownIt().parse(text)):
        target = token.attrs.get("href") or token.attrs.get("src")
        if isinstance(target, str):
            yield target


def _all(tokens: list[Token]) -> Iterator[Token]:
    for token in tokens:
        yield token
        yield from _all(token.children or [])


def headings_of(text: str) -> set[str]:
    """The anchors of the headings of a page, as repository browsers and the site make them."""
    tokens = MarkdownIt().parse(text)
    titles = [after.content for token, after in pairwise(tokens) if token.type == "heading_open"]
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def broken(page: Path, text: str) -> list[str]:
    """The links of a page that lead nowhere; those to other places of the net are not followed."""
    found = []
    for target in links_in(text):
        name, _, heading = target.partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        there = page.parent / name if name else page
        if not there.exists() or (heading and heading not in headings_of(there.read_text(encoding="utf-8"))):
            found.append(target)
    return found


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.name)
def test_links(page: Path) -> None:
    assert broken(page, page.read_text(encoding="utf-8")) == []


def test_a_broken_link_is_noticed() -> None:
    page = next(page for page in pages() if page.name == "state.md")
    text = "# One\n[a](absent.md) [b](#two) [c](#one) [d](state.md#the-file) ![e](x.png)"
    assert broken(page, text) == ["absent.md", "#two", "#one", "x.png"]
