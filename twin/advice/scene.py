"""What the rules know before the program moves: blank, tools as mounted, where the slides put them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from controller.tables.machine_data import MachineData
from controller.tables.parameters import delivered
from twin.advice.envelope import Envelope, HeadEnvelope, HobEnvelope
from twin.cutters.cutter import Cutter
from twin.cutters.hob import Hob
from twin.job.schema import Job, Tool

_X, _Y, _Z = 1, 2, 3
"""values of parameter 1022"""


@dataclass(frozen=True, slots=True, kw_only=True)
class MountedTool:
    """A tool in the spindle."""

    tool: Tool
    envelope: Envelope
    swivel: float
    """η of a hob as it is set, 0 of a head [rad]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Centre:
    """Where the centre of the tool stands, in the part frame of a work at C0 [mm]."""

    x: float
    """towards the tool"""
    y: float
    z: float
    """from the front face, + away from the chuck"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A job on its machine."""

    job: Job
    machine: MachineData
    tools: Mapping[int, MountedTool]
    """by T number; 0 = the one that is mounted without a T word"""
    first_radius: float
    """of the tool that machine zero is preset for [mm]"""
    x_column: int | None
    """of the radial axis"""
    y_column: int | None
    """of a linear axis across the two, as the tilted slide"""
    z_column: int | None
    """of the axial axis"""
    lean: float
    """inclination of the tilted slide as built [rad]; a wrong parameter 8210 does not move the guides"""

    def tool(self, number: int) -> MountedTool | None:
        """The tool of a T number, as a run takes it; None for the touch probe, and where the job has no such
        tool."""
        if self.job.probe is not None and number == self.job.probe.tool:
            return None
        tools = tuple(self.tools.values())
        return self.tools.get(number, tools[0] if number == 0 or len(tools) == 1 else None)

    def centre(self, slides: tuple[float, ...]) -> Centre:
        """The tool centre for slide positions (axes,) [mm]; machine zero by `[setup] reference`."""
        x, y, z = (
            0.0 if column is None else slides[column]
            for column in (self.x_column, self.y_column, self.z_column)
        )
        reference = self.job.setup.reference
        return Centre(
            x=reference.X / 2.0 + self.first_radius + x + y * math.sin(self.lean),
            y=y * math.cos(self.lean),
            z=reference.Z + z,
        )


def scene_of(job: Job, cutters: Mapping[int, Cutter], machine: MachineData) -> Scene:
    """A job, its cutters by tool number, and its machine."""
    first = next(iter(cutters.values()))
    return Scene(
        job=job,
        machine=machine,
        tools={number: _mounted(job.tools[number], cutter) for number, cutter in cutters.items()},
        first_radius=first.radius,
        x_column=_column(machine, _X),
        y_column=_column(machine, _Y),
        z_column=_column(machine, _Z),
        lean=math.radians(delivered(job.machine.setup).number(8210) / 1000.0),
    )


def _column(machine: MachineData, basic: int) -> int | None:
    """Column of the linear axis with this value of parameter 1022: 1 X, 2 Y, 3 Z."""
    parameters = machine.parameters
    for k, letter in enumerate(parameters.letters):
        if parameters.integer(1022, letter) == basic and not machine.axes[k].rotary:
            return k
    return None


def _mounted(tool: Tool, cutter: Cutter) -> MountedTool:
    if isinstance(tool, Hob):
        swivel = math.pi / 2.0 - cutter.swivel
        return MountedTool(
            tool=tool, envelope=HobEnvelope(radius=cutter.radius, swivel=swivel), swivel=swivel
        )
    envelope = HeadEnvelope(radius=cutter.radius, width=tool.breadth_mm)
    return MountedTool(tool=tool, envelope=envelope, swivel=0.0)
