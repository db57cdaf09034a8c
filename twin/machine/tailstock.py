"""A tailstock: a live centre in the part's free end, on a quill. Bodies of revolution about the work axis."""

# pyright: reportAttributeAccessIssue=false

import math
from dataclasses import dataclass

import mujoco  # its bindings are compiled and carry no types
import numpy as np

MM = 1e-3
SIDES = 48
"""of the cone, drawn around it"""
BARREL = 2.0
"""diameter of the barrel that carries the quill, over the quill's"""
BARREL_LENGTH = 0.2
"""[m]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class TailstockMount:
    """A centre that meets the front face on the hole's edge, and what carries it."""

    hole_diameter_mm: float
    """where the cone enters the front face"""
    point_angle_deg: float
    """of the whole cone"""
    centre_diameter_mm: float
    """behind the cone"""
    centre_length_mm: float
    """from the cone's end to the quill"""
    quill_diameter_mm: float
    quill_length_mm: float


def mount_tailstock(mjcf: mujoco.MjSpec, mount: TailstockMount, front_mm: float) -> None:
    """Put it before the front face, which stands `front_mm` from the chuck's face."""
    body = mjcf.worldbody.add_body(name="tailstock", pos=[0.0, 0.0, front_mm * MM])
    narrow, wide = mount.hole_diameter_mm / 2 * MM, mount.centre_diameter_mm / 2 * MM
    cone = (wide - narrow) / math.tan(math.radians(mount.point_angle_deg) / 2.0)
    centre = cone + mount.centre_length_mm * MM
    quill = centre + mount.quill_length_mm * MM
    radius = mount.quill_diameter_mm / 2 * MM
    mjcf.add_mesh(name="live_centre", uservert=_frustum(narrow, wide, cone))
    shapes = [
        {"type": mujoco.mjtGeom.mjGEOM_MESH, "meshname": "live_centre"},
        _cylinder(wide, cone, centre),
        _cylinder(radius, centre, quill),
        _cylinder(BARREL * radius, quill, quill + BARREL_LENGTH),
    ]
    for shape, material in zip(shapes, ("steel", "steel", "guide", "casting"), strict=True):
        body.add_geom(mjcf.find_default("visual"), material=material, **shape)
        body.add_geom(mjcf.find_default("collision"), **shape)


def _cylinder(radius: float, start: float, end: float) -> dict[str, object]:
    return {
        "type": mujoco.mjtGeom.mjGEOM_CYLINDER,
        "size": [radius, 0.0, 0.0],
        "fromto": [0.0, 0.0, start, 0.0, 0.0, end],
    }


def _frustum(narrow: float, wide: float, length: float) -> list[float]:
    """Corners of a cone's stump from z = 0, around it."""
    angle = 2.0 * math.pi * np.arange(SIDES) / SIDES
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(SIDES)]) / math.cos(math.pi / SIDES)
    up = np.array([0.0, 0.0, length])
    return np.vstack([narrow * ring, wide * ring + up]).ravel().tolist()
