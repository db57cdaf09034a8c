"""The tables of the sheet as text: every number is worded here, the template only sets it."""

from dataclasses import dataclass

from twin.inspection.nominal import GearNominal, PolygonNominal
from twin.inspection.result import GearResult, Inspection, PolygonResult
from twin.report.data import Message, Program
from twin.report.scale import MISSING, number, plain

FLANK_ITEMS = (
    ("profile_slope", "f_{Hα}", "profile slope"),
    ("profile_form", "f_{fα}", "profile form"),
    ("profile_total", "F_{α}", "profile total"),
    ("helix_slope", "f_{Hβ}", "helix slope"),
    ("helix_form", "f_{fβ}", "helix form"),
    ("helix_total", "F_{β}", "helix total"),
    ("single_pitch", "f_{p}", "single pitch"),
    ("cumulative_pitch", "F_{p}", "cumulative pitch"),
)
"""item of the inspection, its symbol with `_{…}` for what stands lower, its name"""
LINES_SHOWN = 2000
"""of a program, beside those that messages point at"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """One property, as wanted and as found."""

    label: str
    wanted: str
    found: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Graded:
    """One item of the flanks, both sides, against its tolerance."""

    item: str
    """of the inspection"""
    symbol: str
    """with `_{…}` for what stands lower"""
    name: str
    values: tuple[tuple[str, bool], ...]
    """left and right, or one for both: the value, and whether it lies beyond the tolerance"""
    tolerance: str
    reached: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """One line of a program, or a gap where lines are left out."""

    number: int | None
    text: str
    messages: tuple[Message, ...] = ()


def comparison(inspection: Inspection) -> tuple[Compared, ...]:
    """Size and shape, wanted beside found."""
    nominal = inspection.nominal
    if inspection.gear:
        return _compare_gear(inspection.gear, nominal if isinstance(nominal, GearNominal) else None)
    if inspection.polygon:
        return _compare_polygon(inspection.polygon, nominal if isinstance(nominal, PolygonNominal) else None)
    return ()


def graded(gear: GearResult) -> tuple[Graded, ...]:
    """Flank deviations [µm], tolerance and class of every item."""
    sides = (gear.left, gear.right)
    rows = [_grade(gear, *item, *(getattr(side, f"{item[0]}_um") for side in sides)) for item in FLANK_ITEMS]
    return (*rows, _grade(gear, "runout", "F_{r}", "runout", gear.runout_um))


def class_allowed(inspection: Inspection) -> str:
    """Accuracy class asked for."""
    nominal = inspection.nominal
    allowed = nominal.accuracy_class if isinstance(nominal, GearNominal) else None
    return MISSING if allowed is None else str(allowed)


def class_reached(gear: GearResult, item: str) -> str:
    """Class of an item or of the "overall" gear."""
    if item not in gear.accuracy_class:
        return MISSING
    reached = gear.accuracy_class[item]
    return (
        "worse than 11"
        if reached is None and gear.tolerances_um
        else MISSING
        if reached is None
        else str(reached)
    )


def waves(gear: GearResult) -> tuple[tuple[str, str], ...]:
    """Largest orders of the waviness per turn of the gear, where any was found: what, and orders [µm]."""
    rows = (
        (f"{side} {name}", found)
        for name, field in (("profile", "profile_waviness"), ("helix", "helix_waviness"))
        for side, found in (("Left", getattr(gear.left, field)), ("Right", getattr(gear.right, field)))
    )
    return tuple(
        (label, ",  ".join(f"{wave.order}: {number(wave.amplitude_um, 2)}" for wave in found))
        for label, found in rows
        if found
    )


def listing(program: Program, messages: tuple[Message, ...]) -> tuple[Line, ...]:
    """The program's lines with the messages that point at them; the middle of a long one is left out."""
    here: dict[int, list[Message]] = {}
    for message in messages:
        if message.file == program.name and message.line is not None:
            here.setdefault(message.line, []).append(message)
    texts = program.text.splitlines()
    shown = set(range(1, min(len(texts), LINES_SHOWN) + 1))
    shown.update(n + k for n in here for k in range(-3, 4) if 1 <= n + k <= len(texts))
    lines: list[Line] = []
    last = 0
    for n in [*sorted(shown), len(texts) + 1]:
        if n > last + 1:
            lines.append(Line(number=None, text=f"{n - last - 1} lines not shown"))
        if n <= len(texts):
            lines.append(Line(number=n, text=texts[n - 1], messages=tuple(here.get(n, ()))))
        last = n
    return tuple(lines)


def _grade(gear: GearResult, item: str, symbol: str, name: str, *found: float | None) -> Graded:
    tolerance = gear.tolerances_um.get(item)
    return Graded(
        item=item,
        symbol=symbol,
        name=name,
        values=tuple(
            (number(value), tolerance is not None and value is not None and abs(value) > tolerance)
            for value in found
        ),
        tolerance=plain(tolerance),
        reached=class_reached(gear, item),
    )


def _compare_gear(gear: GearResult, nominal: GearNominal | None) -> tuple[Compared, ...]:
    tip = nominal.tip_diameter_mm if nominal else None
    rows = (
        ("Teeth", str(nominal.number_of_teeth) if nominal else MISSING, str(gear.number_of_teeth)),
        (
            "Normal module",
            plain(nominal.normal_module_mm, "mm") if nominal else MISSING,
            number(gear.normal_module_mm, 4, "mm"),
        ),
        (
            "Helix angle",
            plain(nominal.helix_angle_deg, "°") if nominal else MISSING,
            number(gear.helix_angle_deg, 4, "°"),
        ),
        ("Hand", _hand(nominal.helix_angle_deg) if nominal else MISSING, gear.hand),
        ("Lead", MISSING, number(gear.lead_mm, 3, "mm")),
        ("Tip diameter", plain(tip, "mm"), number(gear.tip_diameter_mm, 3, "mm")),
        ("Root diameter", MISSING, number(gear.root_diameter_mm, 3, "mm")),
        (
            f"Span over {gear.span_teeth} teeth" if gear.span_teeth else "Span",
            MISSING,
            number(gear.span_mm, 4, "mm"),
        ),
        (
            "Over balls" if gear.pin_diameter_mm is None else f"Over balls Ø {plain(gear.pin_diameter_mm)}",
            MISSING,
            number(gear.over_pins_mm, 4, "mm"),
        ),
        (
            "Profile shift",
            plain(nominal.profile_shift) if nominal else MISSING,
            number(gear.profile_shift, 4),
        ),
    )
    return tuple(Compared(label=a, wanted=b, found=c) for a, b, c in rows if (b, c) != (MISSING, MISSING))


def _hand(helix_deg: float) -> str:
    return "spur" if helix_deg == 0 else "right" if helix_deg > 0 else "left"


def _compare_polygon(polygon: PolygonResult, nominal: PolygonNominal | None) -> tuple[Compared, ...]:
    width = f"{plain(nominal.across_flats_mm)} mm {nominal.tolerance}" if nominal else MISSING
    rows = (
        ("Sides", str(nominal.number_of_sides) if nominal else MISSING, str(polygon.number_of_sides)),
        ("Across flats, at mid-face", width, number(polygon.across_flats_mm, 4, "mm")),
        ("Across flats, between mean planes", MISSING, number(polygon.across_flats_planes_mm, 4, "mm")),
        ("Across flats by caliper, largest", width, number(polygon.across_flats_caliper_mm, 4, "mm")),
        ("Across flats by caliper, smallest", width, number(polygon.across_flats_caliper_least_mm, 4, "mm")),
        ("Across corners", MISSING, number(polygon.across_corners_mm, 3, "mm")),
        ("Across corners, smallest", MISSING, number(polygon.across_corners_least_mm, 3, "mm")),
        ("Bow, + convex", MISSING, number(polygon.bow_um, 1, "µm")),
        ("Flatness", MISSING, number(polygon.flatness_um, 1, "µm")),
        ("Twist, + right-hand", MISSING, number(polygon.twist_deg_per_mm, 4, "°/mm")),
        ("Concentricity", MISSING, number(polygon.concentricity_um, 1, "µm")),
    )
    return tuple(Compared(label=a, wanted=b, found=c) for a, b, c in rows)


def key_figures(inspection: Inspection) -> tuple[tuple[str, str], ...]:
    """The few numbers under the verdict; `_{…}` stands lower in the labels."""
    gear, polygon = inspection.gear, inspection.polygon
    if gear:
        worst_profile = _worst(gear, "profile_total_um")
        return (
            ("Teeth", str(gear.number_of_teeth)),
            ("Module", number(gear.normal_module_mm, 3, "mm")),
            (
                "Helix",
                "spur" if gear.hand == "spur" else f"{number(abs(gear.helix_angle_deg), 3)}° {gear.hand}",
            ),
            ("Tip Ø", number(gear.tip_diameter_mm, 2, "mm")),
            ("Profile F_{α}", number(worst_profile, 1, "µm")),
            ("Helix F_{β}", number(_worst(gear, "helix_total_um"), 1, "µm")),
            ("Pitch F_{p}", number(_worst(gear, "cumulative_pitch_um"), 1, "µm")),
            ("Class reached", class_reached(gear, "overall")),
            ("Class allowed", class_allowed(inspection)),
        )
    if polygon:
        return (
            ("Sides", str(polygon.number_of_sides)),
            ("Across flats", number(polygon.across_flats_mm, 3, "mm")),
            ("By caliper", number(polygon.across_flats_caliper_mm, 3, "mm")),
            ("Across corners", number(polygon.across_corners_mm, 3, "mm")),
            ("Bow", number(polygon.bow_um, 1, "µm")),
            ("Flatness", number(polygon.flatness_um, 1, "µm")),
        )
    return ()


def _worst(gear: GearResult, field: str) -> float | None:
    values = [value for value in (getattr(gear.left, field), getattr(gear.right, field)) if value is not None]
    return max(values, default=None)
