import json

import manifold3d as m3
import numpy as np
import pytest

from twin.errors import InputError
from twin.inspection.deviation import deviation_map
from twin.inspection.inspection import inspect
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal, PolygonNominal
from twin.inspection.result import Verdict
from twin.inspection.sheet import to_json

HOB_RADIUS = 35.0


@pytest.fixture(scope="module")
def spur(parts):
    return parts.gear_mesh(teeth=20, module=2.0, z_step=0.5, roll_step=0.25)


def solid(mesh):
    vertices, faces = mesh
    return m3.Manifold(
        m3.Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(faces).astype(np.uint64))
    )


def mesh_of(manifold):
    mesh = manifold.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)


def round_bar(parts, *, waves=0, height=0.0, diameter=44.0, points=2048, noise=0.0):
    angle = np.linspace(0, 2 * np.pi, points, endpoint=False)
    radius = diameter / 2 + height * np.cos(waves * angle)
    radius += noise * np.random.default_rng(1).normal(size=points)
    ring = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    return parts.loft([np.column_stack([ring, np.full(points, z)]) for z in np.linspace(-20, 0, 11)])


def refused(mesh, nominal, words):
    """No kind, no figures, out where something was named, and the reason in words."""
    result = inspect(*mesh, nominal)
    values = to_json(result)
    assert values["kind"] is None
    assert words in values["reason"]
    assert values["verdict"] == ("out" if nominal else "not_graded")
    assert not {"number_of_teeth", "number_of_sides", "flanks", "across_flats_mm"} & values.keys()
    assert np.isnan(deviation_map(*mesh, result)).all()
    json.dumps(values, allow_nan=False)


def test_plain_bar(parts, named):
    refused(round_bar(parts), named(), "a round part of diameter 44.000 mm")
    refused(round_bar(parts), None, "no teeth and no flats")


def test_shallow_waves_are_no_teeth(parts, named):
    refused(
        round_bar(parts, waves=240, height=0.05, points=4800), named(), "240 regular teeth, 0.100 mm deep"
    )


def test_teeth_cut_away(parts, named):
    rough = round_bar(parts, diameter=35.0, noise=0.05)
    refused(rough, named(), "where the tips should stand at 44.00 mm")


def test_lobes_are_no_polygon(parts):
    refused(round_bar(parts, waves=7, height=0.1, diameter=35.0), None, "7 lobes stand about the axis")


def test_lugs_are_no_polygon():
    lug = m3.Manifold.cube((4, 3, 20)).translate((8.5, -1.5, 0))
    lugs = [lug.rotate((0, 0, 60.0 * k)) for k in range(6)]
    shaft = m3.Manifold.cylinder(20, 10, 10, 128)
    refused(mesh_of(m3.Manifold.batch_boolean([shaft, *lugs], m3.OpType.Add)), None, "no faces of a polygon")


@pytest.mark.parametrize("sides", [2, 3, 4, 6, 12])
def test_straight_prisms_do_not_twist(sides):
    """Two triangles a face: their common edge wanders across it, the section does not turn."""
    if sides == 2:
        bar = m3.Manifold.cylinder(20, 10, 10, 128) ^ m3.Manifold.cube((14, 40, 50), True)
    else:
        bar = m3.Manifold.cylinder(20, 10, 10, sides)
    polygon = inspect(*mesh_of(bar)).polygon
    assert polygon.number_of_sides == sides
    assert (polygon.twist_deg_per_mm, polygon.hand) == (0.0, "none")
    assert polygon.across_flats_mm == pytest.approx(
        14.0 if sides == 2 else 20 * np.cos(np.pi / sides), abs=1e-6
    )
    assert polygon.bow_um == 0.0


def test_another_gear_than_named(spur, named):
    refused(spur, named(teeth=19), "20 teeth instead of 19")
    refused(spur, named(helix_deg=20.0), "helix angle 0° instead of 20°")
    refused(spur, named(module=2.25), "normal module 2.000 mm instead of 2.25 mm")
    refused(spur, PolygonNominal(number_of_sides=6, across_flats_mm=17.0), "a part with 20 teeth was found")


def test_hexagon_where_a_gear_is_named(parts, named):
    mesh = parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=3, sides=6)
    refused(mesh, named(), "a part with 6 flat sides was found")


def test_wrong_hand(parts):
    right = parts.gear_mesh(teeth=20, module=2.0, helix_deg=20.0, roll_step=0.3)
    left_hand = GearNominal(number_of_teeth=20, normal_module_mm=2.0, helix_angle_deg=-20.0)
    refused(right, left_hand, "helix angle 20° instead of -20°")


@pytest.mark.parametrize("other", [{"helix_deg": 20.0}, {"teeth": 21, "shift": -0.5}, {"helix_deg": 5.0}])
def test_teeth_cut_across_by_others_are_destroyed(parts, other, named):
    """What a wrong lead or a wrong ratio leaves: only what both sets of teeth share."""
    straight = parts.gear_mesh(teeth=20, module=2.0, z_step=20.0, roll_step=0.5)
    cross = parts.gear_mesh(**{"teeth": 20, "module": 2.0, "z_step": 1.0, "roll_step": 0.5} | other)
    result = inspect(*mesh_of(solid(straight) ^ solid(cross)), named(accuracy_class=8))
    assert result.kind is None
    assert result.verdict is Verdict.OUT


def half_cut(spur, end=-10.0):
    """Full teeth in front of `end`; behind it the hob's circle runs out to the blank."""
    vertices, faces = spur
    vertices = vertices.copy()
    radius = np.hypot(vertices[:, 0], vertices[:, 1])
    past = np.clip(end - vertices[:, 2], 0.0, HOB_RADIUS)
    bottom = np.minimum(17.5 + HOB_RADIUS - np.sqrt(HOB_RADIUS**2 - past**2), 22.0)
    vertices[:, :2] *= np.where(radius > 1, np.maximum(1.0, bottom / np.maximum(radius, 1.0)), 1.0)[:, None]
    return vertices, faces


def test_gear_stopped_half_way(spur, named):
    mesh = half_cut(spur)
    result = inspect(*mesh, named(accuracy_class=8))
    assert result.verdict is Verdict.OUT
    assert result.gear.number_of_teeth == 20
    low, high = result.gear.teeth_range_mm
    assert high == pytest.approx(0.0)
    # from the end of the cut on the hob's circle rises: 1 µm after 0.26 mm
    assert low == pytest.approx(-10.0, abs=0.5)
    assert result.gear.left.helix_total_um < 0.15
    assert "full depth only from z" in result.findings[0]
    value = deviation_map(*mesh, result)
    assert np.isnan(value[mesh[0][:, 2] < low - 1e-6]).all()


def test_gear_on_a_shaft_is_whole(parts, spur, named):
    shaft = m3.Manifold.cylinder(60.0, 8.0, 8.0, 96).translate((0, 0, -40))
    result = inspect(*mesh_of(solid(spur) + shaft), named(accuracy_class=8))
    assert result.verdict is Verdict.IN
    assert result.gear.root_diameter_mm == pytest.approx(35.0, abs=1e-6)


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_gear_between_two_journals(parts, named, helix_deg):
    """Its faces run along the whole width: between the journals the mesh has no vertices of its own."""
    step = 20.0 if helix_deg == 0 else 0.5
    gear = parts.gear_mesh(teeth=20, module=2.0, helix_deg=helix_deg, z_step=step, roll_step=0.2)
    journals = m3.Manifold.cylinder(80.0, 9.0, 9.0, 96, True).translate((0, 0, -10))
    mesh = mesh_of(solid(gear) + journals)
    nominal = named(helix_deg=helix_deg, accuracy_class=8)
    d = 40 / np.cos(np.radians(helix_deg))
    for own_axis, offset in ((False, (0.0, 0.0)), (True, (0.06, 0.08))):
        result = inspect(*parts.moved(mesh, offset=offset), nominal, own_axis=own_axis)
        assert result.verdict is Verdict.IN
        assert result.gear.tip_diameter_mm == pytest.approx(d + 4, abs=1e-3)
        # a chord of the gap's bottom comes inside the root circle by less than 2 µm
        assert result.gear.root_diameter_mm == pytest.approx(d - 5, abs=4e-3)
        span = geometry(nominal).span(3)
        assert result.gear.span_mm == pytest.approx(span, abs=result.gear.uncertainty["span_mm"] + 1e-5)
        if own_axis:
            assert result.axis.offset_mm == pytest.approx(0.1, abs=2e-4)


def test_inside_out_is_turned_and_said(spur, named):
    vertices, faces = spur
    result = inspect(vertices, faces[:, ::-1], named(accuracy_class=8))
    assert result.verdict is Verdict.IN
    assert result.findings[-1] == "the mesh came inside out and was turned"


def test_doubled_and_degenerate_faces_are_left_out_and_said(spur, named):
    vertices, faces = spur
    turned = np.roll(faces[10:15], 1, axis=1)
    for extra, words in (
        (turned, "5 doubled faces were left out"),
        ([[3, 3, 4]], "1 degenerate faces were left out"),
    ):
        result = inspect(vertices, np.concatenate([faces, extra]), named(accuracy_class=8))
        assert result.verdict is Verdict.IN
        assert result.findings[-1] == words


def broken(change):
    vertices, faces = mesh_of(m3.Manifold.cube((10, 10, 10), True))
    vertices, faces = vertices.copy(), faces.copy()
    return change(vertices, faces)


def with_nan(vertices, faces):
    vertices[3, 1] = np.nan
    return vertices, faces


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (with_nan, "1 of 8 vertices are not finite, the first is vertex 3"),
        (lambda v, f: (v, f[1:]), "not closed, 3 edges have only one face"),
        (lambda v, f: (v, np.concatenate([f, f[:1, ::-1]])), "3 edges belong to more than two faces"),
        (lambda v, f: (v, np.concatenate([f[:1, ::-1], f[1:]])), "3 edges .* of opposite orientation"),
        (lambda v, f: (v[:7], f), "face indices run from 0 to 7, valid are 0 to 6"),
        (lambda v, f: (v, f * 1.0), "faces must be integers, got float64"),
        (lambda v, f: (v[:, :2], f), r"vertices must have shape \(n, 3\), got \(8, 2\)"),
        (lambda v, f: (v, f[:0]), "there are no faces"),
        (lambda v, f: ("nonsense", f), "vertices are not an array of numbers"),
        (lambda v, f: (v, np.array([[0, 0, 1]])), "every face names a vertex twice"),
        (lambda v, f: (v * [1, 1, 0], f), "it encloses no volume"),
    ],
)
def test_unusable_meshes_are_refused(change, words):
    with pytest.raises(InputError, match=words):
        inspect(*broken(change))


@pytest.mark.parametrize(
    ("nominal", "words"),
    [
        (GearNominal(number_of_teeth=20, normal_module_mm=-2.0), "normal_module_mm is -2.0"),
        (GearNominal(number_of_teeth=20, normal_module_mm=2.0, accuracy_class=12), "accuracy_class is 12"),
        (PolygonNominal(number_of_sides=1, across_flats_mm=17.0), "number_of_sides is 1"),
        (
            PolygonNominal(number_of_sides=6, across_flats_mm=17.0, tolerance="js9"),
            "tolerance 'js9' is unknown",
        ),
    ],
)
def test_impossible_nominals_are_refused(nominal, words):
    with pytest.raises(InputError, match=words):
        inspect(*broken(lambda v, f: (v, f)), nominal)


SHAPES = {
    "sphere": lambda: m3.Manifold.sphere(10, 32),
    "tetrahedron": m3.Manifold.tetrahedron,
    "bar beside the axis": lambda: m3.Manifold.cylinder(20, 5, 5, 64).translate((30, 0, 0)),
    "cone": lambda: m3.Manifold.cylinder(20, 8, 3, 64),
    "speck": lambda: m3.Manifold.cube((1e-3, 1e-3, 1e-3), True),
    "box askew": lambda: m3.Manifold.cube((30, 20, 10), True).rotate((30, 20, 10)),
    "flat box": lambda: m3.Manifold.cube((30, 20, 10), True),
    "ring of boxes": lambda: m3.Manifold.batch_boolean(
        [m3.Manifold.cube((10, 4, 10), True).translate((8, 0, 0)).rotate((0, 0, 40.0 * k)) for k in range(9)],
        m3.OpType.Add,
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_any_closed_mesh_ends_in_a_result(shape):
    mesh = mesh_of(SHAPES[shape]())
    result = inspect(*mesh)
    json.dumps(to_json(result), allow_nan=False)
    assert deviation_map(*mesh, result).shape == (len(mesh[0]),)


def test_keys_of_the_result(spur, named):
    values = to_json(inspect(*spur, named(accuracy_class=8)))
    wanted = {
        "kind", "number_of_teeth", "normal_module", "helix_angle_deg", "hand", "tip_diameter_mm",
        "root_diameter_mm", "span_teeth", "span_mm", "pin_diameter_mm", "over_pins_mm", "flanks", "runout_um",
        "accuracy_class", "verdict",
    }  # fmt: skip
    assert wanted <= values.keys()
    flank = {
        "profile_slope_um", "profile_form_um", "profile_total_um", "helix_slope_um", "helix_form_um",
        "helix_total_um", "single_pitch_um", "cumulative_pitch_um",
    }  # fmt: skip
    assert flank <= values["flanks"]["left"].keys() & values["flanks"]["right"].keys()
    for key, value in values.items():
        assert value is not None or key in values["unmeasured"] or key == "lead_mm", key
    json.dumps(values, allow_nan=False)
