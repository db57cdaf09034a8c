"""How far beside the blank a hob stands clear of it."""

import numpy as np

from twin.advice.envelope import HobEnvelope

HALVINGS = 60


def clearance(*, tip_radius: float, outside_radius: float, root_radius: float, swivel: float) -> float:
    """Least axial distance [mm] from the blank at which a hob at full depth cuts nothing.

    The hob's axis passes the work axis at root_radius + tip_radius, swivelled by `swivel` [rad] out of the
    transverse plane; for none the distance is √(h (d_a0 − h)), geometry.md 2.
    """
    hob = HobEnvelope(radius=tip_radius, swivel=swivel)
    distance = np.array(root_radius + tip_radius)
    low, high = 0.0, hob.half_width
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        cuts = float(hob.reach(distance, np.array(middle))) < outside_radius
        low, high = (middle, high) if cuts else (low, middle)
    return high
