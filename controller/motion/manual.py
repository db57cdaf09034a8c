"""What the operator does: switches, overrides, holds, motion by hand, RESET and the emergency stop.

Rulings, section 5, and what sections 2 to 4 say of manual mode, feed hold, machine lock, overrides, RESET and
E-stop. A motion by hand is made while the program stands; a gear box stays in force then, and the axial axis
of a helical gear turns the slave also by hand (hobbing, 开始同步 and 斜齿轮加工).
"""

from collections.abc import Callable

from controller.commands import Feed
from controller.laws.gearbox import SyncKind
from controller.laws.inclined import manual_return
from controller.motion.path import NOTHING, AnyPath, Travel
from controller.motion.reference import Reference
from controller.motion.registers import shortest
from controller.motion.requests import Steps
from controller.motion.travel import Manner
from controller.motion.turning import Turning
from controller.operator.actions import OperatorAction, OperatorEvent
from controller.operator.panel import Mode
from controller.tables.alarms import Alarm, alarm
from controller.tables.signals import AxisInput

_FORBIDDEN = {SyncKind.HOBBING: "PS1595", SyncKind.POLYGON: "PS0220"}
_PLANNED_ANEW = ("NOZAGC", "MLK", "MI", "DTCH")
"""signals that change what a path does to the slides"""


class ManualMotion(Turning):
    """Lets the operator act."""

    run_mdi: Callable[[str], Steps[None]]
    """runs a block from the keyboard; whoever reads blocks sets it"""

    def _act(self, event: OperatorEvent) -> Steps[None]:
        panel = self.panel
        match event.action:
            case OperatorAction.CYCLE_START:
                self._start(event)
            case OperatorAction.FEED_HOLD:
                panel.running = False
            case OperatorAction.MANUAL:
                panel.mode, panel.running = Mode.MANUAL, False
            case OperatorAction.AUTO:
                panel.mode = Mode.AUTO
            case OperatorAction.RESET:
                self._reset, panel.emergency, panel.running = True, False, False
                self._by_hand.clear()
            case OperatorAction.EMERGENCY_STOP:
                yield from self._emergency_stop()
            case OperatorAction.SPINDLE_OVERRIDE:
                self._set_spindle_override(event)
            case OperatorAction.MACHINE_LOCK if event.axis:
                self._signal(event, f"MLK{event.axis}")
            case OperatorAction.MACHINE_LOCK:
                panel.locked = event.on
                self._version += 1
            case OperatorAction.SIGNAL:
                self._signal(event, event.text)
            case OperatorAction.JOG | OperatorAction.REFERENCE_RETURN | OperatorAction.MDI:
                self._ask_by_hand(event)
            case _:
                panel.turn(event)

    def _ask_by_hand(self, event: OperatorEvent) -> None:
        """Motion by hand waits until the axes stand; it is refused while the program runs."""
        if self.panel.running:
            self._no_effect(event, "while the program runs", "feed hold or manual before it")
        elif self.panel.emergency:
            self._no_effect(event, "after an emergency stop", "reset before it")
        else:
            self._by_hand.append(event)

    def _no_effect(self, event: OperatorEvent, why: str, valid: str) -> None:
        self._warn(Alarm(number="HT9131", found=f"{event} {why}", span=self._span, valid=valid))

    def _start(self, event: OperatorEvent) -> None:
        if self.panel.emergency:
            self._no_effect(event, "after an emergency stop", "reset before it")
        elif self.panel.mode is Mode.MANUAL:
            self._no_effect(event, "in manual mode", "auto before it")
        else:
            self.panel.running = True

    def _signal(self, event: OperatorEvent, name: str) -> None:
        """A signal of the machine. Master and slave of a gear box keep their servos and stay attached."""
        level, gear = event.on, self.coupling.gear
        before, held = self.panel.inputs, {gear.master, gear.slave} if gear else set[int]()
        self.panel.set_signal(name, level)
        for kind in (AxisInput.DETACH, AxisInput.SERVO_OFF):
            gone = self.panel.inputs.columns(kind) - before.columns(kind)
            if gear and gone & held:
                self.panel.inputs = before
                self._no_effect(event, f"in {gear.kind.value}", "the end of sync before it: G80 or G50.2")
                return
        self.take_signals()
        if name.startswith(_PLANNED_ANEW):
            self._version += 1

    def take_signals(self) -> None:
        """What the input signals change beside the paths: limit switches, detached axes."""
        inputs = self.panel.inputs
        plus, minus = inputs.columns(AxisInput.PLUS_SWITCH), inputs.columns(AxisInput.MINUS_SWITCH)
        if (plus, minus) != (self.limits.plus, self.limits.minus):
            self.limits = self.limits.on_switches(plus, minus)
            self._version += 1
        detached = inputs.columns(AxisInput.DETACH)
        for axis in range(len(self.machine.axes)):
            if axis in detached:
                self.references.detach(axis)
            else:
                self.references.attach(axis)

    def _set_spindle_override(self, event: OperatorEvent) -> None:
        """The ratio of a gear box is held: only the master is overridden (polygon, 注意事项, the last)."""
        override, path = event.value / 100.0, self._underway
        cutting = path is not None and not path.rapid and self.panel.running
        if cutting and self.coupling.gear and override != self.panel.spindle_override:
            self._warn(Alarm(number="HT9132", found=f"{event} while cutting", span=self._span))
        self.panel.spindle_override = override
        if not self._threading:
            self._override_spindles()

    # By hand

    def _manual(self, event: OperatorEvent) -> Steps[None]:
        if event.action is OperatorAction.MDI:
            if self.between_blocks:
                yield from self.run_mdi(event.text)
            else:
                self._no_effect(event, "within a block", "a stop between two blocks, as by single block")
            return
        axis = self.machine.letters.index(event.axis)
        gear = self.coupling.gear
        returns = event.action is OperatorAction.REFERENCE_RETURN
        if gear and (axis == gear.master or (returns and axis == gear.slave)):
            role = "master" if axis == gear.master else "slave"
            found = f"{event}, the {role} of {gear.kind.value},"
            valid = "an axis out of the gear box" + ("" if returns else ", or its slave")
            raise alarm(_FORBIDDEN[gear.kind], found, self._span, valid=valid)
        if mirrored := self._mirrored() & self._slanted({axis: 1.0}).keys():
            names = ", ".join(f"MI{self.machine.letters[k]} = 1" for k in sorted(mirrored))
            self._warn(Alarm(number="HT9123", found=f"{event} with {names}", span=self._span))
        if self.references.states[axis] is Reference.DETACHED:
            self._no_effect(event, "of a detached axis", f"signal DTCH{event.axis}=0 before it")
        elif self.machine.axes[axis].analogue:
            self._no_effect(event, "of an analogue spindle", f"parameter 9005#0.{event.axis} = 0")
        elif self.timeline.tracks[axis].speed(self.time) != 0.0:
            self._no_effect(event, "while the axis turns as a spindle", "the spindle at standstill")
        elif event.action is OperatorAction.JOG:
            yield from self._jog(axis, event)
        else:
            yield from self._return_by_hand(axis)

    def _jog(self, axis: int, event: OperatorEvent) -> Steps[None]:
        """Cartesian, with both slides of an inclined pair (±Jx): independently only with NOZAGC = 1."""
        pair = self.machine.pair
        if pair and axis in (pair.inclined, pair.orthogonal) and self._compensated:
            self._warn(Alarm(number="HT9136", found=str(event), span=self._span))
        letter = self.machine.parameters.letters[axis]
        speed = event.feed or self.machine.parameters.number(1423, letter)
        travel = {axis: event.value / self.machine.axes[axis].factor}
        self._note_commanded(travel)
        path = self._straight(travel, rapid=False)
        if self._mirrored():  # the direction of a motion by hand is not reversed
            slides = self._slanted(travel)
            path = self._straight(self._program(slides), slides, rapid=False)
        yield from self._move_by_hand(path, Feed(value=speed / 60.0))

    def _move_by_hand(self, path: AnyPath | None, feed: Feed | None) -> Steps[None]:
        """A block that is held goes on in parallel afterwards."""
        self._version += 1
        if path:
            path.version = self._version
        yield from self._travel(path, feed, Manner.BY_HAND)

    def _return_by_hand(self, axis: int) -> Steps[None]:
        """Manual reference return (inclined axis, 手动参考点返回操作): on the slide, to parameter 1240."""
        pair, machine = self.machine.pair, self.machine
        now = self.timeline.positions(self.time)
        if pair:
            away = now[pair.inclined] - machine.axes[pair.inclined].reference
            self.references.check_orthogonal((axis,), self._span, inclined_home=abs(away) < NOTHING)
        if overdue := self.references.overdue(self._span, returning=(axis,)):
            self._warn(overdue)
        way = machine.axes[axis].reference - now[axis]
        way = shortest(way) if machine.axes[axis].type_a else way
        azr = machine.parameters.bit(8200, 2)
        slides = manual_return(pair, axis, way, azr=azr)
        path = self._on_slides(slides)
        if path:
            path.commanded = (axis,)  # AZR = 0 induces the motion of the orthogonal axis
        yield from self._move_by_hand(path, None)
        lost = self._lost()
        self.references.returned_by_hand(axis, moved_both=not azr)
        self._stand_on_reference((axis,), lost=lost)

    def _lost(self) -> bool:
        """Whether the inclined pair does not know where it stands."""
        pair = self.machine.pair
        return pair is not None and self.references.states[pair.orthogonal] is not Reference.ESTABLISHED

    def _stand_on_reference(self, returned: tuple[int, ...], *, lost: bool) -> None:
        """The axes stand on their reference points; the displays of what was lost become true again."""
        pair = self.machine.pair
        now = self.timeline.positions(self.time)
        for axis in returned:
            if axis in self.spindles.free:
                self.spindles.free.discard(axis)
                self.registers.orient(axis, now[axis])
        if pair and lost and not self._lost():
            true = self._cartesian({k: now[k] for k in (pair.inclined, pair.orthogonal)})
            for axis in (pair.inclined, pair.orthogonal):
                error = true.get(axis, 0.0) - self.registers.cartesian[axis]
                self.registers.cartesian[axis] += error
                self.registers.absolute[axis] += error
            self.note_extents()

    def _leave_references(self, travel: Travel) -> None:
        """These axes move; a return of the orthogonal axis that was due has not followed at once (注意 3)."""
        if self.references.reached:
            self.references.leave(travel)
        if travel and (overdue := self.references.overdue(self._span)):
            self._warn(overdue)

    def _note_commanded(self, travel: Travel) -> None:
        """These axes are commanded: they leave their reference points, and an inclined axis that moves
        without its compensation takes the references with it (注意 5)."""
        if self.references.detached:  # the short lane of reading has not asked
            for axis in travel:
                self.references.require(axis, self.machine.axes[axis].letter, self._span)
        self._leave_references(travel)
        pair = self.machine.pair
        if pair and travel.get(pair.inclined) and not self._compensated and self.references.lose():
            found = f"a move of {self.machine.axes[pair.inclined].letter} with NOZAGC = 1"
            self._warn(Alarm(number="HT9108", found=found, span=self._span))
