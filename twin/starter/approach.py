"""How far beside the blank a hob stands clear of it."""

import math

import numpy as np

STATIONS = 4001


def clearance(*, tip_radius: float, outside_radius: float, root_radius: float, swivel: float) -> float:
    """Least axial distance [mm] from the blank at which a hob at full depth cuts nothing.

    The hob's axis passes the work axis at root_radius + tip_radius, swivelled by `swivel` [rad] out of the
    transverse plane. A point (x, y) of the blank's circle is inside the hob while
    |z cos η − y sin η| < √(r0² − (a − x)²); for η = 0 the largest z is √(h (d_a0 − h)), geometry.md 2.
    """
    centre = root_radius + tip_radius
    y = np.linspace(-outside_radius, outside_radius, STATIONS)
    across = centre - np.sqrt(outside_radius**2 - y**2)
    inside = across < tip_radius
    if not inside.any():
        return 0.0
    half = np.sqrt(tip_radius**2 - across[inside] ** 2)
    return float(((np.abs(y[inside]) * math.sin(abs(swivel)) + half) / math.cos(swivel)).max())
