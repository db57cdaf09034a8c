"""Draws up the error budget of a job: ideal, each source alone, all together.

The program is run once on ideal axes; whatever sits in clamping, hob or slides moves those same axes. Only
what the drives do needs a run of its own. Parts are felt by rays instead of meshed.
"""

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context

import numpy as np
from numpy.typing import NDArray

from controller.language.source import load_program
from twin.budget.faces import FACE_ITEMS, FeltFaces, face_difference, face_values, feel_faces
from twin.budget.felt import Felt, feel
from twin.budget.items import ITEMS, Item, difference, values
from twin.budget.sources import IDEAL, MISREADING, Source, sources_of, with_drives
from twin.cutters.cutter import Cutter
from twin.cutting.fields import tool_field
from twin.cutting.motion import CutterMotion, RigidTransform
from twin.errors import InputError, PartError, Place
from twin.faults.encoders import stands
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal, PolygonNominal
from twin.inspection.tolerances import GearSize, gear_tolerance, outside_standard
from twin.job.schema import Job
from twin.presets import cutters_of, settings_of
from twin.session import run_program, tool_motions
from twin.setup import Ready, make_ready

Floats = NDArray[np.float64]
Values = dict[str, float | None]
Part = Felt | FeltFaces
Progress = Callable[[str], None]

GRADED = (
    "profile_slope",
    "profile_form",
    "profile_total",
    "helix_slope",
    "helix_form",
    "helix_total",
    "single_pitch",
    "cumulative_pitch",
    "runout",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """What one source does."""

    name: str
    words: str
    values: Values
    """item -> what it alone puts on the flanks [µm]; None = not measurable"""
    reason: str = ""
    """why nothing could be felt"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """The error budget of a job."""

    title: str
    items: tuple[Item, ...]
    """what is measured on such a part"""
    ideal: Values
    """item -> what the process itself leaves: feed marks, flats, the form of the hob [µm]"""
    shares: tuple[Share, ...]
    """the one to mend first first"""
    together: Share
    """the part as it comes off this machine: its own figures, the process included"""
    accuracy_class: int | None
    tolerances: dict[str, float]
    """item -> allowed [µm]; empty where no class is named"""

    @property
    def of_gear(self) -> bool:
        """Whether the part is a gear, not a polygon."""
        return self.items == ITEMS

    def weight(self, item: str, value: float | None) -> float:
        """A figure over what is allowed, or in µm where nothing is said of that."""
        if value is None:
            return 0.0
        if self.tolerances:
            return abs(value) / self.tolerances[item] if item in self.tolerances else 0.0
        return abs(value)

    def worst(self, share: Share) -> tuple[str, float]:
        """The item that a source spoils most, and its weight."""
        weights = {item: self.weight(item, value) for item, value in share.values.items()}
        item = max(weights, key=lambda key: weights[key], default="")
        return item, weights.get(item, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Axes:
    """Recorded axes over time."""

    time_s: Floats
    actual: Floats
    tool: NDArray[np.int16]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    """One part to be felt."""

    job: Job
    """with the faults of that part"""
    drives: tuple[str, ...] | None
    """as `Source.drives`"""
    ideal: _Axes
    phase: float = 0.0
    """about where tooth 1 stands [rad]"""


def draw_up(job: Job, *, progress: Progress = lambda _text: None) -> Budget:
    """The budget of a gear or a polygon.

    Raises InputError for a job without a nominal, PartError where already the ideal part is none.
    """
    if job.nominal is None:
        raise InputError(
            "a budget is drawn up for gears and polygons: this job does not say what it makes",
            place=Place(file=str(job.path)),
            remedy='[nominal] kind = "gear" or "polygon"',
        )
    plain = replace(job, faults=IDEAL)
    cutters = cutters_of(plain)
    ready = make_ready(plain, cutters)
    progress("running the program on ideal axes")
    session = run_program(load_program(job.program), settings_of(plain, cutters), ready, ideal=True)
    if session.alarms:
        raise PartError(f"already on ideal axes the program ends in an alarm: {session.alarms[0]}")
    axes = _Axes(
        time_s=session.recording.time_s, actual=session.recording.actual, tool=session.recording.tool
    )
    sources = sources_of(job.faults, ready.spec, ready.tools[0].assembly.joints)
    progress(f"feeling the ideal part, {len(sources)} with one source each, and the real one")
    try:
        ideal = _feel(plain, ready, session.motions)
    except PartError as cause:
        raise PartError(f"already on ideal axes there is no {_kind(job)} to measure: {cause.text}") from cause
    tasks = [
        *(
            _Task(job=replace(job, faults=s.faults), drives=s.drives, ideal=axes, phase=ideal.phase)
            for s in sources
        ),
        _Task(job=job, drives=MISREADING, ideal=axes, phase=ideal.phase),
    ]
    # those that need the machine to be run take longest: they begin first
    order = sorted(range(len(tasks)), key=lambda k: tasks[k].drives is None)
    workers = min(len(tasks), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        found = dict(zip(order, pool.map(_felt, [tasks[k] for k in order]), strict=True))
    *each, real = (found[k] for k in range(len(tasks)))
    return _budget(job, ideal, tuple(zip(sources, each, strict=True)), real)


def _felt(task: _Task) -> Part | str:
    """The part of a task, or why there is none."""
    job = task.job
    cutters = cutters_of(job)
    ready = make_ready(job, cutters)
    settings = settings_of(job, cutters)
    if task.drives is None:
        actual = stands(settings.encoders, task.ideal.actual)
        motions = tool_motions(ready, task.ideal.time_s, actual, task.ideal.tool)
    else:
        session = run_program(load_program(job.program), settings, _driven(ready, task.drives), ideal=False)
        if session.alarms:
            return str(session.alarms[0])
        motions = session.motions
    try:
        return _feel(job, ready, motions, phase=task.phase)
    except PartError as cause:
        return cause.text


def _feel(
    job: Job, ready: Ready, motions: tuple[tuple[Cutter, CutterMotion], ...], *, phase: float = 0.0
) -> Part:
    blank = job.work.blank()
    fields = tuple(tool_field(c, m, blank.radius, blank.z_range) for c, m in motions)
    if not any(field.passes.count for field in fields):
        raise PartError("no edge ever swung past the blank: nothing was cut")
    turned = job.inspection.datum == "spindle"
    datum = ready.tools[0].kinematics.mount if turned else RigidTransform()
    if isinstance(job.nominal, PolygonNominal):
        return feel_faces(fields, job.nominal, blank, datum=datum, phase=phase)
    if not isinstance(job.nominal, GearNominal):
        raise PartError("nothing is said of what the part should be")
    return feel(fields, geometry(job.nominal), blank, datum=datum, phase=phase)


def _figures(part: Part) -> Values:
    return face_values(part) if isinstance(part, FeltFaces) else values(part)


def _beside(part: Part, reference: Part) -> Values:
    """What a part has beside another one's figures."""
    if isinstance(part, FeltFaces) and isinstance(reference, FeltFaces):
        return face_values(face_difference(part, reference))
    if isinstance(part, Felt) and isinstance(reference, Felt):
        return values(difference(part, reference))
    raise TypeError("a gear and a polygon have nothing to be compared by")


def _kind(job: Job) -> str:
    return "polygon" if isinstance(job.nominal, PolygonNominal) else "gear"


def _driven(ready: Ready, kept: tuple[str, ...]) -> Ready:
    """The machine with drives that misread nothing but `kept`."""
    first, probe = ready.tools[0], ready.probe
    spec = with_drives(first.assembly.spec, kept)
    return replace(
        ready,
        tools=(replace(first, assembly=replace(first.assembly, spec=spec)), *ready.tools[1:]),
        probe=probe and replace(probe, assembly=replace(probe.assembly, spec=spec)),
    )


def _budget(
    job: Job,
    ideal: Part,
    each: tuple[tuple[Source, Part | str], ...],
    real: Part | str,
) -> Budget:
    by_name = {source.name: one for source, one in each}
    shares = []
    for source, one in each:
        reference = by_name[source.against] if source.against else ideal
        said = next((r for r in (one, reference) if isinstance(r, str)), "")
        moved = {}
        if not isinstance(one, str) and not isinstance(reference, str):
            moved = _beside(one, reference)
        shares.append(Share(name=source.name, words=source.words, values=moved, reason=said))
    together = Share(
        name="together",
        words="all together",
        values={} if isinstance(real, str) else _figures(real),
        reason=real if isinstance(real, str) else "",
    )
    budget = Budget(
        title=job.name,
        items=ITEMS if isinstance(ideal, Felt) else FACE_ITEMS,
        ideal=_figures(ideal),
        shares=(),
        together=together,
        accuracy_class=job.nominal.accuracy_class if isinstance(job.nominal, GearNominal) else None,
        tolerances=_tolerances(job),
    )
    # a source that leaves no part is the first to mend
    shares.sort(key=lambda share: (not share.reason, -budget.worst(share)[1]))
    return replace(budget, shares=tuple(shares))


def _tolerances(job: Job) -> dict[str, float]:
    nominal = job.nominal
    if not isinstance(nominal, GearNominal):
        return {}
    gear = geometry(nominal)
    size = GearSize(
        number_of_teeth=gear.teeth,
        reference_diameter=gear.reference_diameter,
        normal_module=gear.module,
        face_width=nominal.face_width_mm or job.work.length_mm,
        helix_angle=nominal.helix_angle_deg,
    )
    if nominal.accuracy_class is None or outside_standard(size):
        return {}
    return {item: gear_tolerance(item, size, nominal.accuracy_class) for item in GRADED}
