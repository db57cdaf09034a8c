"""What is left of the blank, as a radius along the work axis: how deep tips have been at each place.

Not the part: teeth and faces are left out. It says where a tool still meets metal, how deep it has cut, and
by which block.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controller.span import Span
from twin.advice.envelope import Envelope

Floats = NDArray[np.float64]
CELL = 0.2
"""[mm] wanted along the work axis"""
MOST_CELLS = 500
TOUCHING = 0.01
"""[mm] a tip that comes nearer to the metal than this, or not deeper, only touches it"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """Where the centre of the tool goes during one command."""

    distance: Floats
    """(n,) of the tool's axis from the work axis [mm]"""
    axial: Floats
    """(n,) of the tool's centre plane, as the program's Z [mm]"""


@dataclass(slots=True)
class Stock:
    """The blank from Z-length to Z0, turned down by the tips that have passed."""

    blank_radius: float
    """[mm]"""
    z: Floats
    """(n,) places along the work axis, falling from 0 [mm]"""
    radius: Floats
    """(n,) that is left [mm]"""
    feed: Floats
    """(n,) axial feed per turn of the work with which the tip came deepest [mm]"""
    cause: list[Span | None]
    """(n,) block by which the tip came deepest"""

    @classmethod
    def of_blank(cls, *, diameter: float, length: float) -> "Stock":
        """The whole blank [mm]."""
        cells = min(MOST_CELLS, max(10, math.ceil(length / CELL)))
        z = np.linspace(0.0, -length, cells + 1)
        return cls(
            blank_radius=diameter / 2.0,
            z=z,
            radius=np.full(len(z), diameter / 2.0),
            feed=np.zeros(len(z)),
            cause=[None] * len(z),
        )

    def reach(self, envelope: Envelope, path: Path) -> Floats:
        """(n,) least distance of the tips from the work axis at each place, over the whole path [mm]."""
        distance, axial, half = path.distance, path.axial, envelope.half_width
        low, high = axial.min(), axial.max()
        if (
            distance.min() - envelope.radius >= self.blank_radius
            or low - half >= 0.0
            or high + half <= self.z[-1]
        ):
            return np.full(len(self.z), np.inf)
        if distance[0] == distance[-1] and np.ptp(distance) == 0.0:
            # a tool that keeps its distance is nearest where its centre passes
            offset = np.maximum(np.maximum(low - self.z, self.z - high), 0.0)
            return envelope.reach(distance[:1], offset)
        near = (distance - envelope.radius < self.blank_radius) & (axial - half < 0.0)
        near &= axial + half > self.z[-1]
        if not near.any():
            return np.full(len(self.z), np.inf)
        return envelope.reach(distance[near, None], self.z[None, :] - axial[near, None]).min(axis=0)

    def depth_into(self, reach: Floats) -> float:
        """How deep tips with this reach go into metal that is still there [mm]; 0 where they only touch."""
        depth = float((self.radius - reach).max())
        return depth if depth > TOUCHING else 0.0

    def depth_into_blank(self, reach: Floats) -> float:
        """How deep tips with this reach go under the surface of the blank [mm]; 0 where they only touch."""
        depth = self.blank_radius - float(reach.min())
        return depth if depth > TOUCHING else 0.0

    def remove(self, reach: Floats, *, feed: float, span: Span) -> None:
        """The tips have been there, `feed` [mm] along the axis per turn of the work.

        Where a pass goes no deeper than an earlier one the finer feed of the two is what is left.
        """
        deeper = reach < self.radius - TOUCHING
        again = ~deeper & (reach < self.radius + TOUCHING) & (reach < self.blank_radius - TOUCHING)
        finer = again & (feed < self.feed)
        for k in np.flatnonzero(deeper | finer):
            self.feed[k] = feed
            self.cause[k] = span
        self.radius = np.minimum(self.radius, reach)
