"""Controller and machine on one clock, and the recording of what they did."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from controller.clock import Chunk, Feedback, Machine
from controller.cnc import Controller
from controller.language.source import Program
from controller.tables.alarms import Alarm
from twin.cutters.cutter import Cutter
from twin.cutting.motion import CutterMotion
from twin.errors import PartError
from twin.faults.drives import misread
from twin.kinematics import cutter_motion, part_frame
from twin.load.forces import CuttingLoad
from twin.machine import Guarded, IdealMachine, MujocoMachine, SyncWindow
from twin.presets import ControllerSettings
from twin.recording import BlockRef, Recording
from twin.setup import MountedTool, Ready
from twin.sync import spectrum, sync_error

Floats = NDArray[np.float64]

CHUNK = 4096
"""[ticks] proposed at once where nobody watches"""
SETTLE_S = 0.5
"""[s] of a dwell that are run before the rest is passed over"""
MM_PER_UM = 1e-3
LONGEST_RUN_S = 6 * 3600.0
"""[s] of recorded motion; more would not fit the memory of a small machine"""


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
    common: Mapping[int, float | None] = field(default_factory=dict)
    """common variables of the control at the end, #100 to #199 and #500 to #999"""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Tape:
    """What one chunk, or all of them, left: the columns of a recording, row by row."""

    time: Floats
    setpoint: Floats
    actual: Floats
    block: NDArray[np.int32]
    sync: NDArray[np.bool_]
    sync_error: Floats
    tool: NDArray[np.int16]
    rapid: NDArray[np.bool_]

    @staticmethod
    def of(chunk: Chunk, feedback: Feedback, tick_s: float) -> "_Tape":
        """The rows of one chunk that the machine has really made."""
        n = feedback.ticks
        return _Tape(
            time=np.arange(chunk.first_tick + 1, chunk.first_tick + n + 1, dtype=np.float64) * tick_s,
            setpoint=feedback.setpoint,
            actual=feedback.actual,
            block=chunk.block[:n],
            sync=chunk.sync[:n],
            sync_error=sync_error(chunk, feedback),
            tool=chunk.tool[:n],
            rapid=np.zeros(n, dtype=bool) if chunk.rapid is None else chunk.rapid[:n],
        )

    @staticmethod
    def joined(tapes: list["_Tape"], axes: int) -> "_Tape":
        """All rows, one after the other."""
        empty = np.zeros((0, axes))
        none = _Tape(
            time=empty[:, 0],
            setpoint=empty,
            actual=empty,
            block=np.zeros(0, dtype=np.int32),
            sync=np.zeros(0, dtype=bool),
            sync_error=empty[:, 0],
            tool=np.zeros(0, dtype=np.int16),
            rapid=np.zeros(0, dtype=bool),
        )
        names = [f.name for f in fields(_Tape)]
        return _Tape(**{name: np.concatenate([getattr(t, name) for t in (none, *tapes)]) for name in names})


def run_program(
    program: Program,
    settings: ControllerSettings,
    ready: Ready,
    *,
    ideal: bool,
    load: CuttingLoad | None = None,
    progress: Callable[[float], None] = lambda _seconds: None,
) -> Session:
    """Run a program on the machine as made ready, or on one whose axes follow their setpoints exactly; it
    stops where its bodies collide. `load`: what the cut does to axes and mounts."""
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
        machine: Machine = IdealMachine(
            len(controller.axes), settings.encoders, contact=contact, period_s=controller.tick_s
        )
    else:
        machine = MujocoMachine(misread(ready.driven, settings.encoders))
    machine = SyncWindow(machine, settings.parameters.number(9006))
    guarded = Guarded(machine, {tool.number: tool.assembly for tool in ready.tools})
    return record(controller, guarded, ready, load=load, progress=progress)


def record(
    controller: Controller,
    machine: Machine,
    ready: Ready,
    *,
    load: CuttingLoad | None = None,
    progress: Callable[[float], None] = lambda _seconds: None,
) -> Session:
    """Run the program to its end or its first alarm. Raises PartError for a run beyond LONGEST_RUN_S."""
    tapes: list[_Tape] = []
    skipped = recorded = 0
    settle = round(SETTLE_S / controller.tick_s)
    while True:
        idle = controller.idle_ticks()
        if idle > 4 * settle and tapes:
            ticks = idle - 2 * settle
            controller.skip(ticks)
            machine.rest(ticks)
            skipped += ticks
        chunk = controller.propose(min(CHUNK, settle) if idle > 4 * settle else CHUNK)
        if chunk.ticks == 0:
            break
        feedback = machine.advance(chunk, load)
        tapes.append(_Tape.of(chunk, feedback, controller.tick_s))
        controller.commit(feedback)
        recorded += feedback.ticks
        if recorded * controller.tick_s > LONGEST_RUN_S:
            raise PartError(
                f"the program moves for more than {LONGEST_RUN_S / 3600:g} hours",
                remedy="check the feed; run a part of the program",
            )
        progress(chunk.first_tick * controller.tick_s)
    tape = _Tape.joined(tapes, len(controller.axes))
    recording, motions = _recording(controller, ready, tape, load)
    return Session(
        recording=recording,
        motions=motions,
        alarms=controller.alarms,
        warnings=controller.warnings,
        skipped_s=skipped * controller.tick_s,
        rapid=tape.rapid,
        common=controller.common_variables,
    )


def _recording(
    controller: Controller, ready: Ready, tape: _Tape, load: CuttingLoad | None
) -> tuple[Recording, tuple[tuple[Cutter, CutterMotion], ...]]:
    """The recording with the tool in the part frame, and each tool's stretch of motion."""
    n = len(tape.time)
    centre, axis, zero = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    motions: list[tuple[Cutter, CutterMotion]] = []
    pushed = load.recorded(np.rint(tape.time / controller.tick_s).astype(np.int64) - 1) if load else None
    deflection = None if pushed is None else pushed.deflection_um * MM_PER_UM
    for first, last, mounted, cuts in _stretches(ready, tape.tool):
        rows = slice(first, last)
        motion = cutter_motion(
            mounted.kinematics,
            tape.time[rows],
            tape.actual[rows],
            None if deflection is None else deflection[rows],
        )
        centre[first:last], axis[first:last], zero[first:last] = part_frame(motion)
        if cuts and last - first > 1:
            motions.append((mounted.cutter, motion))
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
    return recording, tuple(motions)


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
    """First and one-past-last sample of each stretch with one tool, and whether it cuts.

    Number 0 is the first tool; the touch probe has the first tool's place, and cuts nothing.
    """
    if not len(tool):
        return []
    tools, probe = ready.tools, None if ready.probe is None else ready.probe.contact.probe.tool
    by_number = {t.number: t for t in tools}
    change = np.flatnonzero(np.diff(tool)) + 1
    bounds = [0, *change.tolist(), len(tool)]
    found = []
    for first, last in pairwise(bounds):
        number = int(tool[first])
        if number == probe:
            found.append((first, last, tools[0], False))
            continue
        mounted = by_number.get(number, tools[0] if number == 0 or len(tools) == 1 else None)
        if mounted is None:
            raise PartError(
                f"the program calls T{number:02d}, which the job does not have",
                remedy=f"valid: {', '.join(f'T{n:02d}' for n in by_number)}",
            )
        found.append((first, last, mounted, True))
    return found
