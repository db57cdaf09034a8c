"""Where the tool is clear of the stock, and where it stands still inside it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.motion import CutterMotion, RigidTransform
from twin.errors import PartError

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

SWING = 1e-4
"""Way of the tips [mm] below which a spindle's turn is the trembling of a servo at rest."""
RUB = 5e-3
"""How far the stock may creep past a standing edge [mm] without a word."""
TURNED = 0.5
"""Tool turn [rad] in one slow stretch that is no starting or stopping any more."""
PARALLEL = 1e-6
"""Sine of the angle of two axes below which they are parallel."""
DIRECTIONS = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class StockCylinder:
    """A cylinder about the work spindle's axis that holds the clamped stock at every work angle."""

    radius: float
    """[mm]"""
    z_low: float
    z_high: float

    @classmethod
    def around(cls, mount: RigidTransform, radius: float, z: tuple[float, float]) -> "StockCylinder":
        """The cylinder around a stock of `radius` between `z`, clamped off and askew by `mount`."""
        rotation, shift = mount.rotation, mount.translation
        lean = float(np.hypot(*rotation[:2, 2]))
        ends = rotation[2, 2] * np.array(z) + shift[2]
        rise = radius * float(np.hypot(*rotation[2, :2]))
        return cls(
            radius=radius + float(np.hypot(*shift[:2])) + lean * max(abs(z[0]), abs(z[1])),
            z_low=float(ends.min()) - rise,
            z_high=float(ends.max()) + rise,
        )

    def clear_of(self, centre: Floats, basis: Floats, reach: Floats | float) -> Bools:
        """Whether an endless tool of radius `reach` (n,) about `basis[2]` at `centre` (n, 3) stays clear.

        Two convex bodies are apart where some direction across the tool axis parts them.
        """
        middle = np.array([0.0, 0.0, 0.5 * (self.z_low + self.z_high)])
        half = 0.5 * (self.z_high - self.z_low)
        clear = np.zeros(len(centre), dtype=bool)
        for angle in 2.0 * math.pi * np.arange(DIRECTIONS) / DIRECTIONS:
            towards = math.cos(angle) * basis[0] + math.sin(angle) * basis[1]
            width = self.radius * math.hypot(towards[0], towards[1]) + half * abs(towards[2])
            clear |= (middle - centre) @ towards - width > reach
        return clear


def inner_radius(cutter: Cutter) -> float:
    """Innermost radius at which edges are taken to cut [mm]: there they cross their rake plane slowest."""
    return max(cutter.profile.root, 0.5 * cutter.radius)


def axes_apart(motion: CutterMotion) -> Floats:
    """Distance (n,) of the tool's axis from the work spindle's [mm]."""
    across = np.cross(motion.basis[2], [0.0, 0.0, 1.0])
    length = np.linalg.norm(across)
    if length < PARALLEL:
        return np.hypot(motion.centre[:, 0], motion.centre[:, 1])
    return np.abs(motion.centre @ (across / length))


def twisted(cutter: Cutter, motion: CutterMotion, stock: StockCylinder) -> float:
    """How far the edges' twist turns them about the axis at most, where they can meet stock [rad]."""
    return abs(cutter.twist) * _along(motion, stock, cutter.radius, cutter.shift) if cutter.twist else 0.0


def sway(cutter: Cutter, motion: CutterMotion, stock: StockCylinder) -> tuple[float, float]:
    """How far the tool's own axis leans at most [rad], and how far off its centre it meets stock [mm]."""
    if motion.lean is None:
        return 0.0, 0.0
    far = math.hypot(_along(motion, stock, 2.0 * cutter.radius, 0.0), 2.0 * cutter.radius)
    return float(np.hypot(*motion.lean.T).max()), far


def _along(motion: CutterMotion, stock: StockCylinder, reach: float, middle: float) -> float:
    """How far along its axis from its `middle` a tool of radius `reach` can meet stock [mm]."""
    axis = motion.basis[2]
    step = np.linalg.norm(np.diff(motion.centre, axis=0), axis=1).max(initial=0.0)
    near = ~stock.clear_of(motion.centre, motion.basis, reach + step)
    centre = np.array([0.0, 0.0, 0.5 * (stock.z_low + stock.z_high)])
    half = 0.5 * (stock.z_high - stock.z_low) * abs(axis[2]) + stock.radius * math.hypot(axis[0], axis[1])
    off = np.abs((centre - motion.centre[near]) @ axis - middle)
    return float(off.max(initial=0.0)) + half + step


def stock_speed(motion: CutterMotion, radius: float) -> Floats:
    """(n - 1,) bound on how far stock within `radius` moves against the tool carrier in each sample [mm]."""
    slides = np.linalg.norm(np.diff(motion.centre, axis=0), axis=1)
    return radius * np.abs(np.diff(motion.work_angle)) + slides


def turning_runs(cutter: Cutter, motion: CutterMotion) -> NDArray[np.int64]:
    """(2, m) first and last samples of the stretches in which the tool turns one way."""
    way = np.sign(np.diff(motion.tool_angle))
    change = np.flatnonzero(np.diff(way)) + 1
    first = np.concatenate([[0], change])
    last = np.concatenate([change, [len(way)]])
    swing = np.abs(motion.tool_angle[last] - motion.tool_angle[first])
    return np.stack([first, last])[:, swing * cutter.radius > SWING]


def scraped(cutter: Cutter, motion: CutterMotion, stock: StockCylinder) -> float:
    """Largest way [mm] that the stock moves past the edges of a tool that stands in it; 0 below RUB.

    What that scrapes off is not modelled. Raises PartError where the tool turns all the while, but slower
    than the stock moves past it.
    """
    speed = stock_speed(motion, stock.radius)
    edge = cutter.lever(inner_radius(cutter)) * np.abs(np.diff(motion.tool_angle))
    # a body of revolution cuts all around as long as it turns at all
    slow = edge == 0.0 if cutter.revolved else edge <= speed
    turning = np.zeros(len(slow) + 1, dtype=np.int64)
    first, last = turning_runs(cutter, motion)
    np.add.at(turning, first, 1)
    np.add.at(turning, last, -1)
    slow |= np.cumsum(turning[:-1]) == 0
    edges = np.flatnonzero(np.diff(slow, prepend=False, append=False))
    worst = 0.0
    for a, b in edges.reshape(-1, 2):
        stretch = slice(a, b + 1)
        if speed[a:b].sum() <= RUB:
            continue
        way = stock.radius * np.ptp(motion.work_angle[stretch])
        way += float(np.linalg.norm(np.ptp(motion.centre[stretch], axis=0)))
        if way <= RUB or stock.clear_of(motion.centre[stretch], motion.basis, cutter.radius).all():
            continue
        if np.ptp(motion.tool_angle[stretch]) > TURNED:
            raise PartError(
                "the stock moves past the cutting edges faster than the tool turns; "
                "such a cut is not modelled",
                remedy="check S, the ratio T:L or P:Q, and the feed",
            )
        worst = max(worst, way)
    return worst
