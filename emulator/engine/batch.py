"""Many copies of one engine, each with other gains or another plant, run in one compiled call.

A sweep makes an engine, brings it to where the experiment begins (drive on, profile started, scope armed), copies it,
and changes what differs in whole columns: setting lanes up one call after another would take as long as running them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from .engine import Engine
from .kernels import Records
from .machinery import LOAD_FIELDS
from .memory import Memory
from .plants import Plant
from .trace import Column, Source


class Batch:
    """`count` lanes, each beginning in the state of `template`, which itself is left alone.

    Watches do not act here and events end nothing.
    """

    def __init__(self, template: Engine, count: int) -> None:
        if count < 1:
            raise ValueError(f"a batch has at least one lane, not {count}")
        self.count = count
        self._template = template
        self._memory: Memory = template.memory.replicate(count)
        self._advance = template.kernel.bind_lanes(self._memory, count)
        self._axis_count = len(template.memory.axes)

    @property
    def axes(self) -> Records:
        """The axis records, shape (lanes, axes); assign to whole columns: ``batch.axes["proportional_v"][:, 0] = ...``.

        Fields and units are those of `layout.AXIS_FIELDS`.
        """
        return self._memory.axes.reshape(self.count, self._axis_count)

    def set_plant(self, lane: int, axis_index: int, plant: Plant) -> None:
        """Give one lane another drive and load."""
        place = 2 * (lane * self._axis_count + axis_index)
        for step, fields in enumerate(self._template.plant_steps(plant)):
            record = self._memory.plants[place + step]
            for name, value in fields.items():
                record[name] = value
        for name, value in self._template.load_fields(axis_index, plant).items():
            self.axes[name][lane, axis_index] = value

    def copy_plant(self, axis_index: int, *, source: int, lanes: slice) -> None:
        """Give a range of lanes the drive and load of lane `source`."""
        plants = self._memory.plants.reshape(self.count, self._axis_count, 2)
        plants[lanes, axis_index] = plants[source, axis_index]
        for name in LOAD_FIELDS:
            self.axes[name][lanes, axis_index] = self.axes[name][source, axis_index]

    def run(self, until_ns: int) -> None:
        """Run all lanes to a virtual time, without the interpreter lock."""
        self._advance(until_ns)

    def traces(self) -> tuple[npt.NDArray[np.int64], Mapping[Source, Column]]:
        """What the scopes have recorded: the times, ns, shape (rows,), and of each source an array (lanes, rows).

        All lanes have recorded alike: same start, no trigger. ValueError if the rings are not full, or went round.
        """
        layout = self._template.scope.layout
        if layout is None:
            raise ValueError("the template's scope was not armed")
        written = self._memory.scopes["rows_written"]
        rows = int(self._memory.scopes["rows"][0])
        if not (written == rows).all():
            raise ValueError(f"rows recorded: {written.min()} to {written.max()}, of {rows}")
        table = self._memory.ring.reshape(self.count * rows, -1)
        columns = {source: layout.column(source, table).reshape(self.count, rows) for source in layout.sources}
        return self._template.scope.times_ns(rows), columns
