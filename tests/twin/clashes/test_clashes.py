"""Cutters that meet the stock at rapid, or with a spindle at rest: which block, how deep; what is none."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from controller.language.source import load_program
from controller.tables.alarms import Alarm
from twin.clashes.clashes import clashes
from twin.cutting.blank import Blank
from twin.errors import ExitCode
from twin.job import read_job
from twin.outcome import Options
from twin.presets import cutters_of, settings_of
from twin.run import run_job
from twin.session import Session, run_program
from twin.setup import make_ready

JOB = """[machine]
model = "hobbing_lathe"
parameters = { "201#2" = 1 }
[work]
diameter_mm = 44.0
length_mm = 8.0
stick_out_mm = 150.0
[tool]
kind = "hob"
normal_module_mm = 2.0
pressure_angle_deg = 20.0
starts = 1
hand = "right"
gashes = 12
outside_diameter_mm = 70.0
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = 20
normal_module_mm = 2.0
"""
BESIDE = "G28 U0 W0\nG28 H0 V0\nG54 G00 X50. Z20.\n"
IN_SYNC = f"{BESIDE}G81 T20 L1\nS600\n"
CUT = "G99 G01 X35. F4.\nG01 Z-26. F4.\n"


def ran(folder: Path, program: str, job: str = JOB) -> tuple[Blank, Session]:
    """A run of the program on ideal axes."""
    (folder / "job.toml").write_text(job, encoding="utf-8")
    (folder / "program.nc").write_text(f"O1\n{program}M30\n", encoding="utf-8")
    read = read_job(folder)
    cutters = cutters_of(read)
    session = run_program(
        load_program(read.program), settings_of(read, cutters), make_ready(read, cutters), ideal=True
    )
    assert session.alarms == ()
    return read.work.blank(), session


def said(folder: Path, program: str, job: str = JOB) -> tuple[Alarm, ...]:
    """What comes of it."""
    return tuple(clash.alarm for clash in clashes(*ran(folder, program, job)))


def line_of(program: str, block: str) -> int:
    return f"O1\n{program}".splitlines().index(block) + 1


def test_rapid_into_the_blank_is_named_with_its_block_and_depth(tmp_path: Path) -> None:
    """The hob's tips stand 2 mm under Ø 44 when X is 40; they meet the front face where their circle of 35 mm
    is 2 mm high: 11.66 mm ahead of the centre."""
    program = f"{IN_SYNC}G00 X40.\nG00 Z-4.\nG00 X50.\nS0\nG80\n"
    blank, session = ran(tmp_path, program)
    (clash,) = clashes(blank, session)
    alarm = clash.alarm
    assert alarm.number == "HT9032"
    assert alarm.span
    assert alarm.span.line == line_of(program, "G00 Z-4.")
    depth = float(alarm.found.split(" mm deep")[0].split()[-1])
    assert 1.7 < depth <= 2.0
    time = float(alarm.found.removesuffix(" s").split()[-1])
    _, motion = session.motions[0]
    z = float(np.interp(time, motion.time_s, motion.centre[:, 2]))
    # one of twelve gashes comes by every 8 ms, which at rapid are 3 mm
    assert 11.4 - 6.0 < z < 11.66
    assert clash.time_s == pytest.approx(time, abs=6e-4)
    # a tip, at the side of the blank that faces the tool, within what the rapid does between two gashes
    assert math.hypot(*clash.point[:2]) < 22.0
    assert clash.point[0] > 19.9
    assert -6.0 < clash.point[2] < 0.0


def test_rapid_through_the_gaps_that_were_cut_is_none(tmp_path: Path) -> None:
    """Back in the gear box along finished gaps, where only feed marks of 4²/(8 · 35) = 0.06 mm stand."""
    assert said(tmp_path, f"{IN_SYNC}{CUT}G00 Z20.\nG00 X50.\nS0\nG80\n") == ()


def test_the_same_way_out_of_sync_hits_the_teeth(tmp_path: Path) -> None:
    """The gear box is off and on again, and the work has been turned by half a tooth meanwhile."""
    program = f"{IN_SYNC}{CUT}G98 G01 X50. F3000.\nS0\nG80\nG00 C9.\nG00 X35.\nG00 Z20.\nG00 X50.\n"
    numbers = [alarm.number for alarm in said(tmp_path, program)]
    assert "HT9032" in numbers


def test_retract_from_the_cut_is_none(tmp_path: Path) -> None:
    """The feed ends in mid-face, and the hob goes on turning while it is drawn back."""
    assert said(tmp_path, f"{IN_SYNC}G99 G01 X35. F4.\nG01 Z-4. F4.\nG00 X50.\nS0\nG80\n") == ()


def test_a_rapid_that_goes_nowhere_is_none(tmp_path: Path) -> None:
    assert said(tmp_path, f"{IN_SYNC}{CUT}G00 Z-26.\nG00 X35.\nG00 X50.\nS0\nG80\n") == ()


def test_feed_with_the_hob_at_rest(tmp_path: Path) -> None:
    program = f"{BESIDE}G98 G01 X40. F2000.\nG01 Z-4. F300.\nG01 X50. F2000.\n"
    (alarm,) = said(tmp_path, program)
    assert (alarm.number, alarm.span and alarm.span.line) == ("HT9033", line_of(program, "G01 Z-4. F300."))


def test_polygon_head_at_rest_at_the_turning_work(tmp_path: Path) -> None:
    job = JOB[: JOB.index("[tool]")] + (
        '[tool]\nkind = "polygon_head"\ninserts = 3\ntip_radius_mm = 50.0\nedge_width_mm = 4.0\n'
        'corner_radius_mm = 0.4\n[program]\nfile = "program.nc"\n'
    )
    program = f"{BESIDE}M03 S100\nG98 G01 X40. F2000.\nG01 Z-4. F300.\nG01 X50. F2000.\nM05\n"
    alarms = said(tmp_path, program, job)
    assert [alarm.number for alarm in alarms] == ["HT9033"]


def test_hob_that_turns_in_the_gear_box_at_work_that_stands(tmp_path: Path) -> None:
    """As if the work spindle were stuck: the motion that was recorded, but for the turn of the work."""
    program = f"{IN_SYNC}{CUT}G00 X50.\nS0\nG80\n"
    blank, session = ran(tmp_path, program)
    ((cutter, motion),) = session.motions
    stuck = replace(motion, work_angle=np.zeros(len(motion.time_s)))
    (clash,) = clashes(blank, replace(session, motions=((cutter, stuck),)))
    alarm = clash.alarm
    assert (alarm.number, alarm.span and alarm.span.line) == ("HT9034", line_of(program, "G01 Z-26. F4."))


@pytest.mark.parametrize("radial", ["X46.", "X44.2", "X44."])
def test_a_rapid_beside_the_blank_is_none(tmp_path: Path, radial: str) -> None:
    assert said(tmp_path, f"{IN_SYNC}G00 {radial}\nG00 Z-40.\nG00 X50.\nS0\nG80\n") == ()


def test_the_run_shows_where_they_met(tmp_path: Path) -> None:
    """By hand: at rest one gash points to the work, its edge, swivelled by asin(2/65), meets the face
    where the chord of Ø 44 at X40 ends, 9.17 mm beside the centre: 0.28 mm before the centre does."""
    (tmp_path / "job.toml").write_text(JOB, encoding="utf-8")
    program = f"O1\n{BESIDE}G98 G01 X40. F2000.\nG01 Z-4. F300.\nG00 X50.\nM30\n"
    (tmp_path / "program.nc").write_text(program, encoding="utf-8")
    outcome = run_job(read_job(tmp_path), tmp_path / "out", Options(ideal=True, cell_mm=4.0))
    assert outcome.exit_code is ExitCode.FINDING
    (alarm,) = json.loads((tmp_path / "out" / "alarms.json").read_text(encoding="utf-8"))["alarms"]
    assert (alarm["number"], alarm["line"]) == ("HT9033", 6)
    (clash,) = outcome.session.clashes
    z = np.interp(clash.time_s, outcome.session.recording.time_s, outcome.session.recording.actual[:, 1])
    first = math.sqrt(22.0**2 - 20.0**2) * 2.0 / 65.0
    between = 2.0 * math.pi * 2.0 / 65.0  # a tooth further in
    # what stands 0.1 mm inside counts, and is looked at every 0.5 mm of way
    assert first - between - 0.1 - 0.5 <= z + 300.0 <= first
    picture = (tmp_path / "out" / "collision.svg").read_text(encoding="utf-8")
    assert "Where cutter touches blank" in picture
