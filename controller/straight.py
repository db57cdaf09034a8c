"""Straight moves: paths at rapid, at a feed per minute, and at a feed per revolution of the work.

Blocks end in exact stop. `time` is continuous; a block may begin and end between two ticks. A move with feed
per revolution waits until the spindle has reached its commanded speed, then goes by the theoretical speed in
one closed form or by the measured speed in periods of 8 ms; all other moves do not wait for spindles.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from controller.alarms import Alarm, alarm
from controller.commands import Feed
from controller.coupling import Coupling, Sensor
from controller.feeding import FEED_PERIOD, RevolutionFeed
from controller.gearbox import SyncKind
from controller.limits import first_crossing
from controller.machine_data import MachineData
from controller.path import NOTHING, Extents, Path, path_limits, stopping_point
from controller.registers import Registers
from controller.segments import Phase, trapezoid
from controller.span import Span
from controller.spindles import DEG_PER_S, SURFACE_PERIOD, Spindles
from controller.timeline import Timeline

Floats = NDArray[np.float64]
_OVERTRAVEL = {True: "OT0500", False: "OT0501"}


class StraightMotion:
    """The axes in time, and straight paths on them.

    When `waits_for` is set the motion is planned up to that time, and `resume` goes on with what the encoders
    say then.
    """

    def __init__(
        self, machine: MachineData, *, tick_s: float, warn: Callable[[Alarm], None], closed_form: bool
    ) -> None:
        axes = len(machine.axes)
        self.machine = machine
        self.time = 0.0
        self.timeline = Timeline(axes)
        self.registers = Registers.at_power_on(axes)
        self.spindles = Spindles(machine, self.timeline)
        self.coupling = Coupling(machine, self.timeline, self.registers, self.spindles)
        self.slide_extents = Extents.at(np.zeros(axes))
        self.program_extents = Extents.at(np.zeros(axes))
        self.waits_for: float | None = None
        self._resume: Callable[[Sensor], None] | None = None
        self._rate = round(1.0 / tick_s)
        self._warn = warn
        self._closed_form = closed_form
        self._span: Span | None = None
        self._lower = np.array([axis.lower for axis in machine.axes])
        self._upper = np.array([axis.upper for axis in machine.axes])

    def resume(self, sensor: Sensor) -> None:
        """Go on from `waits_for` with the encoders as they were then."""
        step, self._resume, self.waits_for = self._resume, None, None
        if step:
            step(sensor)

    def note_extents(self) -> None:
        """Count the present position in the extents."""
        self.slide_extents.include(self.timeline.positions(self.time))
        self.program_extents.include(self.registers.absolute)

    def _at_encoders(self, step: Callable[[Sensor], None]) -> None:
        """Take `step` as soon as the encoders of the present time are known."""
        self.waits_for = self.time
        self._resume = step

    def _to_tick(self) -> int:
        """Wait for the next tick, where the encoders are read; returns its number."""
        tick = math.ceil(round(self.time * self._rate, 6))
        self.time = max(self.time, tick / self._rate)
        return tick

    def _travel(
        self,
        slides: Floats,
        cartesian: Floats,
        feed: Feed | None,
        places: Mapping[int, int],
        exact: Mapping[int, float],
    ) -> None:
        if feed and feed.per_revolution:
            self.time = self.spindles.ready(self._driven_axis(), self.time)
        path = self._path(slides, cartesian, feed, exact)
        if path is None:
            self.registers.absolute[list(exact)] = list(exact.values())
            return
        if feed and feed.measured:
            tick = self._to_tick()
            if not self._commanded_is_measured:
                self._feed_on(RevolutionFeed(path=path, feed=feed, tick=tick), places)
                return
        speed = self._path_speed(path, feed)
        if path.end > 0.0:
            phases = trapezoid(path.end, speed=speed, acceleration=path.acceleration)
            start = self.time
            for phase in phases:
                self._lay(path, phase, self.time)
                self.time += phase.duration
            self._adapt_surface(start, path, rapid=feed is None)
        self._arrive(path, places)

    def _path(
        self, slides: Floats, cartesian: Floats, feed: Feed | None, exact: Mapping[int, float]
    ) -> Path | None:
        """The path of a move, its limits included; None where nothing is to be travelled."""
        length = float(np.linalg.norm(cartesian))
        if length < NOTHING:
            return None
        own = self.timeline.own(self.time)
        gear = self.coupling.gear
        epoch = self.timeline.coupling
        induced = (gear.slave, float(epoch.weights @ slides)) if gear and epoch else None
        speed, acceleration = path_limits(self.machine, slides, induced, rapid=feed is None)
        top, rate = speed * length, acceleration * length
        by_slides = not self.machine.parameters.bit(8201, 0)
        start, way = (own, slides) if by_slides else (self.registers.cartesian, cartesian)
        crossing = first_crossing(start, way, self._lower, self._upper)
        end = length
        if crossing:
            wanted = min(top, feed.value) if feed and not feed.per_revolution else top
            before = self.machine.parameters.bit(1300, 7)
            end = stopping_point(length, crossing.fraction * length, wanted, rate, before=before)
        return Path(
            own=own,
            slides=slides,
            moving=tuple(np.flatnonzero(slides).tolist()),
            cartesian=cartesian,
            length=length,
            top_speed=top,
            acceleration=rate,
            end=end,
            crossing=crossing,
            absolute=exact,
        )

    def _path_speed(self, path: Path, feed: Feed | None) -> float:
        if feed is None:
            return path.top_speed
        wanted = feed.value
        if feed.per_revolution:
            axis = self._feed_axis()
            wanted *= abs(self.timeline.speed(axis, self.time)) / (60.0 * DEG_PER_S)
        if wanted > path.top_speed * (1.0 + 1e-9):
            self._warn_slowed(wanted, path.top_speed)
        return min(wanted, path.top_speed)

    def _warn_slowed(self, wanted: float, top: float) -> None:
        found = f"{wanted * 60.0:.0f} mm/min asked for, {top * 60.0:.0f} possible on this path"
        self._warn(Alarm(number="HT9107", found=found, span=self._span))

    def _lay(self, path: Path, phase: Phase, time: float) -> None:
        """Put one phase of the motion on the tracks of the axes that move."""
        for axis in path.moving:
            share = float(path.slides[axis]) / path.length
            position = float(path.own[axis]) + share * phase.start
            self.timeline.tracks[axis].add(time, position, share * phase.speed, share * phase.acceleration)

    def _arrive(self, path: Path, places: Mapping[int, int]) -> None:
        """Stand still at the end of the path, bring the registers there, and stop on a stroke limit."""
        for axis in path.moving:
            position = float(path.own[axis] + path.slides[axis] * path.fraction)
            self.timeline.tracks[axis].add(self.time, position)
        self.registers.move(path.cartesian * path.fraction)
        if path.crossing is None:
            for axis, value in path.absolute.items():
                self.registers.absolute[axis] = value
        gear, epoch = self.coupling.gear, self.timeline.coupling
        if gear and epoch and gear.kind is SyncKind.HOBBING:
            self.registers.compensate(gear.slave, float(epoch.weights @ path.slides) * path.fraction)
        self.note_extents()
        if path.crossing:
            axis = self.machine.axes[path.crossing.axis]
            limit = (axis.upper if path.crossing.upper else axis.lower) * axis.factor
            number = 1320 if path.crossing.upper else 1321
            frame = "Cartesian " if self.machine.parameters.bit(8201, 0) else "slide "
            found = f"{frame}{axis.letter} at its limit {limit:.3f} mm"
            valid = f"a path inside parameter {number}.{axis.letter}"
            raise alarm(
                _OVERTRAVEL[path.crossing.upper],
                found,
                self._place(places.get(path.crossing.axis)),
                valid=valid,
            )

    def _place(self, column: int | None) -> Span | None:
        """The word at a text column of the present block; the block itself where there is none."""
        return replace(self._span, column=column) if self._span and column else self._span

    # Feed per revolution by the measured speed

    @property
    def _commanded_is_measured(self) -> bool:
        """In a dry run the machine is ideal: at constant speed the measured speed is the commanded one."""
        return self._closed_form and self.spindles.surface is None

    def _feed_axis(self) -> int:
        """The work axis, whose turns count for G99."""
        gear = self.coupling.gear
        if gear:
            return gear.slave if gear.kind is SyncKind.HOBBING else gear.master
        if self.machine.work_spindle is None:
            raise alarm("HT9005", "no work spindle in parameter 9001 for a feed per revolution", self._span)
        return self.machine.work_spindle

    def _driven_axis(self) -> int:
        """The axis whose speed S commands."""
        gear = self.coupling.gear
        return gear.master if gear else self._feed_axis()

    def _feed_on(self, revolution: RevolutionFeed, places: Mapping[int, int]) -> None:
        """Wait for the next reading of the encoder, then feed for one period."""
        self._at_encoders(lambda sensor: self._feed_period(revolution, places, sensor))

    def _feed_period(self, revolution: RevolutionFeed, places: Mapping[int, int], sensor: Sensor) -> None:
        turns = abs(sensor.speed(self._feed_axis())) / (60.0 * DEG_PER_S)
        path = revolution.path
        wanted = turns * revolution.feed.value
        if wanted > path.top_speed * (1.0 + 1e-9) and not revolution.slowed:
            revolution.slowed = True
            self._warn_slowed(wanted, path.top_speed)
        radial = self.spindles.surface.radial if self.spindles.surface else None
        before = self.time
        revolution.tick += max(1, round(FEED_PERIOD * self._rate))
        end = revolution.tick / self._rate
        for phase in revolution.period(min(wanted, path.top_speed), end - self.time):
            self._lay(path, phase, self.time)
            self.time += phase.duration
        if not revolution.finished:
            self.time = end
        if radial is not None:
            done = revolution.position / path.length
            radius = float(self.registers.absolute[radial] + path.cartesian[radial] * done)
            self.spindles.adapt(radius, before)
        if revolution.finished:
            self._arrive(path, places)
        elif revolution.stalled:
            found = "the work axis at standstill for one second by its encoder"
            raise alarm("HT9007", found, self._span, valid="a spindle that turns")
        else:
            self._feed_on(revolution, places)

    def _adapt_surface(self, start: float, path: Path, *, rapid: bool) -> None:
        """Under G96 the spindle follows the diameter; at rapid it heads for the end of the path."""
        surface = self.spindles.surface
        if surface is None or path.cartesian[surface.radial] == 0.0:
            return
        origin = float(self.registers.absolute[surface.radial])
        end = origin + float(path.cartesian[surface.radial]) * path.fraction
        if not rapid:
            track = self.timeline.tracks[surface.radial]
            offset = origin - float(path.own[surface.radial])
            for k in range(int((self.time - start) / SURFACE_PERIOD)):
                moment = start + k * SURFACE_PERIOD
                self.spindles.adapt(track.at(moment) + offset, moment)
        self.spindles.adapt(end, start if rapid else self.time)
