"""The faults of a machine's kinematic chain: ways that lean, a carrier off its mark, slides that drift."""

import math
from dataclasses import replace

import numpy as np

from twin.faults.table import Faults, SlideTilt
from twin.kinematics import Chain, JointKind, Kinematics, Link, rotation_about

SECONDS = 60.0
UM = 1e-3


def faulty(kinematics: Kinematics, faults: Faults, *, work_z: float) -> Kinematics:
    """The chain with what is wrong in it; clamping and arbor are set apart (`twin.faults.mounts`).

    `work_z` [mm] is where along Z the middle of the blank stands in the part frame: there, a Z slide that
    leans holds the size that was set.
    """
    links = [
        _swivelled(link, faults.swivel_error_deg) if link.name == "carrier" else link
        for link in kinematics.tool.links
    ]
    if faults.slide_tilt_deg != SlideTilt():
        links = _leaning(links, faults.slide_tilt_deg, _travel(kinematics, work_z))
    creep = np.zeros(kinematics.axes)
    creep[_slide(links, "x_slide")] = faults.x_drift_um_per_min * UM / SECONDS
    return replace(kinematics, tool=Chain(links=tuple(links)), creep=creep)


def _swivelled(link: Link, error_deg: float) -> Link:
    """The carrier turned back about X: its tool axis (0, −sin psi, cos psi) stands at psi = 90° − swivel."""
    (turn,) = rotation_about(np.array([1.0, 0.0, 0.0]), np.radians([-error_deg]))
    return replace(link, rotation=turn @ link.rotation)


def _leaning(links: list[Link], tilt: SlideTilt, travel: float) -> list[Link]:
    """The Z slide's way leaning, the tool where it was at this travel [mm]."""
    found = []
    for link in links:
        if link.name != "z_slide" or link.joint is None:
            found.append(link)
            continue
        straight = link.joint.axis
        lean = np.array([math.tan(math.radians(tilt.xz)), math.tan(math.radians(tilt.yz)), 0.0])
        axis = (straight + lean) / np.linalg.norm(straight + lean)
        position = link.position + link.rotation @ (straight - axis) * travel
        found.append(replace(link, position=position, joint=replace(link.joint, axis=axis)))
    return found


def _travel(kinematics: Kinematics, work_z: float) -> float:
    """Travel of the Z slide [mm] that brings the tool's centre beside a place of the work."""
    still = np.zeros((1, kinematics.axes))
    (front,), _ = kinematics.work.pose(still)
    (centre,), _ = kinematics.tool.pose(still)
    return float(front[2] + work_z - centre[2])


def _slide(links: list[Link], name: str) -> int:
    """Column of a slide. Raises ValueError for a chain without it."""
    for link in links:
        if link.name == name and link.joint is not None and link.joint.kind is JointKind.SLIDE:
            return link.joint.column
    raise ValueError(f"the chain has no slide {name!r}")
