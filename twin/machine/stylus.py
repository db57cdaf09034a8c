"""A touch probe in MuJoCo: a ball on a spring, in touch with the cylinders of the clamped blank.

The ball stands on the slide that carries the tool, in a slide joint along X with the probe's own stiffness.
Explicit contact pairs with the blank's steps are the only contacts of the model; they are off while the
probe is swung out. A band that is out of round has the radius of the place that faces the ball.
"""

# pyright: reportAttributeAccessIssue=false

from dataclasses import dataclass

import mujoco  # its bindings are compiled and carry no types
import numpy as np

from controller.clock import Chunk, MachineAlarm
from twin.cutting.motion import RigidTransform
from twin.machine.watching import crash, require_probe
from twin.probing.band import Form, Step
from twin.probing.probe import Probe
from twin.probing.trigger import Trigger

MM = 1e-3
JOINT = "stylus"
BALL = "ball"
STEP = "step"
"""names of the joint, its geom, and of the steps' geoms, which are numbered"""
NATURAL = 320.0
"""[rad/s] of the stylus alone; its mass is what makes it so, far below that of a slide"""
HARD = {"condim": 1, "solref": [0.002, 1.0], "solimp": [0.995, 0.995, 1e-5, 0.5, 2.0]}
"""of a contact that gives way by 0.07 % of the stylus's way: as much as ruby on steel does"""


@dataclass(frozen=True, slots=True, kw_only=True)
class StylusMount:
    """A probe, and what it may touch."""

    probe: Probe
    steps: tuple[Step, ...]
    form: Form
    clamping: RigidTransform
    """part frame -> work frame"""


def mount_stylus(mjcf: mujoco.MjSpec, mount: StylusMount) -> None:
    """Put stylus and bands into a machine whose tool and work are mounted."""
    probe = mount.probe
    stiffness = probe.stiffness_n_per_mm / MM
    carrier = mjcf.body("carrier").parent
    ahead = (probe.reach_mm - probe.ball_radius_mm) * MM
    stylus = carrier.add_body(name=JOINT, pos=[-ahead, 0.0, 0.0])
    mass = stiffness / NATURAL**2
    stylus.add_joint(
        name=JOINT,
        type=mujoco.mjtJoint.mjJNT_SLIDE,
        axis=[1.0, 0.0, 0.0],
        stiffness=[stiffness, 0.0, 0.0],
        damping=[2.0 * mass * NATURAL, 0.0, 0.0],
        limited=mujoco.mjtLimited.mjLIMITED_FALSE,
    )
    off = {"contype": 0, "conaffinity": 0}
    ball = [probe.ball_radius_mm * MM, 0.0, 0.0]
    stylus.add_geom(name=BALL, type=mujoco.mjtGeom.mjGEOM_SPHERE, size=ball, mass=mass, **off)
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, mount.clamping.rotation.ravel())
    part = mjcf.body("work").add_body(
        name="bands", pos=(mount.clamping.translation * MM).tolist(), quat=quat.tolist()
    )
    for k, step in enumerate(mount.steps):
        part.add_geom(
            name=f"{STEP}{k}",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[(step.radius + mount.form.range_mm) * MM, 0.0, 0.0],
            fromto=[0.0, 0.0, step.low * MM, 0.0, 0.0, step.high * MM],
            mass=0.0,
            **off,
        )
        mjcf.add_pair(name=f"{STEP}{k}", geomname1=BALL, geomname2=f"{STEP}{k}", **HARD)
    home = mjcf.key("home")
    home.qpos = [*home.qpos, 0.0]


class Stylus:
    """The stylus of a compiled machine at work."""

    def __init__(self, model: mujoco.MjModel, mount: StylusMount, work_spindle: str, period_s: float) -> None:
        self._model = model
        self._mount = mount
        self._trigger = Trigger(mount.probe, period_s)
        self._at = int(model.joint(JOINT).qposadr[0])
        self._turn = int(model.joint(work_spindle).qposadr[0])
        self._steps = [int(model.geom(f"{STEP}{k}").id) for k in range(len(mount.steps))]
        self._none = {g for g, step in zip(self._steps, mount.steps, strict=True) if not step.band}
        # the machine's own shapes are watched by distance, and none of them pushes anything
        for geom in range(model.ngeom):
            model.geom_contype[geom] = model.geom_conaffinity[geom] = 0
        self._round = not mount.form.range_mm
        self._inside = False
        self._in_place: list[bool] = []
        self._watched = False
        self._pushed = 0.0
        self.busy = False
        """whether it swings or is in place in the chunk at hand"""
        self._swing(inwards=False)
        self._face(0.0)
        self.alarm: MachineAlarm | None = None
        """once the stylus has crashed"""

    def begin(self, chunk: Chunk) -> None:
        """Take up a chunk. Raises MachineError for a skip without the probe in its place."""
        self._watched = require_probe(chunk, self._mount.probe)
        in_place = chunk.tool == self._mount.probe.tool
        self._in_place = in_place.tolist()
        self.busy = self._inside or bool(in_place.any())
        if not self._watched:
            self._trigger.rest()

    def prepare(self, row: int, data: mujoco.MjData) -> None:
        """Before a tick: swing in or out, and turn the band's form before the ball."""
        if self._in_place[row] is not self._inside:
            self._swing(inwards=self._in_place[row])
        if self._inside and not self._round:
            self._face(float(data.qpos[self._turn]))

    def follow(self, data: mujoco.MjData) -> float | None:
        """After a tick: the share of it after which the axes are latched; `alarm` where the stylus broke."""
        if not self._inside:
            return None
        before, self._pushed = self._pushed, float(data.qpos[self._at]) / MM
        no_band = any(int(geom) in self._none for pair in data.contact.geom for geom in pair)
        self.alarm = crash(self._mount.probe, self._pushed, no_band=no_band)
        return self._trigger.tick(before, self._pushed) if self._watched else None

    def _swing(self, *, inwards: bool) -> None:
        off = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        flags = self._model.opt.disableflags
        self._model.opt.disableflags = flags & ~off if inwards else flags | off
        self._inside, self._pushed = inwards, 0.0

    def _face(self, turned: float) -> None:
        """Give the bands the radius that faces the ball with the work turned by so much [rad]."""
        bump = self._mount.form.at(-turned)
        for geom, step in zip(self._steps, self._mount.steps, strict=True):
            self._model.geom_size[geom, 0] = (step.radius + (bump if step.band else 0.0)) * MM
