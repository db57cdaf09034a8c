"""The outline of a cutting edge in its rake plane, as a signed depth.

Coordinates in the rake half-plane: `s` along the tool axis, `rho` the distance from it [mm]. Depth is the
signed distance to the outline, positive where the edge removes material; it is 1-Lipschitz.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothProfile:
    """A row of equal symmetric teeth with straight flanks and circular tip corners, or a single one.

    Everything below the root radius counts as cutting: the land between two teeth of a hob cuts as well.
    """

    tip: float
    """radius of the tip [mm]"""
    corner_s: float
    """half the straight tip: axial position of the corner arc's centre [mm]"""
    corner_radius: float
    """[mm]"""
    flank_angle: float
    """of the flank against the radial direction [rad]"""
    root: float
    """radius of the land between the teeth [mm]; -inf = none"""
    pitch: float
    """axial distance of the teeth [mm]; inf = a single tooth"""

    def __post_init__(self) -> None:
        if self.corner_s < 0 or self.corner_radius < 0:
            raise InputError(
                f"the tip corner radius {self.corner_radius:g} mm leaves no straight tip",
                remedy="a smaller tip radius",
            )

    def fold(self, s: Floats) -> Floats:
        """Axial distance to the centre of the nearest tooth, with the sign of the side."""
        if math.isinf(self.pitch):
            return s
        return s - self.pitch * np.rint(s / self.pitch)

    def depth(self, s: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Signed depth and its derivatives by `s` and `rho`, each of the inputs' shape."""
        local = self.fold(s)
        depth, g_x, g_y = self._tooth(np.abs(local), rho)
        land = self.root - rho
        below = land > depth
        if below.any():
            depth[below] = land[below]
            g_x[below] = 0.0
            g_y[below] = -1.0
        g_x *= np.where(local < 0, -1.0, 1.0)
        return depth, g_x, g_y

    def tooth(self, s: Floats) -> Floats:
        """Axial position of the nearest tooth's middle."""
        return s - self.fold(s)

    def depth_in(self, tooth: Floats, s: Floats, rho: Floats) -> Floats:
        """Signed depth in the tooth at `tooth` alone: a concave function, nowhere above `depth`."""
        return self._tooth(np.abs(s - tooth), rho)[0]

    def takeover(self, s: Floats, rho: Floats, reach: Floats) -> Floats:
        """Bound on how far `depth` rises above its own tangent within `reach` of a point, in the rake plane.

        A tooth is convex, so its depth is concave: the tangent bounds it from above. Only another tooth or
        the land can rise above the tangent of the one that is deepest here, by the difference of tangents.
        """
        x = np.abs(self.fold(s))
        own, g_x, g_y = self._tooth(x, rho)
        land = self.root - rho
        # depths have no slope above 1, and the next tooth is deeper only beyond the middle of the gap
        close = (own - land < 2.0 * reach) | (x + reach > 0.5 * self.pitch)
        rows = np.flatnonzero(close)
        excess = np.zeros(len(s))
        excess[rows] = self._taken_over(x[rows], rho[rows], reach[rows], (own[rows], g_x[rows], g_y[rows]))
        return excess

    def _taken_over(
        self, x: Floats, rho: Floats, reach: Floats, tooth: tuple[Floats, Floats, Floats]
    ) -> Floats:
        """`takeover` at `x` >= 0 from the nearest tooth's middle, given its depth and derivatives there."""
        own, g_x, g_y = tooth
        land = self.root - rho
        deepest, d_x, d_y = np.maximum(own, land), g_x, g_y
        below = land > own
        if below.any():
            d_x, d_y = np.where(below, 0.0, g_x), np.where(below, -1.0, g_y)
        excess = np.maximum(land - deepest + np.hypot(d_x, d_y + 1.0) * reach, 0.0)
        excess = np.maximum(excess, own - deepest + np.hypot(g_x - d_x, g_y - d_y) * reach)
        if math.isfinite(self.pitch):
            other, o_x, o_y = self._tooth(self.pitch - x, rho)
            excess = np.maximum(excess, other - deepest + np.hypot(o_x + d_x, o_y - d_y) * reach)
        return excess

    def _tooth(self, x: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Depth in one tooth at `x` >= 0 from its middle, and its derivatives by x and rho."""
        cos, sin = math.cos(self.flank_angle), math.sin(self.flank_angle)
        dx = x - self.corner_s
        dy = rho - (self.tip - self.corner_radius)
        tip = self.corner_radius - dy
        flank = self.corner_radius - (dx * cos + dy * sin)
        on_flank = flank < tip
        depth = np.where(on_flank, flank, tip)
        g_x = np.where(on_flank, -cos, 0.0)
        g_y = np.where(on_flank, -sin, -1.0)
        arc = (dx > 0) & (dy * cos > dx * sin)
        if arc.any():
            reach = np.hypot(dx[arc], dy[arc])
            depth[arc] = self.corner_radius - reach
            g_x[arc] = -dx[arc] / reach
            g_y[arc] = -dy[arc] / reach
        return depth, g_x, g_y
