"""The tree of pages is complete and clean, what is written is safe Markdown, and a warning of Sphinx is an error."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt

from documentation import site
from documentation.markdown import code, page, plain, table
from documentation.python_api import prose


def shown(text: str) -> str:
    """What a reader sees of one paragraph of Markdown."""
    inline = MarkdownIt().parse(text)[1]
    assert inline.children is not None
    return "".join(token.content for token in inline.children)


@given(st.text(st.characters(min_codepoint=33, max_codepoint=126), min_size=1))
def test_plain_text_is_shown_as_it_stands(text: str) -> None:
    assert shown("x " + plain(text)) == "x " + text


@given(st.text(st.characters(min_codepoint=33, max_codepoint=126), min_size=1))
def test_code_is_shown_as_it_stands(text: str) -> None:
    assert shown("x " + code(text)) == "x " + text


def test_bars_in_cells() -> None:
    html = MarkdownIt().enable("table").render(table(("a", "b"), [(code("x|y"), plain("p|q"))]))
    assert "<code>x|y</code>" in html
    assert "<td>p|q</td>" in html


def test_a_docstring_keeps_its_code_and_its_sections() -> None:
    text = prose("Sends `1TPE`, gets *1TPE.\n\nArgs:\n    name: which\n        of them.\n    other: ``x``.")
    assert "`1TPE`, gets \\*1TPE." in text
    assert "- name: which of them." in text
    assert "- other: `x`." in text


@pytest.fixture
def pages(tmp_path: Path) -> Path:
    folder = tmp_path / "docs"
    folder.mkdir()
    (folder / "index.md").write_text("# S\n\n```{toctree}\n\none\n```\n")
    (folder / "one.md").write_text("# One\n")
    return folder


def test_a_second_run_changes_nothing_but_what_has_changed(pages: Path, tmp_path: Path) -> None:
    target = tmp_path / "pages"
    site.assemble(target, pages)
    before = {path: path.stat().st_mtime_ns for path in target.rglob("*.md")}
    (target / "left.md").write_text("# of a page that is gone\n")
    (pages / "one.md").write_text("# One, changed\n")
    site.assemble(target, pages)
    after = {path: path.stat().st_mtime_ns for path in target.rglob("*.md")}
    assert after.keys() == before.keys()
    assert [path.name for path in after if after[path] != before[path]] == ["one.md"]
    assert (target / "reference" / "commands.md").exists()


def test_a_written_page_in_the_place_of_a_generated_one_is_refused(pages: Path, tmp_path: Path) -> None:
    (pages / "reference").mkdir()
    (pages / "reference" / "errors.md").write_text("# mine\n")
    with pytest.raises(ValueError, match=r"reference/errors\.md"):
        site.assemble(tmp_path / "pages", pages)


def small_site(folder: Path, text: str) -> int:
    folder.mkdir()
    (folder / "index.md").write_text(page("S", text))
    return site.build(folder, folder.parent / "html")


def test_it_is_built(tmp_path: Path) -> None:
    assert small_site(tmp_path / "pages", "```oem6250\n> 1TPE\n*1TPE+0\n```") == 0
    html = (tmp_path / "html" / "index.html").read_text()
    assert '<span class="gp">&gt; </span>' in html
    for loaded in ('src="http', 'href="http'):
        assert f"<script {loaded}" not in html and f'<link rel="stylesheet" {loaded}' not in html


def test_a_warning_is_an_error(tmp_path: Path) -> None:
    assert small_site(tmp_path / "pages", "[nowhere](absent.md)") != 0
