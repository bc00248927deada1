"""The reference of the public Python names: signatures and docstrings of `clients`, `clients.testing` and `emulator`.

Our docstrings are Markdown already, so they are taken as they stand rather than read as reStructuredText.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator, Sequence
from typing import Any, Final

import clients
import clients.testing
import emulator
from documentation.markdown import page, plain
from emulator.emulator import Unit

_CODE: Final = re.compile(r"(``?)([^`]+)\1")
_LEFT_OUT: Final = {"DEFAULT_PROMPTS", "__version__"}
_SECTIONS: Final = ("Args:", "Raises:", "Returns:", "Yields:")


def reference() -> str:
    """The whole page."""
    return page(
        "Python reference",
        "What a host program or a test imports. The guides: [client library](../client.md), [testing](../testing.md).",
        _module("clients", "For programs that talk to a unit, emulated or physical.", _public(clients)),
        _module("clients.testing", "For tests; the fixture `oem6250` is an `Emulated`, `oem6250_server` a `Served`.",
                _public(clients.testing)),
        _module("emulator", "The units themselves, on a virtual time that moves when told to.",
                [*_public(emulator), ("Unit", Unit)]),
    )  # fmt: skip


def _public(module: Any) -> list[tuple[str, Any]]:
    return [(name, getattr(module, name)) for name in module.__all__ if name not in _LEFT_OUT]


def _module(name: str, sentence: str, members: Sequence[tuple[str, Any]]) -> str:
    return "\n\n".join([f"## {name}", sentence, *(_entry(member, thing) for member, thing in members)])


def _entry(name: str, thing: Any) -> str:
    head = f"### {name}"
    signature = f"`{name}{_signature(thing)}`" if callable(thing) else ""
    parts = [head, signature, prose(inspect.getdoc(thing) or "")]
    if inspect.isclass(thing):
        parts += ["\n".join(_members(thing))]
    return "\n\n".join(part for part in parts if part)


def _members(thing: type) -> Iterator[str]:
    """Methods and properties the class declares itself, or inherits from a class of ours that is not public."""
    for name, member in inspect.getmembers(thing):
        declared = next((base for base in thing.__mro__ if name in vars(base)), object)
        if name.startswith("_") or not declared.__module__.startswith(("clients", "emulator")):
            continue
        first = (inspect.getdoc(member) or "").partition("\n\n")[0]
        if first and (callable(member) or isinstance(member, property)):
            yield f"- `{name}{_signature(member) if callable(member) else ''}`: {prose(first)}"


def _signature(thing: Any) -> str:
    """The parameters as they are written, types included where they are short; nothing where there are none to see."""
    try:
        signature = inspect.signature(thing)
    except (TypeError, ValueError):
        return ""
    kept = [each.replace(annotation=inspect.Parameter.empty) for each in signature.parameters.values()]
    shown = [each for each in kept if each.name not in ("self", "cls")]
    try:
        return str(signature.replace(parameters=shown, return_annotation=inspect.Signature.empty))
    except ValueError:
        return "(...)"


def prose(text: str) -> str:
    """A docstring as Markdown: code spans kept, all else as it stands, sections as paragraphs of their own."""
    paragraphs = re.split(r"\n\s*\n", text)
    return "\n\n".join(_paragraph(each) for each in paragraphs if each.strip())


def _paragraph(text: str) -> str:
    head = text.strip().partition("\n")[0]
    if head in _SECTIONS:
        items = re.split(r"\n    (?=\S)", text.strip())[1:]
        return f"{head}\n\n" + "\n".join(f"- {_spans(item)}" for item in items)
    if text.startswith("    "):
        return "```text\n" + inspect.cleandoc(text) + "\n```"
    return _spans(text)


def _spans(text: str) -> str:
    pieces, end = [], 0
    for found in _CODE.finditer(text):
        pieces += [plain_keeping_ends(text[end : found.start()]), f"`{' '.join(found[2].split())}`"]
        end = found.end()
    return "".join([*pieces, plain_keeping_ends(text[end:])])


def plain_keeping_ends(text: str) -> str:
    """Like `plain`, with a blank at either end where there was white space."""
    if not text.strip():
        return " " if text else ""
    left, right = text[0].isspace(), text[-1].isspace()
    return f"{' ' if left else ''}{plain(text)}{' ' if right else ''}"
