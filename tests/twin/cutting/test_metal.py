"""What is gone when a bite comes, against every earlier bite asked one by one."""

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.blocks import COARSEST, Blocks
from twin.cutting.cells import Cells, points
from twin.cutting.fields import tool_field
from twin.cutting.metal import Metal
from twin.cutting.sweep import Sweep


@pytest.mark.parametrize(("along", "count"), [(1.0 / COARSEST, 2), (0.03, 5)])
def test_what_is_gone_is_known_up_to_both_sides_of_a_slab(synthetic, along, count):
    """Also where a side seems to lie below the slab by rounding, as -2 + 16/67 * 2 does."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    blank = Blank(diameter_mm=24.0, length_mm=2.0, bore_mm=14.0)
    cutter, motion = synthetic.hobbing(hob, teeth=10, tip_x=7.5, z=(2.0, -4.0), feed=2.0, step_deg=6.0)
    sweep = Sweep((tool_field(cutter, motion, 14.0, blank.z_range),))
    cells = Cells.of(blank, 0.2, around=0.2, along=along)
    slabs = list(cells.slabs())
    assert len(slabs) == count
    rng = np.random.default_rng(0)
    n = 60
    at = np.column_stack([rng.uniform(8.0, 12.0, n), rng.uniform(0.0, 6.0, n), np.zeros(n)])
    bite = rng.integers(sweep.count // 3, sweep.count, n)
    until = sweep.pass_begin(bite)
    for low in slabs:
        blocks = Blocks.of(sweep, cells.grid, low)
        metal = Metal(sweep, blank, blocks)
        at[:, 2] = np.mean(blocks.z_range)
        for way in (1.0, -1.0):
            # up to the slab's side, where the climbing ends
            new = metal.moved(at, np.broadcast_to([0.0, 0.0, way], at.shape))
            assert np.allclose(new[:, 2], max(blocks.z_range) if way > 0 else min(blocks.z_range))
            gone = metal.gone(bite, new, np.repeat(metal.rows(new)[:, None], 2, axis=1)) > 0
            where = points(new)
            every = [
                (sweep.evaluate(np.repeat(where[i : i + 1], last, axis=0), np.arange(last)).depth > 0).any()
                for i, last in enumerate(until)
            ]
            np.testing.assert_array_equal(gone, every)
            assert 10 < sum(every) < n
