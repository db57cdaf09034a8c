"""What a job presets before anything moves: each tool's edges and swivel, and the controller's offsets."""

import math

from controller.offsets import Offsets
from twin.cutters.cutter import Cutter
from twin.cutters.hob import Hob
from twin.errors import InputError, Place
from twin.inspection.nominal import GearNominal
from twin.job.schema import Job, Tool


def cutters_of(job: Job) -> dict[int, Cutter]:
    """Cutters by tool number. Raises InputError for a hob whose swivel is neither given nor computable."""
    return {number: _cutter(job, tool) for number, tool in job.tools.items()}


def offsets_of(job: Job, cutters: dict[int, Cutter]) -> Offsets:
    """Presets: X reads the diameter at the tool's tip, Z0 the front face (controller.md, section 0)."""
    reference = job.setup.reference
    first = next(iter(cutters.values()))
    work = {"G54": {"X": -reference.X, "Z": -reference.Z}, **job.setup.offsets}
    tools: dict[int, dict[str, float]] = {
        number: {"X": 2.0 * (first.radius - cutter.radius)} for number, cutter in cutters.items() if number
    }
    for name, values in job.setup.tool_offsets.items():
        if not name.isdigit():
            raise InputError(f"tool_offsets: {name!r} is no number", place=Place(file=str(job.path)))
        tools[int(name)] = dict(values)
    return Offsets(work=work, tool=tools)


def _cutter(job: Job, tool: Tool) -> Cutter:
    if not isinstance(tool, Hob):
        return tool.cutter()
    if tool.swivel_deg is not None:
        return tool.cutter(math.radians(tool.swivel_deg))
    if not isinstance(job.nominal, GearNominal):
        raise InputError(
            "the hob's swivel is not known: the job has no nominal gear",
            place=Place(file=str(job.path)),
            remedy='swivel_deg in [tool], or [nominal] kind = "gear"',
        )
    # swivel = helix angle − lead angle, both with the sign of their hand (geometry.md, section 2)
    return tool.cutter(math.radians(job.nominal.helix_angle_deg) - tool.lead_angle)
