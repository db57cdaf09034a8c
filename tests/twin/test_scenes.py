"""Every scene from the command line to its result folder, at a coarser grid, against closed forms.

Spur and helical gears: geometry.md 1 and 2; polygons: geometry.md 3.
"""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

from twin.cli import main

SCENES = Path(__file__).parents[2] / "scenes"
FEED_MARK = 2.0**2 * math.sin(math.radians(20)) / (4 * 70) * 1e3
"""delta_x = f_a² sin alpha_n / (4 d_a0) [µm], 4.89"""
FLAT = math.pi**2 * 2.0 * math.sin(math.radians(20)) / (4 * 20 * 12**2) * 1e3
"""delta_y at the pitch point [µm], 0.586"""
ALLOWED = FEED_MARK + FLAT + 4.0
"""What a flank cut with ideal axes may stand off the involute: theory and 4 µm for the mesh."""


def run(tmp_path, scene, *options):
    out = tmp_path / scene
    code = main(["run", str(SCENES / scene), "--out", str(out), "--quiet", *options])
    found = json.loads((out / "inspection.json").read_text(encoding="utf-8"))
    return code, found, out


def all_files(out):
    return sorted(path.name for path in out.iterdir())


@pytest.mark.parametrize(
    ("scene", "helix", "hand"),
    [
        ("spur_m2_z20", 0.0, "spur"),
        ("helical_m2_z20_right", 20.0, "right"),
        ("helical_m2_z20_left", -20.0, "left"),
    ],
)
def test_a_gear_scene_cuts_the_gear_it_names(tmp_path, scene, helix, hand):
    code, found, out = run(tmp_path, scene, "--ideal", "--cell-mm", "0.22")
    assert code == 0
    assert found["kind"] == "gear"
    assert found["verdict"] == "in"
    assert found["number_of_teeth"] == 20
    assert found["hand"] == hand
    assert found["helix_angle_deg"] == pytest.approx(helix, abs=0.01)
    pitch = 40.0 / math.cos(math.radians(helix))
    assert found["root_diameter_mm"] == pytest.approx(pitch - 5.0, abs=0.004 + 2 * 0.0143)
    assert found["tip_diameter_mm"] == pytest.approx(pitch + 4.0, abs=0.002)
    for flank in found["flanks"].values():
        assert 0 < flank["profile_total_um"] < ALLOWED
        assert 0 < flank["helix_total_um"] < ALLOWED
    assert all_files(out) == [
        "alarms.json",
        "inspection.json",
        "part.3mf",
        "part.glb",
        "part.stl",
        "provenance.json",
        "recording.npz",
        "report.html",
    ]
    part = trimesh.load_mesh(out / "part.stl")
    assert part.is_watertight
    assert part.bounds[:, 2] == pytest.approx([-20, 0], abs=1e-5)


@pytest.mark.parametrize(
    ("scene", "sides", "flats", "bow", "corners", "code"),
    [
        ("hexagon_af17", 6, 17.0, 13.04, 19.600, 0),
        ("hexagon_af17_original", 6, 17.0, -82.97, 19.822, 1),
        ("square_af10", 4, 10.0, 8.63, 14.118, 0),
    ],
)
def test_a_polygon_scene_cuts_the_faces_of_its_ratio(tmp_path, scene, sides, flats, bow, corners, code):
    found_code, found, _ = run(tmp_path, scene, "--ideal", "--cell-mm", "0.15")
    assert found_code == code
    assert found["number_of_sides"] == sides
    assert found["across_flats_mm"] == pytest.approx(flats, abs=0.001)
    assert found["bow_um"] == pytest.approx(bow, rel=0.05)
    assert found["across_corners_mm"] == pytest.approx(corners, abs=0.005)
    caliper = flats + 2e-3 * max(-bow, 0.0)
    assert found["across_flats_caliper_mm"] == pytest.approx(caliper, abs=0.005)
    assert found["twist_deg_per_mm"] == pytest.approx(0.0, abs=1e-3)


def test_a_hob_shifted_without_its_turn_of_the_work_cuts_another_helix(tmp_path):
    """6 mm of Y over 56 mm of Z without the turn that belongs to them: the teeth lie on another helix."""
    code, found, _ = run(tmp_path, "inclined_shift_uncompensated", "--ideal", "--cell-mm", "0.4")
    assert code == 1
    assert found["verdict"] == "out"
    assert any("instead of 20°" in finding for finding in found["findings"])


def test_the_ratio_of_the_manual_is_named_as_the_cause(tmp_path):
    """P2 Q6 with two inserts: concave faces, a caliper reads 17 + 2 bow."""
    code, found, out = run(tmp_path, "hexagon_af17_original", "--ideal", "--cell-mm", "0.2")
    assert code == 1
    assert found["verdict"] == "out"
    assert any("concave" in finding for finding in found["findings"])
    assert "concave" in (out / "report.html").read_text(encoding="utf-8")


def test_the_wrong_hand_destroys_the_teeth(tmp_path):
    code, found, out = run(tmp_path, "wrong_hand", "--ideal", "--cell-mm", "0.3")
    assert code == 1
    assert found["kind"] is None
    assert found["verdict"] == "out"
    # the teeth are really gone: no more than a third of the ring between root and tip is left
    part = trimesh.load_mesh(out / "part.stl")
    ring = math.pi * (22**2 - 17.5**2) * 20
    core = math.pi * (17.5**2 - 6**2) * 20
    assert 0 < part.volume - core < ring / 3


def test_a_feed_that_stops_halfway_leaves_the_run_out_of_the_hob(tmp_path):
    """Behind the end of the feed the gaps rise along the hob's outside circle."""
    code, found, out = run(tmp_path, "stopped_halfway", "--ideal", "--cell-mm", "0.2")
    assert code == 1
    assert found["verdict"] == "out"
    points = trimesh.load_mesh(out / "part.stl").vertices
    r = np.hypot(points[:, 0], points[:, 1])
    # swivelled by its lead angle, the hob's circle is an ellipse in the gap's plane: 35 cos(1.76°) is 17 µm
    for low, high in [(-9.0, -2.0), (-13.0, -12.4), (-16.0, -15.4), (-19.0, -18.4)]:
        here = (points[:, 2] > low) & (points[:, 2] < high) & (r > 10)
        z = np.minimum(points[here, 2], -10.0)
        floor = 17.5 + 35.0 - np.sqrt(35.0**2 - (z + 10.0) ** 2)
        above = r[here] - floor
        assert above.min() > -0.002
        assert above.min() < 0.03


def test_servo_drives_and_ideal_axes_cut_the_same_hexagon(tmp_path):
    """Settled drives with full feed-forward lag by nothing: less than 2 µm across flats remain."""
    code, found, out = run(tmp_path, "hexagon_af17", "--cell-mm", "0.2")
    assert code == 0
    assert found["across_flats_mm"] == pytest.approx(17.0, abs=0.002)
    assert found["bow_um"] == pytest.approx(13.04, rel=0.05)
    with np.load(out / "recording.npz") as recording:
        assert np.allclose(np.diff(recording["time_s"]), 1e-3)
        error = recording["actual_C"] - recording["setpoint_C"]
        assert 0 < np.abs(error).max() < 0.5


def test_the_recording_tells_where_the_tool_was_in_the_turning_part(tmp_path):
    """From axes and set-up by hand: centre at radius X/2 + R turned back by the work angle."""
    _, _, out = run(tmp_path, "square_af10", "--ideal", "--cell-mm", "0.3")
    with np.load(out / "recording.npz") as recording:
        work = np.radians(recording["actual_C"])
        radius = recording["actual_X"] + 400.0 / 2 + 40.0
        expected = np.column_stack(
            [radius * np.cos(-work), radius * np.sin(-work), recording["actual_Z"] + 300.0]
        )
        assert np.allclose(recording["tool_centre_mm"], expected, atol=1e-9)
        assert np.allclose(recording["tool_axis"], [0, 0, 1], atol=1e-12)
        assert np.array_equal(recording["work_angle_deg"], recording["actual_C"])
        assert np.array_equal(recording["tool_angle_deg"], recording["actual_Y"])
        turned = np.column_stack([-np.cos(-work), -np.sin(-work), 0 * work])
        assert np.allclose(recording["tool_zero"], turned, atol=1e-9)
        assert recording["sync"].any()
        assert not recording["sync"].all()
        assert recording["blocks"][recording["block"][-1]][2].startswith("N0")
