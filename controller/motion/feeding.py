"""Feed per revolution by the measured speed: the encoder is read every 8 ms."""

from dataclasses import dataclass

FEED_PERIOD = 0.008
"""[s] between two readings of the encoder"""
STANDSTILL = 1.0
"""[s] that the feed waits for a spindle that does not turn"""
NO_SPEED = 1e-9
"""[mm/s] slower is standstill"""


@dataclass(slots=True)
class Gauge:
    """The measured speed of the work axis, as read last."""

    turns: float = 0.0
    """[1/s]"""
    until: float = -1.0
    """[s] when it has to be read again"""
    idle: float = 0.0
    """[s] for which the axis has not turned"""

    def read(self, turns: float, until: float) -> None:
        """A reading that is good until a time [s], one period on."""
        self.turns, self.until = turns, until
        self.idle = 0.0 if turns > 0.0 else self.idle + FEED_PERIOD

    @property
    def stalled(self) -> bool:
        """Whether the spindle has stood still too long."""
        return self.idle >= STANDSTILL
