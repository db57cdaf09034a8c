"""What a job presets before anything moves: each tool's edges and swivel, and the controller's offsets."""

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from controller.language.offsets import Offsets
from controller.operator.actions import OperatorEvent, check_events, operator_event
from controller.tables.alarms import AlarmError, ControllerError
from controller.tables.machine_data import machine_data
from controller.tables.parameters import Parameters, delivered
from controller.tables.signals import check_signals
from twin.cutters.cutter import Cutter
from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.errors import InputError, Place
from twin.faults.encoder_table import encoder_errors
from twin.faults.encoders import CyclicError
from twin.faults.hob_errors import hob_errors
from twin.inspection.nominal import GearNominal
from twin.job.locate import line_of
from twin.job.schema import Job, Tool


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerSettings:
    """What the controller is switched on with."""

    parameters: Parameters
    offsets: Offsets
    signals: Mapping[str, bool]
    events: tuple[OperatorEvent, ...] = ()
    """what the operator does"""
    encoders: Mapping[int, CyclicError] = field(default_factory=dict)
    """errors of rotary encoders, by column of the axis"""


def settings_of(
    job: Job,
    cutters: Mapping[int, Cutter],
    *,
    parameters: Mapping[str, str] | None = None,
    signals: Mapping[str, bool] | None = None,
    events: tuple[OperatorEvent, ...] = (),
) -> ControllerSettings:
    """Settings of a job, with those of the command line on top.

    Raises InputError, at the table of the job, for what the controller does not have.
    """
    with _said_of(job, "machine", "parameters"):
        values = delivered(job.machine.setup, {**job.machine.parameters, **(parameters or {})})
    machine = machine_data(values)
    given = {**{name: bool(value) for name, value in job.machine.signals.items()}, **(signals or {})}
    with _said_of(job, "machine", "signals"):
        check_signals(given, machine.letters)
    offsets = offsets_of(job, cutters)
    with _said_of(job, "setup"):
        offsets.check(machine)
    return ControllerSettings(
        parameters=values,
        offsets=offsets,
        signals=given,
        events=(*events_of(job, machine.letters), *events),
        encoders=encoder_errors(job, machine),
    )


def events_of(job: Job, letters: tuple[str, ...]) -> tuple[OperatorEvent, ...]:
    """`[[events]]` of a job. Raises InputError, at the event, for what no operator can do."""
    events = []
    for nth, one in enumerate(job.events):
        with _said_of(job, "events", "do", nth=nth):
            event = operator_event(one.do, time_s=one.time_s, line=one.line)
            check_events((event,), letters)
            events.append(event)
    return tuple(events)


@contextmanager
def _said_of(job: Job, *path: str, nth: int = 0) -> Iterator[None]:
    """Give the controller's refusals the place in the job, in the `nth` table of an array."""
    try:
        yield
    except AlarmError:
        raise
    except ControllerError as cause:
        line = line_of(job.path.read_text(encoding="utf-8"), path, nth)
        place = Place(file=str(job.path), line=line)
        remedy = f"valid: {cause.remedy}" if cause.remedy else ""
        raise InputError(cause.text, place=place, remedy=remedy) from cause


def cutters_of(job: Job) -> dict[int, Cutter]:
    """Cutters by tool number. Raises InputError for a hob whose swivel is neither given nor computable."""
    return {number: _cutter(job, tool) for number, tool in job.tools.items()}


def offsets_of(job: Job, cutters: Mapping[int, Cutter]) -> Offsets:
    """Presets: X reads the diameter at the tool's tip, Z0 the front face (controller.md, section 0)."""
    reference = job.setup.reference
    first = next(iter(cutters.values()))
    work = {"G54": {"X": -reference.X, "Z": -reference.Z}, **job.setup.offsets}
    tools: dict[int, dict[str, float]] = {
        number: {"X": 2.0 * (cutter.radius - first.radius)} for number, cutter in cutters.items() if number
    }
    if job.probe is not None:
        tools[job.probe.tool] = {"X": 2.0 * (job.probe.reach_mm - first.radius)}
    for name, values in job.setup.tool_offsets.items():
        if not name.isdigit():
            raise InputError(f"tool_offsets: {name!r} is no number", place=Place(file=str(job.path)))
        tools[int(name)] = dict(values)
    return Offsets(work=work, tool=tools)


def _cutter(job: Job, tool: Tool) -> Cutter:
    if isinstance(tool, PolygonHead):
        return tool.cutter()
    if tool.swivel_deg is not None:
        return _swivelled(job, tool, math.radians(tool.swivel_deg))
    if not isinstance(job.nominal, GearNominal):
        name = "hob" if isinstance(tool, Hob) else "wheel"
        raise InputError(
            f"the {name}'s swivel is not known: the job has no nominal gear",
            place=Place(file=str(job.path)),
            remedy='swivel_deg in [tool], or [nominal] kind = "gear"',
        )
    # swivel = helix angle − lead angle, both with the sign of their hand (geometry.md, sections 2 and 4)
    lead = tool.lead_angle if isinstance(tool, Hob) else 0.0
    return _swivelled(job, tool, math.radians(job.nominal.helix_angle_deg) - lead)


def _swivelled(job: Job, tool: Hob | DiscWheel, swivel: float) -> Cutter:
    return tool.cutter(swivel, hob_errors(job.faults)) if isinstance(tool, Hob) else tool.cutter(swivel)
