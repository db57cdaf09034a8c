"""A tool as the kernel sees it: edges in radial half-planes that turn about the tool axis."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.profile import ToothProfile

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cutter:
    """Gashes with straight rake faces through the tool axis, all with the same outline."""

    gash_angle: Floats
    """(g,) [rad] of each rake face at tool angle 0, right-hand about the tool axis"""
    gash_shift: Floats
    """(g,) [mm] axial position of the outline on each gash"""
    profile: ToothProfile
    half_length: float
    """half the axial length of the whole tool [mm]; inf = longer than any cut needs"""
    shift: float
    """axial position of the tool's middle [mm]"""
    swivel: float
    """of the tool carrier about X [rad]: 0 = tool axis along +Z, pi/2 = along -Y"""

    @property
    def radius(self) -> float:
        """Radius of the tips [mm]."""
        return self.profile.tip
