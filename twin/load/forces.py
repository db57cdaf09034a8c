"""Cutting forces over time: the law of one piece of metal, and all pieces on the machine's clock.

The energy of a piece is k_c ΔV. The edge pays it along its own way against the metal, F_c = E / way, so power
and torque agree whatever the motion; feed and passive force stand square to that way and pay nothing.
Generalised forces are those of virtual work: Q_k = F · ∂(edge − metal)/∂q_k.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import CutterMotion
from twin.kinematics import Kinematics
from twin.load.material import Material, Physics
from twin.load.removal import Removal
from twin.recording import RecordedLoad, Recording

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

METRES = 1e-3
"""of a millimetre"""
TURNS = 1e-6
"""[deg per tick] below which a spindle stands"""
FARTHEST = 64.0
"""[ticks] by which two motions of one program may be apart"""
SHORTEST = 1e-6
"""[cells] in which a piece can be removed"""
PARTS = 8
"""cells of a tick in which forces are counted: a tooth leaves its chip within less than a tick"""
COLUMNS = ("axes", "tool", "power_w", "removed_mm3")


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """When the motion that cuts was recorded, and where the tool spindle was."""

    tick_s: float
    """control period"""
    tick: Ints
    """(m,) of each sample, increasing"""
    tool_angle_deg: Floats
    """(m,) at its end"""

    @classmethod
    def of(cls, recording: Recording, tick_s: float) -> "Clock":
        """The clock of a recording."""
        return cls(
            tick_s=tick_s,
            tick=np.rint(recording.time_s / tick_s).astype(np.int64) - 1,
            tool_angle_deg=recording.tool_angle_deg,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class CuttingLoad:
    """What the cut does to the machine, by the controller's clock and the tool's angle: a `PhasedLoad`.

    Every tick has `parts` cells, for chips begin and end within ticks. Only cells in which metal is removed
    have a row; in all others every force is zero.
    """

    spindle: int
    """column of the tool spindle"""
    angle: tuple[Ints, Floats]
    """ticks (m,), increasing, and the tool's angle (m,) [deg] at their ends, in the motion that cut"""
    parts: int = 1
    """cells of a tick"""
    cell: Ints
    """(n,) increasing, from 0 at the start of the run"""
    axes: Floats
    """(n, axes) mean force on each axis during the cell [N, N m], positive in its positive sense"""
    tool: Floats
    """(n, 3) mean force on the tool [N], in the work frame, which does not turn"""
    power_w: Floats
    """(n,)"""
    removed_mm3: Floats
    """(n,) per tick, mean"""
    compliance_um_per_n: float
    """of the mounts of tool and work together"""

    @property
    def tick(self) -> Ints:
        """(k,) ticks in which metal is removed, increasing."""
        return np.unique(self.cell // self.parts)

    def __call__(self, first_tick: int, ticks: int) -> Floats:
        """(ticks, axes) mean forces from a tick on."""
        out = np.zeros((ticks * self.parts, self.axes.shape[1]))
        first = first_tick * self.parts
        low, high = np.searchsorted(self.cell, [first, first + len(out)])
        out[self.cell[low:high] - first] = self.axes[low:high]
        return out.reshape(ticks, self.parts, -1).mean(axis=1)

    def impulse(self, first_tick: int, ticks: int) -> Floats:
        """(ticks · parts + 1, axes) forces summed up from the start of a tick on, cell by cell, in ticks."""
        out = np.zeros((ticks * self.parts + 1, self.axes.shape[1]))
        first = first_tick * self.parts
        low, high = np.searchsorted(self.cell, [first, first + len(out) - 1])
        out[self.cell[low:high] - first + 1] = self.axes[low:high] / self.parts
        return np.cumsum(out, axis=0)

    def angle_deg(self, first_tick: int, ticks: int) -> Floats:
        """(ticks,) of the tool at the start of each tick from one on, in the motion that cut."""
        return np.interp(np.arange(first_tick - 1, first_tick + ticks - 1), *self.angle)

    def deflection_um(self, ticks: Ints) -> Floats:
        """(m, 3) how far the mounts give way to the tool's side at the end of ticks (m,), in the work frame.

        Quasi-static, F/k: mounts answer at some hundred hertz, teeth come at some ten.
        """
        force = 0.5 * (self.tool_force(ticks) + self.tool_force(ticks + 1))
        return self.compliance_um_per_n * force

    def recorded(self, ticks: Ints) -> RecordedLoad:
        """The forces of some ticks (m,), increasing."""
        whole = self.whole()
        return RecordedLoad(
            axes=whole.at(ticks)["axes"],
            power_w=whole.at(ticks)["power_w"],
            deflection_um=whole.deflection_um(ticks),
        )

    def on(self, ticks: Ints, angle_deg: Floats) -> "CuttingLoad":
        """The same load on another motion, which has the tool at other angles (m,) at the ends of ticks (m,):
        it comes with its angles."""
        if not len(self.cell):
            return replace(self, angle=(ticks, angle_deg))
        own = np.interp(ticks, *self.angle)
        rate = np.gradient(own) if len(ticks) > 1 else np.zeros(len(ticks))
        ahead = np.divide(angle_deg - own, rate, out=np.zeros(len(ticks)), where=np.abs(rate) > TURNS)
        ahead = np.clip(ahead, -FARTHEST, FARTHEST)
        cell = np.unique((ticks[:, None] * self.parts + np.arange(self.parts)).reshape(-1))
        begin = cell + self.parts * np.interp(cell / self.parts - 1.0, ticks, ahead)
        near = np.searchsorted(self.cell, begin - 2.0) < np.searchsorted(self.cell, begin + 2.0)
        cell, begin = cell[near], begin[near]
        values = {name: self._summed(name, begin + 1.0) - self._summed(name, begin) for name in COLUMNS}
        some = np.flatnonzero(values["power_w"] != 0.0)
        columns = {name: value[some] for name, value in values.items()}
        return replace(self, angle=(ticks, angle_deg), cell=cell[some], **columns)

    def whole(self) -> "CuttingLoad":
        """The same with one cell a tick."""
        if self.parts == 1:
            return self
        tick, place = np.unique(self.cell // self.parts, return_inverse=True)
        columns = {}
        for name in COLUMNS:
            values = getattr(self, name)
            columns[name] = np.zeros((len(tick), *values.shape[1:]))
            np.add.at(columns[name], place, values / self.parts)
        return replace(self, parts=1, cell=tick, **columns)

    def before(self, tick: int) -> "CuttingLoad":
        """What acts before a tick."""
        return self._where(self.cell < tick * self.parts, self.angle[0] < tick)

    def since(self, tick: int) -> "CuttingLoad":
        """What acts from a tick on."""
        return self._where(self.cell >= tick * self.parts, self.angle[0] >= tick)

    def then(self, other: "CuttingLoad") -> "CuttingLoad":
        """This load, and a later one after it."""
        return joined([self, other])

    def later(self, ticks: int, turns: int) -> "CuttingLoad":
        """The same once more some ticks, and some turns of the tool, later."""
        angle = self.angle[0] + ticks, self.angle[1] + 360.0 * turns
        return replace(self, cell=self.cell + ticks * self.parts, angle=angle)

    def at(self, cells: Ints) -> dict[str, Floats]:
        """The columns in some cells (m,), by name."""
        out = {name: np.zeros((len(cells), *getattr(self, name).shape[1:])) for name in COLUMNS}
        if len(self.cell):
            at = np.minimum(np.searchsorted(self.cell, cells), len(self.cell) - 1)
            found = self.cell[at] == cells
            for name, values in out.items():
                values[found] = getattr(self, name)[at[found]]
        return out

    def tool_force(self, ticks: Ints) -> Floats:
        """(m, 3) mean force on the tool during some ticks (m,) [N]."""
        begin = (ticks * self.parts).astype(np.float64)
        return (self._summed("tool", begin + self.parts) - self._summed("tool", begin)) / self.parts

    def _summed(self, name: str, cells: Floats) -> Floats:
        """A column summed up to fractional cells (m,)."""
        values = getattr(self, name)
        total = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
        ends = np.concatenate([self.cell, [np.iinfo(np.int64).max // 2]])
        low = np.searchsorted(ends, np.floor(cells).astype(np.int64))
        share = np.where(ends[low] == np.floor(cells), cells - np.floor(cells), 0.0)
        row = np.minimum(low, max(len(values) - 1, 0))
        if not len(values):
            return total[low]
        return total[low] + (share[:, None] if values.ndim > 1 else share) * values[row]

    def _where(self, rows: NDArray[np.bool_], known: NDArray[np.bool_]) -> "CuttingLoad":
        columns = {name: getattr(self, name)[rows] for name in ("cell", *COLUMNS)}
        return replace(self, angle=(self.angle[0][known], self.angle[1][known]), **columns)


def no_load(kinematics: Kinematics, physics: Physics) -> CuttingLoad:
    """Where nothing is cut."""
    none = np.zeros(0)
    return CuttingLoad(
        spindle=kinematics.tool.spindle.column,
        angle=(np.zeros(0, np.int64), none),
        parts=PARTS,
        cell=np.zeros(0, np.int64),
        axes=np.zeros((0, kinematics.axes)),
        tool=np.zeros((0, 3)),
        power_w=none,
        removed_mm3=none,
        compliance_um_per_n=physics.compliance_um_per_n,
    )


def joined(loads: Sequence[CuttingLoad]) -> CuttingLoad:
    """Loads that follow one another."""
    columns = {name: np.concatenate([getattr(load, name) for load in loads]) for name in ("cell", *COLUMNS)}
    ticks, angle = (np.concatenate(parts) for parts in zip(*(load.angle for load in loads), strict=True))
    return replace(loads[-1], angle=(ticks, angle), **columns)


def summed(loads: Sequence[CuttingLoad]) -> CuttingLoad:
    """All of some loads on the same motion together."""
    cells = np.unique(np.concatenate([load.cell for load in loads]))
    return mixed(loads, np.ones((len(loads), len(cells))), cells)


def mixed(loads: Sequence[CuttingLoad], weights: Floats, cells: Ints) -> CuttingLoad:
    """Σ weight · load, of loads on the same motion, weights (k, m) in some cells (m,), increasing."""
    some = np.flatnonzero(np.isin(cells, np.concatenate([load.cell for load in loads])))
    rows = [load.at(cells[some]) for load in loads]
    sums = {
        name: np.einsum("km,km...->m...", weights[:, some], np.stack([row[name] for row in rows]))
        for name in COLUMNS
    }
    return replace(loads[-1], cell=cells[some], **sums)


def cutting_load(
    metal: Removal,
    motions: Sequence[CutterMotion],
    *,
    kinematics: Kinematics,
    material: Material,
    physics: Physics,
    clock: Clock,
) -> CuttingLoad:
    """The forces that removing the metal puts on axes and tool; `motions` by stretch, as `metal` counts."""
    tick_s = clock.tick_s
    energy = material.specific_force(metal.thickness_mm()) * metal.volume_mm3
    pushes = _impulses(metal, motions, energy, physics)
    on_axes = _on_axes(metal, motions, pushes, kinematics)
    rows = np.column_stack([on_axes, pushes, energy * METRES, metal.volume_mm3 * tick_s])
    cell_s = tick_s / PARTS
    cell, sums = _by_cell(metal.time_s / cell_s, rows)
    mean = sums / cell_s
    axes = kinematics.axes
    return CuttingLoad(
        spindle=kinematics.tool.spindle.column,
        angle=(clock.tick, clock.tool_angle_deg),
        parts=PARTS,
        cell=cell,
        axes=mean[:, :axes],
        tool=mean[:, axes : axes + 3],
        power_w=mean[:, axes + 3],
        removed_mm3=mean[:, axes + 4],
        compliance_um_per_n=physics.compliance_um_per_n,
    )


def _impulses(metal: Removal, motions: Sequence[CutterMotion], energy: Floats, physics: Physics) -> Floats:
    """(n, 3) impulses on the tool [N s], `energy` (n,) [mJ] paid along the edges' way."""
    speed = np.maximum(np.linalg.norm(metal.speed, axis=1), 1e-9)[:, None]
    way = metal.speed / speed
    cutting = energy[:, None] / speed
    axis = np.array([motion.basis[2] for motion in motions]).reshape(-1, 3)[metal.chip[:, 0]]
    outward = metal.lever_mm - (metal.lever_mm * axis).sum(axis=1)[:, None] * axis
    outward /= np.maximum(np.linalg.norm(outward, axis=1), 1e-9)[:, None]
    along, away = metal.push[:, :1], metal.push[:, 1:]
    aside = physics.feed_force_ratio * along * axis + physics.passive_force_ratio * away * outward
    aside -= (aside * way).sum(axis=1)[:, None] * way
    return cutting * (aside - way)


def _on_axes(metal: Removal, motions: Sequence[CutterMotion], push: Floats, kinematics: Kinematics) -> Floats:
    """(n, axes) generalised impulses [N s, N m s] of impulses (n, 3) on the tool."""
    axes = kinematics.axes
    (origin, *ends), _ = kinematics.tool.pose(np.vstack([np.zeros(axes), np.eye(axes)]))
    _, (work,) = kinematics.work.pose(np.zeros((1, axes)))
    on_axes = push @ ((np.array(ends) - origin) @ work).T
    axis = np.array([motion.basis[2] for motion in motions]).reshape(-1, 3)[metal.chip[:, 0]]
    tool, spindle = kinematics.tool.spindle.column, kinematics.work.spindle.column
    on_axes[:, tool] = METRES * (np.cross(metal.lever_mm, push) * axis).sum(axis=1)
    on_axes[:, spindle] = -METRES * np.cross(metal.place_mm, push)[:, 2]
    return on_axes


def _by_cell(span: Floats, rows: Floats) -> tuple[Ints, Floats]:
    """Rows (n, k) spread evenly over their spans (n, 2) of the clock, and summed by cell."""
    begin = np.maximum(span[:, 0], 0.0)
    end = np.maximum(span[:, 1], begin + SHORTEST)
    first = np.floor(begin).astype(np.int64)
    count = np.ceil(end).astype(np.int64) - first
    owner = np.repeat(np.arange(len(rows)), count)
    ticks = first[owner] + np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    overlap = np.minimum(end[owner], ticks + 1) - np.maximum(begin[owner], ticks)
    share = overlap / (end - begin)[owner]
    tick, place = np.unique(ticks, return_inverse=True)
    summed = [np.bincount(place, share * column[owner], len(tick)) for column in rows.T]
    return tick, np.asarray(np.column_stack(summed), dtype=np.float64)
