"""Stored stroke limits 1, 2 and 3 and the limit switches: where a path would leave what is allowed.

Rulings, section 4; inclined axis, 存储行程极限. Limit 1 forbids the outside of its area, limit 3 the inside,
limit 2 what 1300#0 says, while G22 is in force. On an inclined pair each is measured on the slides, where the
Cartesian area is a parallelogram, or with 8201 Cartesian. Rotary axes have none. A path may leave what is
forbidden where it stands in it, but not go further in. Positions are slide travel [mm], axes by column. A dry
run meets every limit where a run does, at the same place of the same block: both read these closed forms.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from controller.commands import StrokeCheck
from controller.laws.inclined import Frame
from controller.laws.stroke_area import FREE, TOLERANCE, Area, Bounds, Crossing, Limit
from controller.laws.wave import Wave
from controller.span import Span
from controller.tables.alarms import AlarmError, alarm
from controller.tables.machine_data import Axis, MachineData


@dataclass(frozen=True, slots=True, kw_only=True)
class StrokeLimits:
    """All limits that are in force."""

    machine: MachineData
    areas: tuple[Area, ...]
    given: Mapping[int, Bounds] | None = None
    """the area of limit 2 as G22 has set it; None = that of the parameters"""
    plus: frozenset[int] = frozenset()
    """columns whose slide stands on its plus limit switch (*+Lx = 0)"""
    minus: frozenset[int] = frozenset()

    @classmethod
    def of(cls, machine: MachineData) -> "StrokeLimits":
        """As at power-on: limits 1 and 3 on, limit 2 off (G23)."""
        return cls(machine=machine, areas=_areas(machine, None, check_2=False))

    def after(self, command: StrokeCheck) -> "StrokeLimits":
        """G22 and G23. A new area holds from then on, for axes with 1310#0 = 1."""
        given = self.given if command.area is None else {**(self.given or {}), **command.area}
        return replace(self, given=given, areas=_areas(self.machine, given, check_2=command.on))

    def on_switches(self, plus: frozenset[int], minus: frozenset[int]) -> "StrokeLimits":
        """With these columns on their limit switches."""
        return replace(self, plus=plus, minus=minus)

    def straight(self, start: Sequence[float], travel: Sequence[float]) -> Crossing | None:
        """The first limit on a straight path of the slides from `start` (axes,) by `travel` (axes,)."""
        first = self._switched(travel) if self.plus or self.minus else None
        for area in self.areas:
            if area.frame is Frame.SLIDES:
                found = area.straight(start, travel)
            else:
                found = area.straight(self._cartesian(start), self._cartesian(travel))
            if found:
                first = found if first is None else _earlier(first, found)
        return first

    def arc(self, start: Sequence[float], waves: Mapping[int, Wave], sweep: float) -> Crossing | None:
        """The first limit on an arc of the slides: their coordinates by column over the angles 0 to `sweep`
        [rad]; the others stand at `start` (axes,). The fraction is that of the angle."""
        slides = [waves.get(k, Wave(position)) for k, position in enumerate(start)]
        first = self._switched_on_arc(slides, sweep)
        for area in self.areas:
            found = area.arc(slides if area.frame is Frame.SLIDES else self._cartesian_waves(slides), sweep)
            if found:
                first = found if first is None else _earlier(first, found)
        return first

    def before_motion(self, start: Sequence[float], travel: Sequence[float]) -> Crossing | None:
        """The check of the end point before the motion begins (1301#7), straight or arc.

        With an inclined pair it acts only where the limit is set Cartesian (移动前行程检测).
        """
        if not self.machine.parameters.bit(1301, 7):
            return None
        for area in self.areas:
            if self.machine.pair is None:
                found = area.straight(start, travel)
                end = [a + b for a, b in zip(start, travel, strict=True)]
            elif area.frame is Frame.CARTESIAN:
                begin, way = self._cartesian(start), self._cartesian(travel)
                found = area.straight(begin, way)
                end = [a + b for a, b in zip(begin, way, strict=True)]
            else:
                continue
            if found and area.forbids(end):
                return replace(found, fraction=0.0, before=True, foreseen=True)
        return None

    def refuse(
        self, crossing: Crossing, span: Span | None, *, standing: Sequence[float] | None = None
    ) -> AlarmError:
        """The alarm of a limit: the slide that stops, the limit it hits, and where it stands now."""
        axis = self.machine.axes[crossing.axis]
        found = f"{crossing.frame.value} {axis.letter} "
        if crossing.limit is Limit.SWITCH:
            found += f"on its limit switch, {_switch(axis, upper=crossing.upper)} = 0"
            back = "minus" if crossing.upper else "plus"
            return alarm(crossing.number, found, span, valid=f"a way in the {back} direction")
        found += f"{'beyond' if crossing.foreseen else 'at'} its limit {crossing.bound * axis.factor:.3f} mm"
        if standing is not None:
            there = standing if crossing.frame is Frame.SLIDES else self._cartesian(standing)
            found += f", standing at {there[crossing.axis] * axis.factor:.3f} mm"
        return alarm(crossing.number, found, span, valid=self._valid(crossing))

    def _valid(self, crossing: Crossing) -> str:
        area = next(area for area in self.areas if area.limit is crossing.limit)
        side = "outside" if area.forbidden else "inside"
        if crossing.limit is Limit.STROKE_2 and self.given and crossing.axis in self.given:
            return f"a path {side} the area of G22, or G23"
        letter = self.machine.parameters.letters[crossing.axis]
        plus, minus = crossing.limit.value[2:]
        if area.forbidden:
            return f"a path outside parameters {minus}.{letter} to {plus}.{letter}"
        return f"a path inside parameter {plus if crossing.upper else minus}.{letter}"

    def _cartesian(self, slides: Sequence[float]) -> Sequence[float]:
        pair = self.machine.pair
        if pair is None:
            return slides
        there = list(slides)
        there[pair.orthogonal], there[pair.inclined] = pair.to_cartesian(
            slides[pair.orthogonal], slides[pair.inclined]
        )
        return there

    def _cartesian_waves(self, slides: Sequence[Wave]) -> Sequence[Wave]:
        pair = self.machine.pair
        if pair is None:
            return slides
        there, along = list(slides), slides[pair.inclined]
        sine, cosine = pair.to_cartesian(0.0, 1.0)
        there[pair.orthogonal] = slides[pair.orthogonal].plus(along, sine)
        there[pair.inclined] = Wave(0.0).plus(along, cosine)
        return there

    def _switched(self, travel: Sequence[float]) -> Crossing | None:
        for axis, way in enumerate(travel):
            if way and axis in (self.plus if way > 0.0 else self.minus):
                return self._at_switch(axis, 0.0, upper=way > 0.0)
        return None

    def _switched_on_arc(self, waves: Sequence[Wave], sweep: float) -> Crossing | None:
        first: Crossing | None = None
        for columns, upper in ((self.plus, True), (self.minus, False)):
            for axis in columns:
                ends = [0.0, *waves[axis].turning(sweep), sweep]
                for low, high in pairwise(ends):
                    gain = waves[axis].at(high) - waves[axis].at(low)
                    if (gain if upper else -gain) > TOLERANCE:
                        if first is None or low / sweep < first.fraction:
                            first = self._at_switch(axis, low / sweep, upper=upper)
                        break
        return first

    def _at_switch(self, axis: int, fraction: float, *, upper: bool) -> Crossing:
        return Crossing(fraction=fraction, axis=axis, upper=upper, limit=Limit.SWITCH, before=True)


def _earlier(one: Crossing, other: Crossing) -> Crossing:
    """The earlier of two limits, with the later one as its wall where that is not to be crossed at all."""
    first, later = (one, other) if one.fraction <= other.fraction else (other, one)
    wall = min(first.wall, later.fraction if later.before else later.wall)
    return replace(first, wall=wall)


def _switch(axis: Axis, *, upper: bool) -> str:
    return f"*{'+' if upper else '-'}L{axis.letter}"


def _areas(machine: MachineData, given: Mapping[int, Bounds] | None, *, check_2: bool) -> tuple[Area, ...]:
    bit, axes = machine.parameters.bit, machine.axes
    before = bit(1300, 7)
    allowed: list[Bounds | None] = [(axis.lower, axis.upper) for axis in axes]
    areas = [_area(machine, Limit.STROKE_1, allowed, forbidden=False, before=before)]
    if check_2:
        bounds = [(given or {}).get(k, axis.area_2) if axis.area_2 else None for k, axis in enumerate(axes)]
        areas.append(_area(machine, Limit.STROKE_2, bounds, forbidden=not bit(1300, 0), before=False))
    third = [axis.area_3 for axis in axes]
    areas.append(_area(machine, Limit.STROKE_3, third, forbidden=True, before=before))
    return tuple(area for area in areas if any(map(math.isfinite, (*area.lower, *area.upper))))


_CARTESIAN_BIT = {Limit.STROKE_1: 0, Limit.STROKE_2: 1, Limit.STROKE_3: 2}
"""of parameter 8201: AOT, AO2, AO3"""


def _area(
    machine: MachineData, limit: Limit, bounds: Sequence[Bounds | None], *, forbidden: bool, before: bool
) -> Area:
    """Equal bounds are no area: the axis has no part in it (Fanuc 1322 to 1325)."""
    kept = [pair if pair and pair[0] < pair[1] else FREE for pair in bounds]
    cartesian = machine.pair is not None and machine.parameters.bit(8201, _CARTESIAN_BIT[limit])
    return Area(
        limit=limit,
        frame=Frame.CARTESIAN if cartesian else Frame.SLIDES,
        lower=tuple(low for low, _ in kept),
        upper=tuple(high for _, high in kept),
        forbidden=forbidden,
        before=before,
    )
