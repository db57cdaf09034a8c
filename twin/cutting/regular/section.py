"""The section of one gap, roughly: where the chart expects the cut surface."""

import math

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import RigidTransform
from twin.cutting.refine import first_cull
from twin.cutting.regular.chart import Chart, Frame
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.spline import Spline
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]

FLANK, ROOT = 16, 25
"""Trial rays of a flank, and into the root."""
HALVINGS = 14
NO_GAP = "there is no gap where the rolling of tool and work puts one"
MIDDLE = 4.0
"""Times less than where it is the largest is the curvature where steps are as long as asked for."""
GRADES = 0.67, 1.05
"""Least and most times as close as that."""
THIN = 1e-3
"""Height of the section [mm]."""


def section(sweep: Sweep, frame: Frame, mount: RigidTransform, z: float) -> Floats:
    """The cut surface (n, 2) in a gap at z, from the one tip to the other. Raises IrregularError for none."""
    start, along = frame.trial(FLANK, ROOT)
    reach = frame.reach(start, along)
    trial = Chart(
        frame=frame,
        mount=mount,
        surface=start,
        along=along,
        inner=np.zeros(len(start)),
        outer=reach,
        z=np.array([z - THIN, z, z + THIN]),
        lift=np.zeros(frame.indexing.teeth),
    )
    n = len(start)
    rays = np.arange(n)
    # a box about every ray holds half of the way to its neighbours
    beside = np.stack([np.maximum(rays - 1, 0), rays, np.minimum(rays + 1, n - 1)])
    ends = np.stack([np.zeros(n), reach])
    corners = np.stack(
        [trial.at(np.array(0), i, np.array(k), tau[i])[0] for i in beside for k in (0, 2) for tau in ends],
        axis=1,
    )
    middle = 0.5 * (corners.min(axis=1) + corners.max(axis=1))
    done = first_cull(sweep, middle, corners)
    crossed = np.zeros(n, dtype=bool)
    crossed[done.alive] = True
    if not crossed[n // 2]:
        raise IrregularError(NO_GAP)
    block = np.maximum(np.cumsum(crossed) - 1, 0)
    low, high = np.zeros(n), reach.copy()
    for _ in range(HALVINGS):
        tau = 0.5 * (low + high)
        inside = (
            sweep.deepest(
                trial.at(np.array(0), rays, np.array(1), tau)[0], block, done.tangents, sign=True
            ).depth
            > 0
        )
        low, high = np.where(inside, tau, low), np.where(inside, high, tau)
    crossed &= (low > 0) & (high < reach)
    # near the tips the land between the hob's teeth may cut; what counts is the surface up to `outside`
    found = start + (0.5 * (low + high))[:, None] * along
    upper = found[: n // 2 + 1][np.flatnonzero(~crossed[: n // 2]).max(initial=-1) + 1 :]
    lower = found[n // 2 + 1 :][: np.flatnonzero(~np.append(crossed[n // 2 + 1 :], False)).min()]
    if not crossed[n // 2] or min(len(upper), len(lower)) < ROOT // 2:
        raise IrregularError(NO_GAP)
    return np.vstack([upper, lower])


def spaced(surface: Floats, outside: float, step: float, multiple: int) -> Floats:
    """A section (n, 2) again, at steps of about `step` [mm], from `outside` to `outside` radius.

    Steps are shorter where the section bends most, and longer where it is straighter. Their number is a
    multiple of `multiple`. Raises IrregularError where the section does not reach that far out.
    """
    radius = np.hypot(*surface.T)
    lowest = int(radius.argmin())
    if min(radius[0], radius[-1]) < outside:
        raise IrregularError("the gaps are not open at the blank's outside")
    length, curve = _curve(surface)
    first = int(np.flatnonzero(radius[:lowest] >= outside).max())
    last = lowest + int(np.flatnonzero(radius[lowest:] >= outside).min())
    ends = [_where(curve, outside, length[at], length[at + 1]) for at in (first, last - 1)]
    at = np.linspace(ends[0], ends[1], 8 * len(surface))
    curvature = _curvature(curve, at)
    close = np.sqrt(MIDDLE * _smooth(curvature, round(step / (at[1] - at[0]))) / curvature.max())
    density = np.clip(close, *GRADES) / step
    number = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(at))])
    count = multiple * math.ceil(number[-1] / multiple)
    return np.asarray(curve(np.interp(np.linspace(0.0, number[-1], count + 1), number, at)), dtype=np.float64)


def _smooth(values: Floats, wide: int) -> Floats:
    """Values (n,) averaged over twice `wide` neighbours."""
    weight = np.ones(2 * max(wide, 1) + 1)
    padded = np.pad(values, max(wide, 1), mode="edge")
    return np.asarray(np.convolve(padded, weight / weight.sum(), mode="valid"), dtype=np.float64)


def _where(curve: Spline, radius: float, low: float, high: float) -> float:
    """Where a curve passes a radius between two places on its two sides."""
    rising = float(np.hypot(*curve(low))) < radius
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (float(np.hypot(*curve(middle))) < radius) == rising else (low, middle)
    return 0.5 * (low + high)


def bend(surface: Floats) -> float:
    """Largest curvature of a section (n, 2) [1/mm]."""
    length, curve = _curve(surface)
    return float(_curvature(curve, np.linspace(length[0], length[-1], 8 * len(surface))).max())


def _curvature(curve: Spline, at: Floats) -> Floats:
    """Of a curve at places (n,) [1/mm]."""
    (dx, dy), (ddx, ddy) = curve(at, 1).T, curve(at, 2).T
    return np.abs((dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3)


def _curve(surface: Floats) -> tuple[Floats, Spline]:
    """Lengths (n,) along a section, and the section as a function of it."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(surface, axis=0).T))])
    return length, Spline.through(length, surface)
