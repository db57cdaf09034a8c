"""Corrections against the work angle: a table that is filled, switched on and off (G10 L60 to L62).

Like a pitch error compensation it acts behind all displays: on the setpoints as they are sampled.
"""

import math
from collections.abc import Mapping

from controller.commands import ClearTable, Couple, SetTablePoint, SwitchTable
from controller.laws.angle_table import RAMP_S, AngleTable, TableInForce
from controller.motion.requests import Steps
from controller.motion.returning import Returning
from controller.tables.alarms import alarm

_FOLLOWED = "a table of the work angle with a gear box of the follow type"


class Correcting(Returning):
    """Keeps the table that the program fills."""

    _points: tuple[Mapping[int, float], ...] = ()
    """corrections by column at even angles of the work"""

    def _clear_table(self, command: ClearTable) -> None:
        """A new table; the one in force stays what it is."""
        if self.machine.work_spindle is None:
            raise alarm("HT9005", "no work spindle in parameter 9001 for a table of its angle", command.span)
        self._points = ({},) * command.points

    def _set_table_point(self, command: SetTablePoint) -> None:
        if not 1 <= command.number <= len(self._points):
            found = f"point {command.number} of a table of {len(self._points)}"
            valid = f"P1 to P{len(self._points)}" if self._points else "G10 L60 Q before it"
            raise alarm("PS0030", found, command.span, valid=valid)
        k = command.number - 1
        point = {**self._points[k], **command.values}
        self._points = (*self._points[:k], point, *self._points[k + 1 :])

    def _switch_table(self, command: SwitchTable) -> Steps[None]:
        work, gear = self.machine.work_spindle, self.coupling.gear
        if command.on and (work is None or not self._points):
            raise alarm("PS0030", "a table without points", command.span, valid="G10 L60 Q before it")
        if command.on and gear is not None and gear.follow:
            raise alarm("HT9003", _FOLLOWED, command.span, valid="201#7 = 0")
        corrections = self.timeline.corrections
        if corrections and corrections[-1].end == math.inf:
            corrections[-1].end = self.time
        if command.on and work is not None:
            columns = sorted({column for point in self._points for column in point})
            values = {column: tuple(point.get(column, 0.0) for point in self._points) for column in columns}
            table = AngleTable(work=work, values=values)
            corrections.append(TableInForce(table=table, start=self.time))
        return self._dwell(RAMP_S)

    def _couple_within(self, command: Couple) -> Steps[None]:
        corrections = self.timeline.corrections
        if command.gear.follow and corrections and corrections[-1].end == math.inf:
            raise alarm("HT9003", _FOLLOWED, self._span, valid="201#7 = 0, or G10 L62 before it")
        return self._couple(command)
