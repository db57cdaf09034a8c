"""All axes over time: one track an axis, the epochs of the gear box, and which tool is held when.

The slave's own track carries what it would do without gear box; the law of the epoch is added where the
timeline is read, from the master's closed form, so no error can grow with the number of turns.
"""

import bisect
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from controller.laws.angle_table import RAMP_S, TableInForce
from controller.laws.gearbox import GearBox, slave_travel
from controller.laws.segments import Track


@dataclass(slots=True, kw_only=True)
class Epoch:
    """One engagement of the gear box."""

    gear: GearBox
    start: float
    """[s]"""
    master_start: float
    """master position at `start` [deg]: measured for the follow type, else commanded"""
    slides_start: Sequence[float]
    """(axes,) own positions at `start`"""
    weights: Mapping[int, float]
    """column -> slave shift per slide travel [deg/mm]: none but for a helical gear"""
    end: float = math.inf

    def shift(self, own: Sequence[float]) -> float:
        """Helical shift of the slave [deg] at own positions (axes,)."""
        return sum(weight * (own[k] - self.slides_start[k]) for k, weight in self.weights.items())


@dataclass(slots=True)
class Marks:
    """A whole number over time."""

    times: list[float] = field(default_factory=lambda: [-math.inf])
    values: list[int] = field(default_factory=lambda: [0])

    def add(self, time: float, value: int) -> None:
        """From just after `time` on it is `value`."""
        if self.times[-1] == time:
            self.values[-1] = value
        elif value != self.values[-1]:
            self.times.append(time)
            self.values.append(value)

    def forget(self, before: float) -> None:
        """Free what no time from `before` on needs."""
        k = bisect.bisect_left(self.times, before) - 1
        if k > 0:
            del self.times[:k]
            del self.values[:k]


@dataclass(slots=True)
class Timeline:
    """The planned motion so far; valid up to the planner's own time."""

    axes: int
    tracks: list[Track] = field(init=False)
    epochs: list[Epoch] = field(default_factory=list)
    tools: Marks = field(default_factory=Marks)
    rapids: Marks = field(default_factory=Marks)
    """1 while a path is travelled at rapid"""
    corrections: list[TableInForce] = field(default_factory=list)
    """tables against the work angle, added where the timeline is sampled: no display counts them"""

    def __post_init__(self) -> None:
        self.tracks = [Track() for _ in range(self.axes)]

    @property
    def coupling(self) -> Epoch | None:
        """The epoch that is open."""
        return self.epochs[-1] if self.epochs and self.epochs[-1].end == math.inf else None

    @property
    def follows(self) -> bool:
        """Whether an open or unread engagement is of the follow type: the machine moves the slave."""
        return any(epoch.gear.follow for epoch in self.epochs)

    def own(self, time: float) -> list[float]:
        """(axes,) positions at one time without the gear box."""
        return [track.at(time) for track in self.tracks]

    def positions(self, time: float) -> list[float]:
        """(axes,) commanded positions at one time, the open epoch included."""
        positions = self.own(time)
        epoch = self.coupling
        if epoch:
            shift = epoch.shift(positions)
            master = positions[epoch.gear.master] - epoch.master_start
            positions[epoch.gear.slave] += slave_travel(epoch.gear, master) + shift
        return positions

    def speed(self, axis: int, time: float) -> float:
        """Commanded speed of one axis [1/s], the open epoch's rotation included."""
        epoch = self.coupling
        own = self.tracks[axis].speed(time)
        if epoch and axis == epoch.gear.slave:
            return own + self.tracks[epoch.gear.master].speed(time) * epoch.gear.ratio
        return own

    def still_until(self, time: float) -> float:
        """Until when no axis moves from `time` on; inf where nothing planned moves again."""
        tables = (correction.still_until(time) for correction in self.corrections)
        return min(*(track.still_until(time) for track in self.tracks), *tables)

    def go_rapid(self, begin: float, end: float) -> None:
        """A path is travelled at rapid between two times."""
        self.rapids.add(begin, 1)
        self.rapids.add(end, 0)

    def forget(self, before: float) -> None:
        """Free what no time from `before` on needs."""
        for track in self.tracks:
            track.forget(before)
        self.tools.forget(before)
        self.rapids.forget(before)
        if self.epochs and self.epochs[0].end <= before:
            self.epochs = [epoch for epoch in self.epochs if epoch.end > before]
        self.corrections = [one for one in self.corrections if one.end + RAMP_S > before]
