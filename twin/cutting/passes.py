"""Every time a cutting edge swings past the side of the tool that faces the work."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.engagement import (
    StockCylinder,
    inner_radius,
    stock_speed,
    sway,
    turning_runs,
    twisted,
)
from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

REACH = 0.6 * math.pi
"""Half the angle about the tool, from tool angle 0, in which stock can stand [rad]: it faces the work."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Passes:
    """The passes of one tool in order of time. Time is counted in samples of the motion (fractional)."""

    at: Floats
    """(k,) when the edge points along tool angle 0, clipped to the run of one-way turning it belongs to"""
    angle: Floats
    """(k,) unwrapped tool angle [rad] at which it does"""
    shift: Floats
    """(k,) axial shift of the edge [mm]"""
    first: Floats
    """(k,) start of the run of one-way turning"""
    last: Floats
    """(k,) its end"""
    travel: Floats
    """(k,) bound on how far a point of the stock moves against the tool carrier during the pass [mm]"""
    carried: Floats
    """(k,) bound on how far the slides alone carry the tool during the pass [mm]"""
    swing: Floats
    """(k,) bound on how far the work turns during the pass, away from where it stands at `at` [rad]"""
    run_angle: Floats
    """(k, 2) tool angle at the lower and the upper end of the run [rad]"""
    slant: Floats
    """(k,) bound on the stock's speed over the edge's speed across the rake plane"""
    turn: Floats
    """(k,) bound on the work's turn per way of the edge across the rake plane [rad/mm]"""
    jolt: Floats
    """(k,) bound on the velocity jump between two samples over the edge's speed"""
    samples: Floats
    """(k,) bound on the samples per way of the edge across the rake plane [1/mm]"""
    creep: Floats
    """(k,) way of the stock in the samples that the four bounds above leave out, for there the edge is the
    slower one: the tool starts or stops [mm]"""

    @property
    def count(self) -> int:
        """Number of passes."""
        return len(self.at)


def find_passes(
    cutter: Cutter, motion: CutterMotion, stock_radius: float, stock_z: tuple[float, float]
) -> Passes:
    """All passes that may touch a stock cylinder of this radius between these z, in the part frame."""
    stock = StockCylinder.around(motion.mount, stock_radius, stock_z)
    # a twisted edge comes to the stock on its far side sooner or later than on its near side
    reach = REACH + twisted(cutter, motion, stock)
    rows: list[tuple[Floats, Floats, Ints, Floats, Floats]] = []
    for a, b in turning_runs(cutter, motion).T:
        angle = motion.tool_angle[a : b + 1]
        index = np.arange(a, b + 1, dtype=float)
        if angle[-1] < angle[0]:
            angle, index = angle[::-1], index[::-1]
        for gash, offset in enumerate(cutter.gash_angle):
            lowest = math.ceil((angle[0] - reach + offset) / (2 * math.pi))
            highest = math.floor((angle[-1] + reach + offset) / (2 * math.pi))
            target = 2 * math.pi * np.arange(lowest, highest + 1) - offset
            at = np.interp(target, angle, index)
            ones = np.ones(len(target))
            rows.append((at, target, np.full(len(target), gash), a * ones, b * ones))
    if not rows:
        shapes = {name: (0, 2) if name == "run_angle" else (0,) for name in Passes.__dataclass_fields__}
        return Passes(**{name: np.zeros(shape) for name, shape in shapes.items()})
    at, angle, gash, first, last = (np.concatenate(column) for column in zip(*rows, strict=True))
    order = np.lexsort((gash, angle, at))
    edges = at[order], angle[order], gash[order], first[order], last[order]
    lean, far = sway(cutter, motion, stock)
    passes = _bounded(cutter, motion, (stock.radius, reach, far), edges)
    samples = np.arange(len(motion.tool_angle), dtype=float)
    centre = np.stack([np.interp(passes.at, samples, column) for column in motion.centre.T], axis=1)
    keep = _closed(
        ~stock.clear_of(centre, motion.basis, cutter.radius + passes.carried + lean * far),
        len(cutter.gash_angle),
    )
    return Passes(**{name: getattr(passes, name)[keep] for name in Passes.__dataclass_fields__})


def _closed(keep: NDArray[np.bool_], most: int) -> NDArray[np.bool_]:
    """Also keep up to `most` passes between two that are kept: a tool off its axis comes near by turns."""
    kept = np.flatnonzero(keep)
    between = np.diff(kept)
    filled = keep.copy()
    for first, count in zip(kept[:-1][between > 1], between[between > 1], strict=True):
        if count <= most:
            filled[first : first + count] = True
    return filled


def _bounded(
    cutter: Cutter,
    motion: CutterMotion,
    sizes: tuple[float, float, float],
    edges: tuple[Floats, Floats, Ints, Floats, Floats],
) -> Passes:
    """Passes from their (at, angle, gash, first, last), with the bounds that the culling proofs need.

    `sizes` are the stock's radius, the angle of the edges' way that counts, and how far off its centre a tool
    that leans can meet stock: that seems to move as much faster.
    """
    stock_radius, reach, far = sizes
    at, angle, gash, first, last = edges
    samples = np.arange(len(motion.tool_angle), dtype=float)
    tool_rate = np.abs(np.diff(motion.tool_angle))
    turning = np.abs(np.diff(motion.work_angle))
    turned = np.concatenate([[0.0], np.cumsum(turning)])
    speed = stock_speed(motion, stock_radius)
    jump = stock_radius * _jumps(motion.work_angle) + np.linalg.norm(_jumps(motion.centre), axis=1)
    if motion.lean is not None:
        leaning = np.linalg.norm(np.diff(motion.lean, axis=0), axis=1)
        turning, speed = turning + leaning, speed + far * leaning
        jump += far * np.linalg.norm(_jumps(motion.lean), axis=1)
    # window of samples in which the edge is within `reach` of the work's side
    way = np.where(motion.tool_angle[last.astype(int)] > motion.tool_angle[first.astype(int)], 1.0, -1.0)
    rising = np.maximum.accumulate(np.cumsum(np.concatenate([[0.0], tool_rate])))
    centre = np.interp(at, samples, rising) + way * (angle - np.interp(at, samples, motion.tool_angle))
    low = np.clip(np.interp(centre - reach, rising, samples), first, last)
    high = np.clip(np.interp(centre + reach, rising, samples), first, last)
    a = np.minimum(np.floor(low), len(samples) - 2).astype(int)
    b = np.minimum(np.maximum(np.ceil(high).astype(int), a + 1), len(samples) - 1)
    path = np.concatenate([[0.0], np.cumsum(speed)])
    slides = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(motion.centre, axis=0), axis=1))])
    inner = cutter.lever(inner_radius(cutter))
    across = np.maximum(inner * tool_rate - speed, 0.0)
    slow = across == 0.0
    creep = np.concatenate([[0.0], np.cumsum(np.where(slow, speed, 0.0))])
    # a jump counts by the slower side
    slower = np.minimum(across, np.append(across[1:], across[-1]))
    with np.errstate(divide="ignore", invalid="ignore"):
        slant = np.where(slow, 0.0, speed / across)
        steep = speed / slower
        jump = (1.0 + steep) * jump + steep * inner * _jumps(motion.tool_angle)
        bounds = {
            "slant": slant,
            "turn": np.where(slow, 0.0, turning / across),
            "jolt": jump / slower,
            "samples": np.where(slow, 0.0, 1.0 / across),
        }
    own = np.interp(at, samples, turned)
    ends = motion.tool_angle[np.stack([first, last], axis=1).astype(int)]
    return Passes(
        at=at,
        angle=angle,
        shift=cutter.gash_shift[gash],
        first=first,
        last=last,
        travel=path[b] - path[a],
        carried=slides[b] - slides[a],
        swing=np.maximum(np.abs(turned[b] - own), np.abs(own - turned[a])),
        run_angle=np.sort(ends, axis=1),
        creep=creep[b] - creep[a],
        **{name: _window_max(values, a, b) for name, values in bounds.items()},
    )


def _jumps(values: Floats) -> Floats:
    """Velocity jump at the end of each sample interval [per sample], (n - 1, ...)."""
    rate = np.diff(values, axis=0)
    return np.abs(np.diff(rate, axis=0, append=rate[-1:]))


def _window_max(values: Floats, a: Ints, b: Ints) -> Floats:
    """Largest of `values[a:b]` for each window; undefined samples do not count."""
    table = [np.nan_to_num(values, nan=0.0, posinf=np.inf)]
    while 2 ** len(table) <= int(np.max(b - a, initial=1)):
        step = 2 ** (len(table) - 1)
        table.append(np.maximum(table[-1][:-step], table[-1][step:]))
    level = np.floor(np.log2(b - a)).astype(int)
    out = np.empty(len(a))
    for k, row in enumerate(table):
        here = level == k
        out[here] = np.maximum(row[a[here]], row[b[here] - 2**k])
    return out
