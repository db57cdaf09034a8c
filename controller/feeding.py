"""Feed per revolution by the measured speed: planned anew every 8 ms, to standstill at the path's end."""

from dataclasses import dataclass

from controller.commands import Feed
from controller.path import Path
from controller.segments import Phase, clip, trapezoid

FEED_PERIOD = 0.008
"""[s] between two readings of the encoder"""
STANDSTILL = 1.0
"""[s] that the feed waits for a spindle that does not turn"""
_NO_SPEED = 1e-9
"""[mm/s] slower is standstill"""


@dataclass(slots=True, kw_only=True)
class RevolutionFeed:
    """A move with feed per revolution on its way."""

    path: Path
    feed: Feed
    tick: int
    """at which the present period began"""
    position: float = 0.0
    """path position [mm | deg]"""
    speed: float = 0.0
    """path speed [1/s]"""
    finished: bool = False
    slowed: bool = False
    """an axis limit has been reported"""
    _idle: float = 0.0

    @property
    def stalled(self) -> bool:
        """Whether the spindle has stood still too long."""
        return self._idle >= STANDSTILL

    def period(self, target: float, duration: float) -> list[Phase]:
        """The phases of the next `duration` [s] at `target` path speed [1/s], up to the end of the path."""
        rate = self.path.acceleration
        if target <= _NO_SPEED:
            self._idle += duration
            braking = self.speed / rate
            phases = clip([Phase(braking, 0.0, self.speed, -rate)] if braking > 0.0 else [], duration)
            reached = phases[-1].end if phases else 0.0
            if braking < duration:
                phases.append(Phase(duration - braking, reached, 0.0, 0.0))
        else:
            self._idle = 0.0
            rest = self.path.end - self.position
            whole = (
                trapezoid(rest, speed=target, acceleration=rate, start_speed=self.speed) if rest > 0.0 else []
            )
            self.finished = sum(phase.duration for phase in whole) <= duration
            phases = clip(whole, duration)
        laid = [Phase(p.duration, self.position + p.start, p.speed, p.acceleration) for p in phases]
        if laid:
            self.position, self.speed = laid[-1].end, laid[-1].end_speed
        return laid
