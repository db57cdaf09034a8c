"""What the kernel is timed against is the same cut, pass by pass."""

import json

import numpy as np
import pytest

from twin.benchmark import kernel, naive
from twin.benchmark.cases import CASES, gear_case, hexagon_case
from twin.cli.main import main
from twin.cutting.field import DepthField


@pytest.mark.parametrize(
    "case", [gear_case(module=2.0, teeth=12, width=2.0, helix_deg=15.0, hob_diameter=50.0), hexagon_case()]
)
def test_sweeps_hold_what_their_pass_removes(case):
    """A point well inside what a tooth sweeps has that pass's depth, and one well outside of all has none."""
    field = DepthField(case.cutter, case.motion, case.blank.radius, case.blank.z_range)
    index = field.passes.count // 2
    sweeps = [naive._sweep(case, field, index, int(t)) for t in np.unique(field.tooth)]
    sweeps = [s for s in sweeps if s is not None]
    assert sweeps
    rng = np.random.default_rng(2)
    r, angle = case.blank.radius * np.sqrt(rng.random(3000)), 2 * np.pi * rng.random(3000)
    z = case.blank.z_range[0] * rng.random(3000)
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    depth = field.evaluate(points, np.full(3000, index)).depth
    root = case.cutter.profile.root
    sure = points[depth > 0.02]
    held = np.zeros(len(sure), dtype=bool)
    for sweep in sweeps:
        mesh = sweep.to_mesh64()
        held |= _inside(np.array(mesh.vert_properties), np.array(mesh.tri_verts, dtype=int), sure)
    # the naive way leaves out the land between the teeth
    assert len(sure) > 5
    assert held.mean() > (0.95 if np.isfinite(root) else 0.99)


def _inside(vertices, faces, points):
    """Whether points lie in a closed mesh, by the solid angle of its triangles."""
    total = np.zeros(len(points))
    for corners in vertices[faces]:
        a, b, c = (corner - points for corner in corners)
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        above = np.einsum("nx,nx->n", a, np.cross(b, c))
        below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        total += 2.0 * np.arctan2(above, below)
    return np.abs(total) > 2 * np.pi


def test_a_line_of_json_with_all_figures(capsys, monkeypatch):
    small = gear_case(module=1.0, teeth=12, width=0.6, hob_diameter=30.0)
    monkeypatch.setitem(CASES, "small", lambda: small)
    monkeypatch.setattr(kernel, "naive_seconds", lambda case, _share: 12.5 if case is small else 0.0)
    monkeypatch.setattr(kernel, "boolean_seconds", lambda: 0.5)
    assert main(["bench", "kernel", "--case", "small"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["case"] == "small"
    assert figures["naive_is"] == "extrapolated from 2 turns"
    assert figures["naive_s"] == 12.5
    assert figures["boolean_s"] == 0.5
    assert figures["kernel_s"] > 0
    assert figures["triangles"] > 1000
    assert figures["peak_mib"] > 10
    assert 0 <= figures["max_error_um"] < 0.1
    assert figures["method"].startswith("regular")


def test_an_unknown_case_is_refused(capsys):
    assert main(["bench", "kernel", "--case", "cube"]) == 2
    assert "valid: spur_m2_z20_b20" in capsys.readouterr().err
