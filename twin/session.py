"""Controller and machine on one clock, and the recording of what they did."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from controller.clock import Machine
from controller.cnc import Controller
from controller.language.source import Program
from controller.tables.alarms import Alarm
from twin.course import Course, Tape
from twin.cutters.cutter import Cutter
from twin.cutting.motion import CutterMotion
from twin.errors import PartError
from twin.faults.drives import misread
from twin.kinematics import cutter_motion, part_frame
from twin.load.timeline import CuttingLoad
from twin.machine import Guarded, IdealMachine, MujocoMachine, SyncWindow
from twin.presets import ControllerSettings
from twin.recording import BlockRef, Recording
from twin.setup import MountedTool, Ready
from twin.sync import spectrum

Floats = NDArray[np.float64]

MM_PER_UM = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Clash:
    """The first time that a tool takes metal the wrong way in a block."""

    alarm: Alarm
    time_s: float
    point: Floats
    """(3,) [mm] where an edge meets the metal, in the work frame: the part frame at C0"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """What a run left behind."""

    recording: Recording
    motions: tuple[tuple[Cutter, CutterMotion], ...]
    """one for each stretch in which one tool was in the spindle"""
    alarms: tuple[Alarm, ...]
    warnings: tuple[Alarm, ...]
    skipped_s: float
    """idle time that was passed over"""
    rapid: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, dtype=bool))
    """(n,) whether the slides moved at rapid, of every sample of the recording"""
    clashes: tuple[Clash, ...] = ()
    """where a cutter took metal as it must not; their alarms are among `alarms`"""
    common: Mapping[int, float | None] = field(default_factory=dict)
    """common variables of the control at the end, #100 to #199 and #500 to #999"""


def run_program(
    program: Program,
    settings: ControllerSettings,
    ready: Ready,
    *,
    ideal: bool,
    progress: Callable[[float], None] = lambda _seconds: None,
) -> Session:
    """Run a program on the machine as made ready, or on one whose axes follow their setpoints exactly; it
    stops where its bodies collide. Raises PartError for a run beyond LONGEST_RUN_S."""
    course = begin_program(program, settings, ready, ideal=ideal, progress=progress)
    course.go()
    return session_of(course, ready)


def begin_program(
    program: Program,
    settings: ControllerSettings,
    ready: Ready,
    *,
    ideal: bool,
    progress: Callable[[float], None] = lambda _seconds: None,
) -> Course:
    """The same before its first tick."""

    controller = Controller(
        program,
        parameters=settings.parameters,
        offsets=settings.offsets,
        tick_s=ready.spec.control_period_s,
        signals=settings.signals,
        events=settings.events,
    )
    if ideal:
        contact = None if ready.probe is None else ready.probe.contact
        axes, period_s = len(ready.tools[0].assembly.joints), ready.spec.control_period_s
        machine: Machine = IdealMachine(axes, settings.encoders, contact=contact, period_s=period_s)
    else:
        machine = MujocoMachine(misread(ready.driven, settings.encoders))
    machine = SyncWindow(machine, settings.parameters.number(9006))
    guarded = Guarded(machine, {tool.number: tool.assembly for tool in ready.tools})
    return Course(controller, guarded, progress=progress)


def record(controller: Controller, machine: Machine, ready: Ready) -> Session:
    """Run a controller's program to its end or its first alarm. Raises PartError for a run beyond
    LONGEST_RUN_S."""
    course = Course(controller, machine)
    course.go()
    return session_of(course, ready)


def session_of(course: Course, ready: Ready, load: CuttingLoad | None = None) -> Session:
    """What a course has left so far; `load`: what the cut has done to axes and mounts."""
    controller, tape = course.controller, course.tape()
    n = len(tape.time)
    centre, axis, zero = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    pushed = load.recorded(ticks_of(tape, controller.tick_s)) if load else None
    motions: list[tuple[Cutter, CutterMotion]] = []
    for rows, cutter, motion in motions_on(tape, ready, None if pushed is None else pushed.deflection_um):
        centre[rows], axis[rows], zero[rows] = part_frame(motion)
        if cutter is not None:
            motions.append((cutter, motion))
    recording = Recording(
        time_s=tape.time,
        axes=controller.axes,
        setpoint=tape.setpoint,
        actual=tape.actual,
        block=tape.block,
        blocks=tuple(BlockRef(file=b.file, line=b.line, text=b.text) for b in controller.blocks),
        tool=tape.tool,
        sync=tape.sync,
        sync_error_arcsec=tape.sync_error,
        sync_spectrum=spectrum(
            tape.time,
            tape.sync_error,
            tape.setpoint[:, ready.work_column],
            tape.setpoint[:, ready.tool_column],
        ),
        work_angle_deg=tape.actual[:, ready.work_column],
        tool_angle_deg=tape.actual[:, ready.tool_column],
        tool_centre_mm=centre,
        tool_axis=axis,
        tool_zero=zero,
        load=pushed,
    )
    return Session(
        recording=recording,
        motions=tuple(motions),
        alarms=controller.alarms,
        warnings=controller.warnings,
        skipped_s=course.skipped * controller.tick_s,
        rapid=tape.rapid,
        common=controller.common_variables,
    )


def ticks_of(tape: Tape, tick_s: float) -> NDArray[np.int64]:
    """(n,) number of each row's tick, from 0."""
    return np.rint(tape.time / tick_s).astype(np.int64) - 1


def motions_on(
    tape: Tape, ready: Ready, deflection_um: Floats | None = None
) -> list[tuple[slice, Cutter | None, CutterMotion]]:
    """Rows and motion of each stretch with one tool of two rows or more, `deflection_um` (n, 3) of the mounts
    in it; no cutter where the touch probe is in its place."""
    found = []
    for first, last, mounted, cuts in _stretches(ready, tape.tool):
        if last - first < 2 <= len(tape.time):
            continue
        rows = slice(first, last)
        pushed = None if deflection_um is None else deflection_um[rows] * MM_PER_UM
        motion = cutter_motion(mounted.kinematics, tape.time[rows], tape.actual[rows], pushed)
        found.append((rows, mounted.cutter if cuts else None, motion))
    return found


def tool_motions(
    ready: Ready, time_s: Floats, actual: Floats, tool: NDArray[np.int16]
) -> tuple[tuple[Cutter, CutterMotion], ...]:
    """How recorded axes (n, axes) move each tool, one for each stretch with one tool in the spindle."""
    return tuple(
        (mounted.cutter, cutter_motion(mounted.kinematics, time_s[first:last], actual[first:last]))
        for first, last, mounted, cuts in _stretches(ready, tool)
        if cuts and last - first > 1
    )


def _stretches(ready: Ready, tool: NDArray) -> list[tuple[int, int, MountedTool, bool]]:
    """First and one-past-last sample of each stretch with one tool, and whether it cuts."""
    if not len(tool):
        return []
    change = np.flatnonzero(np.diff(tool)) + 1
    bounds = [0, *change.tolist(), len(tool)]
    return [(first, last, *tool_in_place(ready, int(tool[first]))) for first, last in pairwise(bounds)]


def tool_in_place(ready: Ready, number: int) -> tuple[MountedTool, bool]:
    """What a tool number has in the spindle, and whether it cuts; 0 is the first tool, the touch probe has
    the first tool's place. Raises PartError for a number that the job does not have."""
    tools = ready.tools
    if ready.probe is not None and number == ready.probe.contact.probe.tool:
        return tools[0], False
    by_number = {t.number: t for t in tools}
    mounted = by_number.get(number, tools[0] if number == 0 or len(tools) == 1 else None)
    if mounted is None:
        raise PartError(
            f"the program calls T{number:02d}, which the job does not have",
            remedy=f"valid: {', '.join(f'T{n:02d}' for n in by_number)}",
        )
    return mounted, True
