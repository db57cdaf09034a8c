"""The blank clamped off the work spindle's axis and askew, the hob likewise on the tool spindle."""

import math

import numpy as np

from twin.cutters.cutter import Cutter
from twin.cutting.motion import RigidTransform
from twin.faults.table import Faults
from twin.kinematics import rotation_about
from twin.probing.band import Form


def clamping(faults: Faults, length_mm: float) -> RigidTransform:
    """From the part's own frame to the frame that turns with the spindle, the same where nothing is wrong.

    `length_mm` is the blank's: its middle stands off by the eccentricity, whatever the tilt (geometry.md 5).
    """
    return _mount(
        offset=faults.work_eccentricity_mm,
        towards=math.radians(faults.work_eccentricity_phase_deg),
        tilt=math.radians(faults.work_tilt_deg),
        lean=math.radians(faults.work_tilt_phase_deg),
        middle=-length_mm / 2.0,
    )


def band_form(faults: Faults) -> Form:
    """How the reference bands of the blank are out of round."""
    return Form(
        range_mm=faults.band_out_of_round_mm,
        lobes=faults.band_lobes,
        phase=math.radians(faults.band_lobes_phase_deg),
    )


def arbor(faults: Faults, cutter: Cutter) -> RigidTransform:
    """From the hob's own frame (Z = its axis, X = its first gash) to the one that turns with the spindle."""
    return _mount(
        offset=faults.hob_runout_mm,
        towards=math.radians(faults.hob_runout_angle_deg),
        tilt=math.atan(faults.hob_wobble_mm / cutter.radius),
        lean=math.radians(faults.hob_wobble_angle_deg),
        middle=cutter.shift,
    )


def _mount(*, offset: float, towards: float, tilt: float, lean: float, middle: float) -> RigidTransform:
    """Off by `offset` [mm] at height `middle` of the axis, and tilted about that point; angles in rad."""
    # leaning to a side turns about the axis a quarter of a turn further on
    about = np.array([-math.sin(lean), math.cos(lean), 0.0])
    (rotation,) = rotation_about(about, np.array([tilt]))
    off = offset * np.array([math.cos(towards), math.sin(towards), 0.0])
    pivot = np.array([0.0, 0.0, middle])
    return RigidTransform(rotation=rotation, translation=off + pivot - rotation @ pivot)
