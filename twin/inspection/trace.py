"""From the points of a trace to its figures: slope, form, total, crowning, with and without the filter."""

import math

import numpy as np

from twin.inspection.result import Figures, Trace
from twin.inspection.solid import Floats

CUT_OFF = 1 / 30
"""wavelength at which the Gaussian filter passes one half, as part of the evaluated length (ISO 1328-1)"""
SHORTEST = 0.25
"""and never below this [mm]"""
ALPHA = math.sqrt(math.log(2) / math.pi)
"""of the Gaussian weighting function (ISO 16610-21)"""
WHOLE = 0.98
"""part of a trace's points that must be there"""


def cut_off(limits: tuple[float, float]) -> float:
    """Return the cut-off wavelength [mm] of a trace evaluated between `limits` [mm]."""
    return max((limits[1] - limits[0]) * CUT_OFF, SHORTEST)


def figures(
    position: Floats, deviation: Floats, limits: tuple[float, float], *, sense: float = 1.0
) -> Figures:
    """Evaluate a curve (m,), all of it within `limits` [mm], about its least-squares line and parabola.

    `sense` turns a rise of material into the slope's sign.
    """
    u = (2 * position - limits[0] - limits[1]) / (limits[1] - limits[0])
    # each point stands for the length about it: what is steep at the ends counts as in the curve itself
    apart = np.diff(u)
    weight = np.sqrt(np.concatenate([[0.0], apart]) + np.concatenate([apart, [0.0]]))
    level, rise = np.polynomial.polynomial.polyfit(u, deviation, 1, w=weight)
    bend = np.polynomial.polynomial.polyfit(u, deviation, 2, w=weight)[2]
    return Figures(
        slope_um=sense * 2 * float(rise),
        form_um=float(np.ptp(deviation - level - rise * u)),
        total_um=float(np.ptp(deviation)),
        crowning_um=-float(bend),
    )


def smoothing(position: Floats, wavelength: float) -> Floats:
    """Return the matrix (m, m) of the Gaussian filter at points (m,) [mm].

    Regression of first order (ISO 16610-28): a straight line passes unchanged up to the very ends.
    """
    apart = position - position[:, None]
    weight = np.exp(-math.pi * (apart / (ALPHA * wavelength)) ** 2)
    s0 = weight.sum(axis=1, keepdims=True)
    s1 = (weight * apart).sum(axis=1, keepdims=True)
    s2 = (weight * apart**2).sum(axis=1, keepdims=True)
    return weight * (s2 - s1 * apart) / (s0 * s2 - s1**2)


def evaluate(
    position: Floats,
    deviation: Floats,
    facet: Floats,
    limits: tuple[float, float],
    *,
    teeth: tuple[int, ...],
    sense: float,
) -> list[Trace | None]:
    """Evaluate the traces of some teeth; None for one with holes.

    Args:
        position: (m,) roll length or z [mm], ascending.
        deviation: (m, z) [µm].
        facet: (m, z) the part of it that the mesh's chords put in [µm].
        limits: evaluated range of `position`.
        teeth: counted from 0.
        sense: of rising material against the sign of the slope.

    """
    inside = (position >= limits[0]) & (position <= limits[1])
    if np.count_nonzero(inside) < 3:
        return [None] * len(teeth)
    x = position[inside]
    smooth = smoothing(x, cut_off(limits))
    traces: list[Trace | None] = []
    for tooth in teeth:
        whole = np.isfinite(deviation[:, tooth])
        y, there = deviation[inside, tooth], whole[inside]
        if np.count_nonzero(there) < max(WHOLE * len(x), 3):
            traces.append(None)
            continue
        found = figures(x[there], y[there], limits, sense=sense)
        traces.append(
            Trace(
                tooth=tooth + 1,
                position=position[whole],
                deviation_um=deviation[whole, tooth] - y[there].mean(),
                evaluation=limits,
                slope_um=found.slope_um,
                form_um=found.form_um,
                total_um=found.total_um,
                crowning_um=found.crowning_um,
                filtered=figures(x, smooth @ np.interp(x, x[there], y[there]), limits, sense=sense),
                facets=figures(x[there], facet[inside, tooth][there], limits, sense=sense),
            )
        )
    return traces
