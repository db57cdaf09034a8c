"""G51.2 against the head and the nominal polygon: P, Q, A and the width across flats."""

import math
from collections.abc import Iterator

from controller.laws.gearbox import SyncKind
from twin.advice.advice import Advice
from twin.advice.kinds import Kind
from twin.advice.moment import Engagement
from twin.advice.polygon_law import Face, face, sides_cut
from twin.advice.scene import Scene
from twin.advice.stock import TOUCHING, Stock
from twin.cutters.polygon_head import PolygonHead
from twin.errors import InputError
from twin.inspection.nominal import PolygonNominal
from twin.inspection.tolerances import across_flats_limits

_JUDGED = 3
"""decimals of a width that is judged (inspection.md, section 2)"""
FLAT_UM = 1.0
"""[µm] a bow below this is no bow"""


def judge_polygon_box(scene: Scene, engagement: Engagement) -> Iterator[Advice]:
    """Advice on P, Q and A, at the block of G51.2."""
    head, gear, nominal = engagement.mounted.tool, engagement.gear, scene.job.nominal
    if gear.kind is not SyncKind.POLYGON or not isinstance(head, PolygonHead):
        return
    if gear.denominator != head.inserts:
        found = f"P{gear.denominator}, {head.inserts} insert(s) mounted"
        valid = f"P{head.inserts}"
        yield Advice(
            kind=Kind.INSERTS, found=found, span=engagement.span, valid=valid, value=float(gear.denominator)
        )
    sides = sides_cut(head.inserts, gear.ratio)
    whole = math.isclose(sides, round(sides), abs_tol=1e-9)
    if isinstance(nominal, PolygonNominal):
        if not whole or round(sides) != nominal.number_of_sides:
            found = (
                f"{head.inserts} insert(s) · {abs(gear.numerator)}/{gear.denominator} = {sides:.4g} sides, "
                f"{nominal.number_of_sides} wanted"
            )
            valid = f"P{head.inserts} Q{nominal.number_of_sides}"
            yield Advice(kind=Kind.SIDES, found=found, span=engagement.span, valid=valid, value=sides)
        if engagement.couple.lead:
            found = f"A{engagement.couple.lead:g} mm a turn"
            yield Advice(kind=Kind.TWISTED, found=found, span=engagement.span, value=engagement.couple.lead)


def judge_polygon_end(scene: Scene, engagement: Engagement | None, stock: Stock) -> Iterator[Advice]:
    """Advice on the faces, of the width that the program leaves."""
    if engagement is None or engagement.gear.kind is not SyncKind.POLYGON:
        return
    head, nominal = engagement.mounted.tool, scene.job.nominal
    deepest = int(stock.radius.argmin())
    width = 2.0 * float(stock.radius[deepest])
    if not isinstance(head, PolygonHead) or stock.blank_radius - width / 2.0 <= TOUCHING:
        return
    if isinstance(nominal, PolygonNominal):
        yield from _width(nominal, stock, deepest, width)
    cut = sides_cut(head.inserts, engagement.gear.ratio)
    sides = round(cut)
    if sides < 3 or not math.isclose(cut, sides, abs_tol=1e-9):
        return
    one = face(across_flats=width, radius=head.tip_radius_mm, ratio=engagement.gear.ratio, sides=sides)
    if one:
        wanted = nominal if isinstance(nominal, PolygonNominal) else None
        yield from _bow(one, engagement, wanted, width, sides)


def _bow(
    one: Face, engagement: Engagement, nominal: PolygonNominal | None, width: float, sides: int
) -> Iterator[Advice]:
    um = 1000.0 * one.bow
    shape = f"{abs(um):.2f} µm, {one.across_corners:.3f} mm across corners"
    if um < -FLAT_UM:
        found = f"faces concave by {shape}; a caliper reads {width - 2.0 * one.bow:.3f} mm"
        # the ratio 2 cuts convex faces whatever the head
        valid = f"P{sides // 2} Q{sides} with {sides // 2} insert(s)" if sides % 2 == 0 else ""
        yield Advice(kind=Kind.CONCAVE, found=found, span=engagement.span, valid=valid, value=um)
    elif nominal and nominal.number_of_sides == sides and (limits := _limits(nominal)):
        # towards its corners the part is thinner by the bow, on both sides
        allowed = limits[1] - limits[0]
        if 2.0 * one.bow > allowed:
            found = f"faces convex by {shape}, twice of it more than the tolerance {allowed:g} mm"
            yield Advice(kind=Kind.CONVEX, found=found, span=engagement.span, value=um)


def _width(nominal: PolygonNominal, stock: Stock, deepest: int, width: float) -> Iterator[Advice]:
    limits = _limits(nominal)
    if limits and not limits[0] <= round(width, _JUDGED) <= limits[1]:
        found = f"X{width:.3f} at the deepest, {limits[0]:g} to {limits[1]:g} mm wanted"
        valid = f"X{nominal.across_flats_mm:g}"
        yield Advice(kind=Kind.ACROSS_FLATS, found=found, span=stock.cause[deepest], valid=valid, value=width)


def _limits(nominal: PolygonNominal) -> tuple[float, float] | None:
    """Smallest and largest width; None where the tolerance is none of the table: the inspection says so."""
    try:
        return across_flats_limits(nominal.across_flats_mm, nominal.tolerance)
    except InputError:
        return None
