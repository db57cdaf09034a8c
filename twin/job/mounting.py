"""The blank of a job, and how it is held."""

import dataclasses
from itertools import pairwise
from typing import Any

from twin.errors import InputError
from twin.inspection.nominal import GearNominal, Nominal
from twin.job.schema import Reference, SetupTable, Tailstock, WorkTable
from twin.job.tables import Tables

LEAST = 0.1
"""[mm] by which a centre is wider than its hole, and the hole than a bore"""


def work_of(tables: Tables) -> WorkTable:
    """[work], its size by its profile."""
    raw = tables.raw(("work",))
    work = tables.converted(WorkTable, {**_size(raw.get("profile")), **raw}, ("work",))
    try:
        dataclasses.replace(work, gear=None).blank()
    except InputError as cause:
        key = "profile" if "profile" in raw else "bore_mm"
        tables.fail(("work", key), cause.text, cause.remedy.removeprefix("valid: "))
    return work


def precut(tables: Tables, work: WorkTable, nominal: Nominal | None) -> WorkTable:
    """The blank's own gaps, completed by the nominal."""
    if work.gear is None:
        return work
    if isinstance(nominal, GearNominal):
        work = dataclasses.replace(work, gear=work.gear.completed(nominal))
    try:
        work.blank()
    except InputError as cause:
        tables.fail(("work", "gear"), f"work.gear: {cause.text}", cause.remedy.removeprefix("valid: "))
    return work


def setup_of(tables: Tables, work: WorkTable) -> SetupTable:
    """[setup] with its own tables."""
    raw = tables.raw(("setup",))
    tables.known(raw, ("reference", "tailstock", "offsets", "tool_offsets"), ("setup",))
    table = tables.table(SetupTable, ("setup",))
    if "reference" in raw:
        table = dataclasses.replace(table, reference=tables.table(Reference, ("setup", "reference")))
    if "tailstock" in raw:
        table = dataclasses.replace(table, tailstock=_tailstock(tables, work))
    return table


def _tailstock(tables: Tables, work: WorkTable) -> Tailstock:
    path = ("setup", "tailstock")
    tailstock = tables.table(Tailstock, path)
    face = 2.0 * float(work.blank().steps()[0, 1])
    sizes = {
        "bore_mm": work.bore_mm,
        "hole_diameter_mm": tailstock.hole(work.bore_mm),
        "centre_diameter_mm": tailstock.centre_diameter_mm,
    }
    for (inner, small), (outer, large) in pairwise(sizes.items()):
        if small + LEAST > large:
            tables.fail(
                (*path, outer),
                f"setup.tailstock: {outer} {large:g} is not above {inner} {small:g}",
                f"{small + LEAST:g} or more",
            )
    if sizes["hole_diameter_mm"] >= face:
        tables.fail(
            (*path, "hole_diameter_mm"),
            f"setup.tailstock: the centre would be wider than the front face, {face:g} mm",
            f"hole_diameter_mm below {face:g}",
        )
    return tailstock


def _size(profile: Any) -> dict[str, float]:
    """Diameter and length of a blank as its profile tells them; nothing where it is none."""
    if not isinstance(profile, list) or not all(isinstance(p, list) and len(p) == 2 for p in profile):
        return {}
    if not profile or not all(isinstance(value, int | float) for point in profile for value in point):
        return {}
    return {"diameter_mm": max(p[1] for p in profile), "length_mm": -min(p[0] for p in profile)}
