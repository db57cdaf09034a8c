"""Whole programs as files: `ok` runs to its end at the place line 1 names, `bad` to the alarm line 1
names."""

import re
from pathlib import Path

import numpy as np
import pytest

from controller.dry_run import DryRun, dry_run
from controller.language.source import load_program
from controller.tables.parameters import delivered

PROGRAMS = Path(__file__).parents[1] / "programs"


def run_file(path: Path) -> DryRun:
    return dry_run(load_program(path), delivered())


@pytest.mark.parametrize("path", sorted((PROGRAMS / "ok").glob("*.nc")), ids=lambda path: path.stem)
def test_ok(path: Path) -> None:
    """`(final X60. Z5.)`: absolute positions at the end, worked by hand."""
    result = run_file(path)
    assert result.alarms == result.warnings == ()
    expected = dict(re.findall(r"([A-Z])(-?[\d.]+)", load_program(path).lines[0]))
    assert expected
    assert {axis: result.absolute[axis] for axis in expected} == {
        axis: float(v) for axis, v in expected.items()
    }


@pytest.mark.parametrize("path", sorted((PROGRAMS / "bad").glob("*.nc")), ids=lambda path: path.stem)
def test_bad(path: Path) -> None:
    """`(PS0005 2:5)`: number, line and column of the first alarm; and its message says what would be
    valid."""
    found = re.fullmatch(r"\((\w+) (\d+):(\d+)\)", load_program(path).lines[0])
    assert found
    (alarm,) = run_file(path).alarms
    assert alarm.span is not None
    assert (alarm.number, alarm.span.line, alarm.span.column) == (found[1], int(found[2]), int(found[3]))
    place = re.escape(f"{path}:{found[2]}:{found[3]}: error[{found[1]}]: ")
    assert re.match(rf"{place}.+: found .+; valid: .+", str(alarm))


def test_the_hobbing_original_cuts_20_teeth() -> None:
    """Hobbing, 编程示例: the tool turns 20 times while the work turns once."""
    result = run_file(PROGRAMS / "ok" / "hobbing_original.nc")
    assert result.turns["C"] * 20 == pytest.approx(result.turns["Y"], rel=1e-14)
    # 300 rpm / 20 = 15 rpm of the work at 2 mm a turn: 30 mm at 30 mm/min last 60 s = 15 turns of the work
    assert result.turns["C"] == pytest.approx(15.0 + 15.0 / 60.0 * (result.cycle_time_s - 60.0), abs=0.2)


def test_the_polygon_original_has_six_sides() -> None:
    """Polygon, 编程示例: the work turns once, the tool three times."""
    result = run_file(PROGRAMS / "ok" / "polygon_original.nc")
    assert result.turns["Y"] == pytest.approx(3.0 * result.turns["C"], rel=1e-14)


def test_helical_example_turns_the_work_by_the_lead(drive) -> None:
    """p_z = π z m_n / sin β = 367.4 mm right-hand: C lags by one turn a lead of Z, at every tick."""
    driven = drive((PROGRAMS / "ok" / "helical_right.nc").read_text())
    sync = driven.sync
    lead = np.pi * 20 * 2 / np.sin(np.radians(20))
    expected = driven.axis("Y")[sync] / 20 - 360 * driven.axis("Z")[sync] / lead
    assert np.abs(driven.axis("C")[sync] - expected).max() < 1e-9
