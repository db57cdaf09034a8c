"""What is known of each bite around a block's middle: its tangent there, and how far it can rise above it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.pairs import Candidates, join

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ROUNDING = 1e-12
"""Share of its radius by which the corner of a block may seem to stand outside."""


@dataclass(frozen=True, slots=True)
class Tangents:
    """For each block the bites that can be the deepest in it, with upper bounds on their depths.

    Within `radius` of `middle` the depth of a bite is at most `plane[0] + plane[1:] · (p − middle) + over`
    (`DepthField.bound`).
    """

    lists: Candidates
    """the bites of each block"""
    middle: Floats
    """(n, 3) of the blocks [mm]"""
    radius: Floats
    """(n,) in which the bounds are proved [mm]"""
    plane: Floats
    """(4, m) depth at the middle and its gradient"""
    over: Floats
    """(m,) [mm]"""

    def of(self, items: Ints) -> "Tangents":
        """Those of some blocks."""
        pairs = self.lists.pairs(items)
        start = np.concatenate([[0], np.cumsum(np.diff(self.lists.start)[items])])
        return Tangents(
            Candidates(start, self.lists.bites.take(pairs)),
            self.middle[items],
            self.radius[items],
            self.plane.take(pairs, axis=1),
            self.over.take(pairs),
        )


def without_bites(middle: Floats) -> Tangents:
    """Blocks without bites."""
    n = len(middle)
    lists = Candidates(np.zeros(n + 1, dtype=np.int64), np.zeros(0, dtype=np.int64))
    return Tangents(lists, middle, np.zeros(n), np.zeros((4, 0)), np.zeros(0))


def joined(parts: list[Tangents]) -> Tangents:
    """Blocks of several parts, one after the other."""
    return Tangents(
        join([p.lists for p in parts]),
        np.concatenate([p.middle for p in parts]),
        np.concatenate([p.radius for p in parts]),
        np.concatenate([p.plane for p in parts], axis=1),
        np.concatenate([p.over for p in parts]),
    )


def can_matter(plane: Floats, over: Floats, owner: Ints, spokes: Floats, floors: Floats) -> Bools:
    """Which pairs (m,) their upper bounds leave a chance: to be positive, and the deepest, in their blocks.

    `spokes` (8, 3, n) leads from the planes' origins to the corners of the n blocks, `floors` (8, n) bounds
    the field from below there, in the sense that convex combinations of it bound it inside. The upper
    bounds are affine: what stays below zero, or below the floor, at all corners does so in the whole block.
    """
    highest = np.full(len(owner), -np.inf)
    lead = np.full(len(owner), -np.inf)
    level, along_x, along_y, along_z = plane
    for (x, y, z), floor in zip(spokes, floors, strict=True):
        tangent = x.take(owner)
        tangent *= along_x
        part = y.take(owner)
        part *= along_y
        tangent += part
        part = z.take(owner)
        part *= along_z
        tangent += part
        tangent += level
        np.maximum(highest, tangent, out=highest)
        tangent -= floor.take(owner)
        np.maximum(lead, tangent, out=lead)
    return (highest + over > 0) & (lead + over >= 0)
