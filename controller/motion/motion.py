"""Commands become motion: every command starts where the last one ended, spindles run beside the axes."""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

from controller.commands import (
    Arc,
    ClearTable,
    Command,
    Coolant,
    Couple,
    Dwell,
    Feed,
    MachineMove,
    Move,
    ProgramEnd,
    ProgramStop,
    ReferenceCheck,
    ReferenceReturn,
    SelectTool,
    SetCoordinates,
    SetTablePoint,
    ShiftCoordinates,
    Skip,
    SpindleSpeed,
    StrokeCheck,
    SurfaceSpeed,
    SwitchTable,
    Thread,
    Uncouple,
)
from controller.laws.arcs import arc_displacements
from controller.motion.correcting import Correcting
from controller.motion.path import NOTHING, Travel
from controller.motion.registers import TURN, modulo, shortest
from controller.motion.requests import Steps
from controller.motion.rest_to_rest import ShortLane
from controller.motion.travel import Manner
from controller.operator.actions import HIGHEST_OVERRIDE
from controller.span import Span
from controller.tables.alarms import Alarm, AlarmClass, alarm


class Motion(Correcting):
    """Plans the motion of the whole machine, command by command."""

    skip_positions: tuple[float, ...] | None = None
    """(axes,) work coordinates where the last G31 was touched, or ended (#5061 ff.); None before it"""
    _helix: float | None = None
    """spindle angle [deg] at which a thread that goes on would begin, right behind a thread"""

    @cached_property
    def _short_lane(self) -> ShortLane:
        return ShortLane(self)

    def execute(self, command: Command, span: Span) -> Steps[None] | None:
        """Plan one command of the block at `span`: at once, or by steps that still have to be taken.

        Raises AlarmError, now or in the steps, where the machine cannot do it.
        """
        self._span = span
        if self._helix is not None and not isinstance(command, Thread):
            self._helix = None
        return _LAWS[type(command)](self, command)

    def cancel_sync(self, kind: AlarmClass) -> Steps[None]:
        """What an alarm of this class does to the gear box (hobbing, 注意事项)."""
        if kind not in (AlarmClass.PROGRAM, AlarmClass.USER):
            yield from self._uncouple()

    def displayed_speed(self, time: float) -> float:
        """The speed display [mm/min]: of the axes' own motion, without the pulses of the gear box and of S
        (hobbing, 注意事项: 系统显示的实际速度); of rotary axes alone [deg/min]."""
        tracks, axes = self.timeline.tracks, self.machine.axes
        turned = {k for k, rpm in self.spindles.commanded.items() if rpm}
        own = [(axis.rotary, tracks[k].speed(time)) for k, axis in enumerate(axes) if k not in turned]
        linear = math.hypot(*(speed for rotary, speed in own if not rotary))
        return 60.0 * (linear or math.hypot(*(speed for rotary, speed in own if rotary)))

    # Moves

    def _travels(self, absolute: Travel, incremental: Travel) -> tuple[dict[int, float], dict[int, float]]:
        """Travel by column in program terms, and the absolute positions it ends on."""
        axes, shown = self.machine.axes, self.registers.absolute
        travel: dict[int, float] = {}
        exact: dict[int, float] = {}
        for axis, target in absolute.items():
            delta, exact[axis] = target - shown[axis], target
            if axes[axis].type_a:
                delta, exact[axis] = shortest(delta), modulo(target)
            if abs(delta) > NOTHING:
                travel[axis] = delta
        for axis, delta in incremental.items():
            if abs(delta) > NOTHING:
                travel[axis] = delta
        self._note_commanded(travel)
        if not travel:
            for axis, target in exact.items():
                shown[axis] = target
        return travel, exact

    def _move(self, command: Move) -> Steps[Any] | None:
        return None if self._short_lane.move(command) else self._travelled(command)

    def _travelled(self, command: Move) -> Steps[Any]:
        feed = command.feed
        if feed and feed.per_revolution:
            yield from self._await_turning(feed)
        travel, exact = self._travels(command.absolute, command.incremental)
        path = self._straight(travel, rapid=feed is None, exact=exact, places=command.places)
        yield from self._travel(path, feed)

    def _arc_move(self, command: Arc) -> Steps[Any]:
        if command.feed.per_revolution:
            yield from self._await_turning(command.feed)
        shown = self.registers.absolute
        travel = {k: target - shown[k] for k, target in command.absolute.items()} | dict(command.incremental)
        radius, sweep, waves = arc_displacements(
            travel, command.plane, command.centre, clockwise=command.clockwise
        )
        if radius < NOTHING:
            raise alarm("HT9012", "an arc of radius 0", self._span, valid="I K or R that make a circle")
        self._note_commanded(travel)
        path = self._arc(
            waves,
            radius=radius,
            sweep=sweep,
            wanted=self._fastest(command.feed),
            exact=command.absolute,
            places=command.places,
        )
        yield from self._travel(path, command.feed)

    def _fastest(self, feed: Feed) -> float:
        """The highest speed that a feed may become by its override, or by dry run [1/s]."""
        if feed.per_revolution:
            return math.inf
        return max(feed.value * HIGHEST_OVERRIDE / 100.0, self._dry_speed)

    def _machine_move(self, command: MachineMove) -> Steps[Any]:
        slides: dict[int, float] = {}
        now = self.timeline.positions(self.time)
        for axis, target in command.target.items():
            delta = target - now[axis]
            slides[axis] = shortest(delta) if self.machine.axes[axis].type_a else delta
        self._leave_references(slides)
        yield from self._travel(self._on_slides(slides, command.places), None)

    def _skip(self, command: Skip) -> Steps[None]:
        move = command.move
        if move.feed and move.feed.per_revolution:
            yield from self._await_turning(move.feed)
        travel, exact = self._travels(move.absolute, move.incremental)
        path = self._straight(travel, rapid=move.feed is None, exact=exact, places=move.places)
        if self.circumstances.closed_form and path:
            self._warn(Alarm(number="HT9133", found="G31", span=self._span))
        touch = yield from self._travel(path, move.feed, Manner.SKIP)
        at = list(self.registers.absolute)
        if touch:
            now = self.timeline.positions(self.time)
            back = {k: touch.latch[k] - now[k] for k in range(len(at)) if k not in self.spindles.free}
            for axis, way in self._program(back).items():
                at[axis] += way
        self.skip_positions = tuple(at)

    def _thread(self, command: Thread) -> Steps[Any]:
        """G32: waits for speed and angle of the spindle; a hold acts after the pass."""
        axes = self.machine.axes
        yield from self._ready(self._driven_axis())
        travel, exact = self._travels(command.absolute, command.incremental)
        path = self._straight(travel, rapid=False, exact=exact, places=command.places)
        longest = max((abs(d) for k, d in travel.items() if not axes[k].rotary), default=0.0)
        if path is None or longest == 0.0:
            return
        self._threading = True
        spindle = self._feed_axis()
        angle = command.start_angle if self._helix is None else self._helix
        yield from self._reach_angle(spindle, angle)
        turning = self.timeline.speed(spindle, self.time)
        speed = command.lead * abs(turning) / TURN * path.length / longest
        if speed > path.top_speed * (1.0 + 1e-9):
            found = f"{speed * 60.0:.0f} mm/min for the lead, {path.top_speed * 60.0:.0f} possible"
            raise alarm("HT9020", found, self._span, valid="a lower S, or a smaller lead")
        yield from self._travel(path, Feed(value=speed), Manner.THREAD)
        self._helix = angle + math.copysign(TURN * longest / command.lead, turning)
        self._threading = False
        if self.spindles.override != self.panel.spindle_override:
            self._override_spindles()

    def _reach_angle(self, spindle: int, angle: float) -> Steps[None]:
        """Wait until the spindle stands at an angle [deg] of its turn."""
        turning = self.timeline.speed(spindle, self.time)
        if turning == 0.0:
            raise alarm(
                "HT9007", "a thread with the spindle at standstill", self._span, valid="S, M03 before it"
            )
        now = self.timeline.positions(self.time)[spindle]
        ahead = math.copysign(1.0, turning) * (angle - now) % TURN
        yield from self._wait(self.time + ahead / abs(turning))

    # Zero points, areas, tools

    def _set_coordinates(self, command: SetCoordinates) -> None:
        for axis, value in command.absolute.items():
            self.registers.shift(axis, value - self.registers.absolute[axis])

    def _shift_coordinates(self, command: ShiftCoordinates) -> None:
        for axis, amount in command.shift.items():
            self.registers.shift(axis, -amount)

    def _stroke_check(self, command: StrokeCheck) -> None:
        self.limits = self.limits.after(command)

    def _select_tool(self, command: SelectTool) -> None:
        self.timeline.tools.add(self.time, command.number)

    def _end(self, _: ProgramEnd) -> Steps[None]:
        return self._stop_spindles(list(range(len(self.machine.axes))))

    def _stop(self, command: ProgramStop) -> Steps[None] | None:
        """M00, M01, #3006: waits for cycle start, where somebody is there to press it."""
        if self.time < self.circumstances.operator_from and not self.circumstances.attended:
            number, found = ("HT9114", command.message) if command.message else ("HT9109", "a program stop")
            self._warn(Alarm(number=number, found=found, span=command.span))
            return None
        self.panel.running = False
        self.between_blocks = True
        return self._stand("a program stop")


def _nothing(_: Motion, __: Command) -> None:
    """Nothing moves: whoever takes the commands reports them."""


_LAWS: dict[type, Callable[..., Steps[Any] | None]] = {
    Move: Motion._move,
    Arc: Motion._arc_move,
    Thread: Motion._thread,
    Skip: Motion._skip,
    MachineMove: Motion._machine_move,
    ReferenceReturn: Motion._return,
    ReferenceCheck: Motion._check_reference,
    StrokeCheck: Motion._stroke_check,
    Dwell: lambda motion, command: motion._dwell(command.seconds),
    Couple: Motion._couple_within,
    Uncouple: lambda motion, _: motion._uncouple(),
    SpindleSpeed: Motion._spindle,
    SurfaceSpeed: Motion._surface_speed,
    SetCoordinates: Motion._set_coordinates,
    ShiftCoordinates: Motion._shift_coordinates,
    SelectTool: Motion._select_tool,
    ClearTable: Motion._clear_table,
    SetTablePoint: Motion._set_table_point,
    SwitchTable: Motion._switch_table,
    Coolant: _nothing,
    ProgramStop: Motion._stop,
    ProgramEnd: Motion._end,
}
