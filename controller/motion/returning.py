"""Reference points by program: G28, G30 and M19 go there, G27 asks whether the axes stand there."""

from controller.commands import ReferenceCheck, ReferenceReturn
from controller.motion.manual import ManualMotion
from controller.motion.path import NOTHING, Travel
from controller.motion.reference import Reference
from controller.motion.registers import shortest
from controller.motion.requests import Steps
from controller.tables.alarms import alarm

_ON_REFERENCE = 1e-6
"""[mm | deg] within which an axis stands on its reference point"""


class Returning(ManualMotion):
    """Returns to reference points and checks them."""

    def _return(self, command: ReferenceReturn) -> Steps[None]:
        """From the intermediate point to the reference point (inclined axis, 自动参考点返回)."""
        axes, pair, point = self.machine.axes, self.machine.pair, command.point
        self.references.check_order(command.axes, command.span, point=point)
        if overdue := self.references.overdue(command.span, returning=command.axes):
            self._warn(overdue)
        for axis in command.axes:
            if self.spindles.turning(axis, self.time):
                self._turn(axis, 0.0)
                yield from self._ready(axis)
        now = self.timeline.positions(self.time)
        there = {k: axis.references[point - 1] for k, axis in enumerate(axes)}
        cartesian_there = self._cartesian(there)
        slides: dict[int, float] = {}
        program: dict[int, float] = {}
        for axis in command.axes:
            inclined_pair = pair is not None and axis in (pair.inclined, pair.orthogonal)
            known = self.references.states[axis] is Reference.ESTABLISHED
            alone = pair is not None and axis == pair.inclined and not self._compensated
            if inclined_pair and known and not alone and self.machine.parameters.bit(8209, 0):
                program[axis] = cartesian_there.get(axis, 0.0) - self.registers.cartesian[axis]
            else:
                delta = there[axis] - now[axis]
                slides[axis] = shortest(delta) if axes[axis].type_a else delta
        lost = self._lost()
        total = _kept(_sum(slides, self._slanted(_kept(program))))
        shown = _sum(self._cartesian(_kept(slides)), program)
        if self._mirrored():  # the way to the reference point is not mirrored, the displays are
            shown = self._cartesian(self._reversed(total))
        path = self._straight(shown, total, rapid=True)
        if path:
            path.commanded = command.axes
        yield from self._travel(path, None)
        self.references.establish(command.axes, point=point)
        self._stand_on_reference(command.axes, lost=lost)

    def _check_reference(self, command: ReferenceCheck) -> None:
        """G27: PS0092 for an axis that is not on its reference point; DS0020 by the order rule (注意 7)."""
        axes, pair = self.machine.axes, self.machine.pair
        now = self.timeline.positions(self.time)
        if pair:
            away = now[pair.inclined] - axes[pair.inclined].reference
            home = abs(away) < _ON_REFERENCE
            self.references.check_orthogonal(command.axes, command.span, inclined_home=home)
        for axis in command.axes:
            away = now[axis] - axes[axis].reference
            away = shortest(away) if axes[axis].type_a else away
            if abs(away) > _ON_REFERENCE:
                found = f"{axes[axis].letter} {away * axes[axis].factor:+.3f} off its reference point"
                raise alarm("PS0092", found, command.span)
        self.references.confirm(command.axes)


def _kept(travel: Travel) -> dict[int, float]:
    return {k: d for k, d in travel.items() if abs(d) >= NOTHING}


def _sum(one: Travel, other: Travel) -> dict[int, float]:
    return {k: one.get(k, 0.0) + other.get(k, 0.0) for k in {**one, **other}}
