"""The service file and the container file say things our own command line understands, and agree with themselves."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest

from emulator.cli import parse_serve_options
from emulator.options import ServeOptions

REPOSITORY = Path(__file__).resolve().parents[2]
SERVICE = (REPOSITORY / "hosting" / "oem6250.service").read_text(encoding="utf-8")
DOCKERFILE = (REPOSITORY / "Dockerfile").read_text(encoding="utf-8")
PROGRAM = "/opt/oem6250/bin/oem6250"


def service(key: str) -> list[str]:
    """The values of a key of the service file."""
    return re.findall(rf"^{key}=(.*)$", SERVICE, re.MULTILINE)


def served_by_the_service() -> ServeOptions:
    program, *arguments = shlex.split(service("ExecStart")[0])
    assert program == PROGRAM
    return parse_serve_options(arguments)


def served_by_the_container() -> ServeOptions:
    found = re.search(r"^CMD (\[.*\])$", DOCKERFILE, re.MULTILINE)
    assert found is not None
    return parse_serve_options(json.loads(found[1]))


class TestService:
    def test_its_command_line_is_ours(self) -> None:
        options = served_by_the_service()
        assert options.tcp == (("127.0.0.1", 6250),)
        assert not options.allow_remote

    def test_it_writes_only_where_it_may(self) -> None:
        options = served_by_the_service()
        assert (service("RuntimeDirectory"), service("StateDirectory")) == (["oem6250"], ["oem6250"])
        assert options.pty is not None and Path(options.pty).parent == Path("/run/oem6250")
        assert options.announce is not None and Path(options.announce).parent == Path("/run/oem6250")
        assert options.state is not None and Path(options.state).parent == Path("/var/lib/oem6250")
        assert service("Environment") == ["OEM6250_CACHE_DIR=/var/cache/" + service("CacheDirectory")[0]]

    def test_the_machine_file_is_checked_first_and_reloaded(self) -> None:
        machine = served_by_the_service().machine
        assert service("ExecStartPre") == [f"{PROGRAM} check {machine}"]
        assert service("ExecReload") == ["/bin/kill -HUP $MAINPID"]

    def test_a_users_mistake_is_not_tried_again_and_again(self) -> None:
        assert service("Restart") == ["on-failure"]
        assert service("RestartPreventExitStatus") == ["2"]

    def test_machine_code_may_be_made(self) -> None:
        assert service("MemoryDenyWriteExecute") == []


class TestContainer:
    def test_its_command_line_is_ours(self) -> None:
        options = served_by_the_container()
        assert options.tcp == (("0.0.0.0", 6250),)
        assert options.allow_remote and options.pty is None and options.machine is None
        assert re.findall(r"^EXPOSE (.*)$", DOCKERFILE, re.MULTILINE) == ["6250"]

    def test_what_it_keeps_lies_in_a_volume(self) -> None:
        found = re.search(r"^VOLUME (\[.*\])$", DOCKERFILE, re.MULTILINE)
        state = served_by_the_container().state
        assert found is not None and state is not None
        assert str(Path(state).parent) in json.loads(found[1])
        assert "OEM6250_CACHE_DIR=/var/cache/oem6250" in DOCKERFILE and "/var/cache/oem6250" in json.loads(found[1])

    def test_it_does_not_run_as_root(self) -> None:
        after = DOCKERFILE[DOCKERFILE.index("\nUSER oem6250\n") :]
        assert "ENTRYPOINT" in after and "USER root" not in after

    @pytest.mark.parametrize("name", re.findall(r"^COPY (?!--from)(.*) \S+$", DOCKERFILE, re.MULTILINE))
    def test_what_it_copies_is_there_and_not_ignored(self, name: str) -> None:
        ignored = (REPOSITORY / ".dockerignore").read_text(encoding="utf-8").splitlines()
        for part in name.split():
            assert (REPOSITORY / part).exists()
            assert f"!{part}" in ignored
