"""Outlines of the machine's bodies as seen along an axis: what a picture of a collision shows."""

# pyright: reportAttributeAccessIssue=false

from dataclasses import dataclass

import mujoco  # its bindings are compiled and carry no types
import numpy as np
from numpy.typing import NDArray

from twin.machine.assembly import Assembly

Floats = NDArray[np.float64]
MM_PER_M = 1e3
AROUND = 48
"""corners of a circle"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outline:
    """One shape of a body, which is convex."""

    body: str
    points: Floats
    """(n, 3) [mm] whose hull it is, in the part frame at C0: Z0 in the front face, +X to the tool"""


def outlines(assembly: Assembly, axes: Floats) -> tuple[Outline, ...]:
    """Every shape that can collide, with the slides at (axes,) positions [mm, deg]."""
    model, data = assembly.model, mujoco.MjData(assembly.model)
    for name, value in zip(assembly.joints, axes, strict=True):
        joint = model.joint(name)
        slide = joint.type[0] == mujoco.mjtJoint.mjJNT_SLIDE
        data.qpos[joint.qposadr[0]] = value / MM_PER_M if slide else 0.0
    mujoco.mj_kinematics(model, data)
    origin = data.body("work").xpos
    found = []
    for k in range(model.ngeom):
        if not (model.geom_contype[k] or model.geom_conaffinity[k]):
            continue
        points = data.geom_xpos[k] + _corners(model, k) @ data.geom_xmat[k].reshape(3, 3).T
        found.append(Outline(body=shape_name(model, k), points=(points - origin) * MM_PER_M))
    return tuple(found)


def shape_name(model: mujoco.MjModel, geom: int) -> str:
    """What a shape is called: by its own name, else by that of its body."""
    name = model.geom(geom).name or model.body(model.geom_bodyid[geom]).name
    return name.replace("_", " ") or "a body without a name"


def _corners(model: mujoco.MjModel, geom: int) -> Floats:
    """(n, 3) points of a box, a cylinder or a mesh in its own frame [m]."""
    size, kind = model.geom_size[geom], model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        return model.mesh_vert[first : first + count].astype(np.float64)
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        corners = np.stack(np.meshgrid([-1.0, 1.0], [-1.0, 1.0], [-1.0, 1.0]), axis=-1)
        return corners.reshape(-1, 3) * size
    angle = np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False)
    ring = np.column_stack([np.cos(angle) * size[0], np.sin(angle) * size[0]])
    return np.vstack([np.column_stack([ring, np.full(AROUND, end * size[1])]) for end in (-1.0, 1.0)])
