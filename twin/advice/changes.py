"""What happens to the gear box while the tool turns or stands in the metal."""

from collections.abc import Iterator

from controller.commands import Couple, SpindleSpeed, Uncouple
from controller.laws.gearbox import GearBox
from twin.advice.advice import Advice
from twin.advice.kinds import Kind
from twin.advice.moment import Moment


def judge_change(moment: Moment) -> Iterator[Advice]:
    """Advice on a gear box that changes, reverses or lets go at the wrong time (hobbing, 注意事项)."""
    gear, rpm, command, span = moment.gear, moment.seen.master_rpm, moment.seen.command, moment.seen.span
    if gear is None or rpm == 0.0:
        return
    inside = f"{moment.blank_depth:.3f} mm inside the blank"
    match command:
        case Couple(gear=after):
            changed = _changed(gear, after)
            # the compensation may change in the air: the phase goes on from where it is
            if changed and (changed == _RATIO or moment.blank_depth):
                found = f"another {changed} with the master at {rpm:g} rpm"
                found += f", {inside}" if moment.blank_depth else ""
                yield Advice(kind=Kind.CHANGED_TURNING, found=found, span=span, value=rpm)
        case SpindleSpeed(axis=axis, rpm=after) if axis == gear.master and rpm * after < 0.0:
            if moment.blank_depth:
                found = f"S from {rpm:g} to {after:g} rpm, {inside}"
                yield Advice(kind=Kind.REVERSED, found=found, span=span, value=after)
        case Uncouple() if moment.blank_depth:
            found = f"the gear box released at {rpm:g} rpm, {inside}"
            yield Advice(kind=Kind.RELEASED, found=found, span=span, value=rpm)
        case _:
            pass


_RATIO, _COMPENSATION = "ratio", "compensation"


def _changed(before: GearBox, after: GearBox) -> str:
    """What the new gear box changes; empty where it is the same."""
    if before.numerator * after.denominator != after.numerator * before.denominator:
        return _RATIO
    return _COMPENSATION if before.axial_rate != after.axial_rate else ""
