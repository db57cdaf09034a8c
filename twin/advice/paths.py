"""The way of the tool's centre during a command, in the part frame."""

import math

import numpy as np
from numpy.typing import NDArray

from controller.commands import Arc
from controller.observed import Observed
from twin.advice.envelope import Envelope
from twin.advice.scene import Scene
from twin.advice.stock import Path

Floats = NDArray[np.float64]
STEP = 0.25
"""[mm] between two points of a path"""
MOST_POINTS = 4000


def path_of(scene: Scene, seen: Observed, envelope: Envelope) -> Path:
    """Where the tool goes, point by point, the ends included."""
    start, end = scene.centre(seen.slides_before), scene.centre(seen.slides_after)
    if (start.x, start.y) == (end.x, end.y) and not isinstance(seen.command, Arc):
        across = math.hypot(start.x, start.y) if envelope.radial_offset else start.x
        return Path(distance=np.array([across, across]), axial=np.array([start.z, end.z]))
    first = np.array([start.x, start.y, start.z])
    travel = np.array([end.x, end.y, end.z]) - first
    if isinstance(seen.command, Arc) and _in_part_plane(scene, seen.command):
        points = _along_arc(scene, seen.command, first, travel)
    else:
        points = first + _fractions(float(np.linalg.norm(travel)))[:, None] * travel
    x, y, z = points.T
    return Path(distance=np.hypot(x, y) if envelope.radial_offset else x, axial=z)


def _fractions(length: float) -> Floats:
    if length == 0.0:
        return np.zeros(1)
    return np.linspace(0.0, 1.0, min(MOST_POINTS, math.ceil(length / STEP)) + 1)


def _in_part_plane(scene: Scene, arc: Arc) -> bool:
    return set(arc.plane) == {scene.x_column, scene.z_column}


def _along_arc(scene: Scene, arc: Arc, first: Floats, travel: Floats) -> Floats:
    """(n, 3) points of an arc in the plane of X and Z."""
    part_axis = {scene.x_column: 0, scene.z_column: 2}
    one, two = (part_axis[column] for column in arc.plane)
    centre = np.array(arc.centre)
    radius = math.hypot(*arc.centre)
    begin = math.atan2(-arc.centre[1], -arc.centre[0])
    stop = math.atan2(travel[two] - arc.centre[1], travel[one] - arc.centre[0])
    sweep = (stop - begin) % (2.0 * math.pi)
    if arc.clockwise:
        sweep -= 2.0 * math.pi
    if math.hypot(travel[one], travel[two]) < 1e-9:
        sweep = math.copysign(2.0 * math.pi, sweep or (-1.0 if arc.clockwise else 1.0))
    angle = begin + sweep * _fractions(abs(sweep) * radius)
    points = np.repeat(first[None, :], len(angle), axis=0)
    points[:, one] += centre[0] + radius * np.cos(angle)
    points[:, two] += centre[1] + radius * np.sin(angle)
    return points
