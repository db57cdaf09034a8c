"""The one kinematic chain, read from the compiled MJCF: axes in, poses of tool and work out.

World frame = machine frame: Z is the work axis, + away from the chuck; X points from the work to the
tool; Y = Z × X (controller.md, section 0). Geometric faults of a machine enter here, as links of the chain,
so that everybody downstream sees them.
"""

# pyright: reportAttributeAccessIssue=false

from dataclasses import dataclass, field, replace
from enum import Enum

import mujoco  # its bindings are compiled and carry no types
import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import CutterMotion, RigidTransform

Floats = NDArray[np.float64]

MM_PER_M = 1e3


class JointKind(Enum):
    """What a joint does to what hangs on it."""

    SLIDE = "slide"
    HINGE = "hinge"


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """One axis of the machine, in the frame of the link that carries it."""

    kind: JointKind
    column: int
    """system axis, from 0"""
    axis: Floats
    """(3,) unit vector"""
    anchor: Floats
    """(3,) [mm] a point on a hinge's axis"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """A body: where it stands on its parent at joint zero, and how it moves."""

    name: str
    position: Floats
    """(3,) [mm] in the parent's frame"""
    rotation: Floats
    """(3, 3) link to parent"""
    joint: Joint | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """Links from the world to the one whose pose is asked for."""

    links: tuple[Link, ...]

    def pose(self, axes: Floats) -> tuple[Floats, Floats]:
        """Pose of the last link in the world.

        `axes` (n, k): slide travel [mm] and angles [deg] in system axis order. Returns positions (n, 3)
        [mm] and rotations (n, 3, 3), link to world.
        """
        position = np.zeros((len(axes), 3))
        rotation = np.eye(3)[None]  # one for all rows as far as nothing turns
        for link in self.links:
            position = position + rotation @ link.position
            rotation = rotation @ link.rotation
            joint = link.joint
            if joint is None:
                continue
            value = axes[:, joint.column]
            if joint.kind is JointKind.SLIDE:
                position = position + (rotation @ joint.axis) * value[:, None]
            else:
                anchor = rotation @ joint.anchor
                rotation = rotation @ rotation_about(joint.axis, np.radians(value))
                position = position + anchor - rotation @ joint.anchor
        return position, np.broadcast_to(rotation, (len(axes), 3, 3))

    def place(self, axes: Floats) -> Floats:
        """The position alone, (n, 3): what turns about the last link's own origin does not matter there."""
        links = list(self.links)
        while links:
            last = links.pop()
            joint = last.joint
            if joint is not None and joint.kind is JointKind.HINGE and not joint.anchor.any():
                last = replace(last, joint=None)
            if last.joint is not None or last.position.any():
                links.append(last)
                break
        return Chain(links=tuple(links)).pose(axes)[0]

    @property
    def spindle(self) -> Joint:
        """The chain's rotary axis. Raises ValueError where it has none."""
        for link in self.links:
            if link.joint and link.joint.kind is JointKind.HINGE:
                return link.joint
        raise ValueError(f"no spindle among {[link.name for link in self.links]}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Kinematics:
    """Tool and work of one machine."""

    axes: int
    """number of system axes"""
    tool: Chain
    """to the tool: Z = its axis u, X = where tool angle 0 points, origin = tool centre"""
    work: Chain
    """to the work frame: Z = the spindle's axis, origin in the front face of a part clamped without fault"""
    mount: RigidTransform = field(default_factory=RigidTransform)
    """part frame -> work frame: how the part is clamped"""
    arbor: RigidTransform = field(default_factory=RigidTransform)
    """hob's own frame -> tool frame: how the hob sits on its spindle"""
    creep: Floats | None = None
    """(axes,) how fast slides move that their encoders do not see [mm/s]"""


def rotation_about(axis: Floats, angle: Floats) -> Floats:
    """(n, 3, 3) rotations by `angle` (n,) [rad] about a unit vector (3,), by Rodrigues."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, versine = np.sin(angle)[:, None, None], (1.0 - np.cos(angle))[:, None, None]
    return np.eye(3) + sine * cross + versine * (cross @ cross)


def read_kinematics(model: mujoco.MjModel, joints: tuple[str, ...]) -> Kinematics:
    """Chains of a compiled machine; `joints` are its axes in system order.

    Raises ValueError unless the tool hangs on slides and then one spindle, and the work on one spindle
    that turns about its own Z.
    """
    kinematics = Kinematics(
        axes=len(joints), tool=read_chain(model, "tool", joints), work=read_chain(model, "work", joints)
    )
    for name, chain in (("tool", kinematics.tool), ("work", kinematics.work)):
        joints_on_it = [link.joint for link in chain.links if link.joint]
        if [j.kind for j in joints_on_it].count(JointKind.HINGE) != 1 or chain.spindle is not joints_on_it[
            -1
        ]:
            raise ValueError(f"{name}: expected one spindle, carried by slides, got {joints_on_it}")
    spindle, part = kinematics.work.links[-2:]
    if len([link for link in kinematics.work.links if link.joint]) != 1 or spindle.joint is None:
        raise ValueError("work: expected the part on a spindle that turns in the headstock")
    if not (
        np.array_equal(spindle.joint.axis, [0, 0, 1])
        and not spindle.joint.anchor.any()
        and np.array_equal(part.rotation, np.eye(3))
        and not part.position[:2].any()
    ):
        raise ValueError("work: expected a spindle about its own Z, with the part's origin on it")
    return kinematics


def read_chain(model: mujoco.MjModel, body: str, joints: tuple[str, ...]) -> Chain:
    """Links from the world to a body.

    Raises ValueError for an unknown body and for joints that are no single-axis system axis.
    """
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
    if number < 0:
        raise ValueError(f"the model has no body {body!r}")
    links: list[Link] = []
    while number > 0:
        links.append(_link(model, number, joints))
        number = int(model.body_parentid[number])
    return Chain(links=tuple(reversed(links)))


_KINDS = {
    int(mujoco.mjtJoint.mjJNT_SLIDE): JointKind.SLIDE,
    int(mujoco.mjtJoint.mjJNT_HINGE): JointKind.HINGE,
}


def _link(model: mujoco.MjModel, body: int, joints: tuple[str, ...]) -> Link:
    name = model.body(body).name
    count, first = int(model.body_jntnum[body]), int(model.body_jntadr[body])
    joint = None
    if count > 1:
        raise ValueError(f"body {name!r} has {count} joints, expected at most one")
    if count == 1:
        joint_name, kind = model.joint(first).name, _KINDS.get(int(model.jnt_type[first]))
        if kind is None or joint_name not in joints or model.qpos0[model.jnt_qposadr[first]] != 0.0:
            raise ValueError(f"joint {joint_name!r}: expected a slide or hinge from 0 among {joints}")
        joint = Joint(
            kind=kind,
            column=joints.index(joint_name),
            axis=model.jnt_axis[first].copy(),
            anchor=model.jnt_pos[first] * MM_PER_M,
        )
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.body_quat[body])
    return Link(
        name=name,
        position=model.body_pos[body] * MM_PER_M,
        rotation=rotation.reshape(3, 3),
        joint=joint,
    )


def cutter_motion(
    kinematics: Kinematics, time_s: Floats, actual: Floats, deflection: Floats | None = None
) -> CutterMotion:
    """The tool's motion in the non-turning work frame.

    `time_s` (n,), `actual` (n, axes) recorded axes [mm | deg], `deflection` (n, 3) of the tool against the
    work in the work frame [mm]. Raises ValueError on other shapes.
    """
    if actual.ndim != 2 or actual.shape != (len(time_s), kinematics.axes):
        raise ValueError(f"actual: expected ({len(time_s)}, {kinematics.axes}), got {actual.shape}")
    still = np.zeros((1, kinematics.axes))
    (origin,), (work,) = kinematics.work.pose(still)
    axes = actual if kinematics.creep is None else actual + time_s[:, None] * kinematics.creep
    centre = kinematics.tool.place(axes)
    _, (tool,) = kinematics.tool.pose(still)
    tool_angle = np.radians(actual[:, kinematics.tool.spindle.column])
    basis = tool.T @ work
    arbor = kinematics.arbor
    centre = (centre - origin) @ work
    if arbor.translation.any():
        (off,) = _spun(tool_angle, arbor.translation)
        centre = centre + off @ basis
    return CutterMotion(
        time_s=time_s,
        work_angle=np.radians(actual[:, kinematics.work.spindle.column]),
        tool_angle=tool_angle,
        centre=centre if deflection is None else centre + deflection,
        basis=basis,
        lean=_spun(tool_angle, arbor.rotation[:, 2])[0][:, :2] if arbor.rotation[2, 2] != 1.0 else None,
        mount=kinematics.mount,
    )


def _spun(angle: Floats, *vectors: Floats) -> list[Floats]:
    """(n, 3) each: vectors (3,), or (n, 3), turned about Z by `angle` (n,) [rad]."""
    cos, sin = np.cos(angle), np.sin(angle)
    found = []
    for vector in vectors:
        x, y, z = vector.T
        turned = np.zeros((len(angle), 3))
        turned[:, 0] = x * cos - y * sin
        turned[:, 1] = x * sin + y * cos
        turned[:, 2] = z
        found.append(turned)
    return found


def part_frame(motion: CutterMotion) -> tuple[Floats, Floats, Floats]:
    """Tool centre [mm], tool axis and direction of tool angle 0 in the turning part frame, each (n, 3)."""
    zero, axis = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    if motion.lean is not None:
        zero, axis = _leaning(motion.lean, zero), _leaning(motion.lean, axis)
    back, mount = -motion.work_angle, motion.mount
    centre, axis, zero = _spun(back, motion.centre, axis @ motion.basis, zero @ motion.basis)
    if mount.translation.any():
        centre = centre - mount.translation
    if (mount.rotation == np.eye(3)).all():
        return centre, axis, zero
    return centre @ mount.rotation, axis @ mount.rotation, zero @ mount.rotation


def _leaning(lean: Floats, vector: Floats) -> Floats:
    """(n, 3) a vector turned the shortest way that brings e_z to (lean, ·), `lean` (n, 2)."""
    high = np.sqrt(1.0 - (lean**2).sum(axis=1))
    # Rodrigues' formula about e_z × axis
    across = np.column_stack([-lean[:, 1], lean[:, 0], np.zeros(len(lean))])
    along = (across @ vector) / (1.0 + high)
    return high[:, None] * vector + np.cross(across, vector) + along[:, None] * across
