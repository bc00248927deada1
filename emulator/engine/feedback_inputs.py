"""Which sensor closes the loop, which way it counts, and from where: SFB, ENCPOL, CMDDIR, ANIPOL, PSET.

Encoder and ANI input are both read all the time, each with a PSET offset of its own; the selected one is the feedback
position. Positions are raw counts inside, reported counts (raw less offset) outside.
"""

from __future__ import annotations

from .encoder import ANI_SOURCE, ENCODER_SOURCE, OPEN_LOOP, AnalogSensor
from .machinery import Machinery
from .readings import ANI, ANI_OFFSET, COMMANDED, ENCODER, ENCODER_OFFSET, FEEDBACK, OFFSET, axis_word

_SOURCE, _ANI_FITTED = axis_word("feedback_source"), axis_word("ani_fitted")
_POLARITY, _OUTPUT_SIGN, _ANI_SIGN = (axis_word(name) for name in ("encoder_polarity", "output_sign", "ani_sign"))


class FeedbackInputs(Machinery):
    """The feedback half of `Engine`."""

    def set_feedback(self, axis_index: int, source: int) -> None:
        """SFB: 0 open loop, 1 encoder, 2 ANI; ValueError for one that is not fitted.

        On a change the commanded position takes over the new feedback with the PSET offset of that source, and the
        integrator is empty.
        """
        ints = self._ints[axis_index]
        fitted = (OPEN_LOOP, ENCODER_SOURCE, ANI_SOURCE) if ints[_ANI_FITTED] else (OPEN_LOOP, ENCODER_SOURCE)
        if source not in fitted:
            raise ValueError(f"feedback source {source} is not fitted")
        if source == ints[_SOURCE]:
            return
        position, offset = (ANI, ANI_OFFSET) if source == ANI_SOURCE else (ENCODER, ENCODER_OFFSET)
        ints[_SOURCE] = source
        ints[OFFSET] = ints[offset]
        ints[COMMANDED] = ints[FEEDBACK] = ints[position]
        self._write(
            axis_index,
            previous_feedback_counts=ints[position],
            system_feedback_counts=ints[position],
            term_i=0.0,
        )

    def set_analog_sensor(self, axis_index: int, sensor: AnalogSensor) -> None:
        """Another sensor, or none that follows the shaft, at the ANI feedback input; ValueError without the option."""
        if not self._ints[axis_index][_ANI_FITTED]:
            raise ValueError(f"axis {axis_index + 1} has no ANI feedback input")
        self._write(axis_index, **sensor.fields())

    def set_polarity(
        self, axis_index: int, *, encoder: int | None = None, command: int | None = None, ani: int | None = None
    ) -> None:
        """ENCPOL, CMDDIR and ANIPOL, 0 normal or 1 reversed; CMDDIR turns the output and every feedback round.

        The encoder's position does not jump, only its counting turns round. The ANI position is a voltage: it changes
        sign, and on an axis that ANI feeds back the commanded position goes with it, the error staying (assumed).
        """
        ints = self._ints[axis_index]
        was = ints[_OUTPUT_SIGN]
        command_sign = was if command is None else 1 - 2 * command
        encoder_polarity = ints[_POLARITY] if encoder is None else 1 - 2 * encoder
        ani_sign = ints[_ANI_SIGN] * was if ani is None else 1 - 2 * ani
        self._write(axis_index, output_sign=command_sign, encoder_polarity=encoder_polarity)
        self.turn_counting(axis_index)
        if ani_sign * command_sign != ints[_ANI_SIGN]:
            ints[_ANI_SIGN] = ani_sign * command_sign
            self._move_ani(axis_index, -ints[ANI])

    def _move_ani(self, axis_index: int, counts: int) -> None:
        """The ANI position jumps to `counts` without having moved."""
        ints = self._ints[axis_index]
        ints[ANI] = counts
        if ints[_SOURCE] == ANI_SOURCE:
            ints[COMMANDED] += counts - ints[FEEDBACK]
            ints[FEEDBACK] = counts
            self._write(axis_index, previous_feedback_counts=counts, system_feedback_counts=counts)

    def set_position(self, axis_index: int, counts: int) -> None:
        """PSET: the present commanded position becomes `counts`; the feedback shifts with it, the error stays.

        The offset belongs to the selected feedback source; in open loop to the encoder.
        """
        ints = self._ints[axis_index]
        ints[OFFSET] = ints[COMMANDED] - counts
        ints[ANI_OFFSET if ints[_SOURCE] == ANI_SOURCE else ENCODER_OFFSET] = ints[OFFSET]
