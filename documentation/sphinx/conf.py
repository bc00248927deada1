"""Sphinx's configuration. Nothing here needs a network, neither to build the site nor to read it."""

import sys
from pathlib import Path

from pygments.lexers import TextLexer, TOMLLexer
from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from documentation.lexer import SixThousandLexer
from emulator import __version__

project = "oem6250"
author = "the oem6250 authors"
version = release = __version__

extensions = ["myst_parser"]
myst_heading_anchors = 4

html_theme = "furo"
html_title = "oem6250"
html_show_sourcelink = False
html_copy_source = False


def setup(app: Sphinx) -> None:
    """The languages of code blocks that are ours."""
    app.add_lexer("oem6250", SixThousandLexer)
    app.add_lexer("recording", TextLexer)
    app.add_lexer("state", TOMLLexer)
    app.add_lexer("terminal", TextLexer)
