"""Read a job: a folder with a job.toml, or the file itself."""

import dataclasses
import math
import re
import tomllib
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, NoReturn, TypeVar, get_args, get_origin, get_type_hints

import msgspec

from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.errors import HobtwinError, InputError, Place
from twin.faults.hob_errors import hob_errors
from twin.faults.table import Faults, SlideTilt
from twin.grinding.wheel import GapWheel
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.job.expect import Expectation, read_expectations
from twin.job.locate import line_of
from twin.job.schema import (
    MODELS,
    EventTable,
    InspectionTable,
    Job,
    MachineTable,
    Reference,
    SetupTable,
    Tailstock,
    Tool,
    WorkTable,
)
from twin.load.material import Physics, material_of
from twin.probing.band import steps_of
from twin.probing.probe import Probe

T = TypeVar("T")

LEAST = 0.1
"""[mm] by which a centre is wider than its hole, and the hole than a bore"""

TOOLS: Mapping[str, type] = {
    "hob": Hob,
    "polygon_head": PolygonHead,
    "disc_wheel": DiscWheel,
    "gap_wheel": GapWheel,
}
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
    return _Reader(file, text, data).job()


def _plain(cause: tomllib.TOMLDecodeError) -> str:
    return re.sub(r"\s*\(at .*\)$", "", str(cause))


def _syntax_place(file: Path, cause: tomllib.TOMLDecodeError) -> Place:
    at = re.search(r"line (\d+), column (\d+)", str(cause))
    return Place(file=str(file), line=int(at[1]), column=int(at[2])) if at else Place(file=str(file))


def _choices(kind: type, path: tuple[str, ...]) -> str:
    """What a field of a few fixed words accepts; empty for any other field."""
    hint = get_type_hints(kind).get(path[0]) if path else None
    return ", ".join(str(word) for word in get_args(hint)) if get_origin(hint) is Literal else ""


def _size(profile: Any) -> dict[str, float]:
    """Diameter and length of a blank as its profile tells them; nothing where it is none."""
    if not isinstance(profile, list) or not all(isinstance(p, list) and len(p) == 2 for p in profile):
        return {}
    if not profile or not all(isinstance(value, int | float) for point in profile for value in point):
        return {}
    return {"diameter_mm": max(p[1] for p in profile), "length_mm": -min(p[0] for p in profile)}


class _Reader:
    """The tables of one job file, turned into dataclasses."""

    def __init__(self, file: Path, text: str, data: dict[str, Any]) -> None:
        self.file = file
        self.text = text
        self.data = data

    def job(self) -> Job:
        self._known(self.data, TABLES, ())
        folder = self.file.resolve().parent
        work = self._work()
        tools = self._tools()
        nominal = self._nominal(work, tools)
        work = self._precut(work, nominal)
        job = Job(
            name=folder.name,
            path=self.file,
            machine=self._table(MachineTable, ("machine",)),
            work=work,
            setup=self._setup(work),
            tools=self._dressed(tools, nominal),
            program=self._program(),
            nominal=nominal,
            inspection=self._table(InspectionTable, ("inspection",)),
            faults=self._faults(tools),
            probe=self._probe(work, tools),
            physics=self._physics(work, tools),
            events=self._events(),
            expect=self._expect(),
        )
        model = job.machine.model
        at_hand = re.fullmatch(r"\w+", model) or "/" in model
        if not at_hand or not (job.model_folder / "machine.toml").is_file():
            known = sorted(path.parent.name for path in MODELS.glob("*/machine.toml"))
            own = "" if "/" not in model else "; or a folder with a machine.toml, from the job's own on"
            self._fail(("machine", "model"), f"unknown machine model {model!r}", ", ".join(known) + own)
        if work.stick_out_mm is not None and work.stick_out_mm < work.length_mm:
            self._fail(
                ("work", "stick_out_mm"),
                f"with stick_out_mm {work.stick_out_mm:g} the work would reach into the chuck",
                f"at least {work.length_mm:g}",
            )
        return job

    def _work(self) -> WorkTable:
        raw = self._raw(("work",))
        work = self._converted(WorkTable, {**_size(raw.get("profile")), **raw}, ("work",))
        try:
            dataclasses.replace(work, gear=None).blank()
        except InputError as cause:
            key = "profile" if "profile" in raw else "bore_mm"
            self._fail(("work", key), cause.text, cause.remedy.removeprefix("valid: "))
        return work

    def _precut(self, work: WorkTable, nominal: Nominal | None) -> WorkTable:
        """The blank's own gaps, completed by the nominal."""
        if work.gear is None:
            return work
        if isinstance(nominal, GearNominal):
            work = dataclasses.replace(work, gear=work.gear.completed(nominal))
        try:
            work.blank()
        except InputError as cause:
            self._fail(("work", "gear"), f"work.gear: {cause.text}", cause.remedy.removeprefix("valid: "))
        return work

    def _dressed(self, tools: dict[int, Tool | GapWheel], nominal: Nominal | None) -> dict[int, Tool]:
        """Wheels dressed for the nominal's gaps."""
        done: dict[int, Tool] = {}
        for number, tool in tools.items():
            if not isinstance(tool, GapWheel):
                done[number] = tool
                continue
            path = ("tools", str(number)) if number else ("tool",)
            if not isinstance(nominal, GearNominal):
                self._fail(path, "a gap_wheel needs a gear to be dressed for", '[nominal] kind = "gear"')
            try:
                done[number] = tool.dressed(nominal)
            except InputError as cause:
                self._fail(path, f"{'.'.join(path)}: {cause.text}", cause.remedy.removeprefix("valid: "))
        return done

    def _setup(self, work: WorkTable) -> SetupTable:
        raw = self._raw(("setup",))
        self._known(raw, ("reference", "tailstock", "offsets", "tool_offsets"), ("setup",))
        table = self._table(SetupTable, ("setup",))
        if "reference" in raw:
            table = dataclasses.replace(table, reference=self._table(Reference, ("setup", "reference")))
        if "tailstock" in raw:
            table = dataclasses.replace(table, tailstock=self._tailstock(work))
        return table

    def _tailstock(self, work: WorkTable) -> Tailstock:
        path = ("setup", "tailstock")
        tailstock = self._table(Tailstock, path)
        face = 2.0 * float(work.blank().steps()[0, 1])
        sizes = {
            "bore_mm": work.bore_mm,
            "hole_diameter_mm": tailstock.hole(work.bore_mm),
            "centre_diameter_mm": tailstock.centre_diameter_mm,
        }
        for (inner, small), (outer, large) in pairwise(sizes.items()):
            if small + LEAST > large:
                self._fail(
                    (*path, outer),
                    f"setup.tailstock: {outer} {large:g} is not above {inner} {small:g}",
                    f"{small + LEAST:g} or more",
                )
        if sizes["hole_diameter_mm"] >= face:
            self._fail(
                (*path, "hole_diameter_mm"),
                f"setup.tailstock: the centre would be wider than the front face, {face:g} mm",
                f"hole_diameter_mm below {face:g}",
            )
        return tailstock

    def _tools(self) -> dict[int, Tool | GapWheel]:
        if ("tool" in self.data) == ("tools" in self.data):
            self._fail((), "a job needs either [tool] or [tools.1], [tools.2], …")
        if "tool" in self.data:
            return {0: self._tagged(TOOLS, ("tool",))}
        numbered = self._raw(("tools",))
        tools: dict[int, Tool | GapWheel] = {}
        for name in numbered:
            if not re.fullmatch(r"[1-9]\d?", name):
                self._fail(("tools", name), f"tools.{name} is no tool number", "1 to 99")
            tools[int(name)] = self._tagged(TOOLS, ("tools", name))
        return tools

    def _faults(self, tools: Mapping[int, Tool | GapWheel]) -> Faults:
        faults = self._table(Faults, ("faults",))
        hobs = [tool for tool in tools.values() if isinstance(tool, Hob)]
        raw = self._raw(("faults",))
        if "slide_tilt_deg" in raw:
            tilt = self._table(SlideTilt, ("faults", "slide_tilt_deg"))
            faults = dataclasses.replace(faults, slide_tilt_deg=tilt)
        given = [name for name in raw if name.startswith("hob_")]
        if given and not hobs:
            self._fail(("faults", given[0]), f"{given[0]}: the job has no hob")
        for hob in hobs:
            try:
                hob.cutter(0.0, hob_errors(faults))
            except InputError as cause:
                even = len(faults.hob_gash_error_deg) in {0, hob.gashes}
                key = "hob_lead_error_um_per_turn" if even else "hob_gash_error_deg"
                self._fail(
                    ("faults", key), f"faults.{key}: {cause.text}", cause.remedy.removeprefix("valid: ")
                )
        return faults

    def _probe(self, work: WorkTable, tools: Mapping[int, Tool | GapWheel]) -> Probe | None:
        if "probe" not in self.data:
            return None
        probe = self._table(Probe, ("probe",))
        if probe.tool in tools:
            free = next(number for number in range(99, 0, -1) if number not in tools)
            self._fail(("probe", "tool"), f"T{probe.tool:02d} is a cutter", f"another number, as {free}")
        if not any(step.band for step in steps_of(work.blank())):
            self._fail(
                ("probe",),
                "the blank has no band that could be probed",
                "a cylinder below the gaps' roots in [work] profile, as a hub",
            )
        if probe.pretravel_mm >= probe.overtravel_mm:
            self._fail(
                ("probe", "overtravel_mm"),
                f"the signal comes after {probe.pretravel_mm:g} mm, the stylus ends at "
                f"{probe.overtravel_mm:g} mm",
                "overtravel_mm above trigger_force_n / stiffness_n_per_mm",
            )
        return probe

    def _physics(self, work: WorkTable, tools: Mapping[int, Tool | GapWheel]) -> Physics:
        physics = self._table(Physics, ("physics",))
        if not physics.cutting_load:
            return physics
        try:
            material_of(work.material, physics)
        except InputError as cause:
            self._fail(("work", "material"), cause.text, cause.remedy.removeprefix("valid: "))
        if work.gear is not None:
            self._fail(
                ("physics", "cutting_load"),
                "forces on a blank that is cut already are not modelled",
                "a blank without [work.gear]",
            )
        if any(isinstance(tool, DiscWheel | GapWheel) for tool in tools.values()):
            self._fail(
                ("physics", "cutting_load"),
                "forces of a grinding wheel are not modelled",
                "hob, polygon_head",
            )
        return physics

    def _program(self) -> Path:
        raw = self._raw(("program",))
        self._known(raw, ("file",), ("program",))
        name = raw.get("file")
        if not isinstance(name, str):
            self._fail(
                ("program", "file"), "the job names no program file", 'file = "program.nc" in [program]'
            )
        path = self.file.parent / name
        if not path.is_file():
            self._fail(("program", "file"), f"there is no program {name!r} beside the job")
        return path

    def _nominal(self, work: WorkTable, tools: dict[int, Tool | GapWheel]) -> Nominal | None:
        if "nominal" not in self.data:
            return None
        nominal: Nominal = self._tagged(NOMINALS, ("nominal",))
        if isinstance(nominal, PolygonNominal):
            if nominal.number_of_sides < 3:
                self._fail(("nominal", "number_of_sides"), "a polygon has at least 3 sides")
            if nominal.across_flats_mm <= 0:
                self._fail(("nominal", "across_flats_mm"), "across_flats_mm must be above 0")
            return nominal
        if abs(nominal.helix_angle_deg) >= 90 or nominal.number_of_teeth < 3 or nominal.normal_module_mm <= 0:
            self._fail(
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

    def _events(self) -> tuple[EventTable, ...]:
        raw = self.data.get("events", [])
        if not isinstance(raw, list) or not all(isinstance(one, dict) for one in raw):
            self._fail(("events",), "events is no list of tables", "[[events]], once for each event")
        events = tuple(self._converted(EventTable, one, ("events",), nth=nth) for nth, one in enumerate(raw))
        for nth, event in enumerate(events):
            if (event.time_s is None) == (event.line is None):
                self._fail(("events",), "an event has its time_s or its line", "one of the two", nth=nth)
        return events

    def _expect(self) -> tuple[Expectation, ...]:
        def fault(way: tuple[str, ...], text: str, valid: str) -> InputError:
            # "flanks.left.…" may be written as one quoted key
            paths = (("expect", *way), ("expect", ".".join(way)))
            line = max(line_of(self.text, path) or 0 for path in paths)
            return InputError(
                text, place=Place(file=str(self.file), line=line or None), remedy=f"valid: {valid}"
            )

        return read_expectations(self._raw(("expect",)), fault)

    def _tagged(self, kinds: Mapping[str, type], path: tuple[str, ...]) -> Any:
        raw = self._raw(path)
        kind = raw.get("kind")
        if not isinstance(kind, str) or kind not in kinds:
            self._fail((*path, "kind"), f"unknown kind {kind!r} of {'.'.join(path)}", ", ".join(kinds))
        return self._table(kinds[kind], path, extra=("kind",))

    def _raw(self, path: tuple[str, ...]) -> dict[str, Any]:
        value: Any = self.data
        for name in path:
            value = value.get(name, {})
            if not isinstance(value, dict):
                self._fail(path, f"{'.'.join(path)} is not a table")
        return value

    def _table(self, kind: type[T], path: tuple[str, ...], *, extra: tuple[str, ...] = ()) -> T:
        return self._converted(kind, self._raw(path), path, extra=extra)

    def _converted(
        self,
        kind: type[T],
        raw: Mapping[str, Any],
        path: tuple[str, ...],
        *,
        extra: tuple[str, ...] = (),
        nth: int = 0,
    ) -> T:
        fields = [f.name for f in dataclasses.fields(kind)]  # pyright: ignore[reportArgumentType]
        self._known(raw, (*extra, *fields), path, nth)
        values = {key: value for key, value in raw.items() if key not in extra}
        self._finite(values, path, nth)
        try:
            return msgspec.convert(values, kind, strict=True)
        except msgspec.ValidationError as cause:
            text, _, at = str(cause).partition(" - at ")
            inner = tuple(re.findall(r"[A-Za-z_]\w*", at.strip("`$")))
            where = (*path, *inner)
            self._fail(where, f"{'.'.join(where)}: {text}", _choices(kind, inner), nth=nth)
        except HobtwinError as cause:
            valid = cause.remedy.removeprefix("valid: ")
            self._fail(path, f"{'.'.join(path)}: {cause.text}", valid, nth=nth)

    def _finite(self, value: Any, path: tuple[str, ...], nth: int = 0) -> None:
        """Refuse numbers that are none, however deep in tables and lists."""
        if isinstance(value, dict):
            for key, inner in value.items():
                self._finite(inner, (*path, key), nth)
        elif isinstance(value, list):
            for inner in value:
                self._finite(inner, path, nth)
        elif isinstance(value, float) and not math.isfinite(value):
            self._fail(path, f"{path[-1]} = {value} is not a finite number", nth=nth)

    def _known(
        self, raw: Mapping[str, Any], valid: tuple[str, ...], path: tuple[str, ...], nth: int = 0
    ) -> None:
        for key in raw:
            if key not in valid:
                what = f"[{'.'.join(path)}]" if path else "the job"
                self._fail((*path, key), f"unknown key {key!r} in {what}", ", ".join(valid), nth=nth)

    def _fail(self, path: tuple[str, ...], text: str, valid: str = "", *, nth: int = 0) -> NoReturn:
        place = Place(file=str(self.file), line=line_of(self.text, path, nth))
        raise InputError(text, place=place, remedy=f"valid: {valid}" if valid else "")
