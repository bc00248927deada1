"""What an action or a fault of the control surface takes: values by name, each declared with its type and unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

Value = float | int | bool | str


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter: its type and, for numbers, its unit; with a default it may be left out."""

    name: str
    kind: type
    sentence: str
    unit: str = ""
    default: Value | None = None


def checked(owner: str, parameters: Sequence[Parameter], values: Mapping[str, Value]) -> dict[str, Value]:
    """The values with the defaults filled in, in the order in which the parameters are declared.

    Raises:
        KeyError: a parameter is missing or unknown.
        TypeError: a parameter has the wrong type.
    """
    filled = {each.name: each.default for each in parameters if each.default is not None} | dict(values)
    names = [each.name for each in parameters]
    if set(filled) != set(names):
        raise KeyError(f"{owner} takes {', '.join(names) or 'nothing'}, not {', '.join(values) or 'nothing'}")
    for each in parameters:
        value = filled[each.name]
        fits = isinstance(value, (int, float) if each.kind is float else each.kind)
        if not fits or (isinstance(value, bool) and each.kind is not bool):
            raise TypeError(f"{owner}: {each.name} must be {each.kind.__name__}, not {value!r}")
    return {name: filled[name] for name in names}
