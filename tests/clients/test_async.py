"""The asyncio face. Its core is the blocking one's; here is what differs: surface, tasks, cancelled waits, threads."""

from __future__ import annotations

import asyncio
import inspect

import pytest

from clients import OEM6250, AsyncOEM6250, Gains, InDefinition, LineLost, NoAnswer, UnitError
from clients.async_lines import DirectLine, ThreadedLine
from clients.blocking import Axis, Programs, Status
from clients.typed.blocking import UnitActions, UnitReports, UnitSettings
from tests.clients.peers import EmulatedLine, FamilyUnit, ScriptedLine


def client(line: EmulatedLine | ScriptedLine, **options: object) -> AsyncOEM6250:
    return AsyncOEM6250(DirectLine(line), **options)  # type: ignore[arg-type]


async def test_typed_commands_motion_programs_variables() -> None:
    async with client(EmulatedLine()) as ctl:
        axis = ctl.axis[1]
        await axis.set_velocity(5.0)
        assert await axis.get_velocity() == 5.0
        with pytest.raises(UnitError, match="DRIVE SHUTDOWN"):
            await axis.move_to(4000)
        await axis.set_drive_enabled(True)
        await axis.move_to(4000, velocity=10, acceleration=200)
        assert await axis.get_commanded_position() == 4000
        assert (await ctl.status.axis(1)).in_target_zone
        await axis.move_by(-100)
        await axis.jog(2)
        await axis.stop(wait=True)
        await ctl.var.set(1, 2.5)
        await ctl.varb.set(1, 3)
        await ctl.vars.set(1, "x")
        assert (float(await ctl.var.get(1)), (await ctl.varb.get(1))[:3], await ctl.vars.get(1)) == (2.5, "110", "x")
        await axis.set_continuous_motion(False)
        await ctl.programs.download("HELLO", ['WRITE"HELLO"', "T0.2"])
        await ctl.programs.run("HELLO", wait=True)
        assert (await ctl.take_output()).endswith("HELLO")
        assert await ctl.programs.exists("hello")
        await axis.set_gains(Gains(1, 2, 3, 4, 5, 6))
        assert (await axis.get_gains()).velocity == 3
        await ctl.stop()


async def test_synchronises_as_the_blocking_face_does() -> None:
    line = EmulatedLine()
    line.unit.send(b"ECHO0:ERRLVL1:DEF HALF\r")
    with pytest.raises(InDefinition):
        await client(line).connect()
    async with client(line, end_definition=True, error_level=4) as ctl:
        assert ctl.changed == ("END", "ERRLVL4")
        await ctl.check()


async def test_many_tasks_share_a_line() -> None:
    async with client(FamilyUnit(values={f"1{name}": "+5" for name in ("TPE", "TPC")}).line()) as ctl:

        async def ask(name: str) -> set[str]:
            return {await ctl.query(f"1{name}") for _ in range(50)}

        assert await asyncio.gather(ask("TPE"), ask("TPC"), ask("TPE")) == [{"+5"}] * 3


async def test_a_move_waited_for_can_be_stopped_by_another_task() -> None:
    async with client(EmulatedLine()) as ctl:
        await ctl.axis[1].set_drive_enabled(True)
        waiting = asyncio.ensure_future(ctl.axis[1].move_to(4_000_000, velocity=1, timeout_s=100))
        await asyncio.sleep(0)
        while not (await ctl.status.axis(1)).moving:
            await asyncio.sleep(0)
        await ctl.axis[1].stop()
        await waiting
        assert await ctl.axis[1].get_commanded_position() < 4_000_000


async def test_a_cancelled_wait_spoils_nothing() -> None:
    unit = FamilyUnit(values={"1TPE": "+5", "1TPC": "+6"})
    async with AsyncOEM6250(ThreadedLine(Slow(unit))) as ctl:
        asking = asyncio.ensure_future(ctl.query("1TPC"))
        await asyncio.sleep(0.003)  # until the wait to be cancelled has begun, in a thread on the wall clock
        asking.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asking
        assert await ctl.query("1TPE") == "+5"


class Slow(ScriptedLine):
    """Takes a little of the wall's time to read, so that there is something to cancel."""

    def __init__(self, unit: FamilyUnit) -> None:
        super().__init__(unit.answer)

    def read(self, timeout_s: float) -> bytes:
        import time

        time.sleep(0.01)  # a blocking line blocks: that is what the thread is for
        return super().read(timeout_s)


async def test_no_answer_and_nobody_there() -> None:
    with pytest.raises(NoAnswer, match="is it the unit's port"):
        await client(ScriptedLine(lambda data: [])).connect()
    with pytest.raises(LineLost, match="reconnect"):
        await AsyncOEM6250.open("tcp://127.0.0.1:1")
    with pytest.raises(ValueError, match="tcp://host:port"):
        await AsyncOEM6250.open("tcp://nowhere")


async def test_over_tcp_a_lost_connection_is_told() -> None:
    unit = FamilyUnit(values={"1TPE": "+5"})

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while (data := await reader.read(1000)) and b"TPC" not in data:
            for _, part in unit.answer(data):
                writer.write(part)
        writer.close()
        await writer.wait_closed()

    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    async with server:
        port = server.sockets[0].getsockname()[1]
        async with await AsyncOEM6250.open(f"tcp://127.0.0.1:{port}") as ctl:
            assert await ctl.axis[1].get_position() == 5
            with pytest.raises(LineLost, match="closed the connection"):
                await ctl.axis[1].get_commanded_position()


@pytest.mark.parametrize("blocking", [OEM6250, Axis, Programs, Status, UnitSettings, UnitReports, UnitActions])
def test_both_faces_have_the_same_surface(blocking: type) -> None:
    import clients.asynchronous
    import clients.awaitable
    import clients.typed.awaitable as typed

    here = {"OEM6250": AsyncOEM6250, "Axis": clients.awaitable.AsyncAxis}
    name = blocking.__name__
    other = here.get(name) or getattr(clients.awaitable, name, None) or getattr(typed, name)
    names = {
        f"get_{name}" if isinstance(inspect.getattr_static(blocking, name), property) else name
        for name in dir(blocking)
        if not name.startswith("_")
    }
    plain = {"get_changed": "changed", "get_number": "number", "locked": "open"}
    missing = {plain.get(name, name) for name in names} - set(dir(other))
    assert missing == set()
