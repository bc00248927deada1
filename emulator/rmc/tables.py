"""The machine-file tables of an RMC: what no page confirms about it, and what is set up in its own tool.

`rmc` is the controller, `axisN.rmc` what belongs to an axis; the plant and encoder of an axis are those the OEM6250's
axes have. The file counts axes from 1, the RMC from 0: `axis1` is its axis 0.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from emulator.table_fields import Table, known

HALT_LEVELS = ("status_only", "external_halt", "closed_loop_halt", "open_loop_halt", "direct_output_halt")
HaltLevel = Literal["status_only", "external_halt", "closed_loop_halt", "open_loop_halt", "direct_output_halt"]
ModeCode = Annotated[int, msgspec.Meta(ge=0, le=255)]


class ModeCodes(Table, frozen=True):
    """Codes of Set Pos/Vel Ctrl Mode (68) and of Next Pos/Vel Control Mode."""

    position_pid: Annotated[ModeCode, known("Position PID", "inferred", "M", "codes M840")] = 0
    position_i_pd: Annotated[ModeCode, known("Position I-PD", "inferred", "M", "codes M840")] = 1
    velocity_pid: Annotated[ModeCode, known("Velocity PID", "inferred", "M", "codes M840")] = 4
    velocity_i_pd: Annotated[ModeCode, known("Velocity I-PD", "inferred", "M", "codes M840")] = 5


class Rmc(Table, frozen=True):
    """A Delta RMC75, RMC150 or RMC151."""

    axes: Annotated[int, known("control axes", "design", ge=1, le=8)] = 2
    loop_us: Annotated[Literal[250, 500, 1000, 2000, 4000], known("loop time, us", "assumed", "M", "H Loop_Time")] = (
        1000
    )
    port: Annotated[int, known("Modbus/TCP port", "documented", source="RMC101 p. 428", ge=0, le=65_535)] = 502
    map: Annotated[
        Literal["rmc150", "rmc75"], known("register map; the RMC151 has the RMC150's", "inferred", "H", "H Loop_Time")
    ] = "rmc150"
    word_order: Annotated[
        Literal["low_first", "high_first"],
        known("which half of a register comes first on Modbus", "inferred", "M", "FINS: M453"),
    ] = "low_first"
    mode_codes: Annotated[ModeCodes, known("codes of control modes", "inferred", "M")] = ModeCodes()
    register_names: Annotated[
        dict[str, int], known("status elements that stand elsewhere than assumed, by tag", "assumed", "L")
    ] = msgspec.field(default_factory=dict)
    autostop: Annotated[HaltLevel, known("AutoStop of every error bit at power-up", "documented", source="M1018")] = (
        "direct_output_halt"
    )
    enabled_at_start: Annotated[bool, known("axes are enabled at power-up", "assumed", "M")] = False
    enable_output_follows: Annotated[
        bool, known("commands 7 and 97 turn the Enable Output on with the axis", "assumed", "M")
    ] = True
    output_limit_v: Annotated[float, known("Output Limit, V; its element is unknown", "assumed", "M", gt=0, le=10)] = (
        10.0
    )
    closed_loop_halt_decel: Annotated[
        float, known("Closed Loop Halt Deceleration, pu/s2; its element is unknown", "assumed", "L", gt=0)
    ] = 100.0
    open_loop_halt_ramp: Annotated[
        float, known("Open Loop Halt Ramp, V/s; its element is unknown", "assumed", "L", gt=0)
    ] = 100.0


class RmcAxis(Table, frozen=True):
    """What an RMC knows of one axis beside its parameters."""

    parameters: Annotated[
        dict[str, float], known("parameters at power-up by tag, such as PosScale; docs/rmc.md lists them", "design")
    ] = msgspec.field(default_factory=dict)
    simulate: Annotated[
        Literal["off", "first_order", "second_order"], known("Simulate mode and its model", "design")
    ] = "off"
    high_order: Annotated[
        Literal["none", "acceleration_control", "active_damping"],
        known("what element 69 is: nothing, double differential, or active damping", "design"),
    ] = "none"
    transducer: Annotated[
        Literal["quadrature", "mdt"], known("range of the counts: mdt 0 to 1,048,575", "documented", source="M871")
    ] = "quadrature"
    start_counts: Annotated[int, known("counts where the machine stands at start", "design", ge=-(2**31), lt=2**31)] = 0
    halt_group: Annotated[int, known("axes of a group halt together; 0 = none", "design", ge=0, le=8)] = 0


def rmc_conflicts(rmc: Rmc, axes: tuple[RmcAxis, ...]) -> list[tuple[str, str, str]]:
    """Key, what was found and what is allowed, of values of an RMC that cannot stand together."""
    conflicts = _loop_conflicts(rmc)
    codes = rmc.mode_codes
    if len({codes.position_pid, codes.position_i_pd, codes.velocity_pid, codes.velocity_i_pd}) < 4:
        conflicts.append(("rmc.mode_codes", "two modes with one code", "four different codes"))
    if rmc.register_names or any(axis.parameters for axis in axes):
        conflicts += _tag_conflicts(rmc, axes)
    return conflicts


def _loop_conflicts(rmc: Rmc) -> list[tuple[str, str, str]]:
    most = {250: 1, 500: 2}.get(rmc.loop_us, 8)
    if rmc.axes <= most:
        return []
    return [("rmc.loop_us", str(rmc.loop_us), f"1000 or more with {rmc.axes} axes ({rmc.loop_us} us: {most})")]


def _tag_conflicts(rmc: Rmc, axes: tuple[RmcAxis, ...]) -> list[tuple[str, str, str]]:
    from emulator.machine_errors import nearest
    from protocol.rmc.registers import PARAMETER_BY_TAG, STATUS_BY_TAG

    conflicts = []
    for tag, element in rmc.register_names.items():
        if tag not in STATUS_BY_TAG:
            conflicts.append(
                (f"rmc.register_names.{tag}", str(element), f"a tag such as {nearest(tag, STATUS_BY_TAG)}")
            )
        elif not 0 <= element <= 255:
            conflicts.append((f"rmc.register_names.{tag}", str(element), "an element from 0 to 255"))
    for number, axis in enumerate(axes, start=1):
        for tag, value in axis.parameters.items():
            key, parameter = f"axis{number}.rmc.parameters.{tag}", PARAMETER_BY_TAG.get(tag)
            if parameter is None:
                conflicts.append((key, f"{value:g}", f"a parameter such as {nearest(tag, PARAMETER_BY_TAG)}"))
            elif not parameter.allows(value):
                conflicts.append((key, f"{value:g}", f"{parameter.low:g} to {parameter.high:g} {parameter.unit}"))
    return conflicts
