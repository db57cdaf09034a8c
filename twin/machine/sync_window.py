"""The window of the gear box: a slave that leaves it ends the run (parameter 9006)."""

from dataclasses import replace

import numpy as np

from controller.clock import Chunk, Feedback, Load, Machine, MachineAlarm
from twin.sync.error import sync_error


class SyncWindow:
    """A machine that stops with SV0407 at the first tick in which a gear box's slave is out of its window.

    Where the slave really is counts, against where its master, and in a helical gear box the axial slide,
    really ask it to be: what would spoil the part.
    """

    def __init__(self, machine: Machine, window_arcsec: float) -> None:
        """`window_arcsec` to each side; 0 = not watched."""
        self._machine = machine
        self._window = window_arcsec

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:
        """Move along the chunk up to its end, or to the first tick out of the window."""
        feedback = self._machine.advance(chunk, load)
        if not self._window or not chunk.gears:
            return feedback
        error = sync_error(chunk, feedback)
        outside = np.flatnonzero(np.abs(error) > self._window)
        if not len(outside):
            return feedback
        tick = int(outside[0])
        gear = next(g for g in chunk.gears if g.first <= tick < g.last)
        found = f"{error[tick]:+.4g} arcsec against its master, window {self._window:g} arcsec"
        ticks = tick + 1
        return replace(
            feedback,
            ticks=ticks,
            setpoint=feedback.setpoint[:ticks],
            actual=feedback.actual[:ticks],
            measured=None if feedback.measured is None else feedback.measured[:ticks],
            latch=None,
            alarms=(MachineAlarm(number="SV0407", axis=gear.slave, found=found),),
            signals={},
        )

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves."""
        self._machine.rest(ticks)
