"""A faulty hob's gear by the quick way and by the general one, both against the rigid hob itself."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.regular.irregular import IrregularError

sys.path.insert(0, str(Path(__file__).parent))

CELL = 0.14
GASHES = 8
HOB = 40.0
CASES = {
    "wobble": {"wobble": 0.03},
    "gashes and lead": {"gashes": [0.0, 0.1, 0.0, -0.2, 0.0, 0.0, 0.15, 0.0], "lead": 15.0},
    "all at once": {
        "wobble": 0.03, "runout": 0.02, "gashes": [0.0, 0.1, 0.0, -0.2, 0.0, 0.0, 0.15, 0.0], "lead": 15.0,
        "step": 4.0,
    },
}  # fmt: skip
"""`step` [deg]: a motion is linear between its samples, so that a place that circles at e stands up to
e (1 - cos(step / 2)) off the circle; with runout and wobble at 8 degrees that is 0.12 um of 0.1."""


def refused(*_, **__):
    raise IrregularError("the sake of a comparison")


@pytest.mark.parametrize("name", CASES)
def test_both_ways_leave_what_a_rigid_hob_leaves(name, hobbed, brute_force, monkeypatch):
    from rigid_hob import deepest
    from test_hob_on_its_arbor import turned

    case = CASES[name]
    wobble, runout, longer = case.get("wobble", 0.0), case.get("runout", 0.0), case.get("lead", 0.0) / 1e3
    errors, helix = case.get("gashes", [0.0] * GASHES), case.get("helix", 0.0)
    settings = {
        "teeth": 12, "length": 0.8, "feed": 2.0, "gashes": GASHES, "hob": HOB, "helix": helix, "over": 17.0,
        "step_deg": case.get("step", 8.0),
    }  # fmt: skip
    gear = hobbed(
        f"hob_runout_mm = {runout}\nhob_runout_angle_deg = 70.0\nhob_wobble_mm = {wobble}\n"
        f"hob_wobble_angle_deg = 200.0\nhob_gash_error_deg = {errors}\n"
        f"hob_lead_error_um_per_turn = {1e3 * longer}",
        **settings,
    )
    clean = hobbed(**settings)
    tip = gear.gear.tip_diameter
    blank = Blank(diameter_mm=tip, length_mm=0.8, bore_mm=0.4 * tip)
    tools = ((gear.cutter, gear.motion),)
    one = cut(blank, tools, cell_mm=CELL)
    monkeypatch.setattr("twin.cutting.cut.regular_cut", refused)
    other = cut(blank, tools, cell_mm=CELL)
    assert one.method.startswith("regular")
    assert other.method.startswith("general")
    removed = [r.remains.blank_volume_mm3 - r.remains.volume_mm3 for r in (one, other)]
    assert removed[0] == pytest.approx(removed[1], rel=2e-3)

    outlines, pitch, _ = brute_force.hob_outlines(
        module=2.0, outside_diameter=HOB, starts=1, pressure_angle=20.0, addendum=1.25, tip_radius=0.38,
        dedendum=1.25,
    )  # fmt: skip
    outlines = [line + np.array([k * longer, 0.0]) for line, k in zip(outlines, (-1, 0, 1, 0), strict=True)]
    pitch += longer
    gashes = [
        (2 * math.pi * k / GASHES + math.radians(error), pitch * k / GASHES) for k, error in enumerate(errors)
    ]
    lean = math.radians(200.0)
    arbor = (
        turned([-math.sin(lean), math.cos(lean), 0.0], math.atan(wobble / (HOB / 2.0))),
        runout * np.array([math.cos(math.radians(70.0)), math.sin(math.radians(70.0)), 0.0]),
    )
    rng = np.random.default_rng(3)
    for result in (one, other):
        assert result.largest_error_um < 0.1
        assert result.remains.genus == 1
        v = result.remains.vertices
        r, z = np.hypot(v[:, 0], v[:, 1]), v[:, 2]
        cut_there = (r > 0.2 * tip + 1e-2) & (r < tip / 2 - 1e-2) & (z < -1e-3) & (z > -0.8 + 1e-3)
        for point in v[rng.choice(np.flatnonzero(cut_there), 3, replace=False)]:
            assert abs(deepest(point, clean.motion, gashes, arbor, outlines, pitch)) < 1e-4
