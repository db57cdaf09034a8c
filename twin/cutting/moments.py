"""When each place of a cut surface came to be: at the instant of the deepest bite there."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from twin.cutting.dual import Surface
from twin.cutting.motion import CutterMotion
from twin.cutting.pairs import BATCH, in_parallel
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def moments(sweep: Sweep, motions: tuple[CutterMotion, ...], surface: Surface) -> Floats:
    """When the bites that made the vertices (n,) of a surface met them [s]; NaN where none did.

    `motions` are those of the sweep's tools, in their order.
    """
    when = np.full(len(surface.vertices), np.nan)
    made = np.flatnonzero(surface.bite >= 0)
    bite = surface.bite[made]
    instant = (
        surface.instant[made] if len(surface.instant) else _instants(sweep, surface.vertices[made], bite)
    )
    tool = sweep.tool(bite)
    for number, motion in enumerate(motions):
        own = tool == number
        when[made[own]] = np.interp(instant[own], np.arange(len(motion.time_s)), motion.time_s)
    return when


def _instants(sweep: Sweep, vertices: Floats, bite: Ints) -> Floats:
    """Samples (n,) at which bites meet vertices (n, 3)."""

    def work(part: slice) -> Floats:
        return sweep.evaluate(vertices[part], bite[part]).instant

    return np.concatenate(
        [np.zeros(0), *in_parallel(work, (slice(low, low + BATCH) for low in range(0, len(bite), BATCH)))]
    )


def face_moments(origin: Ints, faces: Iterable[Ints], times: Iterable[Floats]) -> Floats:
    """When each face of a part was made [s]: the latest of the corners of the face it is a piece of.

    Args:
        origin: (m,) `Remains.origin`
        faces: of the removed surfaces, (k, 3) each
        times: of their vertices, NaN = of no tool

    Returns:
        (m,) NaN on what is left of the blank's skin.

    """
    latest = []
    for face, time in zip(faces, times, strict=True):
        known = np.where(np.isnan(time), -np.inf, time)
        corners = (known.take(corner) for corner in face.T)
        latest.append(np.maximum(np.maximum(next(corners), next(corners)), next(corners)))
    known = np.concatenate([*latest, [-np.inf]])  # the last for −1
    found = known[origin]
    return np.where(np.isfinite(found), found, np.nan)
