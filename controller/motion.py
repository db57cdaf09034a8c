"""Commands become motion: every command starts where the last one ended, spindles run beside the axes."""

from collections.abc import Callable

import numpy as np

from controller.alarms import Alarm, AlarmClass
from controller.commands import (
    Command,
    Coolant,
    Couple,
    Dwell,
    MachineMove,
    Move,
    ProgramEnd,
    ProgramStop,
    ReferenceReturn,
    SelectTool,
    SetCoordinates,
    ShiftCoordinates,
    SpindleSpeed,
    SurfaceSpeed,
    Uncouple,
)
from controller.coupling import Sensor
from controller.gearbox import GearBox
from controller.inclined import cartesian_from_slides, slides_from_cartesian
from controller.machine_data import MachineData
from controller.path import NOTHING
from controller.reference import Reference, References
from controller.registers import modulo, shortest
from controller.span import Span
from controller.spindles import DEG_PER_S
from controller.straight import StraightMotion


class Motion(StraightMotion):
    """Plans the motion of the whole machine, command by command."""

    def __init__(
        self,
        machine: MachineData,
        *,
        tick_s: float,
        compensated: bool,
        warn: Callable[[Alarm], None],
        closed_form: bool = False,
    ) -> None:
        super().__init__(machine, tick_s=tick_s, warn=warn, closed_form=closed_form)
        axes = len(machine.axes)
        self.references = References.at_power_on(axes, machine.pair)
        self._compensated = compensated
        self._to_slides = slides_from_cartesian(axes, machine.pair, compensated=compensated)
        self._to_cartesian = cartesian_from_slides(axes, machine.pair)

    def execute(self, command: Command, span: Span) -> None:
        """Plan one command of the block at `span`. Raises AlarmError where the machine cannot do it."""
        self._span = span
        match command:
            case Move() | MachineMove():
                self._straight(command)
            case ReferenceReturn():
                self._return(command)
            case Dwell():
                self.time += command.seconds
            case Couple():
                self._couple(command)
            case Uncouple():
                self._uncouple()
            case SpindleSpeed():
                self._spindle(command)
            case SurfaceSpeed():
                self._surface_speed(command)
            case ProgramEnd():
                self._stop_spindles()
            case SelectTool():
                self.timeline.tools.add(self.time, command.number)
            case SetCoordinates() | ShiftCoordinates():
                self._set_displays(command)
            case Coolant() | ProgramStop():
                pass  # nothing moves: whoever takes the commands reports them

    def cancel_sync(self, kind: AlarmClass) -> None:
        """What an alarm of this class does to the gear box (hobbing, 注意事项)."""
        if kind not in (AlarmClass.PROGRAM, AlarmClass.USER):
            self._uncouple()

    def _straight(self, command: Move | MachineMove) -> None:
        if isinstance(command, Move):
            self._move(command)
        else:
            self._machine_move(command)

    def _set_displays(self, command: SetCoordinates | ShiftCoordinates) -> None:
        if isinstance(command, SetCoordinates):
            for axis, value in command.absolute.items():
                self.registers.shift(axis, value - float(self.registers.absolute[axis]))
        else:
            for axis, amount in command.shift.items():
                self.registers.shift(axis, -amount)

    def _move(self, command: Move) -> None:
        axes, pair = self.machine.axes, self.machine.pair
        travel = np.zeros(len(axes))
        exact: dict[int, float] = {}
        for axis, target in command.absolute.items():
            delta = target - float(self.registers.absolute[axis])
            travel[axis] = shortest(delta) if axes[axis].type_a else delta
            exact[axis] = modulo(target) if axes[axis].type_a else target
        for axis, delta in command.incremental.items():
            travel[axis] = delta
        travel[np.abs(travel) < NOTHING] = 0.0
        if pair and not self._compensated and travel[pair.inclined] != 0.0 and self.references.lose():
            found = f"a move of {axes[pair.inclined].letter} with NOZAGC = 1"
            self._warn(Alarm(number="HT9108", found=found, span=self._span))
        self._travel(self._to_slides @ travel, travel, command.feed, command.places, exact)

    def _machine_move(self, command: MachineMove) -> None:
        slides = np.zeros(len(self.machine.axes))
        now = self.timeline.positions(self.time)
        for axis, target in command.target.items():
            delta = target - float(now[axis])
            slides[axis] = shortest(delta) if self.machine.axes[axis].type_a else delta
        slides[np.abs(slides) < NOTHING] = 0.0
        self._travel(slides, self._to_cartesian @ slides, None, command.places, {})

    # Reference points

    def _return(self, command: ReferenceReturn) -> None:
        """From the intermediate point to the reference point (inclined axis, 自动参考点返回)."""
        axes, pair = self.machine.axes, self.machine.pair
        self.references.check_order(command.axes, command.span)
        for axis in command.axes:
            if self.spindles.turning(axis, self.time):
                self._turn(axis, 0.0)
                self.time = self.spindles.ready(axis, self.time)
        now = self.timeline.positions(self.time)
        reference = np.array([axis.reference for axis in axes])
        slides = np.zeros(len(axes))
        cartesian = np.zeros(len(axes))
        for axis in command.axes:
            inclined_pair = pair is not None and axis in (pair.inclined, pair.orthogonal)
            known = self.references.states[axis] is Reference.ESTABLISHED
            if inclined_pair and known and self.machine.parameters.bit(8209, 0):
                cartesian[axis] = float(
                    (self._to_cartesian @ reference)[axis] - self.registers.cartesian[axis]
                )
            else:
                delta = float(reference[axis] - now[axis])
                slides[axis] = shortest(delta) if axes[axis].type_a else delta
        for way in (slides, cartesian):
            way[np.abs(way) < NOTHING] = 0.0
        total = slides + self._to_slides @ cartesian
        self._travel(total, self._to_cartesian @ slides + cartesian, None, {}, {})
        self._establish(command.axes)

    def _establish(self, returned: tuple[int, ...]) -> None:
        """The axes stand on their reference points; the displays of what was lost become true again."""
        pair = self.machine.pair
        was_lost = pair is not None and self.references.states[pair.orthogonal] is not Reference.ESTABLISHED
        self.references.establish(returned)
        now = self.timeline.positions(self.time)
        for axis in returned:
            if axis in self.spindles.free:
                self.spindles.free.discard(axis)
                self.registers.orient(axis, float(now[axis]))
        if pair and was_lost and self.references.states[pair.orthogonal] is Reference.ESTABLISHED:
            true = self._to_cartesian @ now
            for axis in (pair.inclined, pair.orthogonal):
                error = float(true[axis] - self.registers.cartesian[axis])
                self.registers.cartesian[axis] += error
                self.registers.absolute[axis] += error

    # Spindles and gear box

    @property
    def _following(self) -> bool:
        gear = self.coupling.gear
        return gear is not None and gear.follow

    def _turn(self, axis: int, rpm: float) -> None:
        gear = self.coupling.gear
        coupled = gear is not None and axis == gear.master
        self.spindles.turn(axis, rpm, self.time, self.coupling.ramp() if coupled else None)

    def _spindle(self, command: SpindleSpeed) -> None:
        gear = self.coupling.gear
        if gear is None or command.axis != gear.master:
            self.spindles.free.add(command.axis)
            self.spindles.surface = None
        self._turn(command.axis, command.rpm)
        if command.wait:
            self.time = self.spindles.ready(command.axis, self.time)
        self.note_extents()

    def _surface_speed(self, command: SurfaceSpeed) -> None:
        self.spindles.surface = command
        self.spindles.free.add(command.axis)
        self.spindles.adapt(float(self.registers.absolute[command.radial]), self.time)

    def _stop_spindles(self) -> None:
        self.spindles.surface = None
        gear = self.coupling.gear
        turning = [k for k in range(len(self.machine.axes)) if self.spindles.driven(k, self.time)]
        for axis in turning:
            self._turn(axis, 0.0)
        for axis in turning:
            self.time = self.spindles.ready(axis, self.time)
        if turning and gear is None:
            self.spindles.free.update(turning)
        self.note_extents()

    def _couple(self, command: Couple) -> None:
        if self._following:
            self._to_tick()
            self._at_encoders(lambda sensor: self._recouple(command, sensor))
        else:
            self._recouple(command, None)

    def _recouple(self, command: Couple, sensor: Sensor | None) -> None:
        """Close an older engagement, turn the master by R, engage."""
        before = self.coupling.close(self.time, sensor)
        if command.phase:
            self.time = self.coupling.advance_master(command.gear, command.phase, self.time)
        if command.gear.follow:
            self._to_tick()
            self._at_encoders(lambda encoders: self._engage(command.gear, before, encoders))
        else:
            self._engage(command.gear, before, None)

    def _engage(self, gear: GearBox, before: float, sensor: Sensor | None) -> None:
        jump = (self.coupling.engage(gear, self.time, sensor) - before) / DEG_PER_S
        if abs(jump) > NOTHING:
            found = f"a jump of {jump:+.3f} rpm"
            self._warn(Alarm(number="HT9100", found=found, span=self._span))

    def _uncouple(self) -> None:
        if self._following:
            self._to_tick()
            self._at_encoders(self._release)
        else:
            self._release(None)

    def _release(self, sensor: Sensor | None) -> None:
        self.time = self.coupling.release(self.time, sensor)
        self.note_extents()
