"""Paths are built here: from program terms to slides, with the limits that hold for them now."""

import math
from collections.abc import Callable, Mapping
from typing import TypeVar

from controller.laws.gearbox import SyncKind
from controller.laws.inclined import InclinedPair
from controller.laws.wave import Wave
from controller.motion.axes import Axes
from controller.motion.path import (
    NOTHING,
    AnyPath,
    ArcPath,
    StraightPath,
    Travel,
    arc_limits,
    straight_limits,
)
from controller.motion.registers import shortest
from controller.motion.spindles import DEG_PER_S
from controller.tables.alarms import alarm
from controller.tables.signals import AxisInput

_OVER_SPEED = {SyncKind.HOBBING: "PS1596", SyncKind.POLYGON: "PS5018"}
_REACHED = 1e-6
"""[mm | deg] within which a commanded end is reached"""


_T = TypeVar("_T")
"""what a slide does: a travel, or a coordinate of an arc"""


class Paths(Axes):
    """Builds paths from where the machine stands."""

    @property
    def _compensated(self) -> bool:
        """NOZAGC = 1 leaves the orthogonal axis out (inclined axis, 三、信号)."""
        return not self.panel.inputs.on("NOZAGC")

    def _slides(self, program: Travel) -> Travel:
        """What the slides do for a motion in program terms."""
        return self._reversed(self._slanted(program))

    def _slanted(self, program: Travel) -> Travel:
        """The same without mirror image."""
        pair = self.machine.pair
        if pair is None or pair.inclined not in program:
            return program
        x, y = program.get(pair.orthogonal, 0.0), program[pair.inclined]
        return _both(program, pair, pair.to_slides(x, y, compensated=self._compensated))

    def _reversed(self, slides: Travel) -> Travel:
        """Mirror image: every slide by itself (inclined axis, MIx)."""
        mirrored = self._mirrored()
        return {k: -d if k in mirrored else d for k, d in slides.items()} if mirrored else slides

    def _program(self, slides: Travel) -> Travel:
        """The motion in program terms that moves the slides so: the inverse."""
        pair = self.machine.pair
        slides = self._reversed(slides)
        if pair is None or self._compensated:
            return self._cartesian(slides)
        return {
            **slides,
            **self._cartesian({pair.inclined: slides.get(pair.inclined, 0.0)}),
            pair.orthogonal: slides.get(pair.orthogonal, 0.0),
        }

    def _mirrored(self) -> frozenset[int]:
        """Columns whose slides go the other way (MIx)."""
        return self.panel.inputs.columns(AxisInput.MIRROR)

    def _cartesian(self, slides: Travel) -> Travel:
        """What motion of the slides is in Cartesian machine terms."""
        pair = self.machine.pair
        if pair is None or pair.inclined not in slides:
            return slides
        x, y = slides.get(pair.orthogonal, 0.0), slides[pair.inclined]
        return _both(slides, pair, pair.to_cartesian(x, y))

    def _slide_waves(self, program: Mapping[int, Wave]) -> Mapping[int, Wave]:
        """The same for the coordinates of an arc."""
        pair = self.machine.pair
        slides = program
        if pair and pair.inclined in program:
            cross, along = pair.to_slides(0.0, 1.0, compensated=self._compensated)
            slides = _waves(program, pair, cross, along)
        if mirrored := self._mirrored():
            slides = {k: Wave(0.0).plus(w, -1.0) if k in mirrored else w for k, w in slides.items()}
        return slides

    def _cartesian_waves(self, slides: Mapping[int, Wave]) -> Mapping[int, Wave]:
        pair = self.machine.pair
        if pair is None or pair.inclined not in slides:
            return slides
        return _waves(slides, pair, *pair.to_cartesian(0.0, 1.0))

    def _locked(self) -> frozenset[int]:
        """Columns whose slides stand: by machine lock, but for those of a gear box (hobbing, 注意事项), and
        of detached axes (DTCHx)."""
        locked = self.panel.locked_columns(len(self.machine.axes))
        gear = self.coupling.gear
        if gear and locked:
            locked -= {gear.master, gear.slave}
        return locked | self.panel.inputs.columns(AxisInput.DETACH)

    def _on_slides(self, slides: Travel, places: Mapping[int, int] | None = None) -> StraightPath | None:
        """A rapid path of the slides by so much, whatever the program would call it; not mirrored."""
        slides = {k: d for k, d in slides.items() if abs(d) >= NOTHING}
        program = self._cartesian(self._reversed(slides))
        path = self._straight(program, slides, rapid=True, places=places)
        if path:
            path.commanded = slides.keys()
        return path

    def _straight(
        self,
        program: Travel,
        slides: Travel | None = None,
        *,
        rapid: bool,
        exact: Travel | None = None,
        places: Mapping[int, int] | None = None,
    ) -> StraightPath | None:
        """A straight path by `program`, its slides as they follow from it or as they are given; None where
        nothing is to be travelled. `exact`: absolute positions at the end; `places`: text columns."""
        length = math.sqrt(sum([d * d for d in program.values()]))
        if length < NOTHING:
            return None
        mapped = slides is None
        slides = self._slides(program) if slides is None else slides
        top, rate = straight_limits(self.machine.axes, slides, length, rapid=rapid)
        slides, machine = self._carried_out(program, slides, self._cartesian)
        if self.timeline.epochs:
            top, rate = self._spare(slides, length, top, rate)
        base, travel = self._from_here(slides)
        return StraightPath(
            length=length,
            top_speed=top,
            acceleration=rate,
            base=base,
            rapid=rapid,
            version=self._version,
            commanded=program.keys(),
            crossing=self.limits.before_motion(base, travel) or self.limits.straight(base, travel),
            exact=exact or {},
            places=places or {},
            program=program,
            machine=machine,
            slides=slides,
            mapped=mapped,
        )

    def _arc(
        self,
        program: Mapping[int, Wave],
        *,
        radius: float,
        sweep: float,
        wanted: float,
        exact: Travel | None = None,
        places: Mapping[int, int] | None = None,
    ) -> ArcPath | None:
        """An arc by displacements over the angles 0 to `sweep` [rad]; `wanted`: speed asked for [1/s]."""
        length = radius * sweep
        if length < NOTHING:
            return None
        slides = self._slide_waves(program)
        top, rate = arc_limits(self.machine.axes, slides, radius, wanted)
        slides, machine = self._carried_out(program, slides, self._cartesian_waves)
        base, travel = self._from_here({k: wave.at(sweep) for k, wave in slides.items()})
        there = {k: wave.plus(Wave(base[k]), 1.0) for k, wave in slides.items()}
        path = ArcPath(
            length=length,
            top_speed=top,
            acceleration=rate,
            base=base,
            rapid=False,
            version=self._version,
            commanded=program.keys(),
            crossing=self.limits.before_motion(base, travel) or self.limits.arc(base, there, sweep),
            exact=exact or {},
            places=places or {},
            radius=radius,
            sweep=sweep,
            wanted=wanted,
            program=program,
            machine=machine,
            slides=slides,
        )
        if self.timeline.epochs:
            path.top_speed, path.acceleration = self._spare(path.shares, 1.0, top, rate)
        return path

    def _carried_out(
        self,
        program: Mapping[int, _T],
        slides: Mapping[int, _T],
        cartesian: Callable[[Mapping[int, _T]], Mapping[int, _T]],
    ) -> tuple[Mapping[int, _T], Mapping[int, _T]]:
        """The motion of the slides without those that stand locked, and what it is in Cartesian machine
        terms: that of the program, but under machine lock and mirror image."""
        locked = self._locked()
        if locked:
            slides = {k: motion for k, motion in slides.items() if k not in locked}
        return slides, cartesian(slides) if locked or self._mirrored() else program

    def _from_here(self, slides: Travel) -> tuple[list[float], list[float]]:
        """(axes,) positions of the tracks, and the way of every slide from there."""
        base = self.timeline.own(self.time)
        travel = [0.0] * len(base)
        for k, way in slides.items():
            travel[k] = way
        return base, travel

    def _spare(self, slides: Travel, length: float, top: float, rate: float) -> tuple[float, float]:
        """Path limits at which the helical shift does not drive the slave beyond its own limits, either."""
        epoch = self.timeline.coupling
        shift = sum(abs(w * slides.get(k, 0.0)) for k, w in epoch.weights.items()) if epoch else 0.0
        if epoch is None or shift == 0.0:
            return top, rate
        slave = self.machine.axes[epoch.gear.slave]
        return min(top, slave.rapid * length / shift), min(rate, slave.acceleration * length / shift)

    def _top(self, path: AnyPath, speed: float) -> float:
        """Path speed that leaves the slave within its limit together with what the master makes it turn now
        and when it has its commanded speed; on an arc wherever the helical shift is steepest.

        Raises PS1596, PS5018 where the master alone takes it there; a path under way (`speed` > 0) is to stop
        first.
        """
        epoch = self.timeline.coupling
        if epoch is None:
            return path.top_speed
        gear, shift = epoch.gear, self._shift(path)
        slave, master = self.machine.axes[gear.slave], self.timeline.tracks[gear.master]
        moments = (self.time, self.spindles.ready(gear.master, self.time))
        rates = [gear.ratio * master.speed(moment) for moment in moments]
        ahead = max(math.copysign(rate, shift * rate) for rate in rates)
        turning = max(map(abs, rates)) if isinstance(path, ArcPath) else ahead
        if abs(shift) < NOTHING or turning <= 0.0:
            return path.top_speed
        limit = slave.spindle_max * DEG_PER_S
        spare = limit - turning
        if spare >= limit * NOTHING:
            return min(path.top_speed, spare / abs(shift))
        if speed > 0.0:
            return 0.0
        found = f"a motion of {slave.letter} beside {turning / DEG_PER_S:.0f} rpm in sync"
        valid = f"S that leaves {slave.letter} below its {slave.spindle_max:.0f} rpm"
        raise alarm(_OVER_SPEED[gear.kind], found, self._span, valid=valid)

    def _shift(self, path: AnyPath) -> float:
        """What a path turns the slave, by itself and by the helical shift, per path [deg/mm]; of an arc the
        most it can be anywhere."""
        epoch, shares = self.timeline.coupling, path.shares
        if epoch is None:
            return 0.0
        own = shares.get(epoch.gear.slave, 0.0)
        parts = [own, *(w * shares.get(k, 0.0) for k, w in epoch.weights.items())]
        return sum(map(abs, parts)) if isinstance(path, ArcPath) else sum(parts)

    def _rest(self, path: AnyPath, position: float) -> AnyPath | None:
        """What is left of a path behind a position, for the machine as it is now, parallel to the old one."""
        left: AnyPath | None
        if isinstance(path, ArcPath):
            sweep = path.sweep - position / path.radius
            left = self._arc(path.rest(position), radius=path.radius, sweep=sweep, wanted=path.wanted)
        else:
            program, _, slides = path.between(position, path.length)
            left = self._straight(program, None if path.mapped else slides, rapid=path.rapid)
        if left:
            travel, _, _ = left.between(0.0, left.length)
            left.exact = {
                k: end for k, end in path.exact.items() if self._reaches(k, travel.get(k, 0.0), end)
            }
            left.places, left.slowed, left.commanded = path.places, path.slowed, path.commanded
        return left

    def _reaches(self, axis: int, travel: float, target: float) -> bool:
        """Whether the axis' display is at `target` after so much travel."""
        error = self.registers.absolute[axis] + travel - target
        return abs(shortest(error) if self.machine.axes[axis].type_a else error) < _REACHED


def _both(travel: Travel, pair: InclinedPair, both: tuple[float, float]) -> Travel:
    """The travels with the pair's own in their place; an axis that only rounding moves stands."""
    across, along = both
    mixed = {**travel, pair.orthogonal: across, pair.inclined: along}
    if abs(across) < NOTHING:
        del mixed[pair.orthogonal]
    return mixed


def _waves(waves: Mapping[int, Wave], pair: InclinedPair, cross: float, along: float) -> Mapping[int, Wave]:
    """Coordinates of an arc with the pair's own in their place: `cross` and `along` of the inclined axis."""
    inclined = waves[pair.inclined]
    mixed = {**waves, pair.inclined: Wave(0.0).plus(inclined, along)}
    if cross:
        mixed[pair.orthogonal] = waves.get(pair.orthogonal, Wave(0.0)).plus(inclined, cross)
    return mixed
