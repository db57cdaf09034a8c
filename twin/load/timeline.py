"""Cutting forces over time, as the machine feels them and as a recording keeps them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.recording import RecordedLoad

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TURNS = 1e-6
"""[deg per tick] below which a spindle stands"""
FARTHEST = 64.0
"""[ticks] by which two motions of one program may be apart"""
PARTS = 8
"""cells of a tick in which forces are counted: a tooth leaves its chip within less than a tick"""
COLUMNS = ("axes", "tool", "power_w", "removed_mm3")


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
        if not len(self.angle[0]):
            return np.zeros(ticks)
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


def no_load(spindle: int, axes: int, compliance_um_per_n: float) -> CuttingLoad:
    """Where nothing is cut."""
    none = np.zeros(0)
    return CuttingLoad(
        spindle=spindle,
        angle=(np.zeros(0, np.int64), none),
        parts=PARTS,
        cell=np.zeros(0, np.int64),
        axes=np.zeros((0, axes)),
        tool=np.zeros((0, 3)),
        power_w=none,
        removed_mm3=none,
        compliance_um_per_n=compliance_um_per_n,
    )


def joined(loads: Sequence[CuttingLoad]) -> CuttingLoad:
    """Loads that follow one another."""
    columns = {name: np.concatenate([getattr(load, name) for load in loads]) for name in ("cell", *COLUMNS)}
    ticks, angle = (np.concatenate(parts) for parts in zip(*(load.angle for load in loads), strict=True))
    return replace(loads[-1], angle=(ticks, angle), **columns)


def summed(loads: Sequence[CuttingLoad], shares: Sequence[float] = (1.0, 1.0)) -> CuttingLoad:
    """All of some loads on the same motion together, or `shares` of them."""
    cells = np.unique(np.concatenate([load.cell for load in loads]))
    rows = [load.at(cells) for load in loads]
    sums = {name: sum(w * row[name] for w, row in zip(shares, rows, strict=True)) for name in COLUMNS}
    return replace(loads[-1], cell=cells, **sums)
