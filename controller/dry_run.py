"""A program without machine: alarms, positions and times from the closed forms alone, nothing is sampled."""

from collections.abc import Mapping
from dataclasses import dataclass

from controller.alarms import Alarm
from controller.events import EventKind
from controller.execution import Execution
from controller.motion import Motion
from controller.offsets import Offsets
from controller.parameters import Parameters
from controller.registers import TURN, modulo
from controller.source import Program

_TICK_S = 0.001
_DIGITS = 6
"""decimals of a reported position: rounding noise is not a position"""


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisExtent:
    """How far an axis has been, in programmed units."""

    absolute: tuple[float, float]
    """smallest and largest work coordinate"""
    machine: tuple[float, float]
    """smallest and largest slide coordinate; of a rotary axis unwrapped"""


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
    turns: Mapping[str, float]
    """rotary axis letter -> turns from the start to the end"""


@dataclass(frozen=True, slots=True)
class IdealSensor:
    """Encoders of a machine that follows its setpoints exactly."""

    motion: Motion

    def position(self, axis: int) -> float:
        """The commanded position [mm | deg]."""
        return float(self.motion.timeline.positions(self.motion.time)[axis])

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
) -> DryRun:
    """Run a program to its end or its first alarm on an ideal machine.

    Raises ControllerError for offsets or signals the machine does not have and AlarmError HT9005 for
    parameters that contradict each other; alarms of the program are in the result.
    """
    execution = Execution(
        program, parameters, offsets or Offsets(), signals or {}, tick_s=_TICK_S, closed_form=True
    )
    motion = execution.motion
    sensor = IdealSensor(motion)
    while not execution.done:
        if motion.waits_for is not None:
            execution.resume(sensor)
        else:
            execution.step()
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
            _displayed(float(value) * axis.factor, wrapped=axis.type_a) for value in positions
        )
        program_extent, slide_extent = (
            (round(float(e.low[k]) * axis.factor, _DIGITS), round(float(e.high[k]) * axis.factor, _DIGITS))
            for e in (motion.program_extents, motion.slide_extents)
        )
        extents[axis.letter] = AxisExtent(absolute=program_extent, machine=slide_extent)
        if axis.rotary:
            turns[axis.letter] = float(slides[k]) / TURN
    reports = execution.reports
    return DryRun(
        alarms=tuple(r.alarm for r in reports if r.alarm and r.kind is EventKind.ALARM),
        warnings=tuple(r.alarm for r in reports if r.alarm and r.kind is EventKind.WARNING),
        absolute=absolute,
        relative=relative,
        machine=machine,
        cycle_time_s=motion.time,
        extents=extents,
        turns=turns,
    )
