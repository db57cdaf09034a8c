"""Interpolated against follow type, servo against induction master, from the program to the recorded motion.

geometry.md, section 5: a servo axis lags (1 - k_ff) w / Kv. Interpolated, the work is off by the mismatch
(1 - k_ff) w_C (1/Kv_C - 1/Kv_tool); in the follow type by its own lag behind the measured hob.
"""

from pathlib import Path

import numpy as np
import pytest

from controller.cnc import Controller
from controller.language.source import parse_program
from twin.errors import InputError
from twin.job import read_job
from twin.machine import MujocoMachine
from twin.presets import cutters_of, settings_of
from twin.recording import Recording
from twin.session import record, run_program
from twin.setup import make_ready, require_analogue

JOB = """
[machine.parameters]
"201#2" = 1
{parameters}
[machine.drives.work_spindle]
velocity_feedforward = {k_ff}
position_gain = 80.0
[machine.drives.tool_spindle]
velocity_feedforward = {k_ff}
position_gain = {kv_tool}
kind = "{kind}"
[work]
diameter_mm = 44.0
length_mm = 20.0
[tool]
kind = "hob"
normal_module_mm = 2.0
outside_diameter_mm = 70.0
gashes = 12
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = 20
normal_module_mm = 2.0
"""
PROGRAM = """O1
G81 T20 L1
S300
G04 X6.
S600
G04 X6.
S0
G80
M30
"""
K_FF, KV_WORK = 0.9, 80.0


def recorded(folder: Path, *, follow: bool, kv_tool: float = 100.0, kind: str = "servo") -> Recording:
    parameters = f'"201#7" = {int(follow)}'
    if kind != "servo":
        parameters += '\n"9005#0.Y" = 1'
    text = JOB.format(parameters=parameters, k_ff=K_FF, kv_tool=kv_tool, kind=kind)
    (folder / "job.toml").write_text(text, encoding="utf-8")
    (folder / "program.nc").write_text(PROGRAM, encoding="utf-8")
    job = read_job(folder)
    cutters = cutters_of(job)
    ready, settings = make_ready(job, cutters), settings_of(job, cutters)
    require_analogue(ready, settings.parameters)
    controller = Controller(
        parse_program(PROGRAM, file="program.nc"), parameters=settings.parameters, offsets=settings.offsets
    )
    session = record(controller, MujocoMachine(ready.tools[0].assembly), ready)
    assert not session.alarms
    return session.recording


def mean_error(recording: Recording, line: int) -> float:
    """Over the last whole work turn of the dwell in this line [arcsec]."""
    blocks = [b.line for b in recording.blocks]
    rows = np.flatnonzero(recording.block == blocks.index(line))
    angle = recording.work_angle_deg[rows]
    rows = rows[np.abs(angle - angle[-1]) <= 360.0][:-1]
    return float(recording.sync_error_arcsec[rows].mean())


def lag(rpm: float, kv: float) -> float:
    """(1 - k_ff) w / Kv [arcsec] of the work at a hob speed."""
    return (1 - K_FF) * (rpm / 20 * 6.0) / kv * 3600.0


def test_follow_type_shifts_by_the_work_s_own_lag(tmp_path: Path) -> None:
    recording = recorded(tmp_path, follow=True, kv_tool=40.0)
    slow, fast = mean_error(recording, 4), mean_error(recording, 6)
    assert slow == pytest.approx(-lag(300, KV_WORK), rel=0.01)
    assert fast - slow == pytest.approx(-(lag(600, KV_WORK) - lag(300, KV_WORK)), rel=0.01)


@pytest.mark.parametrize("kv_tool", [50.0, 80.0, 120.0])
def test_interpolated_type_shifts_by_the_mismatch_of_the_gains(tmp_path: Path, kv_tool: float) -> None:
    recording = recorded(tmp_path, follow=False, kv_tool=kv_tool)
    slow, fast = mean_error(recording, 4), mean_error(recording, 6)
    mismatch = lag(300, KV_WORK) - lag(300, kv_tool)
    assert fast - slow == pytest.approx(-mismatch, rel=0.01, abs=0.05)
    assert slow == pytest.approx(-mismatch, rel=0.01, abs=0.05)


def test_an_induction_hob_slips_and_the_work_keeps_to_it(tmp_path: Path) -> None:
    recording = recorded(tmp_path, follow=True, kind="variable_frequency")
    hob = recording.axes.index("Y")
    dwell = recording.block == [b.line for b in recording.blocks].index(6)
    told, turned = (np.ptp(a[dwell, hob]) for a in (recording.setpoint, recording.actual))
    assert 0.99 < turned / told < 0.9999
    assert mean_error(recording, 6) == pytest.approx(-lag(600, KV_WORK), rel=0.02)


def test_an_induction_motor_the_controller_does_not_know_of_is_refused(tmp_path: Path) -> None:
    text = JOB.format(parameters="", k_ff=1.0, kv_tool=80.0, kind="variable_frequency")
    (tmp_path / "job.toml").write_text(text, encoding="utf-8")
    (tmp_path / "program.nc").write_text(PROGRAM, encoding="utf-8")
    job = read_job(tmp_path)
    cutters = cutters_of(job)
    with pytest.raises(InputError, match=r'takes Y for a servo axis .*"9005#0.Y" = 1') as refusal:
        require_analogue(make_ready(job, cutters), settings_of(job, cutters).parameters)
    assert refusal.value.place
    assert refusal.value.place.line == text.splitlines().index('kind = "variable_frequency"') + 1


@pytest.mark.parametrize("size", [7, 4096])
def test_a_slave_out_of_its_window_ends_the_run_at_that_very_tick(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    """The work lags by 810 arcsec at 600 rpm of the hob, by half of that at 300: a window between the two is
    left while the hob is run up."""
    free = recorded(tmp_path, follow=True)
    window = 0.5 * (lag(300, KV_WORK) + lag(600, KV_WORK))
    beyond = int(np.argmax(np.abs(np.nan_to_num(free.sync_error_arcsec)) > window))
    monkeypatch.setattr("twin.course.CHUNK", size)
    text = JOB.format(parameters=f'"201#7" = 1\n"9006" = {window}', k_ff=K_FF, kv_tool=100.0, kind="servo")
    (tmp_path / "job.toml").write_text(text, encoding="utf-8")
    job = read_job(tmp_path)
    cutters = cutters_of(job)
    program = parse_program(PROGRAM, file="program.nc")
    session = run_program(program, settings_of(job, cutters), make_ready(job, cutters), ideal=False)
    (alarm,) = session.alarms
    assert alarm.number == "SV0407"
    assert alarm.span
    assert alarm.span.line in {5, 6}
    assert "C: " in alarm.found
    assert f"window {window:g} arcsec, at {free.time_s[beyond]:.3f} s" in alarm.found
    assert session.recording.time_s[-1] == free.time_s[beyond]
    assert np.array_equal(session.recording.actual, free.actual[: beyond + 1])


def test_recording_file_holds_error_and_spectrum(tmp_path: Path) -> None:
    recording = recorded(tmp_path, follow=False, kv_tool=50.0)
    recording.save(tmp_path / "recording.npz")
    with np.load(tmp_path / "recording.npz") as saved:
        np.testing.assert_array_equal(saved["sync_error_arcsec"], recording.sync_error_arcsec)
        assert np.array_equal(np.isfinite(saved["sync_error_arcsec"]), saved["sync"])
        assert len(saved["sync_order"]) == len(saved["sync_amplitude_arcsec"]) > 100
    assert recording.sync_spectrum
    assert recording.sync_spectrum.tool_turns == pytest.approx(20.0)
