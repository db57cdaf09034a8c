"""One part against another: where the surface of A stands off that of B, and which figures changed."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from twin.comparison.changes import Change, changes
from twin.comparison.distance import Surface
from twin.errors import InputError
from twin.inspection.result import GearResult, Inspection, PolygonResult
from twin.inspection.sheet import to_json
from twin.inspection.solid import Floats, Ints, Solid
from twin.inspection.units import wrong_unit

PERCENTILES = (50, 90, 99)
DECIMALS = 6
"""of a deviation [µm]: below it is the rounding of the distances"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Extreme:
    """Where the deviation is largest."""

    deviation_um: float
    position_mm: tuple[float, float, float]
    radius_mm: float
    place: str
    """"tooth 3", "face 2"; empty on a part that is neither gear nor polygon"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """How far the vertices of one surface stand off another."""

    most: Extreme
    """material outside"""
    least: Extreme
    """material lacking"""
    rms_um: float
    """by area"""
    percentiles_um: dict[int, float]
    """share [%] of the area -> size of the deviation that it holds"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """What there is to say of A against B."""

    deviation_um: Floats
    """(n,) of the vertices of A from the surface of B, + = A has more material"""
    surface: Spread
    """A from B"""
    reverse: Spread
    """B from A: what B has and A has not, where A has no vertex to show it"""
    changes: tuple[Change, ...]
    notes: tuple[str, ...]

    @property
    def largest_um(self) -> float:
        """Size of the largest deviation, either way."""
        ends = (self.surface.most, self.surface.least, self.reverse.most, self.reverse.least)
        return max(abs(end.deviation_um) for end in ends)


def compare(a: tuple[Solid, Inspection], b: tuple[Solid, Inspection]) -> Comparison:
    """Compare two checked solids, in one frame, and their inspections.

    Raises InputError where one of them seems to be in another unit.
    """
    (solid, found), (other, wanted) = a, b
    size, reference = _extent(solid), _extent(other)
    if mistake := wrong_unit(size, reference):
        raise InputError(
            f"A is {size:.4g} mm across, B {reference:.4g} mm: {mistake.explanation}",
            remedy="--units is A's, --against-units is B's",
        )
    # numpy leaves the interpreter free most of the time
    with ThreadPoolExecutor(2) as pool:
        deviation, back = pool.map(_deviation, (solid, other), (other, solid))
    return Comparison(
        deviation_um=deviation,
        surface=_spread(solid, deviation, found),
        reverse=_spread(other, back, wanted),
        changes=changes(to_json(found), to_json(wanted)),
        notes=tuple(_notes(found, wanted)),
    )


def _extent(solid: Solid) -> float:
    return float(np.ptp(solid.vertices, axis=0).max())


def _deviation(solid: Solid, other: Solid) -> Floats:
    return np.round(1000.0 * Surface(other.vertices, other.faces).signed(solid.vertices), DECIMALS) + 0.0


def _notes(a: Inspection, b: Inspection) -> list[str]:
    if a.kind == b.kind:
        return (
            []
            if a.kind
            else ["neither is recognised as a gear or a polygon: the surfaces alone are compared"]
        )
    kinds = [kind or "neither gear nor polygon" for kind in (a.kind, b.kind)]
    return [f"A is {_article(kinds[0])}, B is {_article(kinds[1])}: their figures have little in common"]


def _article(kind: str) -> str:
    return kind if " " in kind else f"a {kind}"


def _spread(solid: Solid, deviation: Floats, inspection: Inspection) -> Spread:
    corner = solid.vertices[solid.faces]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
    share = np.bincount(solid.faces.ravel(), np.repeat(area / 3, 3), len(deviation))
    share /= share.sum()
    size = np.abs(deviation)
    order = np.argsort(size)
    held = np.cumsum(share[order])
    rows = np.minimum(np.searchsorted(held, np.array(PERCENTILES) / 100 - 1e-12), len(order) - 1)
    return Spread(
        most=_extreme(solid, deviation, int(deviation.argmax()), inspection),
        least=_extreme(solid, deviation, int(deviation.argmin()), inspection),
        rms_um=math.sqrt(float(share @ deviation**2)),
        percentiles_um={p: float(size[order[row]]) for p, row in zip(PERCENTILES, rows, strict=True)},
    )


def _extreme(solid: Solid, deviation: Floats, row: int, inspection: Inspection) -> Extreme:
    x, y, z = (float(value) for value in solid.vertices[row])
    return Extreme(
        deviation_um=float(deviation[row]),
        position_mm=(x, y, z),
        radius_mm=math.hypot(x, y),
        place=_place(inspection, math.atan2(y, x), z),
    )


def _place(inspection: Inspection, angle: float, z: float) -> str:
    """The tooth or face at an angle [rad] and height."""
    if inspection.gear:
        return f"tooth {_tooth(inspection.gear, angle, z)}"
    if inspection.polygon:
        return f"face {_face(inspection.polygon, angle, z)}"
    return ""


def _tooth(gear: GearResult, angle: float, z: float) -> int:
    """From 1, clockwise; the twist of the helix taken out."""
    twist = 2 * math.pi / abs(gear.lead_mm) * (1 if gear.hand == "right" else -1) if gear.lead_mm else 0.0
    turned = angle - math.radians(gear.phase_deg) - twist * (z - gear.measuring_plane_mm)
    return round(-turned * gear.number_of_teeth / (2 * math.pi)) % gear.number_of_teeth + 1


def _face(polygon: PolygonResult, angle: float, z: float) -> int:
    """From 1, counter-clockwise; the twist taken out."""
    turned = angle - math.radians(polygon.twist_deg_per_mm) * (z - sum(polygon.range_mm) / 2)
    directions: Ints | Floats = np.radians([face.direction_deg for face in polygon.faces])
    return int(np.cos(turned - directions).argmax()) + 1
