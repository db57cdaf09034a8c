"""What the machine observes for the controller: in position, speed reached."""

from controller.clock import Watch, WatchKind
from twin.errors import HobtwinError

SPEED_TOLERANCE = 0.05
"""relative deviation at which a commanded speed counts as reached [plausible]"""
STANDSTILL = 0.1
"""deviation [rad/s], 1 rpm, that counts as reached at any commanded speed [plausible]"""


class MachineError(HobtwinError):
    """The machine cannot do what it is asked, or its physics broke down."""


class Watcher:
    """Keeps count of one watch over the chunks that carry it.

    A chunk with a watch ends at the tick where the condition first holds, or when the watch has been
    pending for `timeout_ticks`. `Feedback.signals` then says which: `{kind: held, "timeout": timed_out}`.
    """

    def __init__(self) -> None:
        self._watch: Watch | None = None
        self._elapsed = 0

    def begin(self, watch: Watch | None) -> Watch | None:
        """Take up a chunk's watch; an equal one that is still pending goes on counting."""
        if watch is not None and watch.kind is WatchKind.SKIP:
            raise MachineError("a skip (G31) needs a touch probe, and this machine has none")
        if watch != self._watch:
            self._watch, self._elapsed = watch, 0
        return watch

    @property
    def remaining(self) -> int:
        """Ticks until the timeout of the pending watch."""
        return 0 if self._watch is None else max(self._watch.timeout_ticks - self._elapsed, 0)

    def end(self, ticks: int, *, reached: bool) -> dict[str, bool]:
        """Count a chunk that advanced by `ticks`; the signals to report."""
        if self._watch is None:
            return {}
        self._elapsed += ticks
        timeout = not reached and self.remaining == 0
        signals = {self._watch.kind.value: reached, "timeout": timeout}
        if reached or timeout:
            self._watch = None
        return signals


def speed_reached(commanded: float, actual: float) -> bool:
    """Whether a spindle's speed [rad/s] has come up to its command."""
    return abs(commanded - actual) <= max(SPEED_TOLERANCE * abs(commanded), STANDSTILL)
