"""Read a job: a folder with a job.toml, or the file itself."""

import dataclasses
import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path

from twin.cutters.hob import Hob
from twin.errors import InputError, Place
from twin.grinding.wheel import GapWheel
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.job.expect import Expectation, read_expectations
from twin.job.locate import line_of
from twin.job.mounting import precut, setup_of, work_of
from twin.job.schema import (
    MODELS,
    EventTable,
    InspectionTable,
    Job,
    MachineTable,
    Tool,
    WorkTable,
)
from twin.job.tables import Tables
from twin.job.tools import dressed, faults_of, physics_of, probe_of, tools_of

NOMINALS: Mapping[str, type] = {"gear": GearNominal, "polygon": PolygonNominal}
TABLES = (
    "machine",
    "work",
    "setup",
    "tool",
    "tools",
    "program",
    "nominal",
    "inspection",
    "faults",
    "probe",
    "physics",
    "events",
    "expect",
)


def read_job(path: Path) -> Job:
    """Read and check a job.

    Raises InputError, with file and line, for whatever is not readable, not known, or impossible.
    """
    file = path / "job.toml" if path.is_dir() else path
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as cause:
        why = cause.strerror if isinstance(cause, OSError) and cause.strerror else "not UTF-8 text"
        raise InputError(f"cannot read the job: {why}", place=Place(file=str(file))) from cause
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as cause:
        raise InputError(f"not TOML: {_plain(cause)}", place=_syntax_place(file, cause)) from cause
    return _job(Tables(file, text, data))


def _plain(cause: tomllib.TOMLDecodeError) -> str:
    return re.sub(r"\s*\(at .*\)$", "", str(cause))


def _syntax_place(file: Path, cause: tomllib.TOMLDecodeError) -> Place:
    at = re.search(r"line (\d+), column (\d+)", str(cause))
    return Place(file=str(file), line=int(at[1]), column=int(at[2])) if at else Place(file=str(file))


def _job(tables: Tables) -> Job:
    tables.known(tables.data, TABLES, ())
    folder = tables.file.resolve().parent
    work = work_of(tables)
    tools = tools_of(tables)
    nominal = _nominal(tables, work, tools)
    work = precut(tables, work, nominal)
    job = Job(
        name=folder.name,
        path=tables.file,
        machine=tables.table(MachineTable, ("machine",)),
        work=work,
        setup=setup_of(tables, work),
        tools=dressed(tables, tools, nominal),
        program=_program(tables),
        nominal=nominal,
        inspection=tables.table(InspectionTable, ("inspection",)),
        faults=faults_of(tables, work, tools),
        probe=probe_of(tables, work, tools),
        physics=physics_of(tables, work, tools),
        events=_events(tables),
        expect=_expect(tables),
    )
    model = job.machine.model
    at_hand = re.fullmatch(r"\w+", model) or "/" in model
    if not at_hand or not (job.model_folder / "machine.toml").is_file():
        known = sorted(path.parent.name for path in MODELS.glob("*/machine.toml"))
        own = "" if "/" not in model else "; or a folder with a machine.toml, from the job's own on"
        tables.fail(("machine", "model"), f"unknown machine model {model!r}", ", ".join(known) + own)
    if work.stick_out_mm is not None and work.stick_out_mm < work.length_mm:
        tables.fail(
            ("work", "stick_out_mm"),
            f"with stick_out_mm {work.stick_out_mm:g} the work would reach into the chuck",
            f"at least {work.length_mm:g}",
        )
    return job


def _program(tables: Tables) -> Path:
    raw = tables.raw(("program",))
    tables.known(raw, ("file",), ("program",))
    name = raw.get("file")
    if not isinstance(name, str):
        tables.fail(("program", "file"), "the job names no program file", 'file = "program.nc" in [program]')
    path = tables.file.parent / name
    if not path.is_file():
        tables.fail(("program", "file"), f"there is no program {name!r} beside the job")
    return path


def _nominal(tables: Tables, work: WorkTable, tools: dict[int, Tool | GapWheel]) -> Nominal | None:
    if "nominal" not in tables.data:
        return None
    nominal: Nominal = tables.tagged(NOMINALS, ("nominal",))
    if isinstance(nominal, PolygonNominal):
        if nominal.number_of_sides < 3:
            tables.fail(("nominal", "number_of_sides"), "a polygon has at least 3 sides")
        if nominal.across_flats_mm <= 0:
            tables.fail(("nominal", "across_flats_mm"), "across_flats_mm must be above 0")
        return nominal
    if abs(nominal.helix_angle_deg) >= 90 or nominal.number_of_teeth < 3 or nominal.normal_module_mm <= 0:
        tables.fail(
            ("nominal",),
            "no such gear",
            "number_of_teeth from 3, normal_module_mm above 0, helix_angle_deg between -90 and 90",
        )
    tool = next(iter(tools.values()))
    filled: dict[str, float] = {}
    if nominal.tip_diameter_mm is None:
        pitch = nominal.number_of_teeth * nominal.normal_module_mm
        pitch /= math.cos(math.radians(nominal.helix_angle_deg))
        filled["tip_diameter_mm"] = pitch + 2 * nominal.normal_module_mm * (1 + nominal.profile_shift)
    if nominal.face_width_mm is None:
        filled["face_width_mm"] = work.length_mm
    if isinstance(tool, Hob):
        filled["dedendum_factor"] = tool.addendum_factor
        filled["tip_radius_factor"] = tool.tip_radius_factor
    return dataclasses.replace(nominal, **filled)


def _events(tables: Tables) -> tuple[EventTable, ...]:
    raw = tables.data.get("events", [])
    if not isinstance(raw, list) or not all(isinstance(one, dict) for one in raw):
        tables.fail(("events",), "events is no list of tables", "[[events]], once for each event")
    events = tuple(tables.converted(EventTable, one, ("events",), nth=nth) for nth, one in enumerate(raw))
    for nth, event in enumerate(events):
        if (event.time_s is None) == (event.line is None):
            tables.fail(("events",), "an event has its time_s or its line", "one of the two", nth=nth)
    return events


def _expect(tables: Tables) -> tuple[Expectation, ...]:
    def fault(way: tuple[str, ...], text: str, valid: str) -> InputError:
        # "flanks.left.…" may be written as one quoted key
        paths = (("expect", *way), ("expect", ".".join(way)))
        line = max(line_of(tables.text, path) or 0 for path in paths)
        return InputError(
            text, place=Place(file=str(tables.file), line=line or None), remedy=f"valid: {valid}"
        )

    return read_expectations(tables.raw(("expect",)), fault)
