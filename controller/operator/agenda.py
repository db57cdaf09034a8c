"""The operator's events in the order in which they act."""

import math
from collections.abc import Iterable, Sequence

from controller.operator.actions import OperatorAction, OperatorEvent

_MOVING = frozenset(
    {
        OperatorAction.CYCLE_START,
        OperatorAction.JOG,
        OperatorAction.REFERENCE_RETURN,
        OperatorAction.MDI,
    }
)
"""what moves something although no program runs"""


class Agenda:
    """Events that have not acted yet. Those with a time act at the first tick that is not before it."""

    __slots__ = ("_timed", "lines", "next_time")

    def __init__(self, events: Iterable[OperatorEvent], rate: int) -> None:
        events = tuple(events)
        timed = [(_tick_time(e.time_s, rate), e) for e in events if e.line is None]
        # sorting keeps the order of events of one time: the first named acts first
        self._timed = sorted(timed, key=lambda pair: pair[0])[::-1]
        self.lines: dict[int, list[OperatorEvent]] = {}
        """line -> events that wait for its block"""
        for event in events:
            if event.line is not None:
                self.lines.setdefault(event.line, []).append(event)
        self.next_time = self._timed[-1][0] if self._timed else math.inf
        """[s] when the next event acts"""

    def pop(self) -> OperatorEvent:
        """The event of `next_time`."""
        _, event = self._timed.pop()
        self.next_time = self._timed[-1][0] if self._timed else math.inf
        return event

    def at_line(self, line: int, time: float) -> Sequence[OperatorEvent]:
        """The events of a line whose block begins at `time`, for the first time since they were posted."""
        waiting = self.lines.pop(line, [])
        if later := [event for event in waiting if event.since_s > time]:
            self.lines[line] = later
        return [event for event in waiting if event.since_s <= time]

    @property
    def moves_again(self) -> bool:
        """Whether an event is to come that moves something although no program runs."""
        return any(event.action in _MOVING for _, event in self._timed)

    @property
    def left(self) -> list[OperatorEvent]:
        """The events that have not acted, in order."""
        return [e for _, e in reversed(self._timed)] + [e for at in self.lines.values() for e in at]


def _tick_time(time_s: float | None, rate: int) -> float:
    return math.ceil((time_s or 0.0) * rate - 1e-6) / rate
