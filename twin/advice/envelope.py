"""How near a tool comes to the work axis: the surface that its tips sweep while it stands at a centre.

Everything is a radius from the work axis. A polygon head sweeps a ring, a hob a cylinder about its own axis,
which the carrier has swivelled out of the plane across the work.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_NEWTON_STEPS = 5
_RIM = 0.999
"""of the hob's radius: beyond it the surface is too steep for Newton, and too far out to cut"""


@dataclass(frozen=True, slots=True, kw_only=True)
class HobEnvelope:
    """The cylinder of a hob's tips."""

    radius: float
    """of the tips [mm]"""
    swivel: float
    """of the hob's axis out of the plane across the work [rad]"""
    radial_offset: bool = False
    """whether the tool's offset along Y takes it away from the work: along a hob's own axis it does not"""

    @property
    def half_width(self) -> float:
        """How far from its centre plane the tool can cut, along the work axis [mm]."""
        return self.radius / math.cos(self.swivel)

    def reach(self, distance: Floats, offset: Floats) -> Floats:
        """Least distance from the work axis [mm], of the inputs' common shape; inf where the tool is not.

        `distance` of the hob's axis from the work axis, `offset` along the work axis from the hob's centre.
        At the lateral position y its surface stands at x = A − c, c² = ρ² − (h cos η − y sin η)², and
        (A − c)² + y² is convex in y while A > c.
        """
        cos, sin = math.cos(self.swivel), math.sin(self.swivel)
        limit, square = _RIM * self.radius, self.radius**2
        inside = np.abs(offset) * cos < limit
        along = np.where(inside, offset, 0.0) * cos
        p, y = along, 0.0
        for _ in range(_NEWTON_STEPS if sin else 0):
            depth = np.sqrt(square - p * p)
            slope = p * sin / depth
            gap = np.maximum(distance - depth, 0.0)
            y = y - (y - gap * slope) / (slope * slope + gap * (sin * sin * square) / depth**3 + 1.0)
            p = np.minimum(np.maximum(along - y * sin, -limit), limit)
        depth = np.sqrt(square - p * p)
        return np.where(inside, np.hypot(np.maximum(distance - depth, 0.0), y), np.inf)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeadEnvelope:
    """The ring of a polygon head's edges."""

    radius: float
    """of the tips [mm]"""
    width: float
    """of the edges, centred on the tool plane [mm]"""
    radial_offset: bool = True
    """see `HobEnvelope`"""

    @property
    def half_width(self) -> float:
        """How far from its centre plane the tool can cut, along the work axis [mm]."""
        return self.width / 2.0

    def reach(self, distance: Floats, offset: Floats) -> Floats:
        """Least distance from the work axis [mm], of the inputs' common shape; inf where the tool is not."""
        return np.where(np.abs(offset) <= self.half_width, np.maximum(distance - self.radius, 0.0), np.inf)


Envelope = HobEnvelope | HeadEnvelope
