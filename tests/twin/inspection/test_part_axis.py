"""A part that stands off Z and leans: its axis is found by bore or tips, taken out, and reported."""

import math

import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.result import Verdict


def displaced(tooth, side, roll, z):
    return np.full_like(roll, side * 0.006 if tooth == 3 else 0.0)


CASES = [
    # helix, bore, offset, tilt, towards
    (0.0, 12.0, (0.06, 0.08), 0.1, 30.0),
    (0.0, 0.0, (0.06, -0.08), 0.1, 200.0),
    (15.0, 12.0, (-0.1, 0.0), 0.05, 90.0),
    (-15.0, 0.0, (0.0, 0.1), 0.1, 300.0),
]


@pytest.mark.parametrize(("helix", "bore", "offset", "tilt", "towards"), CASES)
def test_axis_is_found_taken_out_and_reported(parts, named, helix, bore, offset, tilt, towards):
    step = {"z_step": 0.5, "roll_step": 0.1} if helix else {"z_step": 10.0, "roll_step": 0.05}
    mesh = parts.gear_mesh(teeth=20, module=2.0, helix_deg=helix, bore=bore, error=displaced, **step)
    askew = parts.moved(mesh, offset=offset, tilt_deg=tilt, towards_deg=towards)
    nominal = named(helix_deg=helix, accuracy_class=6)
    result = inspect(*askew, nominal, own_axis=True)
    axis = result.axis
    assert axis.datum == ("bore" if bore else "tip circle")
    tip = 40 / math.cos(math.radians(helix)) + 4
    assert axis.diameter_mm == pytest.approx(bore or tip, abs=1e-6)
    assert axis.tilt_deg == pytest.approx(tilt, abs=1e-6)
    lean = math.tan(math.radians(tilt))
    x = offset[0] + axis.at_z_mm * lean * math.cos(math.radians(towards))
    y = offset[1] + axis.at_z_mm * lean * math.sin(math.radians(towards))
    assert (axis.x_mm, axis.y_mm) == pytest.approx((x, y), abs=1e-6)
    assert axis.offset_mm == pytest.approx(math.hypot(x, y), abs=1e-6)
    assert math.tan(math.radians(axis.tilt_x_deg)) == pytest.approx(
        lean * math.cos(math.radians(towards)), abs=1e-8
    )
    straight = inspect(*mesh, nominal)
    assert straight.axis is None
    assert result.verdict is straight.verdict is Verdict.IN
    for side in ("left", "right"):
        one, other = getattr(result.gear, side), getattr(straight.gear, side)
        for item in ("profile_slope", "profile_form", "helix_slope", "helix_form", "cumulative_pitch"):
            assert getattr(one, f"{item}_um") == pytest.approx(getattr(other, f"{item}_um"), abs=0.05)
        assert one.profile_total_um < 0.15
        assert one.helix_total_um < 0.15
    # left as it stands, it is out
    assert inspect(*askew, nominal).verdict is Verdict.OUT


def test_a_bore_beside_the_teeths_axis_is_the_datum(parts, named):
    """The bore stands 20 µm beside the axis of the teeth, towards a gap: about it they run out by 2 e."""
    vertices, faces = parts.gear_mesh(teeth=20, module=2.0, bore=12.0, z_step=10.0, roll_step=0.05)
    inner = np.hypot(vertices[:, 0], vertices[:, 1]) < 6.5
    x, y = 0.02 * math.cos(math.radians(9.0)), 0.02 * math.sin(math.radians(9.0))
    vertices[inner, :2] += (x, y)
    result = inspect(vertices, faces, named(), own_axis=True)
    assert result.axis.datum == "bore"
    assert (result.axis.x_mm, result.axis.y_mm) == pytest.approx((x, y), abs=1e-6)
    assert result.gear.runout_um == pytest.approx(40.0, rel=0.01)
    assert inspect(vertices, faces, named()).gear.runout_um < 0.1


def test_a_keyway_does_not_move_the_bore(parts, named):
    """A groove of 30° in the wall of the bore."""
    vertices, faces = parts.gear_mesh(teeth=20, module=2.0, bore=12.0, z_step=10.0, roll_step=0.1)
    radius, angle = np.hypot(vertices[:, 0], vertices[:, 1]), np.arctan2(vertices[:, 1], vertices[:, 0])
    groove = (radius < 6.5) & (np.abs(angle) < math.radians(15))
    vertices[groove, :2] *= 7.5 / 6.0
    askew = parts.moved((vertices, faces), offset=(0.06, 0.08))
    axis = inspect(*askew, named(), own_axis=True).axis
    assert axis.datum == "bore"
    assert (axis.x_mm, axis.y_mm) == pytest.approx((0.06, 0.08), abs=1e-6)


def test_polygon_by_its_corners(parts):
    mesh = parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=3, sides=6)
    askew = parts.moved(mesh, offset=(0.06, 0.08), tilt_deg=0.1, towards_deg=77.0, about_z=-10.0)
    result = inspect(*askew, own_axis=True)
    assert result.axis.datum == "corners"
    along = math.tan(math.radians(0.1)) * (result.axis.at_z_mm + 10.0)
    assert result.axis.x_mm == pytest.approx(0.06 + along * math.cos(math.radians(77.0)), abs=1e-6)
    assert result.axis.y_mm == pytest.approx(0.08 + along * math.sin(math.radians(77.0)), abs=1e-6)
    assert result.axis.tilt_deg == pytest.approx(0.1, abs=1e-5)
    assert result.polygon.across_flats_mm == pytest.approx(17.0, abs=1e-4)
    assert result.polygon.concentricity_um < 0.01
    # about Z the faces' axis runs out by what it stands off and leans, over the height they are read
    found = inspect(*askew).polygon
    along = math.tan(math.radians(0.1)) * (sum(found.range_mm) / 2 + 10.0)
    turn = math.radians(77.0)
    off = math.hypot(0.06 + along * math.cos(turn), 0.08 + along * math.sin(turn))
    assert found.concentricity_um == pytest.approx(2000 * off, rel=0.01)


def test_nothing_to_find_an_axis_by(parts):
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    ring = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle)])
    bar = parts.loft([np.column_stack([ring, np.full(200, z)]) for z in np.linspace(-20, 0, 5)])
    result = inspect(*bar, own_axis=True)
    assert result.kind is None
    assert result.reason.startswith("no bore and no tips to find an axis by: a round part")
