"""A tool as the kernel sees it: edges in radial half-planes that turn about the tool axis."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.profile import ToothProfile

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cutter:
    """Gashes with rake faces through the tool axis, all with the same outline.

    The rake faces are planes, or helicoids about the axis: then the edge turns as it goes along it. Without a
    single gash it is a body of revolution, the outline of which cuts all around.
    """

    gash_angle: Floats
    """(g,) [rad] of each rake face at tool angle 0, in the plane across the tool's middle, right-hand about
    the tool axis"""
    gash_shift: Floats
    """(g,) [mm] axial position of the outline on each gash"""
    profile: ToothProfile
    half_length: float
    """half the axial length of the whole tool [mm]; inf = longer than any cut needs"""
    shift: float
    """axial position of the tool's middle [mm]"""
    swivel: float
    """of the tool carrier about X [rad]: 0 = tool axis along +Z, pi/2 = along -Y"""
    twist: float
    """turn of the rake faces about the axis per way along it [rad/mm], + right-hand; 0 = planes"""

    @property
    def radius(self) -> float:
        """Radius of the tips [mm]."""
        return self.profile.tip

    @property
    def revolved(self) -> bool:
        """Whether it has no single edges: its outline cuts all around, as that of a grinding wheel."""
        return len(self.gash_angle) == 0

    def lever(self, rho: Floats | float) -> Floats | float:
        """Speed of the edges at `rho` across their rake faces, over the tool's turn [mm]."""
        return rho / np.sqrt(1.0 + (self.twist * rho) ** 2)
