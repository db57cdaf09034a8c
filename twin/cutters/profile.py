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

    def tooth_depth(self, tooth: Floats, s: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Signed depth in the tooth with its middle at `tooth` alone, and its derivatives by `s` and `rho`.

        A tooth is convex, so this is a concave function; nowhere above `depth`.
        """
        local = s - tooth
        depth, g_x, g_y = self._tooth(np.abs(local), rho)
        g_x *= np.where(local < 0, -1.0, 1.0)
        return depth, g_x, g_y

    def teeth(self, low: float, high: float) -> NDArray[np.int64]:
        """Numbers of the teeth, tooth k at k pitches, that reach between two positions above the land."""
        if math.isinf(self.pitch):
            return np.zeros(1, dtype=np.int64)
        first = math.ceil((low - self.half_width) / self.pitch)
        return np.arange(first, math.floor((high + self.half_width) / self.pitch) + 1)

    @property
    def half_width(self) -> float:
        """Half the width of a tooth where it is widest: on the land [mm]; inf without land."""
        if math.isinf(self.root):
            return math.inf if self.flank_angle else self.corner_s + self.corner_radius
        flank = self.corner_s + self.corner_radius / math.cos(self.flank_angle)
        return flank + (self.tip - self.corner_radius - self.root) * math.tan(self.flank_angle)

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
