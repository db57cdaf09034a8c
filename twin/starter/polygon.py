"""A polygon to be turned with a head of inserts."""

from dataclasses import dataclass

from twin.advice.polygon_law import Face, face
from twin.cutters.polygon_head import PolygonHead
from twin.errors import InputError
from twin.inspection.nominal import TOLERANCE
from twin.inspection.tolerances import across_flats_limits
from twin.starter.plan import Draft, highest_speeds, program_text, toml_number, up, word

BESIDE = 2.0
"""[mm] beside the blank and above it"""
ROOM = 0.1
"""[mm] of blank outside the corners"""
RADII = (40.0, 50.0, 63.0, 80.0, 100.0, 125.0, 160.0, 200.0)
"""[mm] of tips on usual heads; larger ones cut flatter faces"""
WIDEST = 120.0
"""[mm] across flats: what the table of h13 holds"""
SHARE = 0.5
"""Of the tolerance of the width across flats, left to both faces' bow."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonOrder:
    """What is wanted; None = chosen."""

    sides: int
    across_flats: float
    """[mm]"""
    length: float = 10.0
    """[mm]"""
    inserts: int | None = None
    """None = half the sides, rounded up"""
    tip_radius: float | None = None
    """[mm] of the head; None = the smallest usual one whose faces are flat enough"""
    speed: int = 300
    """S of the work [rpm]"""
    feed: float = 0.5
    """[mm per turn of the work]"""


def draft_polygon(order: PolygonOrder) -> Draft:
    """Job and program. Raises InputError for what the head cannot turn."""
    _check(order)
    inserts = _inserts(order)
    ratio = order.sides / inserts
    radius, faces = _flat_enough(order, ratio)
    head = PolygonHead(inserts=inserts, tip_radius_mm=radius)
    work_rpm, tool_rpm = highest_speeds()
    speed = min(order.speed, int(tool_rpm / ratio), int(work_rpm))
    blank = up(faces.across_corners + ROOM, 0.1)
    above = up(blank + 2.0 * BESIDE, 1.0)
    half = head.edge_width_mm / 2.0
    rows = (
        ("G28 U0 W0", "X and Z to the reference point"),
        ("G28 H0 V0", "work and tool spindle to the reference point"),
        (f"G54 G00 {word('X', above)} {word('Z', half + BESIDE)}", "beside the blank"),
        (f"G51.2 P{inserts} Q{order.sides}", f"tool turns {ratio:.4g} times as fast as the work"),
        (f"S{speed}", "speed of the work"),
        (f"G99 G01 {word('X', order.across_flats)} F1.", "X = width across flats"),
        (f"G01 {word('Z', -order.length - half - BESIDE)} {word('F', order.feed)}", "the whole length"),
        (f"G01 {word('X', above)} F1.", "retract"),
        ("S0", "stop"),
        ("G50.2", "gear box off"),
        ("M30", ""),
    )
    return Draft(
        job=_job(order, head, blank) + _expect(order, faces),
        program=program_text(f"{order.sides} SIDES {order.across_flats:g} A/F", rows),
        summary=f"{order.sides} sides, {order.across_flats:g} mm across flats: "
        f"P{inserts} Q{order.sides} S{speed}",
    )


def _check(order: PolygonOrder) -> None:
    limits = (
        ("--sides", order.sides, 3, 100),
        ("--across-flats", order.across_flats, 2.0, WIDEST),
        ("--length", order.length, 0.5, 300.0),
        ("--tip-radius", order.tip_radius if order.tip_radius is not None else 40.0, 10.0, 200.0),
        ("--inserts", order.inserts if order.inserts is not None else 1, 1, 20),
        ("--speed", order.speed, 1, highest_speeds()[0]),
        ("--feed", order.feed, 0.01, 10.0),
    )
    for name, value, low, high in limits:
        if not low <= value <= high:
            raise InputError(f"{name} {value:g}", remedy=f"valid: {low:g} to {high:g}")


def _inserts(order: PolygonOrder) -> int:
    """Half the sides, rounded up: at Q / P = 2 or just below faces are convex whatever the head."""
    return order.inserts if order.inserts is not None else (order.sides + 1) // 2


def _flat_enough(order: PolygonOrder, ratio: float) -> tuple[float, Face]:
    """Tip radius of the head and the faces that it leaves.

    The smallest usual one whose faces are convex and hold their share of the tolerance; as ordered, where
    inserts or radius are. Raises InputError where there is none, or where the faces meet in no corner.
    """
    if order.tip_radius is not None or order.inserts is not None:
        radius = order.tip_radius if order.tip_radius is not None else RADII[0]
        found = _faces(order.sides, order.across_flats, radius, ratio)
        if found is None:
            raise InputError(
                f"a head of {radius:g} mm turns no corners between {order.sides} such faces",
                remedy="another --tip-radius or --inserts",
            )
        return radius, found
    for radius in RADII:
        found = _faces(order.sides, order.across_flats, radius, ratio)
        if found is not None and _holds(found, order.across_flats):
            return radius, found
    widest = _widest(order.sides, ratio)
    ways = f"--across-flats up to {widest:g}, " if widest else ""
    raise InputError(
        f"no usual head turns {order.sides} faces {order.across_flats:g} mm across flats within {TOLERANCE}",
        remedy=f"valid: {ways}more --sides, or all the same with --tip-radius 10 to 200",
    )


def _faces(sides: int, across_flats: float, radius: float, ratio: float) -> Face | None:
    return face(across_flats=across_flats, radius=radius, ratio=ratio, sides=sides)


def _holds(faces: Face, across_flats: float) -> bool:
    """Towards the corners the part is thinner by the bow, on both sides."""
    low, high = across_flats_limits(across_flats, TOLERANCE)
    return not faces.concave and 2.0 * faces.bow <= SHARE * (high - low)


def _widest(sides: int, ratio: float) -> int:
    """Largest whole width across flats [mm] that the largest head turns flat enough; 0 = none."""
    widths = range(int(WIDEST), 1, -1)
    found = ((width, _faces(sides, float(width), RADII[-1], ratio)) for width in widths)
    return next((width for width, one in found if one is not None and _holds(one, float(width))), 0)


def _expect(order: PolygonOrder, faces: Face) -> str:
    """Theory's own figures; in tolerance where the bow leaves the width across flats in it everywhere."""
    bow = 1000.0 * faces.bow
    low, high = across_flats_limits(order.across_flats, TOLERANCE)
    verdict = "" if faces.concave or 2.0 * faces.bow > high - low else 'verdict = "in"\n'
    return f"""
[expect]   # theory: faces {"concave" if faces.concave else "convex"} by {abs(bow):.2f} µm
number_of_sides = {order.sides}
across_flats_mm = {{value = {toml_number(order.across_flats)}, tolerance = 0.005}}
bow_um = {{value = {toml_number(round(bow, 2))}, tolerance = {toml_number(round(1.0 + 0.05 * abs(bow), 2))}}}
hand = "none"
{verdict}alarms = []
"""


def _job(order: PolygonOrder, head: PolygonHead, blank: float) -> str:
    number = toml_number
    return f"""\
[machine]
model = "hobbing_lathe"
setup = "hobbing"

[work]
diameter_mm = {number(blank)}
length_mm = {number(order.length)}
clamping = "chuck"

[tool]
kind = "polygon_head"
inserts = {head.inserts}
tip_radius_mm = {number(head.tip_radius_mm)}
edge_width_mm = {number(head.edge_width_mm)}

[program]
file = "program.nc"

[nominal]
kind = "polygon"
number_of_sides = {order.sides}
across_flats_mm = {number(order.across_flats)}
"""
