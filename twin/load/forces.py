"""Cutting forces of pieces of metal, on the machine's clock, and how they change where the edges give way.

The energy of a piece is k_c ΔV, k_c that of the chip's thickness there. The edge pays it along its own way
against the metal, F_c = E / way, so power and torque agree whatever the motion; feed and passive force stand
square to that way and pay nothing. Generalised forces are those of virtual work,
Q_k = F · ∂(edge − metal)/∂q_k.

An edge that gives way by δ leaves n · δ of the thickness h standing, n the normal that it is pushed along:
F_c = k_c1.1 b h^(1 − m_c) changes by −(1 − m_c) F_c / h of that.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import CutterMotion
from twin.kinematics import Kinematics
from twin.load.material import Material, Physics
from twin.load.removal import Removal
from twin.load.timeline import COLUMNS, PARTS, CuttingLoad, summed

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

METRES = 1e-3
"""of a millimetre"""
SHORTEST = 1e-6
"""[cells] in which a piece can be removed"""
THINNEST = 1e-6
"""[mm] of a chip whose force still changes with its thickness"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """When the motion that cuts was recorded, and where the tool spindle was."""

    tick_s: float
    """control period"""
    tick: Ints
    """(m,) of each sample, increasing"""
    tool_angle_deg: Floats
    """(m,) at its end"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stiff:
    """Cutting forces, and their change with a displacement of the tool."""

    load: CuttingLoad
    axes: Floats
    """(n, axes, 3) change of the load's columns, by cell, per way of the tool in the work frame [1/mm]"""
    tool: Floats
    """(n, 3, 3) [N/mm]"""
    power_w: Floats
    """(n, 3)"""
    removed_mm3: Floats
    """(n, 3) zero: what is taken away is known"""

    def and_also(self, other: CuttingLoad) -> "Stiff":
        """With other forces on the same motion, that do not change."""
        load = summed([other, self.load])
        place = np.searchsorted(load.cell, self.load.cell)
        columns = {}
        for name in COLUMNS:
            values = getattr(self, name)
            columns[name] = np.zeros((len(load.cell), *values.shape[1:]))
            columns[name][place] = values
        return Stiff(load=replace(load, angle=self.load.angle), **columns)

    def before(self, tick: int) -> "Stiff":
        """What acts before a tick."""
        some = self.load.cell < tick * self.load.parts
        columns = {name: getattr(self, name)[some] for name in COLUMNS}
        load = replace(
            self.load, cell=self.load.cell[some], **{n: getattr(self.load, n)[some] for n in COLUMNS}
        )
        return Stiff(load=load, **columns)


def cutting_load(
    metal: Removal,
    motion: CutterMotion,
    *,
    kinematics: Kinematics,
    material: Material,
    physics: Physics,
    clock: Clock,
    compliance_um_per_n: float,
    since: int = 0,
) -> Stiff:
    """The forces that removing the metal puts on axes and tool, those from tick `since` on, whose mounts give
    way by `compliance_um_per_n`."""
    tick_s, axes = clock.tick_s, kinematics.axes
    energy = material.specific_force(metal.thickness_mm) * metal.volume_mm3
    sides = _Sides(metal, motion)
    push = sides.impulses(metal, energy, physics)
    rows = np.column_stack(
        [_on_axes(metal, motion, push, kinematics), push, energy * METRES, metal.volume_mm3 * tick_s]
    )
    thickness = np.maximum(metal.thickness_mm, THINNEST)
    share = np.repeat(material.growth(metal.thickness_mm)[:, None], rows.shape[1], axis=1)
    share[:, -1] = 0.0
    change = -(rows * share / thickness[:, None])[:, :, None] * sides.normal[:, None, :]
    cell_s = tick_s / PARTS
    cell, sums = _by_cell(
        metal.time_s / cell_s, np.hstack([rows, change.reshape(len(rows), 3 * rows.shape[1])]), since * PARTS
    )
    sums /= cell_s
    mean, slope = sums[:, : axes + 5], sums[:, axes + 5 :].reshape(-1, axes + 5, 3)
    load = CuttingLoad(
        spindle=kinematics.tool.spindle.column,
        angle=(clock.tick, clock.tool_angle_deg),
        parts=PARTS,
        cell=cell,
        axes=mean[:, :axes],
        tool=mean[:, axes : axes + 3],
        power_w=mean[:, axes + 3],
        removed_mm3=mean[:, axes + 4],
        compliance_um_per_n=compliance_um_per_n,
    )
    return Stiff(
        load=load,
        axes=slope[:, :axes],
        tool=slope[:, axes : axes + 3],
        power_w=slope[:, axes + 3],
        removed_mm3=slope[:, axes + 4],
    )


class _Sides:
    """Where the edges stand against the metal: (n, 3) along their way, the tool's axis and away from it."""

    def __init__(self, metal: Removal, motion: CutterMotion) -> None:
        self._speed = np.maximum(np.linalg.norm(metal.speed, axis=1), 1e-9)[:, None]
        self._way = metal.speed / self._speed
        self._axis = motion.basis[2]
        outward = metal.lever_mm - (metal.lever_mm @ self._axis)[:, None] * self._axis
        self._outward = outward / np.maximum(np.linalg.norm(outward, axis=1), 1e-9)[:, None]
        self.normal = metal.push[:, :1] * self._axis + metal.push[:, 1:] * self._outward
        """(n, 3) from the metal into the edge"""

    def impulses(self, metal: Removal, energy: Floats, physics: Physics) -> Floats:
        """(n, 3) impulses on the tool [N s], `energy` (n,) [mJ] paid along the edges' way."""
        along, away = metal.push[:, :1], metal.push[:, 1:]
        aside = (
            physics.feed_force_ratio * along * self._axis + physics.passive_force_ratio * away * self._outward
        )
        aside -= (aside * self._way).sum(axis=1)[:, None] * self._way
        return energy[:, None] / self._speed * (aside - self._way)


def _on_axes(metal: Removal, motion: CutterMotion, push: Floats, kinematics: Kinematics) -> Floats:
    """(n, axes) generalised impulses [N s, N m s] of impulses (n, 3) on the tool."""
    axes = kinematics.axes
    (origin, *ends), _ = kinematics.tool.pose(np.vstack([np.zeros(axes), np.eye(axes)]))
    _, (work,) = kinematics.work.pose(np.zeros((1, axes)))
    on_axes = push @ ((np.array(ends) - origin) @ work).T
    tool, spindle = kinematics.tool.spindle.column, kinematics.work.spindle.column
    on_axes[:, tool] = METRES * np.cross(metal.lever_mm, push) @ motion.basis[2]
    on_axes[:, spindle] = -METRES * np.cross(metal.place_mm, push)[:, 2]
    return on_axes


def _by_cell(span: Floats, rows: Floats, since: int) -> tuple[Ints, Floats]:
    """Rows (n, k) spread evenly over their spans (n, 2) of the clock, and summed by cell from `since` on."""
    from scipy.sparse import csr_array  # noqa: PLC0415 - slow to load, and few runs need it

    begin = span[:, 0]
    end = np.maximum(span[:, 1], begin + SHORTEST)
    first = np.maximum(np.floor(begin).astype(np.int64), since)
    count = np.maximum(np.ceil(end).astype(np.int64) - first, 0)
    owner = np.repeat(np.arange(len(rows)), count)
    ticks = first[owner] + np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    overlap = np.minimum(end[owner], ticks + 1) - np.maximum(begin[owner], ticks)
    share = overlap / (end - begin)[owner]
    if not len(ticks):
        return ticks, np.zeros((0, rows.shape[1]))
    lowest = int(ticks.min())
    present = np.zeros(int(ticks.max()) - lowest + 1, dtype=bool)
    present[ticks - lowest] = True
    row = (np.cumsum(present) - 1)[ticks - lowest]
    shares = csr_array((share, (row, owner)), shape=(int(row.max()) + 1, len(rows)))
    return lowest + np.flatnonzero(present), shares @ rows
