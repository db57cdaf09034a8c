"""What is said before any work is done: recordings that are none, cells that cannot be, memory."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.plan import ALLOWED, plan_grid, working_memory
from twin.errors import InputError, PartError

HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
BLANK = Blank(diameter_mm=44.0, length_mm=20.0, bore_mm=12.0)


@pytest.fixture
def tool(synthetic):
    return synthetic.hobbing(HOB, teeth=20, tip_x=17.5, z=(3, -3), feed=3, step_deg=10)


@pytest.mark.parametrize("name", ["time_s", "work_angle", "tool_angle", "centre", "basis"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_recording_that_is_not_finite_is_refused_at_its_sample(tool, name, value):
    bad = getattr(tool[1], name).copy()
    bad[2] = value
    with pytest.raises(InputError, match=f"recording, {name}: sample 2 is not a finite number"):
        replace(tool[1], **{name: bad})


@pytest.mark.parametrize("step", [0.0, -0.5])
def test_time_that_does_not_increase_is_refused(tool, step):
    time = tool[1].time_s.copy()
    time[7:] += time[6] - time[7] + step
    with pytest.raises(InputError, match="time does not increase from sample 6"):
        replace(tool[1], time_s=time)


def test_a_recording_of_one_sample_or_of_odd_lengths_is_refused(tool):
    motion = tool[1]
    with pytest.raises(InputError, match="1 sample"):
        replace(motion, time_s=motion.time_s[:1])
    with pytest.raises(InputError, match=r"tool_angle: expected \(\d+,\), got \(\d+,\)"):
        replace(motion, tool_angle=motion.tool_angle[1:])
    with pytest.raises(InputError, match="no right-handed frame"):
        replace(motion, basis=motion.basis[::-1])


@pytest.mark.parametrize("cell", [0.0, -1.0, math.nan, math.inf])
def test_a_cell_that_is_none_is_refused(tool, cell):
    with pytest.raises(InputError, match=r"a cell of .* above 0"):
        cut(BLANK, (tool,), cell_mm=cell)


@pytest.mark.parametrize("cell", [0.02, 1e-4, 1e-300])
def test_more_memory_than_allowed_is_said_with_a_cell_that_fits(tool, cell):
    with pytest.raises(InputError, match=r"would need about \S+ GiB of memory, 2 are allowed") as refused:
        cut(BLANK, (tool,), cell_mm=cell)
    fits = float(re.search(r"--cell-mm (\S+) or more", refused.value.remedy)[1])
    grid = plan_grid(BLANK, [tool[0]], closest=17.5, cell_mm=fits)
    assert np.prod(grid.node_shape, dtype=float) * 8 < ALLOWED
    with pytest.raises(InputError, match="would need"):
        plan_grid(BLANK, [tool[0]], closest=17.5, cell_mm=0.9 * fits)


def test_huge_blank_gets_a_cell_that_fits():
    """Left to itself the grid always fits."""
    for size in (1.0, 44.0, 500.0, 5000.0):
        blank = Blank(diameter_mm=size, length_mm=size)
        grid = plan_grid(blank, [HOB.cutter(0.0)], closest=0.0)
        assert np.prod(grid.node_shape, dtype=float) * 8 < ALLOWED


@pytest.mark.parametrize("tolerance", [0.0, -1.0, math.nan, math.inf])
def test_a_tolerance_that_is_none_is_refused(tool, tolerance):
    with pytest.raises(InputError, match=r"a tolerance of .* above 0"):
        cut(BLANK, (tool,), tolerance_um=tolerance)


def test_more_memory_than_allowed_is_said_with_a_tolerance_that_fits(tool):
    with pytest.raises(InputError, match=r"--tolerance-um \S+ or more") as refused:
        cut(BLANK, (tool,), tolerance_um=0.01)
    found = re.search(r"--tolerance-um (\S+) or", str(refused.value))
    assert found
    fine = plan_grid(BLANK, [tool[0]], closest=17.0, tolerance_um=float(found[1]))
    # errors go with the square of the cell
    usual = plan_grid(BLANK, [tool[0]], closest=17.0)
    assert fine.cell_mm[0] / usual.cell_mm[0] == pytest.approx(math.sqrt(float(found[1])), rel=0.02)


@pytest.mark.parametrize("asked", [{"cell_mm": 1e9}, {"tolerance_um": 1e15}, {"cell_mm": 1e300}])
def test_cells_wider_than_any_use_are_the_widest_useful(tool, asked):
    """In blocks of wider cells no pass can be left out: they would cost hours."""
    grid = plan_grid(BLANK, [tool[0]], closest=17.5, **asked)
    assert BLANK.radius / 40 < min(grid.cell_mm[:2]) <= max(grid.cell_mm[:2]) < BLANK.radius / 15
    assert max(grid.cells) < 200


def test_a_cut_with_a_cell_wider_than_the_blank_ends_soon(synthetic):
    small = Blank(diameter_mm=24.0, length_mm=2.0, bore_mm=6.0)
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    tool = synthetic.hobbing(
        hob, teeth=10, tip_x=7.5, z=(1.0, -3.0), feed=2.0, step_deg=10, ratio_factor=-1.0
    )
    wide, widest = (cut(small, (tool,), cell_mm=cell) for cell in (1e6, small.radius / 20.0))
    assert wide.cell_mm == widest.cell_mm
    assert wide.remains.volume_mm3 == widest.remains.volume_mm3


def test_a_search_that_outgrows_the_memory_ends_with_a_word(synthetic, monkeypatch):
    """What only shows while it is searched, as a tool that trembles in the stock."""
    small = Blank(diameter_mm=24.0, length_mm=2.0, bore_mm=6.0)
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    tool = synthetic.hobbing(
        hob, teeth=10, tip_x=7.5, z=(1.0, -3.0), feed=2.0, step_deg=10, ratio_factor=-1.0
    )
    assert cut(small, (tool,), cell_mm=0.4).method.startswith("general")
    monkeypatch.setattr("twin.cutting.cut.working_memory", lambda: 2.0**15)
    with pytest.raises(
        PartError, match=r"outgrows the 3.1e-05 GiB .* blocks with \d+ bites each .* --cell-mm"
    ):
        cut(small, (tool,), cell_mm=0.4)


@pytest.mark.parametrize(("gib", "allowed"), [(1, ALLOWED), (3, ALLOWED), (64, 32 << 30)])
def test_a_search_may_take_half_of_the_memory_and_as_much_as_any_plan(gib, allowed, monkeypatch):
    sizes = {"SC_PAGE_SIZE": 4096, "SC_PHYS_PAGES": gib << 18}
    monkeypatch.setattr("os.sysconf", sizes.__getitem__)
    assert working_memory() == allowed


def test_a_machine_that_does_not_tell_its_memory_is_a_small_one(monkeypatch):
    monkeypatch.delattr("os.sysconf")
    assert working_memory() == ALLOWED
