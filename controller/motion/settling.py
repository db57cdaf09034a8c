"""What a motion leaves behind: in the displays, in the extents and peaks, and with the spindle under G96."""

import math
from dataclasses import replace

from controller.laws.gearbox import SyncKind
from controller.laws.segments import Phase
from controller.motion.path import AnyPath, ArcPath
from controller.motion.paths import Paths
from controller.motion.spindles import SURFACE_PERIOD
from controller.span import Span


class Settling(Paths):
    """Keeps the books of the paths that are travelled."""

    def _settle(self, path: AnyPath, position: float) -> None:
        """The displays show the axes at a path position."""
        if position == path.settled:
            return
        start, path.settled = path.settled, position
        registers, epoch = self.registers, self.timeline.coupling
        before = registers.absolute.copy() if isinstance(path, ArcPath) else []
        program, machine, slides = path.between(start, position)
        registers.move(program, machine)
        if epoch and epoch.gear.kind is SyncKind.HOBBING and epoch.weights:
            shift = sum(weight * slides.get(k, 0.0) for k, weight in epoch.weights.items())
            registers.compensate(epoch.gear.slave, shift)
        if position == path.length:
            for axis, value in path.exact.items():
                registers.absolute[axis] = value
        for axis in slides:
            self.slide_extents.stretch(axis, self.timeline.tracks[axis].at(self.time))
        for axis in program:
            self.program_extents.stretch(axis, registers.absolute[axis])
        if isinstance(path, ArcPath):
            self._stretch_round(path, start, position, before)
        if epoch:
            self.note_extents()

    def _stretch_round(self, path: ArcPath, start: float, end: float, absolute: list[float]) -> None:
        """An arc reaches furthest where it passes a quadrant. `absolute`: displays at `start`."""
        u, v = start / path.radius, end / path.radius
        for extents, waves, origin in (
            (self.slide_extents, path.slides, path.base),
            (self.program_extents, path.program, absolute),
        ):
            for axis, wave in waves.items():
                offset = 0.0 if extents is self.slide_extents else wave.at(u)
                for turn in wave.turning(v):
                    if turn > u:
                        extents.stretch(axis, origin[axis] + wave.at(turn) - offset)

    def _arrive(self, path: AnyPath, position: float) -> None:
        """The path is done. Raises AlarmError where a stroke limit has ended it."""
        self._settle(path, position)
        if path.crossing and position >= path.end:
            standing = None if path.crossing.before else self.timeline.positions(self.time)
            place = self._place(path.places.get(path.crossing.axis))
            raise self.limits.refuse(path.crossing, place, standing=standing)

    def _place(self, column: int | None) -> Span | None:
        """The word at a text column of the present block; the block itself where there is none."""
        return replace(self._span, column=column) if self._span and column else self._span

    def _note_peaks(self, path: AnyPath, phases: list[Phase], begin: float) -> None:
        """The highest speeds and accelerations on a stretch that began at `begin`."""
        top = max([max(phase.speed, phase.end_speed) for phase in phases])
        rate = max([abs(phase.acceleration) for phase in phases])
        self.peaks.note(path.shares, top, rate)
        epoch = self.timeline.coupling
        if epoch and epoch.gear.slave not in path.slides and not epoch.weights:
            return
        if epoch:
            slave, master = epoch.gear.slave, self.timeline.tracks[epoch.gear.master]
            parts = path.shares
            share = parts.get(slave, 0.0) + sum(w * parts.get(k, 0.0) for k, w in epoch.weights.items())
            for phase in phases:
                for moment, speed in ((begin, phase.speed), (begin + phase.duration, phase.end_speed)):
                    turning = epoch.gear.ratio * master.speed(moment)
                    self.peaks.note(
                        {slave: 1.0}, abs(turning + share * speed), abs(share * phase.acceleration)
                    )
                begin += phase.duration

    def _follow_diameter(self, path: AnyPath, phases: list[Phase], begin: float) -> None:
        """Under G96 the spindle follows the diameter; at rapid it heads for the end of the stretch."""
        surface = self.spindles.surface
        if surface is None or surface.radial not in path.program:
            return
        radial, shown = surface.radial, self.registers.absolute[surface.radial]

        def radius(position: float) -> float:
            return shown + path.between(path.settled, position)[0][radial]

        if path.rapid:
            self.spindles.adapt(radius(path.end), begin)
            return
        time = begin
        for phase in phases:
            for k in range(math.ceil(phase.duration / SURFACE_PERIOD)):
                tau = k * SURFACE_PERIOD
                position = phase.start + tau * (phase.speed + 0.5 * phase.acceleration * tau)
                self.spindles.adapt(radius(position), time + tau)
            time += phase.duration
        self.spindles.adapt(radius(phases[-1].end), self.time)
