"""The verdict on a polygon, in sentences a reader understands (ISO 4759-1 grade A)."""

from twin.inspection.nominal import PolygonNominal
from twin.inspection.result import PolygonResult, Verdict
from twin.inspection.tolerances import across_flats_limits

TWIST_LIMIT = 0.5
"""faces that turn by more than this [degrees] over the length are not plain"""
CORNERS_OVER_FLATS = 1.13
"""e_min / s_min of a hexagon (ISO 4759-1)"""
CONCAVE_ABOVE = 5.0
"""bow [µm] from which concave faces are worth a word"""


def judge_polygon(
    polygon: PolygonResult, nominal: PolygonNominal | None, *, whole: bool
) -> tuple[Verdict, list[str]]:
    """Return the verdict on a polygon and the findings, most important first (ISO 4759-1 grade A)."""
    shape = [*_shape_of_faces(polygon), _flatness(polygon)]
    if nominal is None:
        return Verdict.NOT_GRADED, [*shape, "no width across flats was named to judge by"]
    wrong = _twisted(polygon)
    low, high = across_flats_limits(nominal.across_flats_mm, nominal.tolerance)
    limits = f"{nominal.tolerance} of {nominal.across_flats_mm:g} mm allows {low:.3f} to {high:.3f} mm"
    least, largest = polygon.across_flats_caliper_least_mm, polygon.across_flats_caliper_mm
    how = "by caliper"
    if least is None or largest is None:  # no face stands opposite another: twice the distance from the axis
        least = largest = polygon.across_flats_mm
        how = "as twice the distance of the faces from the axis"
    if round(largest, 3) > high:
        wrong.append(f"too large: {largest:.3f} mm across flats {how}, {limits}")
    if round(least, 3) < low:
        wrong.append(f"too small: {least:.3f} mm across flats {how}, {limits}")
    least_corners = CORNERS_OVER_FLATS * low
    if polygon.number_of_sides == 6 and round(polygon.across_corners_least_mm, 3) < round(least_corners, 3):
        wrong.append(
            f"corners too small: {polygon.across_corners_least_mm:.3f} mm across corners, "
            f"at least {least_corners:.3f} mm are wanted (1.13 times the smallest width across flats)"
        )
    if not whole:
        z = polygon.range_mm
        shape.append(f"the faces have their full depth from z = {z[0]:.2f} to {z[1]:.2f} mm")
    if wrong:
        return Verdict.OUT, wrong[:1] + shape + wrong[1:]
    return Verdict.IN, [f"across flats {largest:.3f} mm {how}: {limits}", *shape]


def _twisted(polygon: PolygonResult) -> list[str]:
    """Say whether the faces turn, where plain ones are wanted: a nominal polygon has no twist."""
    low, high = polygon.range_mm
    turn = abs(polygon.twist_deg_per_mm) * (high - low)
    if turn <= TWIST_LIMIT:
        return []
    return [
        f"the faces are twisted by {abs(polygon.twist_deg_per_mm):.3f} °/mm {polygon.hand}-hand, {turn:.1f}° "
        f"over {high - low:.2f} mm: plain faces are wanted"
    ]


def _flatness(polygon: PolygonResult) -> str:
    """Say which general tolerance the flatness holds; the verdict does not depend on it."""
    limits = ", ".join(f"{name} {limit:g}" for name, limit in polygon.flatness_limits_um.items())
    if not limits:
        return f"flatness {polygon.flatness_um:.1f} µm: faces of this length are outside ISO 2768-2"
    held = "worse than L" if polygon.flatness_class == "worse" else f"class {polygon.flatness_class}"
    return (
        f"flatness {polygon.flatness_um:.1f} µm: {held} of ISO 2768-2 ({limits} µm); not part of the verdict"
    )


def _shape_of_faces(polygon: PolygonResult) -> list[str]:
    words = []
    if polygon.bow_um < -CONCAVE_ABOVE:
        words.append(
            f"the faces are concave by {-polygon.bow_um:.1f} µm: "
            f"{polygon.across_flats_mm:.3f} mm across flats at the middle of the faces, "
            "but a caliper touches near the corners; a ratio Q/P of 2 makes them convex"
        )
    return words
