"""Moves that meet metal in the wrong way: at rapid, without gear box, with the tool at rest, too fast."""

from collections.abc import Iterator

from controller.laws.gearbox import SyncKind
from twin.advice.advice import Advice
from twin.advice.gear_law import cutting_speed
from twin.advice.kinds import Kind
from twin.advice.moment import Moment
from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob

SLOWEST, FASTEST = 20.0, 280.0
"""[m/min] half of the least and twice the highest usual cutting speed (geometry.md, 6)"""


def judge_way(moment: Moment) -> Iterator[Advice]:
    """Advice on one move that cuts."""
    if not (moment.moves and moment.cut_depth):
        return
    span, rpm = moment.seen.span, moment.seen.master_rpm
    depth = f"{moment.cut_depth:.3f} mm into the stock"
    if moment.rapid:
        yield Advice(kind=Kind.RAPID, found=f"the tool {depth}", span=span, value=moment.cut_depth)
    elif moment.gear is None and isinstance(moment.mounted.tool, DiscWheel):
        return  # a wheel grinds gap after gap, the work stands still
    elif moment.gear is None:
        yield Advice(kind=Kind.OUT_OF_SYNC, found=f"the tool {depth}", span=span, value=moment.cut_depth)
    elif rpm == 0.0:
        yield Advice(kind=Kind.STANDSTILL, found=f"the tool {depth}", span=span, value=moment.cut_depth)
    elif moment.gear.kind is SyncKind.HOBBING and isinstance(moment.mounted.tool, Hob):
        yield from _speed(moment, moment.mounted.tool)


def _speed(moment: Moment, hob: Hob) -> Iterator[Advice]:
    speed = cutting_speed(diameter=hob.outside_diameter_mm, rpm=moment.seen.master_rpm)
    if not SLOWEST <= speed <= FASTEST:
        found = f"{speed:.1f} m/min at the hob's outside"
        yield Advice(kind=Kind.CUTTING_SPEED, found=found, span=moment.seen.span, value=speed)
