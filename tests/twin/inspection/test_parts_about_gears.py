"""What stands about a gear, or is wrong with some of its teeth, leaves the figures of the others alone."""

import manifold3d as m3
import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.involute import geometry
from twin.inspection.result import Verdict


def solid(mesh):
    vertices, faces = mesh
    return m3.Manifold(
        m3.Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(faces).astype(np.uint64))
    )


def mesh_of(manifold):
    mesh = manifold.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)


def bar(diameter, low, high, points=256):
    return m3.Manifold.cylinder(high - low, diameter / 2, diameter / 2, points).translate((0, 0, low))


def block(size, at):
    return m3.Manifold.cube(size, True).translate(at)


@pytest.fixture(scope="module")
def spur(parts):
    return solid(parts.gear_mesh(teeth=20, module=2.0, width=20.0, z_step=20.0, roll_step=0.2))


def small(flank):
    return max(flank.profile_total_um, flank.helix_total_um, flank.cumulative_pitch_um)


ABOUT = {
    "hubs": lambda: bar(24, -35, -10) + bar(20, -10, 9),
    "a hub wider than the root": lambda: bar(41, -30, -20) + bar(20, -21, 1),
    "a hub just inside the root": lambda: bar(34.4, -30, -10),
    "a collar": lambda: bar(52, -25, -20) + bar(20, -21, 1),
    "collars": lambda: bar(52, -25, -20) + bar(60, 0, 6) + bar(20, -21, 1),
    "a long shaft": lambda: bar(18, -150, 120),
}


@pytest.mark.parametrize("about", ABOUT)
def test_face_between_hubs_collars_and_shafts(spur, named, about):
    """All of the face is measured, and the gear is whole."""
    result = inspect(*mesh_of(spur + ABOUT[about]()), named(accuracy_class=6), own_axis=True)
    gear = result.gear
    assert result.verdict is Verdict.IN
    assert gear.teeth_range_mm == pytest.approx((-20.0, 0.0), abs=1e-6)
    assert gear.tip_diameter_mm == pytest.approx(44.0, abs=1e-4)
    assert gear.root_diameter_mm == pytest.approx(35.0, abs=2e-3)
    assert gear.span_mm == pytest.approx(geometry(named()).span(3), abs=3e-4)
    assert result.axis.offset_mm < 1e-6
    assert small(gear.left) < 0.2
    assert small(gear.right) < 0.2


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_thin_gear_on_a_long_shaft(parts, named, helix_deg):
    gear = parts.gear_mesh(teeth=20, module=2.0, width=5.0, helix_deg=helix_deg, z_step=0.5, roll_step=0.2)
    result = inspect(*mesh_of(solid(gear) + bar(18, -150, 60)), named(helix_deg=helix_deg, accuracy_class=6))
    assert result.verdict is Verdict.IN
    assert result.gear.teeth_range_mm == pytest.approx((-5.0, 0.0), abs=1e-6)


def test_of_a_cluster_the_gear_that_is_named(parts, spur, named):
    other = solid(parts.gear_mesh(teeth=30, module=2.0, width=10.0, z_step=10.0, roll_step=0.2))
    mesh = mesh_of(spur + other.translate((0, 0, -30)) + bar(18, -60, 20))
    for teeth, low, high in ((20, -20.0, 0.0), (30, -40.0, -30.0)):
        result = inspect(*mesh, named(teeth=teeth, accuracy_class=6))
        assert result.verdict is Verdict.IN
        assert result.gear.teeth_range_mm == pytest.approx((low, high), abs=1e-6)
        assert f"{50 - teeth} teeth or flats stand about z = " in result.findings[-1]
    assert inspect(*mesh).gear.number_of_teeth == 20


def test_a_gear_with_a_hexagon(spur, named):
    key = m3.Manifold.cylinder(60, 10, 10, 6).translate((0, 0, -60))
    result = inspect(*mesh_of(spur + key), named(accuracy_class=6))
    assert result.verdict is Verdict.IN
    assert result.gear.number_of_teeth == 20


@pytest.mark.parametrize("helix_deg", [3.0, 30.0])
def test_double_helix_is_named(parts, named, helix_deg):
    half = solid(parts.gear_mesh(teeth=20, module=2.0, width=10.0, helix_deg=helix_deg, roll_step=0.5))
    mesh = mesh_of(half + half.mirror((0, 0, 1)))
    for nominal in (None, named(helix_deg=helix_deg)):
        result = inspect(*mesh, nominal)
        assert result.kind is None
        assert "20 teeth turn one way up to z = 0 mm and the other way" in result.reason


def test_a_missing_tooth_is_named(spur, named):
    tooth = block((12, 5, 40), (20, 0, -10)) ^ (bar(70, -30, 10) - bar(34.9, -40, 20, 512))
    result = inspect(*mesh_of(spur - tooth), named(accuracy_class=6))
    assert result.kind is None
    assert result.verdict is Verdict.OUT
    assert "in regular steps but for 1 that is missing" in result.reason


def test_a_damaged_tooth_is_named(spur, named):
    nick = m3.Manifold.sphere(0.4, 32).translate((20, 1.7, -10))
    result = inspect(*mesh_of(spur - nick), named(accuracy_class=6))
    assert result.verdict is Verdict.OUT
    assert result.findings[0].startswith("tooth 1 is damaged: its left flank strays ")
    assert small(result.gear.left) > 200
    assert small(result.gear.right) < 0.2


def test_a_broken_tooth_is_named(spur, named):
    result = inspect(*mesh_of(spur - block((2, 2, 3), (22, 0, -10))), named(accuracy_class=6))
    assert result.verdict is Verdict.OUT
    assert "of tooth 1 is not all there" in result.findings[0]
    assert result.gear.left.profile_total_um is None


def test_pitch_of_one_side_alone_holds_no_class(spur, named):
    """A left flank that is gone at mid-face: the right ones alone are no gear."""
    gone = block((3, 2, 3), (20, 2.1, -10))
    result = inspect(*mesh_of(spur - gone), named(accuracy_class=6))
    assert result.verdict is Verdict.OUT
    assert "tooth 1" in " ".join(result.findings)


@pytest.mark.parametrize("helix_deg", [20.0, -45.0])
def test_span_of_a_wide_helical_gear(parts, named, helix_deg):
    """Far from where jaws touch, the teeth have turned away, and through the planes of the jaws."""
    mesh = parts.gear_mesh(
        teeth=12, module=2.0, shift=0.3, helix_deg=helix_deg, width=60.0, z_step=0.4, roll_step=0.3
    )
    nominal = named(teeth=12, shift=0.3, helix_deg=helix_deg)
    gear = inspect(*mesh, nominal).gear
    ideal = geometry(nominal)
    assert gear.span_mm == pytest.approx(ideal.span(ideal.span_teeth()), abs=5e-4)


@pytest.mark.parametrize("teeth", [5, 9, 13])
def test_undercut_is_said_where_it_is(parts, named, teeth):
    """The rack would undercut these: one mesh is, the other goes on to the base circle."""
    words = {"teeth": teeth, "module": 2.0, "z_step": 20.0, "roll_step": 0.05}
    plain, cut = (inspect(*parts.gear_mesh(**words, trochoid=t), named(teeth=teeth)) for t in (False, True))
    assert (plain.gear.undercut, cut.gear.undercut) == (False, True)
    assert not any("undercut" in words for words in plain.findings)
    assert any("undercut" in words for words in cut.findings)


BORES = {
    "steps": lambda: bar(12, -21, 1) + bar(20, -8, 1) + bar(24, -3, 1),
    "a groove": lambda: bar(12, -21, 1) + bar(18, -12, -8),
    "a keyway": lambda: bar(12, -21, 1) + block((4, 8, 30), (0, 5, -10)),
}


@pytest.mark.parametrize("bore", BORES)
def test_axis_of_bores_in_steps(parts, spur, named, bore):
    mesh = parts.moved(
        mesh_of(spur - BORES[bore]()), offset=(0.06, -0.08), tilt_deg=0.1, towards_deg=77.0, about_z=-10.0
    )
    result = inspect(*mesh, named(accuracy_class=6), own_axis=True)
    assert (result.axis.datum, result.verdict) == ("bore", Verdict.IN)
    assert result.axis.diameter_mm == pytest.approx(12.0, abs=1e-5)
    assert result.axis.tilt_deg == pytest.approx(0.1, abs=1e-5)
    assert result.axis.roundness_um < 0.01
    assert small(result.gear.left) < 0.2
