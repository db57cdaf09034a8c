"""The tools of a job, what is wrong with them, and what they feel."""

import dataclasses
import re
from collections.abc import Mapping

from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.errors import InputError
from twin.faults.hob_errors import hob_errors
from twin.faults.table import Faults, SlideTilt
from twin.grinding.wheel import GapWheel
from twin.inspection.nominal import GearNominal, Nominal
from twin.job.schema import Tool, WorkTable
from twin.job.tables import Tables
from twin.load.material import Physics, material_of
from twin.probing.band import steps_of
from twin.probing.probe import Probe

TOOLS: Mapping[str, type] = {
    "hob": Hob,
    "polygon_head": PolygonHead,
    "disc_wheel": DiscWheel,
    "gap_wheel": GapWheel,
}


def tools_of(tables: Tables) -> dict[int, Tool | GapWheel]:
    """The tools by number, 0 for the only one."""
    if ("tool" in tables.data) == ("tools" in tables.data):
        tables.fail((), "a job needs either [tool] or [tools.1], [tools.2], …")
    if "tool" in tables.data:
        return {0: tables.tagged(TOOLS, ("tool",))}
    numbered = tables.raw(("tools",))
    tools: dict[int, Tool | GapWheel] = {}
    for name in numbered:
        if not re.fullmatch(r"[1-9]\d?", name):
            tables.fail(("tools", name), f"tools.{name} is no tool number", "1 to 99")
        tools[int(name)] = tables.tagged(TOOLS, ("tools", name))
    return tools


def dressed(tables: Tables, tools: dict[int, Tool | GapWheel], nominal: Nominal | None) -> dict[int, Tool]:
    """Wheels dressed for the nominal's gaps."""
    done: dict[int, Tool] = {}
    for number, tool in tools.items():
        if not isinstance(tool, GapWheel):
            done[number] = tool
            continue
        path = ("tools", str(number)) if number else ("tool",)
        if not isinstance(nominal, GearNominal):
            tables.fail(path, "a gap_wheel needs a gear to be dressed for", '[nominal] kind = "gear"')
        try:
            done[number] = tool.dressed(nominal)
        except InputError as cause:
            tables.fail(path, f"{'.'.join(path)}: {cause.text}", cause.remedy.removeprefix("valid: "))
    return done


def faults_of(tables: Tables, work: WorkTable, tools: Mapping[int, Tool | GapWheel]) -> Faults:
    """[faults], held against the blank and the tools."""
    faults = tables.table(Faults, ("faults",))
    radius = work.blank().radius
    if faults.work_eccentricity_mm >= radius:
        tables.fail(
            ("faults", "work_eccentricity_mm"),
            f"faults.work_eccentricity_mm {faults.work_eccentricity_mm:g}: the spindle's axis "
            "would pass the blank by",
            f"below {radius:g}",
        )
    hobs = [tool for tool in tools.values() if isinstance(tool, Hob)]
    raw = tables.raw(("faults",))
    if "slide_tilt_deg" in raw:
        tilt = tables.table(SlideTilt, ("faults", "slide_tilt_deg"))
        faults = dataclasses.replace(faults, slide_tilt_deg=tilt)
    given = [name for name in raw if name.startswith("hob_")]
    if given and not hobs:
        tables.fail(("faults", given[0]), f"{given[0]}: the job has no hob")
    for hob in hobs:
        try:
            hob.cutter(0.0, hob_errors(faults))
        except InputError as cause:
            even = len(faults.hob_gash_error_deg) in {0, hob.gashes}
            key = "hob_lead_error_um_per_turn" if even else "hob_gash_error_deg"
            tables.fail(("faults", key), f"faults.{key}: {cause.text}", cause.remedy.removeprefix("valid: "))
    return faults


def probe_of(tables: Tables, work: WorkTable, tools: Mapping[int, Tool | GapWheel]) -> Probe | None:
    """[probe], None without one."""
    if "probe" not in tables.data:
        return None
    probe = tables.table(Probe, ("probe",))
    if probe.tool in tools:
        free = next(number for number in range(99, 0, -1) if number not in tools)
        tables.fail(("probe", "tool"), f"T{probe.tool:02d} is a cutter", f"another number, as {free}")
    if not any(step.band for step in steps_of(work.blank())):
        tables.fail(
            ("probe",),
            "the blank has no band that could be probed",
            "a cylinder below the gaps' roots in [work] profile, as a hub",
        )
    if probe.pretravel_mm >= probe.overtravel_mm:
        tables.fail(
            ("probe", "overtravel_mm"),
            f"the signal comes after {probe.pretravel_mm:g} mm, the stylus ends at "
            f"{probe.overtravel_mm:g} mm",
            "overtravel_mm above trigger_force_n / stiffness_n_per_mm",
        )
    return probe


def physics_of(tables: Tables, work: WorkTable, tools: Mapping[int, Tool | GapWheel]) -> Physics:
    """[physics], held against work and tools."""
    physics = tables.table(Physics, ("physics",))
    if not physics.cutting_load:
        return physics
    try:
        material_of(work.material, physics)
    except InputError as cause:
        tables.fail(("work", "material"), cause.text, cause.remedy.removeprefix("valid: "))
    if work.gear is not None:
        tables.fail(
            ("physics", "cutting_load"),
            "forces on a blank that is cut already are not modelled",
            "a blank without [work.gear]",
        )
    if any(isinstance(tool, DiscWheel | GapWheel) for tool in tools.values()):
        tables.fail(
            ("physics", "cutting_load"),
            "forces of a grinding wheel are not modelled",
            "hob, polygon_head",
        )
    return physics
