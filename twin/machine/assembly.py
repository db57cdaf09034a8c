"""The machine as mounted for a job: MJCF plus drives, work and tool, compiled."""

# pyright: reportAttributeAccessIssue=false

import math
from dataclasses import dataclass

import mujoco  # its bindings are compiled and carry no types
import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError
from twin.machine.bare import bare
from twin.machine.drive import AxisDrive, DriveKind
from twin.machine.spec import MachineSpec, Setup
from twin.machine.stylus import StylusMount, mount_stylus
from twin.machine.tailstock import TailstockMount, mount_tailstock

STEEL = 7850.0
"""density [kg/m³]"""
MM = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkMount:
    """The blank and how far it stands out (controller.md, section 0)."""

    diameter_mm: float
    length_mm: float
    arbor_diameter_mm: float
    stick_out_mm: float | None = None
    """front face from the chuck's face; None = length + 80"""

    @property
    def stick_out(self) -> float:
        """The same where it is left open, too [mm]."""
        return self.length_mm + 80.0 if self.stick_out_mm is None else self.stick_out_mm


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolMount:
    """The cutter's envelope and how its carrier is swivelled."""

    carrier_swivel_deg: float
    """psi about X: tool axis u = (0, -sin psi, cos psi); 0 = parallel to the work (polygon head)"""
    radius_mm: float
    """tip radius"""
    length_mm: float
    edges: int
    """rows of teeth or inserts, for the picture and the balance"""


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineZero:
    """Part coordinates of machine zero (`[setup] reference` of a job)."""

    x_mm: float = 400.0
    """diameter at the tool tip"""
    z_mm: float = 300.0
    """tool centre from the front face"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Assembly:
    """A compiled machine. Joints stand in system axis order."""

    spec: MachineSpec
    setup: Setup
    mjcf: mujoco.MjSpec
    """editable; with everything visible, lights and cameras"""
    model: mujoco.MjModel
    """compiled for distances: nothing that is only seen"""
    joints_alone: mujoco.MjModel
    """compiled for the drives: no shapes; the same qpos as `model`"""
    stylus: StylusMount | None = None
    """the touch probe, where one is mounted"""

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in system axis order."""
        return self.spec.setups[self.setup]

    def picture_model(self) -> mujoco.MjModel:
        """Compiled with visual geometry; the same qpos as `model`."""
        return self.mjcf.compile()

    def drives(self) -> tuple[AxisDrive, ...]:
        """What moves each axis, referred to it."""
        hinge = mujoco.mjtJoint.mjJNT_HINGE
        return tuple(
            self.spec.drives[j].at_axis(rotary=self.model.joint(j).type[0] == hinge) for j in self.joints
        )

    def inertia(self) -> NDArray[np.float64]:
        """(k, k) generalised inertia of the axes [kg | kg m²]; constant, as no joint changes it."""
        data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, data)
        full = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, data, full)
        dofs = [self.model.joint(j).dofadr[0] for j in self.joints]
        return full[np.ix_(dofs, dofs)]


def hob_carrier_swivel(swivel_deg: float) -> float:
    """Carrier swivel psi of a hob at swivel eta (geometry.md, section 2): u = (0, -cos eta, sin eta)."""
    return 90.0 - swivel_deg


def assemble(
    spec: MachineSpec,
    setup: Setup,
    *,
    work: WorkMount,
    tool: ToolMount,
    zero: MachineZero | None = None,
    stylus: StylusMount | None = None,
    tailstock: TailstockMount | None = None,
) -> Assembly:
    """Mount work and tool on a machine, a touch probe beside the tool, a tailstock, and compile it.

    Raises InputError for sizes that are not positive and for an MJCF that does not compile.
    """
    zero = zero or MachineZero()
    _require_sizes(work, tool, zero)
    try:
        mjcf = mujoco.MjSpec.from_file(str(spec.folder / "scene.xml"))
    except ValueError as cause:
        raise InputError(f"cannot read machine model {spec.name!r}: {cause}", place=spec.place) from cause
    _require_masses(mjcf, spec)
    _require_parts(mjcf, spec, setup)
    _clamp_unused(mjcf, spec, setup)
    _apply_drives(mjcf, spec, setup)
    stick_out = work.stick_out
    _mount_work(mjcf, work, stick_out)
    if tailstock is not None:
        mount_tailstock(mjcf, tailstock, stick_out)
    _mount_tool(mjcf, tool)
    # Every frame of the tool chain stands in the tool centre at machine zero.
    mjcf.body("z_slide").pos = [0.0, 0.0, (stick_out + zero.z_mm) * MM]
    mjcf.body("x_slide").pos = [(zero.x_mm / 2 + tool.radius_mm) * MM, 0.0, 0.0]
    if stylus is not None:
        mount_stylus(mjcf, stylus)
    mjcf.option.timestep = spec.physics_step_s
    try:
        physics = mjcf.copy()  # which compiles, too
        physics.discard_visual()
        physics.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_SENSOR | mujoco.mjtDisableBit.mjDSBL_ISLAND
        model = physics.compile()
        joints_alone = bare(physics, model)
    except ValueError as cause:
        raise InputError(
            f"machine model {spec.name!r} does not compile: {cause}", place=spec.place
        ) from cause
    return Assembly(spec=spec, setup=setup, mjcf=mjcf, model=model, joints_alone=joints_alone, stylus=stylus)


def _require_sizes(work: WorkMount, tool: ToolMount, zero: MachineZero) -> None:
    sizes = {
        "work diameter": work.diameter_mm,
        "work length": work.length_mm,
        "arbor diameter": work.arbor_diameter_mm,
        "stick-out": work.length_mm if work.stick_out_mm is None else work.stick_out_mm,
        "tool radius": tool.radius_mm,
        "tool length": tool.length_mm,
        "number of cutting edges": tool.edges,
    }
    for name, size in sizes.items():
        if not 0 < size < math.inf:
            raise InputError(f"{name} {size:g}: must be above 0 and finite")
    if work.stick_out_mm is not None and work.stick_out_mm < work.length_mm:
        raise InputError(
            f"stick-out {work.stick_out_mm:g} mm: work {work.length_mm:g} mm long would reach into the chuck"
        )
    for name, value in {"swivel": tool.carrier_swivel_deg, "X": zero.x_mm, "Z": zero.z_mm}.items():
        if not math.isfinite(value):
            raise InputError(f"{name} of the set-up is {value}: expected a finite number")


def _require_masses(mjcf: mujoco.MjSpec, spec: MachineSpec) -> None:
    """Raise InputError for a mass that is not above 0; MuJoCo asks that of all that moves together alone."""
    for body in mjcf.bodies[1:]:  # the first one is the world
        if body.explicitinertial and not body.mass > 0.0:
            raise InputError(
                f"machine model {spec.name!r}: body {body.name!r} has a mass of {body.mass:g} kg",
                place=spec.place,
                remedy="above 0",
            )


def _require_parts(mjcf: mujoco.MjSpec, spec: MachineSpec, setup: Setup) -> None:
    """Raise InputError where the MJCF lacks a part that mounting or driving needs."""
    joints = spec.setups[setup]
    wanted = {
        "joint": (joints, mjcf.joints),
        "actuator": (joints, mjcf.actuators),
        "body": (("z_slide", "x_slide", "carrier", "tool", "work"), mjcf.bodies),
        "keyframe": (("home",), mjcf.keys),
    }
    for kind, (names, elements) in wanted.items():
        present = [element.name for element in elements]
        if missing := [name for name in names if name not in present]:
            raise InputError(
                f"machine model {spec.name!r} has no {kind} named {missing[0]!r}",
                place=spec.place,
                remedy=f"it has: {', '.join(present)}",
            )


def _clamp_unused(mjcf: mujoco.MjSpec, spec: MachineSpec, setup: Setup) -> None:
    """Delete joints that are no axis of the set-up; the home keyframe shrinks with them."""
    joints = spec.setups[setup]
    for motor in [a for a in mjcf.actuators if a.target not in joints]:
        mjcf.delete(motor)
    for sensor in [s for s in mjcf.sensors if s.objname not in joints]:
        mjcf.delete(sensor)
    for joint in [j for j in mjcf.joints if j.name not in joints]:
        mjcf.delete(joint)
    home = mjcf.key("home")
    home.qpos = [0.0] * len(joints)
    home.ctrl = [0.0] * len(joints)


def _apply_drives(mjcf: mujoco.MjSpec, spec: MachineSpec, setup: Setup) -> None:
    for name in spec.setups[setup]:
        drive, joint, motor = spec.drives[name], mjcf.joint(name), mjcf.actuator(name)
        rotary = joint.type == mujoco.mjtJoint.mjJNT_HINGE
        if drive.kind is DriveKind.VARIABLE_FREQUENCY and not rotary:
            raise InputError(
                f"drives.{name}: an induction motor drives a spindle, not a slide",
                place=spec.place_of(("drives", name, "kind")),
                remedy=f"valid: {DriveKind.SERVO.value}",
            )
        at_axis = drive.at_axis(rotary=rotary)
        joint.armature = at_axis.inertia
        joint.frictionloss = drive.coulomb_friction
        joint.damping = [drive.viscous_friction, 0.0, 0.0]  # linear term alone
        motor.ctrlrange = [-at_axis.force_limit, at_axis.force_limit]


def _mount_work(mjcf: mujoco.MjSpec, work: WorkMount, stick_out_mm: float) -> None:
    """Blank and arbor turn together; the arbor fills the bore, so both are solid steel."""
    mount = mjcf.body("work")
    mount.pos = [0.0, 0.0, stick_out_mm * MM]
    back, chuck = -work.length_mm * MM, -stick_out_mm * MM
    for name, radius, start, end, material in (
        ("blank", work.diameter_mm / 2 * MM, 0.0, back, "work"),
        ("arbor", work.arbor_diameter_mm / 2 * MM, back, chuck, "dark"),
    ):
        if start == end:
            continue
        body = mount.add_body(name=name)
        ends = [0.0, 0.0, start, 0.0, 0.0, end]
        shape = {"type": mujoco.mjtGeom.mjGEOM_CYLINDER, "size": [radius, 0, 0], "fromto": ends}
        body.add_geom(mjcf.find_default("visual"), material=material, **shape)
        body.add_geom(
            mjcf.find_default("work_collision"), mass=STEEL * math.pi * radius**2 * (start - end), **shape
        )


def _mount_tool(mjcf: mujoco.MjSpec, tool: ToolMount) -> None:
    """Swivel the carrier and mount a cutter: a core, and its rows of teeth or inserts on the rim."""
    half = math.radians(tool.carrier_swivel_deg) / 2
    mjcf.body("carrier").quat = [0.0, 0.0, -math.sin(half), math.cos(half)]  # Rx(psi) Rz(180 deg)
    cutter = mjcf.body("tool").add_body(name="cutter")
    radius, length = tool.radius_mm * MM, tool.length_mm / 2 * MM
    depth = 0.15 * radius
    width = min(0.2 * math.tau * radius / tool.edges, 0.25 * radius)
    core = {"type": mujoco.mjtGeom.mjGEOM_CYLINDER}
    cutter.add_geom(mjcf.find_default("visual"), material="steel", size=[radius - depth, length, 0], **core)
    for k in range(tool.edges):
        angle = math.tau * k / tool.edges
        at = radius - depth / 2
        cutter.add_geom(
            mjcf.find_default("visual"),
            material="tool",
            pos=[at * math.cos(angle), at * math.sin(angle), 0.0],
            quat=[math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)],
            size=[depth / 2, width / 2, length],
        )
    cutter.add_geom(
        mjcf.find_default("tool_collision"),
        mass=STEEL * math.pi * radius**2 * 2 * length,
        size=[radius, length, 0],
        **core,
    )
