"""A program without machine: alarms, positions and times from the closed forms alone, nothing is sampled."""

import math
from array import array
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain, islice

from controller.events import EventKind
from controller.execution import Execution
from controller.language.offsets import Offsets
from controller.language.source import Program
from controller.motion.axes import Circumstances
from controller.motion.coupling import SyncInterval
from controller.motion.motion import Motion
from controller.motion.outputs import output_signals
from controller.motion.registers import TURN, modulo
from controller.motion.requests import Answer, Reading
from controller.motion.spindles import DEG_PER_S
from controller.observed import Observed
from controller.operator.actions import OperatorEvent
from controller.tables.alarms import Alarm
from controller.tables.parameters import Parameters

_RATE = 1000
"""[1/s] control ticks, on which an operator's events and readings of encoders fall"""
_DIGITS = 6
"""decimals of a reported position: rounding noise is not a position"""
_TIDY = 256
"""steps of planning after which memory of the past is freed"""


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisExtent:
    """How far an axis has been, in programmed units."""

    absolute: tuple[float, float]
    """smallest and largest work coordinate"""
    machine: tuple[float, float]
    """smallest and largest slide coordinate; of a rotary axis unwrapped"""


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisPeak:
    """The highest speed and acceleration of a slide, and what it could do. A linear axis counts slide travel,
    also where it is programmed in diameter."""

    speed: float
    """[mm/min | rpm]"""
    speed_limit: float
    """[mm/min | rpm] rapid speed (parameter 1420), of a spindle its highest (3772)"""
    acceleration: float
    """[mm/s² | rpm/s]"""
    acceleration_limit: float
    """[mm/s² | rpm/s] (parameter 1660)"""


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockTimes:
    """When every executed block began and how long it took, in the order of execution; each (n,)."""

    line: "array[int]"
    """from 1; 0 = a block from the keyboard (MDI)"""
    start_s: "array[float]"
    """[s]"""
    duration_s: "array[float]"
    """[s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class DryRun:
    """What a program does on an ideal machine, up to its end or its first alarm."""

    alarms: tuple[Alarm, ...]
    warnings: tuple[Alarm, ...]
    absolute: Mapping[str, float]
    """axis letter -> work coordinate at the end, in programmed units"""
    relative: Mapping[str, float]
    """axis letter -> relative coordinate at the end, in programmed units"""
    machine: Mapping[str, float]
    """axis letter -> slide coordinate at the end, in programmed units; rotary modulo 360"""
    cycle_time_s: float
    extents: Mapping[str, AxisExtent]
    peaks: Mapping[str, AxisPeak]
    turns: Mapping[str, float]
    """rotary axis letter -> turns from the start to the end"""
    blocks: BlockTimes
    sync: tuple[SyncInterval, ...]
    """when the gear box was engaged; an interval that is open ends with the program"""
    in_sync_at_end: bool
    """whether the gear box is engaged when nothing more happens, after an alarm as its class demands"""
    signals: Mapping[str, bool]
    """output signals at the end"""


@dataclass(frozen=True, slots=True)
class IdealSensor:
    """Encoders of a machine that follows its setpoints exactly."""

    motion: Motion

    def position(self, axis: int) -> float:
        """The commanded position [mm | deg]."""
        return self.motion.timeline.positions(self.motion.time)[axis]

    def command(self, axis: int) -> float:
        """The same."""
        return self.position(axis)

    def command_speed(self, axis: int) -> float:
        """The commanded speed [mm/s | deg/s]."""
        return self.speed(axis)

    def speed(self, axis: int) -> float:
        """The commanded speed [mm/s | deg/s]."""
        return self.motion.timeline.speed(axis, self.motion.time)


def dry_run(
    program: Program,
    parameters: Parameters,
    offsets: Offsets | None = None,
    signals: Mapping[str, bool] | None = None,
    *,
    events: Iterable[OperatorEvent] = (),
    observe: Callable[[Observed], None] | None = None,
) -> DryRun:
    """Run a program to its end or its first alarm on an ideal machine.

    `events`: what the operator does; M00 waits for cycle start where there are any. `observe` is told of
    every command that has been carried out.

    Raises ControllerError for offsets, signals or events of what the machine does not have and AlarmError
    HT9005 for parameters that contradict each other; alarms of the program are in the result.
    """
    events = tuple(events)
    circumstances = Circumstances(rate=_RATE, closed_form=True, operator_from=0.0 if events else math.inf)
    execution = Execution(
        program,
        parameters,
        offsets or Offsets(),
        signals or {},
        events=events,
        circumstances=circumstances,
        observe=observe,
    )
    motion, answer, steps = execution.motion, None, 0
    sensor = IdealSensor(motion)
    while not execution.done:
        execution.step(answer)
        answer: Answer = sensor if isinstance(execution.request, Reading) else None
        steps += 1
        if steps % _TIDY == 0:
            motion.timeline.forget(motion.time)
    return _result(execution)


def _displayed(value: float, *, wrapped: bool) -> float:
    """A position as a display shows it, without rounding noise and without minus zero."""
    return modulo(round(modulo(value), _DIGITS)) if wrapped else round(value, _DIGITS) + 0.0


def _result(execution: Execution) -> DryRun:
    motion, axes = execution.motion, execution.machine.axes
    slides = motion.timeline.positions(motion.time)
    motion.note_extents()
    absolute: dict[str, float] = {}
    relative: dict[str, float] = {}
    machine: dict[str, float] = {}
    extents: dict[str, AxisExtent] = {}
    turns: dict[str, float] = {}
    for k, axis in enumerate(axes):
        positions = (motion.registers.absolute[k], motion.registers.relative[k], slides[k])
        absolute[axis.letter], relative[axis.letter], machine[axis.letter] = (
            _displayed(value * axis.factor, wrapped=axis.type_a) for value in positions
        )
        program_extent, slide_extent = (
            (round(e.low[k] * axis.factor, _DIGITS), round(e.high[k] * axis.factor, _DIGITS))
            for e in (motion.program_extents, motion.slide_extents)
        )
        extents[axis.letter] = AxisExtent(absolute=program_extent, machine=slide_extent)
        if axis.rotary:
            turns[axis.letter] = slides[k] / TURN
    reports = execution.reports
    return DryRun(
        alarms=tuple(r.alarm for r in reports if r.alarm and r.kind is EventKind.ALARM),
        warnings=tuple(r.alarm for r in reports if r.alarm and r.kind is EventKind.WARNING),
        absolute=absolute,
        relative=relative,
        machine=machine,
        cycle_time_s=motion.time,
        extents=extents,
        peaks=_peaks(motion),
        turns=turns,
        blocks=_block_times(execution),
        sync=tuple(replace(i, end_s=min(i.end_s, motion.time)) for i in motion.coupling.intervals),
        in_sync_at_end=motion.coupling.gear is not None,
        signals=output_signals(
            execution.machine,
            motion.panel.inputs,
            motion.references,
            slides=slides,
            moves=lambda column: motion.timeline.speed(column, motion.time) != 0.0,
        ),
    )


def _peaks(motion: Motion) -> dict[str, AxisPeak]:
    found: dict[str, AxisPeak] = {}
    for k, axis in enumerate(motion.machine.axes):
        unit = 1.0 / DEG_PER_S if axis.rotary else 60.0
        found[axis.letter] = AxisPeak(
            speed=motion.peaks.speed[k] * unit,
            speed_limit=axis.spindle_max or axis.rapid * unit,
            acceleration=motion.peaks.acceleration[k] * (unit if axis.rotary else 1.0),
            acceleration_limit=axis.acceleration * (unit if axis.rotary else 1.0),
        )
    return found


def _block_times(execution: Execution) -> BlockTimes:
    start = array("d", execution.log.starts)
    ends = chain(islice(start, 1, None), [execution.motion.time])
    return BlockTimes(
        line=array("q", (max(index + 1, 0) for index in execution.log.indices)),
        start_s=start,
        duration_s=array("d", (end - begin for begin, end in zip(start, ends, strict=False))),
    )
