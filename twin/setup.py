"""A job made ready to run: the machine as mounted, the controller's offsets, each tool's cutter."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from controller.tables.machine_data import machine_data
from controller.tables.parameters import Parameters
from twin.cutters.cutter import Cutter
from twin.cutters.hob import Hob
from twin.cutting.motion import RigidTransform
from twin.errors import InputError
from twin.faults.chain import faulty
from twin.faults.mounts import arbor, band_form, clamping
from twin.inspection.nominal import GearNominal
from twin.job.schema import Job, Tool
from twin.kinematics import Kinematics, read_kinematics
from twin.machine import (
    Assembly,
    Changes,
    DriveKind,
    MachineSpec,
    MachineZero,
    Setup,
    TailstockMount,
    ToolMount,
    WorkMount,
    assemble,
    load_machine,
)
from twin.machine.stylus import StylusMount
from twin.probing.band import steps_of
from twin.probing.contact import Contact

HEAD = 66.0
"""Radius of the tool head about the tool's axis [mm]."""
HEAD_BESIDE_CHUCK = 110.0
"""How far along the tool's axis the head stands beside the chuck [mm]."""
JAWS = 15.0
"""By which the chuck's jaws stand before its face, and some air [mm]."""
ARBOR = 0.6
"""Arbor diameter over root diameter where a job names none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MountedTool:
    """One tool in the spindle, its carrier swivelled for it."""

    number: int
    cutter: Cutter
    assembly: Assembly
    kinematics: Kinematics


@dataclass(frozen=True, slots=True, kw_only=True)
class MountedProbe:
    """The touch probe beside the first tool."""

    assembly: Assembly
    """of the first tool, with the stylus"""
    contact: Contact
    """the same in closed form, for ideal axes"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ready:
    """Everything that a run needs beside the program."""

    spec: MachineSpec
    setup: Setup
    tools: tuple[MountedTool, ...]
    """the first one is in the spindle when the program starts"""
    work_column: int
    """of the work spindle among the system axes"""
    tool_column: int
    """of the tool spindle"""
    work: WorkMount
    """how the work is clamped"""
    probe: MountedProbe | None = None

    @property
    def driven(self) -> Assembly:
        """The machine that the drives move."""
        return self.tools[0].assembly if self.probe is None else self.probe.assembly


def make_ready(job: Job, cutters: dict[int, Cutter], *, lowest_z_mm: float | None = None) -> Ready:
    """Mount work and tools, `cutters` by tool number.

    `lowest_z_mm`: how far the program takes the tool's centre towards the chuck, from the front face, None =
    a tool's radius behind the blank; a stick-out that the job leaves open clears it.

    Raises InputError where the job contradicts itself or the machine.
    """
    folder = job.model_folder.resolve()
    changes = Changes(table=job.machine.changes(), place=lambda path: job.place("machine", *path))
    spec = load_machine(folder.name, models=folder.parent, changes=changes)
    setup = Setup(job.machine.setup)
    reference = job.setup.reference
    machine_zero = MachineZero(x_mm=reference.X, z_mm=reference.Z)
    first = next(iter(cutters.values()))
    work = WorkMount(
        diameter_mm=job.work.diameter_mm,
        length_mm=job.work.length_mm,
        arbor_diameter_mm=job.work.arbor_diameter_mm or ARBOR * _root_diameter(job),
        stick_out_mm=job.work.stick_out_mm or _stick_out(job, cutters, lowest_z_mm),
    )
    tailstock = _tailstock(job)
    tools, mounts = [], []
    for number, cutter in cutters.items():
        mount = ToolMount(
            carrier_swivel_deg=math.degrees(cutter.swivel),
            radius_mm=cutter.radius,
            length_mm=_length(job, job.tools[number]),
            edges=max(len(cutter.gash_angle), 1),
        )
        mounts.append(mount)
        # X counts from the tips of the first tool: another one's centre stands where that one's would
        aside = 2.0 * (first.radius - cutter.radius)
        zero = MachineZero(x_mm=reference.X + aside, z_mm=reference.Z)
        assembly = assemble(spec, setup, work=work, tool=mount, zero=zero, tailstock=tailstock)
        kinematics = replace(
            faulty(
                read_kinematics(assembly.model, assembly.joints), job.faults, work_z=-job.work.length_mm / 2
            ),
            mount=clamping(job.faults, job.work.length_mm),
            arbor=arbor(job.faults, cutter) if isinstance(job.tools[number], Hob) else RigidTransform(),
        )
        tools.append(MountedTool(number=number, cutter=cutter, assembly=assembly, kinematics=kinematics))
    return Ready(
        spec=spec,
        setup=setup,
        tools=tuple(tools),
        work_column=tools[0].kinematics.work.spindle.column,
        tool_column=tools[0].kinematics.tool.spindle.column,
        work=work,
        probe=_probe(
            job,
            tools[0].kinematics,
            lambda stylus: assemble(
                spec,
                setup,
                work=work,
                tool=mounts[0],
                zero=machine_zero,
                stylus=stylus,
                tailstock=tailstock,
            ),
        ),
    )


def _tailstock(job: Job) -> TailstockMount | None:
    """The job's tailstock on the machine, where it has one."""
    table = job.setup.tailstock
    if table is None:
        return None
    return TailstockMount(
        hole_diameter_mm=table.hole(job.work.bore_mm),
        point_angle_deg=table.point_angle_deg,
        centre_diameter_mm=table.centre_diameter_mm,
        centre_length_mm=table.centre_length_mm,
        quill_diameter_mm=table.quill_diameter_mm,
        quill_length_mm=table.quill_length_mm,
    )


def _probe(
    job: Job, kinematics: Kinematics, assembled: Callable[[StylusMount], Assembly]
) -> MountedProbe | None:
    """The job's touch probe on the machine, where it has one."""
    if job.probe is None:
        return None
    steps, form = steps_of(job.work.blank()), band_form(job.faults)
    stylus = StylusMount(probe=job.probe, steps=steps, form=form, clamping=kinematics.mount)
    contact = Contact(probe=job.probe, kinematics=kinematics, steps=steps, form=form)
    return MountedProbe(assembly=assembled(stylus), contact=contact)


def require_analogue(ready: Ready, parameters: Parameters) -> None:
    """Raise InputError where the controller takes for a servo axis what is an induction motor."""
    letters = machine_data(parameters).letters
    for joint, letter in zip(ready.spec.setups[ready.setup], letters, strict=True):
        induction = ready.spec.drives[joint].kind is DriveKind.VARIABLE_FREQUENCY
        if induction and not parameters.bit(9005, 0, letter):
            raise InputError(
                f"drives.{joint} is an induction motor without position control, and the controller takes "
                f"{letter} for a servo axis",
                place=ready.spec.place_of(("drives", joint, "kind")),
                remedy=f'parameters = {{ "9005#0.{letter}" = 1 }}, and for a gear box on it "201#7" = 1',
            )


def _stick_out(job: Job, cutters: dict[int, Cutter], lowest_z_mm: float | None) -> float:
    """Front face from the chuck's face: 80 mm behind the blank, or more where the tool goes further."""
    if lowest_z_mm is None:
        lowest_z_mm = -job.work.length_mm - max(cutter.radius for cutter in cutters.values())
    reach = 0.0
    for number, cutter in cutters.items():
        across, along = abs(math.sin(cutter.swivel)), math.cos(cutter.swivel)
        tool = cutter.radius * across + _length(job, job.tools[number]) / 2 * abs(along)
        head = HEAD * across + HEAD_BESIDE_CHUCK * max(0.0, -along)
        reach = max(reach, tool, head)
    return max(job.work.length_mm + 80.0, -lowest_z_mm + reach + JAWS)


def _root_diameter(job: Job) -> float:
    """Root diameter of the nominal; without one, four fifths of the blank."""
    nominal = job.nominal
    if isinstance(nominal, GearNominal):
        pitch = (
            nominal.number_of_teeth
            * nominal.normal_module_mm
            / math.cos(math.radians(nominal.helix_angle_deg))
        )
        root = pitch - 2.0 * nominal.normal_module_mm * (nominal.dedendum_factor - nominal.profile_shift)
        return min(max(root, 0.2 * job.work.diameter_mm), job.work.diameter_mm)
    if nominal is not None:
        return min(nominal.across_flats_mm, job.work.diameter_mm)
    return 0.8 * job.work.diameter_mm


def _length(job: Job, tool: Tool) -> float:
    """Length of the tool along its axis, for the machine's picture and inertia [mm]."""
    if isinstance(tool, Hob):
        return tool.length_mm or max(0.8 * tool.outside_diameter_mm, 1.2 * job.work.diameter_mm)
    return 4.0 * tool.breadth_mm + 10.0
