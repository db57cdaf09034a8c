"""The blank clamped off the spindle's axis, and askew."""

import math

import numpy as np

from twin.cutting.motion import RigidTransform
from twin.faults.table import Faults
from twin.kinematics import rotation_about


def clamping(faults: Faults, length_mm: float) -> RigidTransform:
    """From the part's own frame to the frame that turns with the spindle, the same where nothing is wrong.

    `length_mm` is the blank's: its middle stands off by the eccentricity, whatever the tilt (geometry.md 5).
    """
    lean = math.radians(faults.work_tilt_phase_deg)
    # leaning towards `lean` turns about the axis a quarter of a turn further on
    about = np.array([-math.sin(lean), math.cos(lean), 0.0])
    (rotation,) = rotation_about(about, np.radians([faults.work_tilt_deg]))
    phase = math.radians(faults.work_eccentricity_phase_deg)
    offset = faults.work_eccentricity_mm * np.array([math.cos(phase), math.sin(phase), 0.0])
    middle = np.array([0.0, 0.0, -length_mm / 2.0])
    return RigidTransform(rotation=rotation, translation=offset + middle - rotation @ middle)
