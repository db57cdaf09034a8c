"""The hob's own errors, from what a job says of them."""

import math

from twin.cutters.hob import HobErrors
from twin.faults.table import Faults

UM = 1e-3


def hob_errors(faults: Faults) -> HobErrors:
    """Spacing of the gashes and lead of the thread."""
    return HobErrors(
        gash_rad=tuple(math.radians(angle) for angle in faults.hob_gash_error_deg),
        lead_mm=UM * faults.hob_lead_error_um_per_turn,
    )
