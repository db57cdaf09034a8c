"""An inspection as lines for a terminal: sizes, deviations with filter and uncertainty, verdict."""

from collections.abc import Iterator

from twin.inspection.result import Axis, GearResult, Inspection, PolygonResult, Verdict, Wave
from twin.inspection.trace import cut_off

ITEMS = (
    ("profile_slope", "profile slope f_Hα"),
    ("profile_form", "profile form f_fα"),
    ("profile_total", "profile total F_α"),
    ("profile_crowning", "profile crowning C_α"),
    ("helix_slope", "helix slope f_Hβ"),
    ("helix_form", "helix form f_fβ"),
    ("helix_total", "helix total F_β"),
    ("helix_crowning", "helix crowning C_β"),
    ("single_pitch", "single pitch f_p"),
    ("cumulative_pitch", "cumulative pitch F_p"),
)
HEADS = {
    Verdict.IN: "In tolerance.",
    Verdict.OUT: "Out of tolerance.",
    Verdict.NOT_GRADED: "Not graded.",
}
LISTED = 5
"""orders of the waviness that are listed"""


def text_lines(inspection: Inspection) -> list[str]:
    """Say what was found, with its uncertainty, then the verdict and why."""
    said: list[str] = []
    if inspection.axis is not None:
        said.append(_axis(inspection.axis))
    if inspection.gear is not None:
        said += _gear(inspection.gear)
    if inspection.polygon is not None:
        said += _polygon(inspection.polygon)
    if inspection.kind is None:
        said.append("Not the part." if inspection.nominal else "Not recognised.")
    else:
        said.append(HEADS[inspection.verdict])
    said += [f"  - {finding}" for finding in inspection.findings]
    for key, why in inspection.unmeasured.items():
        name = key.removesuffix("_um").removesuffix("_mm").replace("_", " ")
        said.append(f"  - {name} not measured: {why}")
    return said


def _axis(axis: Axis) -> str:
    return (
        f"  axis by the {axis.datum} Ø {axis.diameter_mm:.4f} mm: {axis.offset_mm:.4f} mm off Z at "
        f"z = {axis.at_z_mm:.2f} mm (x {_signed(axis.x_mm, 4)}, y {_signed(axis.y_mm, 4)}), "
        f"tilted by {axis.tilt_deg:.4f}° (x {_signed(axis.tilt_x_deg, 4)}°, "
        f"y {_signed(axis.tilt_y_deg, 4)}°); taken out"
    )


def _gear(gear: GearResult) -> Iterator[str]:
    yield (
        f"  {gear.number_of_teeth} teeth, module {gear.normal_module_mm:.4f} mm, helix "
        f"{_signed(gear.helix_angle_deg, 4)}° ({gear.hand}), profile shift {_signed(gear.profile_shift, 4)}"
    )
    yield f"  tip {gear.tip_diameter_mm:.3f} mm, root {gear.root_diameter_mm:.3f} mm"
    sizes = (
        (f"span over {gear.span_teeth} teeth", "span_mm", gear.span_mm),
        (f"over balls of {gear.pin_diameter_mm or 0:g} mm", "over_pins_mm", gear.over_pins_mm),
        ("tooth thickness", "tooth_thickness_mm", gear.tooth_thickness_mm),
    )
    for name, key, value in sizes:
        if value is not None:
            yield f"  {name} {value:.4f} ± {gear.uncertainty.get(key, 0.0):.4f} mm"
    if gear.chordal_thickness_mm is not None:
        chord, height = gear.chordal_thickness_mm, gear.chordal_height_mm
        yield f"  chordal thickness {chord:.4f} mm at height {height:.4f} mm"
    low, high = gear.profile_range_mm
    foot = "undercut" if gear.undercut else "fillet"
    yield (
        f"  profile evaluated from Ø {low:.3f} ({foot} below Ø {gear.form_diameter_mm:.3f}) "
        f"to Ø {high:.3f} mm (flank ends at Ø {gear.tip_form_diameter_mm:.3f})"
    )
    if gear.helix_range_mm is not None:
        yield "  helix evaluated from z = {:.3f} to {:.3f} mm".format(*gear.helix_range_mm)
    yield from _table(gear)
    for side in ("left", "right"):
        for name in ("profile", "helix"):
            waves: tuple[Wave, ...] = getattr(getattr(gear, side), f"{name}_waviness")
            if waves:
                orders = ", ".join(f"{w.order}: {w.amplitude_um:.2f} µm" for w in waves[:LISTED])
                yield f"  {name} waviness, {side}, by orders per turn: {orders}"


def _table(gear: GearResult) -> Iterator[str]:
    """Both sides in µm: as read, behind the filter, and what the mesh's facets can make of it."""
    teeth = ", ".join(str(trace.tooth) for trace in gear.left.profile)
    cut = ", ".join(
        f"{cut_off(traces[0].evaluation):.2f} mm" for traces in (gear.left.profile, gear.left.helix) if traces
    )
    yield f"  traced teeth {teeth or '—'}; filter cut-off {cut or '—'}"
    head = f"{'read':>8}{'filtered':>10}{'± facets':>10}"
    yield f"  {'µm':<22}{'left':>6}{head}{'right':>9}{head}   class"
    for item, name in ITEMS:
        cells = ""
        for flank, gap in ((gear.left, 6), (gear.right, 9)):
            key = f"{item}_um"
            values = (getattr(flank, key), flank.filtered.get(key), flank.uncertainty.get(key))
            cells += " " * gap + "".join(
                f"{_number(value):>{width}}" for value, width in zip(values, (8, 10, 10), strict=True)
            )
        yield f"  {name:<22}{cells}   {_class(gear, item)}"
    if gear.runout_um is not None:
        facets = gear.uncertainty.get("runout_um", 0.0)
        yield f"  runout F_r {gear.runout_um:.2f} ± {facets:.2f} µm, class {_class(gear, 'runout')}"
    if gear.accuracy_class:
        behind = gear.accuracy_class_filtered.get("overall")
        yield f"  class {_class(gear, 'overall')} overall, {behind or 'none'} by the filtered values"


def _class(gear: GearResult, item: str) -> str:
    if item not in gear.accuracy_class:
        return ""
    reached = gear.accuracy_class[item]
    return "none" if reached is None else str(reached)


def _polygon(polygon: PolygonResult) -> Iterator[str]:
    def mm(value: float | None, key: str) -> str:
        if value is None:
            return "—"
        return f"{value:.4f} ± {polygon.uncertainty.get(key, 0.0):.4f} mm"

    yield (
        f"  {polygon.number_of_sides} sides, across flats "
        f"{mm(polygon.across_flats_mm, 'across_flats_mm')} at mid-face, "
        f"{mm(polygon.across_flats_planes_mm, 'across_flats_planes_mm')} between mean planes, "
        f"by caliper {mm(polygon.across_flats_caliper_mm, 'across_flats_caliper_mm')}"
    )
    corners, least = polygon.across_corners_mm, polygon.across_corners_least_mm
    yield f"  across corners {corners:.4f} mm, least {least:.4f} mm"
    shape = "flat" if polygon.bow_um == 0 else "convex" if polygon.bow_um > 0 else "concave"
    yield (
        f"  bow {_signed(polygon.bow_um, 2)} ± {polygon.uncertainty.get('bow_um', 0.0):.2f} µm ({shape}), "
        f"flatness {polygon.flatness_um:.2f} ± {polygon.uncertainty.get('flatness_um', 0.0):.2f} µm "
        f"(ISO 2768-2: {polygon.flatness_class or '—'})"
    )
    angles = polygon.angles_deg
    yield (
        f"  twist {_signed(polygon.twist_deg_per_mm, 4)} °/mm ({polygon.hand}), concentricity "
        f"{polygon.concentricity_um:.2f} µm, angles {angles.min():.4f}° to {angles.max():.4f}°"
    )


def _number(value: float | None) -> str:
    return "—" if value is None else f"{value + 0.0 if round(value, 2) else 0.0:.2f}"


def _signed(value: float, digits: int) -> str:
    """A number with its sign, and no sign on what rounds to zero."""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0.0:.{digits}f}"
