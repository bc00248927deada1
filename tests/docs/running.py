"""How a block of each language is run: a runner raises what the block raises, or AssertionError with what is wrong."""

from __future__ import annotations

import ast
import asyncio
import doctest
import inspect
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, chdir
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final

import pytest

from clients.testing import EmulatedRmc, Served, served
from emulator import Emulator, Machine
from tests.docs import screen, terminal
from tests.docs.blocks import Block
from tests.docs.material import lay_out
from tests.docs.shell import Shell

FLAGS: Final = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
PORT: Final = re.compile(r"\b6250\b")
RMC_PORT: Final = re.compile(r"\b1502\b")
POLL_S: Final = 0.05
"""What each request of a master lets pass: these pause between their polls."""
SERIAL_PORT: Final = "/tmp/oem6250"
"""The virtual serial port of the examples (`--pty /tmp/oem6250`)."""


def run(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    """Run a block of a page in a folder; `before` are the blocks above it."""
    for other in before:
        for name in other.values("file"):
            (folder / name).write_text(other.text, encoding="utf-8")
    for names in block.values("with"):
        lay_out(folder, names)
    RUNNERS[block.language](_with_says(block), before, folder, request)


def _with_says(block: Block) -> Block:
    text = block.text
    for said in block.values("say"):
        shown, _, meant = (part.strip() for part in said.partition("=>"))
        assert shown in text, f"{block.place}: {shown!r} is not in the block"
        text = text.replace(shown, meant)
    return replace(block, text=text)


# Python


def _python(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    if block.has("pytest"):
        _pytest(block.text, folder, request)
        return
    with ExitStack() as stack:
        stack.enter_context(chdir(folder))
        names = _names(block, stack)
        place = _place_of_rmc(block, stack)
        texts = [_with_says(each).text for each in _continued(block, before)]
        for text in (*texts, block.text):
            _execute(place(_placed(text, names)), names, block)


def _pytest(text: str, folder: Path, request: pytest.FixtureRequest) -> None:
    """Run a test module with the plugin of this package alone."""
    Emulator()  # pytester gives the process another home, where no compiled kernel is kept; so it is loaded before
    pytester: pytest.Pytester = request.getfixturevalue("pytester")
    request.getfixturevalue("monkeypatch").setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    pytester.makepyfile(test_block=text)
    shutil.copytree(folder, pytester.path, dirs_exist_ok=True)
    result = pytester.runpytest_inprocess("-p", "no:cacheprovider", "-p", "clients.pytest_plugin")
    assert result.ret == 0, result.stdout.str()


def _continued(block: Block, before: Sequence[Block]) -> list[Block]:
    """The blocks a block goes on from, first to last: for doctests the earlier doctests of the page."""
    if not block.has("continues") and not is_doctest(block):
        return []
    alike = [place for place, each in enumerate(before) if _may_precede(each, block)]
    if not alike:
        return []
    earlier = before[alike[-1]]
    return [*_continued(earlier, before[: alike[-1]]), earlier]


def is_doctest(block: Block) -> bool:
    """Whether a block of Python is a session with an interpreter."""
    return block.text.lstrip().startswith(">>> ")


def _may_precede(earlier: Block, block: Block) -> bool:
    if earlier.language != "python" or earlier.has("none:"):
        return False
    return block.has("continues") or is_doctest(earlier)


def _names(block: Block, stack: ExitStack) -> dict[str, Any]:
    names: dict[str, Any] = {"__name__": "__main__"}
    if block.has("unit"):
        names["emu"] = stack.enter_context(Emulator())
        names["unit"] = names["emu"].unit(0)
    if block.has("server"):
        names["server"] = stack.enter_context(_served(block.values("server")[0].split()))
    return names


def _served(words: Sequence[str]) -> AbstractContextManager[Served]:
    """A server of the named machine file and number of units."""
    machine = next((word for word in words if word.endswith(".toml")), None)
    chain = next((int(word) for word in words if word.isdigit()), 1)
    return served(None if machine is None else Machine.load(machine), chain=chain)


def _place_of_rmc(block: Block, stack: ExitStack) -> Callable[[str], str]:
    """What puts the port of the RMC that a block asks for in place of the one it names."""
    if not block.has("rmc"):
        return str
    _, port = stack.enter_context(EmulatedRmc(Path(block.values("rmc")[0]))).serve(request_s=POLL_S)
    return partial(RMC_PORT.sub, str(port))


def _placed(text: str, names: Mapping[str, Any]) -> str:
    """The text with the ports of the running server in place of those it names."""
    if "server" not in names:
        return text
    server = names["server"]
    return PORT.sub(str(server.address[1]), text.replace(SERIAL_PORT, server.port))


def _execute(text: str, names: dict[str, Any], block: Block) -> None:
    if text.lstrip().startswith(">>> "):
        _doctest(text, names, block)
        return
    code = compile(text, block.place, "exec", flags=ast.PyCF_ALLOW_TOP_LEVEL_AWAIT)
    result = eval(code, names)
    if inspect.iscoroutine(result):
        asyncio.run(result)


def _doctest(text: str, names: dict[str, Any], block: Block) -> None:
    examples = doctest.DocTestParser().get_doctest(text, names, block.place, str(block.page), block.line)
    said: list[str] = []
    runner = doctest.DocTestRunner(optionflags=FLAGS, verbose=False)
    runner.run(examples, out=said.append, clear_globs=False)
    names.update(examples.globs)
    assert runner.summarize(verbose=False).failed == 0, "".join(said)


# Other languages


def _shell(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    for program in block.values("needs"):
        # Meant: such programs come with the system, not from the package index.
        if shutil.which(program) is None:
            pytest.skip(f"{program} is not installed")
    with ExitStack() as stack:
        stack.enter_context(chdir(folder))
        place = _place_of_rmc(block, stack)
        stack.enter_context(Shell(folder)).run_script(place(block.text))


def _terminal(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    with served() as server:
        text = _placed(block.text, {"server": server})
        shown = terminal.play(text, server.tcp_url, folder / "history")
    assert doctest.OutputChecker().check_output(text, f"{shown}\n", FLAGS), shown


def _console(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    """Each `$ command` with what it prints; all end with 0 but the last may be said to end with another status."""
    commands = list(_commands(block.text))
    wanted_status = int(next(iter(block.values("status")), "0"))
    with Shell(folder) as shell:
        for command, wanted in commands:
            status, got = shell.run_command(command)
            expected = wanted_status if command == commands[-1][0] else 0
            assert status == expected, f"{command!r} ended with {status}: {got}"
            if wanted.strip():
                assert doctest.OutputChecker().check_output(wanted, got, FLAGS), f"{command!r} printed\n{got}"


def _commands(text: str) -> Iterator[tuple[str, str]]:
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, output = part.partition("\n")
        yield command, output


def _toml(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    Machine.parse(block.text, name=block.place)


def _session(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    screen.play(block.text, "\n".join(line for text in block.values("machine") for line in text.split("|")))


def _c(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    # Meant: a C compiler is a program of the system, not of the package index.
    if (compiler := shutil.which("cc")) is None:
        pytest.skip("no C compiler here")
    options = ["-std=c11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-x", "c", "-"]
    result = subprocess.run([compiler, *options], input=block.text, text=True, capture_output=True, check=False)
    assert result.returncode == 0, result.stderr


def _state(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    """The text of a state file: an empty state takes it, and gives it back as it is."""
    (folder / "block.toml").write_text(block.text, encoding="utf-8")
    with Shell(folder) as shell:
        shell.run_script("oem6250 state block.state import block.toml")
        status, text = shell.run_command("oem6250 state block.state export -")
    kept = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    assert (status, kept.strip()) == (0, block.text.strip())


def _recording(block: Block, before: Sequence[Block], folder: Path, request: pytest.FixtureRequest) -> None:
    from emulator.recording import replay

    (folder / "block.rec").write_text(block.text, encoding="utf-8")
    assert replay(folder / "block.rec").difference is None


RUNNERS: Final[Mapping[str, Callable[[Block, Sequence[Block], Path, pytest.Pytester], None]]] = {
    "python": _python,
    "sh": _shell,
    "console": _console,
    "toml": _toml,
    "oem6250": _session,
    "terminal": _terminal,
    "c": _c,
    "state": _state,
    "recording": _recording,
}
"""Language of a block -> what runs it."""
