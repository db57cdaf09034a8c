"""Steady hobbing: templates that stand for their images under the screw, and motions that leave the screw."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rays import deepest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.engagement import StockCylinder
from twin.cutting.field import DepthField
from twin.cutting.fields import tool_field
from twin.cutting.motion import CutterMotion
from twin.cutting.regular import proved, regular
from twin.cutting.regular.indexing import find_indexing
from twin.cutting.regular.screw import lay_out
from twin.cutting.regular.steady import find_steady
from twin.cutting.sweep import Sweep

FACE = 1.6
CELL = 0.08
FEED = 0.3


def gear(synthetic, *, teeth=12, helix_deg=0.0, hob=None, **more):
    """Blank and tool of a gear of module 1 and full depth, with a feed of which the face holds several."""
    hob = hob or Hob(normal_module_mm=1.0, outside_diameter_mm=30.0, gashes=9)
    reference = teeth / math.cos(math.radians(helix_deg))
    run = math.sqrt(2.25 * hob.outside_diameter_mm) + 3.0
    run += 2.0 * abs(math.tan(math.radians(helix_deg))) * math.sqrt(teeth)
    tool = synthetic.hobbing(
        hob,
        teeth=teeth,
        helix_deg=helix_deg,
        tip_x=reference / 2.0 - 1.25,
        z=(run, -FACE - run),
        feed=FEED,
        step_deg=8.0,
        **more,
    )
    return Blank(diameter_mm=reference + 2.0, length_mm=FACE, bore_mm=0.3 * reference), tool


def steady_of(blank, tool, limit=0.01):
    cutter, motion = tool
    field = DepthField(cutter, motion, blank.radius, blank.z_range)
    stock = StockCylinder.around(motion.mount, blank.radius, blank.z_range)
    indexing = find_indexing(cutter, motion, stock.radius)
    return field, indexing, stock, find_steady(field, motion, indexing, stock, limit)


@pytest.fixture
def shown(monkeypatch):
    """Strips, how many of them were taken for images, and how many had passes near that do not repeat."""
    seen = []

    def spied(*args, passes, **rest):
        found = MATTER(*args, passes=passes, **rest)
        near = sum(any(len(numbers) for numbers in tools) for tools in passes)
        seen.append((len(found), int((~found).sum()), near))
        return found

    monkeypatch.setattr(proved, "matter", spied)
    return seen


MATTER = proved.matter


def quick(blank, tool):
    z = -blank.length_mm - 1.0, 1.0
    field = tool_field(*tool, blank.radius + 1.0, z)
    return regular.regular_cut(blank, (tool,), Sweep((field,)), cell_mm=CELL)


def off_envelope(blank, tool, made):
    """Largest distance of vertices in the blank from all passes, without image, tile or bound [mm]."""
    field = DepthField(*tool, blank.radius + 1.0, (-FACE - 1.0, 1.0))
    points = made.surface.vertices
    inside = points[blank.contains(points)]
    chosen = np.random.default_rng(1).choice(inside, 150, replace=False)
    return np.abs(deepest(field, chosen)[0]).max()


def jittered(tool, synthetic):
    cutter, motion = tool
    rng = np.random.default_rng(4)
    return cutter, synthetic.jittered(motion, rng, slide=2e-4, work=1e-5, tool=2e-5)


def on_a_bent_arbor(tool, _):
    """The hob's middle runs round a circle."""
    cutter, motion = tool
    turned = 0.02 * (np.cos(motion.tool_angle)[:, None] * motion.basis[0])
    turned += 0.02 * (np.sin(motion.tool_angle)[:, None] * motion.basis[1])
    return cutter, replace(motion, centre=motion.centre + turned)


FAMILY = {
    "spur": {},
    "right-hand": {"helix_deg": 20.0},
    "left-hand": {"helix_deg": -12.0, "teeth": 13},
    "two starts, two orbits": {
        "teeth": 14,
        "hob": Hob(normal_module_mm=1.0, outside_diameter_mm=40.0, starts=2, gashes=10),
    },
    "helical gashes": {
        "helix_deg": 8.0,
        "hob": Hob(normal_module_mm=1.0, outside_diameter_mm=36.0, gash="helical"),
    },
}
MOUNTS = {
    "as it is": lambda tool, _: tool,
    "servo noise": jittered,
    "bent arbor": on_a_bent_arbor,
    "off its axis": lambda tool, synthetic: (
        tool[0],
        synthetic.clamped(tool[1], eccentricity=0.02, tilt=5e-4),
    ),
}


@pytest.mark.parametrize(
    ("name", "mount"), [*((name, "as it is") for name in FAMILY), *(("spur", m) for m in MOUNTS)]
)
def test_images_stand_where_their_templates_say(name, mount, synthetic, shown):
    blank, tool = gear(synthetic, **FAMILY[name])
    tool = MOUNTS[mount](tool, synthetic)
    made = quick(blank, tool)
    ((strips, images, _),) = shown
    assert images == strips > 2 * FAMILY[name].get("teeth", 12)
    assert off_envelope(blank, tool, made) < 1e-4


def bumped(motion: CutterMotion, high: float) -> CutterMotion:
    """The tool is pushed away from the work for a part of one turn, at mid-face."""
    where = np.exp(-(((motion.centre[:, 2] + 0.5 * FACE) / 0.04) ** 2))
    return replace(motion, centre=motion.centre + high * where[:, None] * [1.0, 0.0, 0.0])


@pytest.mark.parametrize("high", [2e-3, 2e-2])
def test_a_bump_is_in_the_margin_or_cut_by_itself(high, synthetic, shown):
    """Two micrometres pass for an image; twenty do not, and where passes come near them all is searched."""
    blank, (cutter, motion) = gear(synthetic)
    tool = cutter, bumped(motion, high)
    made = quick(blank, tool)
    ((strips, images, near),) = shown
    assert (images == strips) == (high < 1e-2)
    assert (near > 0) == (high > 1e-2)
    assert off_envelope(blank, tool, made) < 1e-4


def test_a_screw_is_what_the_program_says(synthetic):
    for name, options in FAMILY.items():
        blank, tool = gear(synthetic, **options)
        field, indexing, _, steady = steady_of(blank, tool)
        starts = 2 if name.startswith("two starts") else 1
        assert steady.step in (starts, indexing.teeth - starts)
        # the differential of a helical gear turns the work a little faster or slower than the ratio
        assert abs(steady.rise) == pytest.approx(FEED * starts / indexing.teeth, rel=0.02)
        assert steady.per_turn == len(tool[0].gash_angle)
        assert steady.astray < 1e-6
        numbers = [steady.number(float(field.passes.angle[n])) for n in (0, 5, 40, 100)]
        assert numbers == [0, 5, 40, 100]


def test_nodes_of_all_gaps_are_on_the_screw(synthetic):
    """Every cell's corners are what the screw makes of its template's, and no cell is left out."""
    for options in FAMILY.values():
        blank, tool = gear(synthetic, **options)
        _, indexing, stock, steady = steady_of(blank, tool)
        layout = lay_out(indexing, steady, (stock.z_low, stock.z_high), 0.1)
        gap, k = np.indices((indexing.teeth, len(layout.z) - 1))
        turns = layout.later(gap, layout.strip(gap, k))
        home, column = layout.template[gap], layout.column(gap, k)
        rise = layout.z[k] + layout.lift[gap] - layout.z[column] - layout.lift[home]
        np.testing.assert_allclose(rise, turns * steady.rise, atol=1e-9)
        assert ((home + turns * steady.step - gap) % indexing.teeth == 0).all()
        reached = layout.z + layout.lift[:, None]
        assert (reached[:, 0] < stock.z_low).all()
        assert (reached[:, -1] > stock.z_high).all()


def test_no_screw_in_a_motion_that_changes_its_feed(synthetic):
    blank, (cutter, motion) = gear(synthetic)
    z = motion.centre[:, 2]
    centre = motion.centre.copy()
    centre[:, 2] = z + 0.05 * np.sin(z)
    *_, steady = steady_of(blank, (cutter, replace(motion, centre=centre)), limit=1e-4)
    assert steady is None or steady.near[1] - steady.near[0] < 0.5 * len(z) / 45


def test_a_roughing_pass_does_not_hinder(synthetic, shown):
    """Its passes come near every strip, are held against the finishing ones there, and cut nothing more."""
    teeth = 12
    blank, (cutter, motion) = gear(synthetic, teeth=teeth)
    deep, n, back = motion.centre, len(motion.centre), 200
    # out, back and in again, the tool turning on
    high = np.linspace(deep[-1], deep[0], back)
    high[:, 0] += np.interp(np.arange(back), [0, 80, 120, back], [0.15, 15.0, 15.0, 0.0])
    tool_angle = math.radians(8.0) * np.arange(2 * n + back)
    both = replace(
        motion,
        time_s=1e-3 * np.arange(len(tool_angle)),
        tool_angle=tool_angle,
        work_angle=tool_angle / teeth,
        centre=np.concatenate([deep + np.array([0.15, 0.0, 0.0]), high, deep]),
    )
    made = quick(blank, (cutter, both))
    ((strips, images, near),) = shown
    assert near == images == strips
    assert off_envelope(blank, (cutter, both), made) < 1e-4
