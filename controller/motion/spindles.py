"""Axes that turn at a speed: ramps, speed arrival, constant surface speed, spindle override.

A ramp is one quadratic piece beside the motion of the other axes; no block waits for it but S0 in sync, M05,
M19, G28, the end of the program, a thread, and a move with feed per revolution.
"""

import math
from dataclasses import dataclass, field

from controller.commands import SurfaceSpeed
from controller.motion.peaks import Peaks
from controller.motion.timeline import Timeline
from controller.tables.machine_data import MachineData

DEG_PER_S = 6.0
"""one rpm [deg/s]"""
SURFACE_PERIOD = 0.008
"""[s] between two updates of the speed under G96"""
_SMALLEST_RADIUS = 1e-6
"""[mm] where G96 would ask for an infinite speed, the clamp holds"""


@dataclass(slots=True)
class Spindles:
    """The rotary axes as spindles."""

    machine: MachineData
    timeline: Timeline
    peaks: Peaks
    commanded: dict[int, float] = field(default_factory=dict)
    """column -> speed as programmed [rpm], before the override"""
    arrival: dict[int, float] = field(default_factory=dict)
    """column -> time [s] at which the commanded speed is reached"""
    free: set[int] = field(default_factory=set)
    """columns that have turned as a spindle and not been oriented since (PS0197); analogue ones for ever"""
    surface: SurfaceSpeed | None = None
    override: float = 1.0

    def __post_init__(self) -> None:
        self.free.update(k for k, axis in enumerate(self.machine.axes) if axis.analogue)

    def turn(
        self,
        axis: int,
        rpm: float,
        time: float,
        acceleration: float | None = None,
        highest: float = math.inf,
    ) -> float:
        """Ramp an axis to a programmed speed [rpm] from `time` on; returns the time of arrival [s].

        The override acts on it, within the spindle's own limit and `highest` [rpm].
        """
        self.commanded[axis] = rpm
        most = max(abs(rpm), min(self.machine.axes[axis].spindle_max, highest))
        target = math.copysign(min(abs(rpm) * self.override, most), rpm) * DEG_PER_S
        track = self.timeline.tracks[axis]
        rate = acceleration or self.machine.axes[axis].acceleration
        position, speed = track.at(time), track.speed(time)
        duration = abs(target - speed) / rate
        if duration > 0.0:
            track.add(time, position, speed, math.copysign(rate, target - speed))
            self.peaks.note({axis: 1.0}, max(abs(speed), abs(target)), rate)
        track.add(time + duration, position + 0.5 * (speed + target) * duration, target)
        self.arrival[axis] = time + duration
        return time + duration

    def ready(self, axis: int, time: float) -> float:
        """The time from which the axis has its commanded speed, at least `time`."""
        return max(time, self.arrival.get(axis, time))

    def turning(self, axis: int, time: float) -> bool:
        """Whether the axis turns, by itself or in the gear box, or is about to."""
        return self.timeline.speed(axis, time) != 0.0 or self.driven(axis, time)

    def driven(self, axis: int, time: float) -> bool:
        """Whether the axis turns by its own speed command, or is about to."""
        return self.timeline.tracks[axis].speed(time) != 0.0 or self.arrival.get(axis, time) > time

    def surface_rpm(self, radius: float) -> float:
        """Speed [rpm] that G96 asks for at a radius [mm]; n = 1000 V / (π D), clamped."""
        surface = self.surface
        if surface is None:
            return 0.0
        top = min(surface.clamp, self.machine.axes[surface.axis].spindle_max)
        rpm = 1000.0 * abs(surface.speed) / (2.0 * math.pi * max(abs(radius), _SMALLEST_RADIUS))
        return math.copysign(min(rpm, top), surface.speed)

    def adapt(self, radius: float, time: float) -> None:
        """Under G96, head for the speed of this radius [mm] from `time` on."""
        if self.surface:
            self.turn(self.surface.axis, self.surface_rpm(radius), time, highest=self.surface.clamp)
