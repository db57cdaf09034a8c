"""All axes over time: one track an axis, the epochs of the gear box, and what block and tool held when.

The slave's own track carries what it would do without gear box; the law of the epoch is added where the
timeline is read, from the master's closed form, so no error can grow with the number of turns.
"""

import bisect
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from controller.gearbox import GearBox, slave_travel
from controller.segments import Track

Floats = NDArray[np.float64]


@dataclass(slots=True, kw_only=True)
class Epoch:
    """One engagement of the gear box."""

    gear: GearBox
    start: float
    """[s]"""
    master_start: float
    """master position at `start` [deg]: measured for the follow type, else commanded"""
    slides_start: Floats
    """(axes,) own positions at `start`"""
    weights: Floats
    """(axes,) slave shift per slide travel [deg/mm]: zero but for a helical gear"""
    end: float = math.inf

    def shift(self, own: Floats) -> Floats:
        """Helical shift of the slave (n,) at own positions (n, axes)."""
        return (own - self.slides_start) @ self.weights


@dataclass(slots=True)
class Marks:
    """A whole number over time: which block, which tool."""

    times: list[float] = field(default_factory=lambda: [-math.inf])
    values: list[int] = field(default_factory=lambda: [0])

    def add(self, time: float, value: int) -> None:
        """From just after `time` on it is `value`."""
        if self.times[-1] == time:
            self.values[-1] = value
        elif value != self.values[-1]:
            self.times.append(time)
            self.values.append(value)

    def sample(self, time: Floats) -> NDArray[np.int64]:
        """(n,) values in force up to each time (n,)."""
        if self.times[-1] < time[0]:
            return np.full(len(time), self.values[-1])
        k = np.searchsorted(np.array(self.times), time, side="left") - 1
        return np.array(self.values)[k]

    def forget(self, before: float) -> None:
        """Drop what no time from `before` on needs."""
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
    blocks: Marks = field(default_factory=Marks)
    tools: Marks = field(default_factory=Marks)

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

    def own(self, time: float) -> Floats:
        """(axes,) positions at one time without the gear box."""
        return np.array([track.at(time) for track in self.tracks])

    def positions(self, time: float) -> Floats:
        """(axes,) commanded positions at one time, the open epoch included."""
        positions = self.own(time)
        epoch = self.coupling
        if epoch:
            shift = float(epoch.shift(positions))
            master = float(positions[epoch.gear.master]) - epoch.master_start
            positions[epoch.gear.slave] += slave_travel(epoch.gear, master) + shift
        return positions

    def speed(self, axis: int, time: float) -> float:
        """Commanded speed of one axis [1/s], the open epoch's rotation included."""
        epoch = self.coupling
        own = self.tracks[axis].speed(time)
        if epoch and axis == epoch.gear.slave:
            return own + self.tracks[epoch.gear.master].speed(time) * epoch.gear.ratio
        return own

    def sample(self, time: Floats) -> Floats:
        """(n, axes) setpoints at ascending times (n,); follow-type rotation is left to the machine."""
        out = np.stack([track.sample(time) for track in self.tracks], axis=1)
        for epoch in self.epochs:
            first, last = np.searchsorted(time, (epoch.start, epoch.end), side="left")
            if first < last:
                part = out[first:last]
                added = epoch.shift(part)
                if not epoch.gear.follow:
                    added += slave_travel(epoch.gear, part[:, epoch.gear.master] - epoch.master_start)
                part[:, epoch.gear.slave] += added
        return out

    def in_sync(self, time: Floats) -> NDArray[np.bool_]:
        """(n,) whether the gear box was engaged up to each time."""
        engaged = np.zeros(len(time), dtype=bool)
        for epoch in self.epochs:
            engaged |= (time > epoch.start) & (time <= epoch.end)
        return engaged

    def still_until(self, time: float) -> float:
        """Until when no axis moves from `time` on; inf where nothing planned moves again."""
        return min(track.still_until(time) for track in self.tracks)

    def forget(self, before: float) -> None:
        """Free what no time from `before` on needs."""
        for track in self.tracks:
            track.forget(before)
        self.blocks.forget(before)
        self.tools.forget(before)
        self.epochs = [epoch for epoch in self.epochs if epoch.end > before]
