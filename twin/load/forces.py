"""Cutting forces over time: the law of one piece of metal, and all pieces on the machine's clock.

The energy of a piece is k_c ΔV. The edge pays it along its own way against the metal, F_c = E / way, so power
and torque agree whatever the motion; feed and passive force stand square to that way and pay nothing.
Generalised forces are those of virtual work: Q_k = F · ∂(edge − metal)/∂q_k.
"""

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
"""[ticks] in which a piece can be removed"""


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
    """What the cut does to the machine, tick by tick of the controller's clock: a `PhasedLoad`.

    Only ticks in which metal is removed have a row; in all others every force is zero.
    """

    spindle: int
    """column of the tool spindle"""
    angle: tuple[Ints, Floats]
    """ticks (m,), increasing, and the tool's angle (m,) [deg] at their ends, in the motion that cut"""

    tick: Ints
    """(n,) increasing"""
    axes: Floats
    """(n, axes) mean force on each axis during the tick [N, N m], positive in its positive sense"""
    tool: Floats
    """(n, 3) mean force on the tool [N], in the work frame, which does not turn"""
    power_w: Floats
    """(n,)"""
    removed_mm3: Floats
    """(n,)"""
    compliance_um_per_n: float
    """of the mounts of tool and work together"""

    def __call__(self, first_tick: int, ticks: int) -> Floats:
        """(ticks, axes) from a tick on."""
        low, high = np.searchsorted(self.tick, [first_tick, first_tick + ticks])
        out = np.zeros((ticks, self.axes.shape[1]))
        out[self.tick[low:high] - first_tick] = self.axes[low:high]
        return out

    def angle_deg(self, first_tick: int, ticks: int) -> Floats:
        """(ticks,) of the tool at the start of each tick from one on, in the motion that cut."""
        return np.interp(np.arange(first_tick - 1, first_tick + ticks - 1), *self.angle)

    def deflection_um(self, ticks: Ints) -> Floats:
        """(m, 3) how far the mounts give way to the tool's side at the end of ticks (m,), in the work frame.

        Quasi-static, F/k: mounts answer at some hundred hertz, teeth come at some ten.
        """
        force = 0.5 * (self._looked_up(self.tool, ticks) + self._looked_up(self.tool, ticks + 1))
        return self.compliance_um_per_n * force

    def recorded(self, ticks: Ints) -> RecordedLoad:
        """The forces of some ticks (m,), increasing."""
        return RecordedLoad(
            axes=self._looked_up(self.axes, ticks),
            power_w=self._looked_up(self.power_w, ticks),
            deflection_um=self.deflection_um(ticks),
        )

    def on(self, ticks: Ints, angle_deg: Floats) -> "CuttingLoad":
        """The same load on another motion, which has the tool at other angles (m,) at the ends of ticks (m,):
        it comes with its angles."""
        own = np.interp(ticks, *self.angle)
        rate = np.gradient(own) if len(ticks) > 1 else np.zeros(len(ticks))
        ahead = np.divide(angle_deg - own, rate, out=np.zeros(len(ticks)), where=np.abs(rate) > TURNS)
        at = ticks + np.clip(ahead, -FARTHEST, FARTHEST)
        low = np.floor(at).astype(np.int64)
        share = at - low
        before, after = self.at(low), self.at(low + 1)
        values = {
            name: before[name]
            + (share[:, None] if before[name].ndim > 1 else share) * (after[name] - before[name])
            for name in before
        }
        some = np.flatnonzero(values["power_w"] != 0.0)
        return replace(
            self,
            angle=(ticks, angle_deg),
            tick=ticks[some],
            **{name: value[some] for name, value in values.items()},
        )

    def at(self, ticks: Ints) -> dict[str, Floats]:
        """The columns of some ticks (m,), by name."""
        return {
            name: self._looked_up(getattr(self, name), ticks)
            for name in ("axes", "tool", "power_w", "removed_mm3")
        }

    def tool_force(self, ticks: Ints) -> Floats:
        """(m, 3) mean force on the tool during some ticks (m,) [N]."""
        return self._looked_up(self.tool, ticks)

    def _looked_up(self, values: Floats, ticks: Ints) -> Floats:
        out = np.zeros((len(ticks), *values.shape[1:]))
        if len(self.tick):
            at = np.minimum(np.searchsorted(self.tick, ticks), len(self.tick) - 1)
            found = self.tick[at] == ticks
            out[found] = values[at[found]]
        return out


def mixed(loads: list[CuttingLoad], weights: Floats) -> CuttingLoad:
    """Σ weight · load, of loads on the same motion, weights (k,) that come to 1."""
    ticks = np.unique(np.concatenate([load.tick for load in loads]))
    rows = [load.at(ticks) for load in loads]
    sums = {name: sum(w * row[name] for w, row in zip(weights, rows, strict=True)) for name in rows[-1]}
    return replace(loads[-1], tick=ticks, **sums)


def cutting_load(
    metal: Removal,
    motions: tuple[CutterMotion, ...],
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
    tick, summed = _by_tick(metal.time_s / tick_s, rows)
    mean = summed / tick_s
    axes = kinematics.axes
    return CuttingLoad(
        spindle=kinematics.tool.spindle.column,
        angle=(clock.tick, clock.tool_angle_deg),
        tick=tick,
        axes=mean[:, :axes],
        tool=mean[:, axes : axes + 3],
        power_w=mean[:, axes + 3],
        removed_mm3=mean[:, axes + 4],
        compliance_um_per_n=1.0 / physics.tool_stiffness_n_per_um + 1.0 / physics.work_stiffness_n_per_um,
    )


def _impulses(metal: Removal, motions: tuple[CutterMotion, ...], energy: Floats, physics: Physics) -> Floats:
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


def _on_axes(
    metal: Removal, motions: tuple[CutterMotion, ...], push: Floats, kinematics: Kinematics
) -> Floats:
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


def _by_tick(span: Floats, rows: Floats) -> tuple[Ints, Floats]:
    """Rows (n, k) spread evenly over their spans (n, 2) of the clock, and summed by tick."""
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
