"""One inspection from mesh to verdict."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from numpy.typing import ArrayLike

from twin.errors import InputError, PartError
from twin.inspection.axis import find_axis, straightened
from twin.inspection.beside import Beside
from twin.inspection.bodies import separate_bodies
from twin.inspection.damage import FLANK_LIMIT, destroyed
from twin.inspection.fit import find_gear
from twin.inspection.gear import measure_gear
from twin.inspection.identity import name_of, other_unit, unlike
from twin.inspection.involute import geometry
from twin.inspection.judge_gear import judge_gear
from twin.inspection.judge_polygon import judge_polygon
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.inspection.polygon import measure_polygon
from twin.inspection.recognise import MOST_SIDES, Form, Outline, recognise
from twin.inspection.result import Inspection, Verdict
from twin.inspection.solid import Solid, check_solid
from twin.inspection.tolerances import across_flats_limits

PRESSURE_DEG = 20.0
"""normal pressure angle assumed where none is told (inspection.md, section 3)"""


def inspect(
    vertices: ArrayLike,
    faces: ArrayLike,
    nominal: Nominal | None = None,
    *,
    teeth: Sequence[int] | Literal["all"] | None = None,
    pressure_deg: float = PRESSURE_DEG,
    own_axis: bool = False,
) -> Inspection:
    """Recognise and measure a part.

    Args:
        vertices: (n, 3) [mm] in the part frame: work axis = Z, +X = C0.
        faces: (m, 3) vertex indices of a closed 2-manifold.
        nominal: what the part should be; None: only what is found, not judged.
        teeth: numbers of the teeth to trace, from 1 clockwise from C0, or all; None: four, equally
            spaced.
        pressure_deg: normal pressure angle of a gear that has no nominal [degrees].
        own_axis: look for the part's own axis (bore, else tip circle) and measure about that.

    Raises:
        InputError: the mesh is no closed 2-manifold of finite numbers, or the nominal is impossible.

    """
    _check_nominal(nominal, pressure_deg)
    solid = check_solid(vertices, faces)
    return inspect_solid(solid, nominal, teeth=teeth, pressure_deg=pressure_deg, own_axis=own_axis)


def inspect_solid(
    solid: Solid,
    nominal: Nominal | None = None,
    *,
    teeth: Sequence[int] | Literal["all"] | None = None,
    pressure_deg: float = PRESSURE_DEG,
    own_axis: bool = False,
) -> Inspection:
    """As `inspect`, a mesh that was checked. Raises InputError for an impossible nominal."""
    _check_nominal(nominal, pressure_deg)
    wanted = _count(nominal)
    counted = Beside(lambda: separate_bodies(solid))
    outline = recognise(solid, wanted=wanted)
    bodies = counted.result()
    if bodies > 1:
        return _nothing(f"the mesh holds {bodies} separate bodies, a part is one", nominal)
    axis = None
    if own_axis:
        try:
            axis = find_axis(solid, outline)
        except PartError as fault:
            return _nothing(fault.text, nominal)
        solid = straightened(solid, axis)
        outline = recognise(solid, wanted=wanted)
    if outline.form is Form.GEAR and not isinstance(nominal, PolygonNominal):
        result = _inspect_gear(solid, outline, nominal, teeth, pressure_deg)
    elif outline.form is Form.POLYGON and not isinstance(nominal, GearNominal):
        result = _inspect_polygon(solid, outline, nominal)
    else:
        result = _nothing(_unexpected(outline, nominal), nominal)
    notes = (*_others(outline), *solid.mended)
    return replace(result, axis=axis, findings=(*result.findings, *notes))


def _count(nominal: Nominal | None) -> int | None:
    """Return how many teeth or sides are wanted."""
    if isinstance(nominal, GearNominal):
        return nominal.number_of_teeth
    return nominal.number_of_sides if isinstance(nominal, PolygonNominal) else None


def _others(outline: Outline) -> list[str]:
    """Say what else stands about the axis and was not looked at."""
    return [
        f"{count} teeth or flats stand about z = {low:.1f} to {high:.1f} mm too: another part of the piece, "
        "not measured"
        for count, low, high in outline.others
    ]


def _check_nominal(nominal: Nominal | None, pressure_deg: float) -> None:
    """An impossible nominal is refused before anything is measured."""
    if isinstance(nominal, GearNominal):
        geometry(nominal)
    elif isinstance(nominal, PolygonNominal):
        across_flats_limits(nominal.across_flats_mm, nominal.tolerance)
        if not 2 <= nominal.number_of_sides <= MOST_SIDES:
            raise InputError(
                f"nominal polygon: number_of_sides is {nominal.number_of_sides}",
                remedy=f"valid is 2 to {MOST_SIDES}",
            )
    else:
        geometry(
            GearNominal(number_of_teeth=20, normal_module_mm=1.0, normal_pressure_angle_deg=pressure_deg)
        )


def _inspect_gear(
    solid: Solid,
    outline: Outline,
    nominal: GearNominal | None,
    teeth: Sequence[int] | Literal["all"] | None,
    pressure_deg: float,
) -> Inspection:
    if nominal is not None:
        pressure_deg = nominal.normal_pressure_angle_deg
        if outline.count == nominal.number_of_teeth:
            unit = other_unit(2 * outline.tip_radius, geometry(nominal).tip_diameter, "the tip diameter")
            if unit:
                return _nothing(unit, nominal)
    try:
        found = find_gear(solid, outline, pressure_deg=pressure_deg)
    except PartError as fault:
        return _nothing(fault.text, nominal)
    if found.straying > FLANK_LIMIT * found.module:
        return _nothing(
            f"{found.teeth} teeth stand about the axis, but their flanks stray {found.straying:.3f} mm "
            "from one involute: the teeth are destroyed or of another kind",
            nominal,
        )
    difference = unlike(found, nominal) if nominal is not None else ""
    if difference:
        return _nothing(f"{difference} (found: {found})", nominal)
    gear, unmeasured = measure_gear(solid, outline, found, nominal, teeth)
    ruined = destroyed(gear)
    if ruined:
        return _nothing(ruined, nominal)
    gear, verdict, findings = judge_gear(gear, nominal, whole=outline.whole, unmeasured=unmeasured)
    return Inspection(
        gear=gear, nominal=nominal, verdict=verdict, findings=tuple(findings), unmeasured=unmeasured
    )


def _inspect_polygon(solid: Solid, outline: Outline, nominal: PolygonNominal | None) -> Inspection:
    if nominal is not None:
        if outline.count != nominal.number_of_sides:
            return _nothing(
                f"a polygon with {outline.count} sides was found, not {nominal.number_of_sides}", nominal
            )
        unit = other_unit(2 * outline.root_radius, nominal.across_flats_mm, "the width across flats")
        if unit:
            return _nothing(unit, nominal)
    try:
        polygon, unmeasured = measure_polygon(solid, outline, nominal)
    except PartError as fault:
        return _nothing(fault.text, nominal)
    verdict, findings = judge_polygon(polygon, nominal, whole=outline.whole)
    return Inspection(
        polygon=polygon, nominal=nominal, verdict=verdict, findings=tuple(findings), unmeasured=unmeasured
    )


def _unexpected(outline: Outline, nominal: Nominal | None) -> str:
    """Say what was found where something else was named."""
    if outline.form is Form.NEITHER:
        if isinstance(nominal, GearNominal) and outline.tip_radius > 0:
            gear, largest = geometry(nominal), 2 * outline.tip_radius
            if largest < gear.tip_diameter - gear.module:
                return (
                    f"{outline.reason}; the teeth are cut away: the largest diameter left is "
                    f"{largest:.2f} mm where the tips should stand at {gear.tip_diameter:.2f} mm"
                )
        return outline.reason
    what = "teeth" if outline.form is Form.GEAR else "flat sides"
    return f"a part with {outline.count} {what} was found"


def _nothing(reason: str, nominal: Nominal | None) -> Inspection:
    """Give the result without figures: not the part named, or nothing that can be measured."""
    if nominal is None:
        return Inspection(verdict=Verdict.NOT_GRADED, reason=reason, findings=(reason,))
    full = f"not {name_of(nominal)}: {reason}"
    return Inspection(nominal=nominal, verdict=Verdict.OUT, reason=full, findings=(full,))
