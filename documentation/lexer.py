"""Colours for sessions in the 6000 language, as the blocks marked `oem6250` hold them."""

from __future__ import annotations

from typing import Any, ClassVar

from pygments.lexer import RegexLexer, bygroups
from pygments.token import Comment, Generic, Keyword, Number, Operator, String, Text


class SixThousandLexer(RegexLexer):
    """Lines typed behind a prompt, replies beginning with a star, and programs without either."""

    name = "6000 Series"
    aliases: ClassVar[list[str]] = ["oem6250"]
    tokens: ClassVar[dict[str, list[Any]]] = {
        "root": [
            (r"^([>?-]) ", Generic.Prompt),
            (r"^(\*.*)(\n)", bygroups(Generic.Output, Text)),
            (r";.*", Comment.Single),
            (r'"[^"\n]*"?', String),
            (r"[@!:=,()<>+\-/&|^~.]", Operator),
            (r"[A-Z$_a-z]+", Keyword),
            (r"\d+", Number),
            (r"\s+", Text),
            (r".", Text),
        ]
    }
