"""The machine whose axes follow their setpoints exactly."""

from collections.abc import Mapping

import numpy as np

from controller.clock import Chunk, Feedback, Floats, Load, MachineAlarm
from twin.faults.encoders import CyclicError, stands
from twin.machine.following import couple, require_chunk
from twin.machine.watching import Watcher, crash, require_probe
from twin.probing.contact import Contact
from twin.probing.trigger import Trigger


class IdealMachine:
    """Encoders read their setpoints, couplings applied; forces move nothing.

    `axes` = number of system axes, `encoders` = errors of some of them by column, `contact` = what a touch
    probe meets, `period_s` = the control's.
    """

    def __init__(
        self,
        axes: int,
        encoders: Mapping[int, CyclicError] | None = None,
        *,
        contact: Contact | None = None,
        period_s: float = 0.001,
    ) -> None:
        self._encoders = encoders or {}
        self._axes = axes
        self._tick = 0
        self._watcher = Watcher()
        self._contact = contact
        self._trigger = None if contact is None else Trigger(contact.probe, period_s)
        self._last = np.zeros(axes)

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:  # noqa: ARG002 - no force moves it
        """Move along the chunk; a touch or a crash of the probe ends it, every other watched condition holds
        at its first tick."""
        require_chunk(chunk, self._axes, self._tick)
        probe = None if self._contact is None else self._contact.probe
        watch = self._watcher.begin(chunk.watch)
        skip = require_probe(chunk, probe)
        ticks = chunk.ticks if watch is None or skip else min(chunk.ticks, 1)
        if skip:
            ticks = min(ticks, self._watcher.remaining)
        position = couple(chunk)[:ticks]
        latch, alarms = None, ()
        if self._contact is not None:
            ticks, latch, alarms = self._touch(chunk, position, skip=skip)
            position = position[:ticks]
        reached = latch is not None if skip else ticks > 0
        signals = self._watcher.end(ticks, reached=reached)
        self._tick += ticks
        if ticks:
            self._last = position[-1]
        return Feedback(
            ticks=ticks,
            setpoint=position,
            actual=stands(self._encoders, position),
            latch=latch,
            alarms=alarms,
            signals=signals,
        )

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves."""
        self._tick += ticks

    def _touch(
        self, chunk: Chunk, position: Floats, *, skip: bool
    ) -> tuple[int, Floats | None, tuple[MachineAlarm, ...]]:
        """How many ticks of (n, axes) readings pass, what is latched at their end, and the probe's alarm."""
        contact, trigger = self._contact, self._trigger
        if contact is None or trigger is None or not len(position):
            return len(position), None, ()
        if not skip:
            trigger.rest()
        in_place = chunk.tool[: len(position)] == contact.probe.tool
        if not in_place.any():
            return len(position), None, ()
        rows = np.vstack([self._last, position])
        pushed, blocked = contact.pushed_back(stands(self._encoders, rows))
        for k in np.flatnonzero(in_place).tolist():
            if alarm := crash(contact.probe, float(pushed[k + 1]), no_band=bool(blocked[k + 1])):
                return k + 1, None, (alarm,)
            if skip and (share := trigger.tick(float(pushed[k]), float(pushed[k + 1]))) is not None:
                return k + 1, rows[k] + share * (rows[k + 1] - rows[k]), ()
        return len(position), None, ()
