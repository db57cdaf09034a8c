"""The machine whose axes follow their setpoints exactly."""

from collections.abc import Mapping

from controller.clock import Chunk, Feedback, Load
from twin.faults.encoders import CyclicError, stands
from twin.machine.following import couple, require_chunk
from twin.machine.watching import Watcher


class IdealMachine:
    """Encoders read their setpoints, couplings applied; forces move nothing.

    `axes` = number of system axes, `encoders` = errors of some of them by column.
    """

    def __init__(self, axes: int, encoders: Mapping[int, CyclicError] | None = None) -> None:
        self._axes = axes
        self._encoders = encoders or {}
        self._tick = 0
        self._watcher = Watcher()

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:  # noqa: ARG002 - no force moves it
        """Move along the chunk; every watched condition holds at its first tick."""
        require_chunk(chunk, self._axes, self._tick)
        watch = self._watcher.begin(chunk.watch)
        ticks = chunk.ticks if watch is None else min(chunk.ticks, 1)
        position = couple(chunk)[:ticks]
        signals = self._watcher.end(ticks, reached=ticks > 0)
        self._tick += ticks
        return Feedback(
            ticks=ticks, setpoint=position, actual=stands(self._encoders, position), signals=signals
        )

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves."""
        self._tick += ticks
