"""One path of several axes at once: straight, or an arc; how far, how fast, where a stroke limit ends it.

The position along a path is Cartesian [mm], of rotary axes alone in degrees. What a path does to the displays
(`program`), to the Cartesian machine position (`machine`) and to the slides is kept apart: they differ with
an inclined pair and under machine lock.
"""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from controller.laws.segments import Phase, Track
from controller.laws.stroke_area import Crossing
from controller.laws.wave import Wave
from controller.tables.machine_data import Axis

NOTHING = 1e-9
"""[mm | deg] far below the least increment: rounding, not travel"""
Travel = Mapping[int, float]
"""column -> travel [mm | deg]; what is not named stands"""


@dataclass(slots=True, kw_only=True)
class Path:
    """What straight paths and arcs have in common."""

    length: float
    top_speed: float
    """[1/s] the highest path speed that no axis exceeds"""
    acceleration: float
    """[1/s²]"""
    base: Sequence[float]
    """(axes,) positions of the tracks at the start"""
    rapid: bool
    version: int
    """of the state of the machine that the path was planned for"""
    commanded: Collection[int]
    """columns that the program moves"""
    end: float = field(init=False)
    """path position where the motion stops: `length` unless a stroke limit is in the way"""
    crossing: Crossing | None
    exact: Travel
    """absolute positions at `length`, exactly"""
    places: Mapping[int, int]
    """column -> text column of the word that commanded it"""
    settled: float = 0.0
    """path position that the displays show"""
    slowed: bool = False
    """an axis limit has been reported"""

    def __post_init__(self) -> None:
        self.end = self.length


@dataclass(slots=True, kw_only=True)
class StraightPath(Path):
    """A straight path: everything in proportion to the path position."""

    program: Travel
    machine: Travel
    slides: Travel
    mapped: bool
    """the slides follow from the program; else they are what was commanded (G53, reference return)"""

    @property
    def shares(self) -> Travel:
        """Slide travel per path."""
        return {k: travel / self.length for k, travel in self.slides.items()}

    def lay(self, tracks: Sequence[Track], phases: Iterable[Phase], time: float) -> None:
        """Put the motion on the tracks of the slides that move, from `time` on."""
        for k, travel in self.slides.items():
            add, base, share, start = tracks[k].add, self.base[k], travel / self.length, time
            for duration, position, speed, acceleration in phases:
                add(start, base + share * position, share * speed, share * acceleration)
                start += duration

    def stop(self, tracks: Sequence[Track], position: float, time: float) -> None:
        """The slides stand at a path position from `time` on."""
        part = position / self.length
        for k, travel in self.slides.items():
            tracks[k].add(time, self.base[k] + travel * part)

    def between(self, start: float, end: float) -> tuple[Travel, Travel, Travel]:
        """Travel in program, machine and slides between two path positions."""
        if start == 0.0 and end == self.length:
            return self.program, self.machine, self.slides
        part = (end - start) / self.length
        program = {k: d * part for k, d in self.program.items()}
        machine = program if self.machine is self.program else {k: d * part for k, d in self.machine.items()}
        return program, machine, {k: d * part for k, d in self.slides.items()}


@dataclass(slots=True, kw_only=True)
class ArcPath(Path):
    """An arc, and what goes along with it: coordinates over the angle, which is path position by radius."""

    radius: float
    sweep: float
    """[rad]"""
    wanted: float
    """speed asked for [1/s]"""
    program: Mapping[int, Wave]
    """column -> displacement"""
    machine: Mapping[int, Wave]
    slides: Mapping[int, Wave]

    @property
    def shares(self) -> Travel:
        """The largest slide travel per path anywhere on the arc."""
        return {k: steepest(wave, self.sweep) / self.radius for k, wave in self.slides.items()}

    def lay(self, tracks: Sequence[Track], phases: Iterable[Phase], time: float) -> None:
        """Put the motion on the tracks of the slides that move, from `time` on."""
        r = self.radius
        for k, wave in self.slides.items():
            there, start = wave.plus(Wave(self.base[k]), 1.0), time
            for duration, position, speed, acceleration in phases:
                tracks[k].add_round(start, there, position / r, speed / r, acceleration / r)
                start += duration

    def stop(self, tracks: Sequence[Track], position: float, time: float) -> None:
        """The slides stand at a path position from `time` on."""
        for k, wave in self.slides.items():
            tracks[k].add(time, self.base[k] + wave.at(position / self.radius))

    def between(self, start: float, end: float) -> tuple[Travel, Travel, Travel]:
        """Travel in program, machine and slides between two path positions."""
        u, v = start / self.radius, end / self.radius
        return _gains(self.program, u, v), _gains(self.machine, u, v), _gains(self.slides, u, v)

    def rest(self, position: float) -> dict[int, Wave]:
        """The displacements of what is left behind a path position, over the angle from there."""
        u = position / self.radius
        return {k: later(wave, u) for k, wave in self.program.items()}


AnyPath = StraightPath | ArcPath


def _gains(waves: Mapping[int, Wave], u: float, v: float) -> Travel:
    return {k: wave.at(v) - wave.at(u) for k, wave in waves.items()}


def later(wave: Wave, u: float) -> Wave:
    """The displacement from the angle `u` on, over the angle from there."""
    c, s = math.cos(u), math.sin(u)
    cosine, sine = wave.cosine * c + wave.sine * s, wave.sine * c - wave.cosine * s
    return Wave(-cosine, cosine, sine, wave.rate)


def steepest(wave: Wave, sweep: float) -> float:
    """The largest magnitude of the slope over the angles 0 to `sweep` [mm/rad]."""
    slope = Wave(wave.rate, wave.sine, -wave.cosine)
    return max(abs(slope.at(u)) for u in (0.0, *slope.turning(sweep), sweep))


def straight_limits(
    axes: Sequence[Axis], slides: Travel, length: float, *, rapid: bool
) -> tuple[float, float]:
    """Path speed and acceleration at which the first axis of a straight path meets its limit."""
    top = rate = math.inf
    for k, travel in slides.items():
        axis = axes[k]
        ratio = length / abs(travel)
        speed = (axis.rapid if rapid else axis.cutting) * ratio
        top = min(top, speed)
        rate = min(rate, axis.acceleration * ratio)
    return top, rate


CENTRIPETAL = 0.8
"""share of the acceleration that an arc at its highest speed needs; the rest is left for the path"""


def arc_limits(
    axes: Sequence[Axis], slides: Mapping[int, Wave], radius: float, wanted: float
) -> tuple[float, float]:
    """Path speed and acceleration at which the first axis of an arc meets its limit.

    On the circle v²/r and the path's own acceleration stand at right angles: both together stay within what
    the axes can do. `wanted` is the path speed asked for: the slower, the more is left for the path.
    """
    top, total, along = math.inf, math.inf, math.inf
    for k, wave in slides.items():
        round_share = math.hypot(wave.cosine, wave.sine) / radius
        share = round_share + abs(wave.rate) / radius
        if share < NOTHING:
            continue
        top = min(top, axes[k].cutting / share)
        if round_share > NOTHING:
            total = min(total, axes[k].acceleration / share)
        else:
            along = min(along, axes[k].acceleration / share)
    top = min(top, math.sqrt(CENTRIPETAL * total * radius))
    speed = min(top, wanted)
    centripetal = speed * speed / radius
    return top, min(along, math.sqrt(total * total - centripetal * centripetal))


def stopping_point(length: float, limit: float, speed: float, acceleration: float, *, before: bool) -> float:
    """Where the path ends that meets a stroke limit at `limit` (parameter 1300#7, BFA).

    `before`: the axis stops on the limit; else it begins to brake there.
    """
    if before:
        return limit
    squared = min(speed * speed, 2.0 * acceleration * limit, 2.0 * acceleration * (length - limit))
    return min(length, limit + max(squared, 0.0) / (2.0 * acceleration))
