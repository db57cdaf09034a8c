"""What the machine observes for the controller: in position, speed reached, the skip signal."""

from controller.clock import Chunk, MachineAlarm, Watch, WatchKind
from twin.errors import HobtwinError
from twin.probing.probe import Probe

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


def require_probe(chunk: Chunk, probe: Probe | None) -> bool:
    """Whether a chunk waits for the touch of a probe. Raises MachineError where it is not in its place."""
    if chunk.watch is None or chunk.watch.kind is not WatchKind.SKIP:
        return False
    if probe is None:
        raise MachineError(
            "a skip (G31) needs a touch probe, and this machine has none", remedy="[probe] in the job"
        )
    if chunk.ticks and int(chunk.tool[0]) != probe.tool:
        raise MachineError(
            f"a skip (G31) with T{int(chunk.tool[0]):02d} in place: the touch probe is T{probe.tool:02d}",
            remedy=f"T{probe.tool:02d}{probe.tool:02d} before it",
        )
    return True


def crash(probe: Probe, pushed_mm: float, *, no_band: bool) -> MachineAlarm | None:
    """The alarm of a stylus that is pushed back so far, or by what is no band; None where all is well."""
    if no_band:
        found = "the stylus touches what is no reference band"
    elif pushed_mm > probe.overtravel_mm:
        found = f"the stylus is pushed back {pushed_mm:.3f} mm, its overtravel is {probe.overtravel_mm:g} mm"
    else:
        return None
    return MachineAlarm(number="HT9031", axis=None, found=found)


def speed_reached(commanded: float, actual: float) -> bool:
    """Whether a spindle's speed [rad/s] has come up to its command."""
    return abs(commanded - actual) <= max(SPEED_TOLERANCE * abs(commanded), STANDSTILL)
