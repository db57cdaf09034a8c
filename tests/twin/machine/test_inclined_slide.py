"""The inclined slide on the `tilted` set-up with 8200#0 = 1 (controller.md, section 4), in the run."""

import math
from pathlib import Path

import numpy as np
import pytest
from mounted import EXACT

from controller.cnc import Controller
from controller.language.source import parse_program
from twin.cutting.fields import Field, tool_field
from twin.cutting.motion import CutterMotion
from twin.job import read_job
from twin.machine import IdealMachine, MujocoMachine
from twin.machine.loops import Loops
from twin.machine.servo import tune
from twin.presets import cutters_of, settings_of
from twin.session import Session, record
from twin.setup import make_ready

JOB = """
[machine]
setup = "tilted"
parameters = {{ "8200#0" = 1, "201#2" = 1, "8210" = "{angle}" }}
{drives}
[work]
diameter_mm = 46.567
length_mm = 8.0
[tool]
kind = "hob"
normal_module_mm = 2.0
outside_diameter_mm = 70.0
gashes = 24
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = 20
normal_module_mm = 2.0
helix_angle_deg = 20.0
"""
REFERENCE = "G28 V0\nG28 U0 W0\nG28 H0\n"
THERE_AND_BACK = f"O1\n{REFERENCE}G98 G54 G00 X120. Z20. Y0.\nG01 Y100. F3000.\nG01 Y-60. F5000.\nM30\n"
HOBBING = (
    f"O1\n{REFERENCE}G54 G00 X37.567 Z5. Y-1.5\nG81 T20 L1 Q2. P20.\nS1200\nG99 G01 Z-9. {{shift}} F0.25\n"
    "S0\nG80\nM30\n"
)


LINEAR = "".join(
    f"[machine.drives.{joint}]\ncoulomb_friction = 0.0\nencoder_counts = 0.0\n" for joint in EXACT.drives
)


def run(folder: Path, program: str, *, angle: str = "-30000", drives: str | None = None) -> Session:
    """Record a program; on ideal axes, or with these tables of drives."""
    text = JOB.format(angle=angle, drives=drives or "")
    (folder / "job.toml").write_text(text, encoding="utf-8")
    (folder / "program.nc").write_text(program, encoding="utf-8")
    job = read_job(folder)
    cutters = cutters_of(job)
    ready, settings = make_ready(job, cutters), settings_of(job, cutters)
    controller = Controller(
        parse_program(program, file="program.nc"), parameters=settings.parameters, offsets=settings.offsets
    )
    machine = IdealMachine(5) if drives is None else MujocoMachine(ready.tools[0].assembly)
    session = record(controller, machine, ready)
    assert not session.alarms
    return session


def path(session: Session, *lines: int) -> np.ndarray:
    """(n, 3) tool centre [mm] in the machine while these lines of the program run."""
    recording = session.recording
    lines_of = np.array([b.line for b in recording.blocks])
    ((_, motion),) = session.motions
    return motion.centre[np.isin(lines_of[recording.block], lines)]


def test_a_programmed_y_move_is_straight(tmp_path: Path) -> None:
    centre = path(run(tmp_path, THERE_AND_BACK), 6, 7)
    assert np.ptp(centre[:, 1]) == pytest.approx(160.0, abs=0.01)
    assert np.abs(centre[:, 0] - (60.0 + 35.0)).max() < 1e-4
    assert np.abs(centre[:, 2] - 20.0).max() < 1e-4


@pytest.mark.parametrize("wrong", [0.01, -0.01])
def test_a_wrong_angle_shows_its_slope(tmp_path: Path, wrong: float) -> None:
    """θ' for θ: Ya = Y / cos θ', Xa = X - Y tan θ', so the tool drifts by Y (sin θ - sin θ') / cos θ' in X
    and comes cos θ / cos θ' as far in Y: 17.5 µm of X on 100 mm for 0.01°."""
    angle = math.radians(-30.0 + wrong)
    centre = path(run(tmp_path, THERE_AND_BACK, angle=f"{-30000 + round(1000 * wrong)}"), 6, 7)
    slope = np.polyfit(centre[:, 1], centre[:, 0], 1)[0]
    assert slope == pytest.approx((-0.5 - math.sin(angle)) / math.cos(math.radians(30.0)), rel=1e-9)
    assert slope * 100e3 == pytest.approx(-17.45 * wrong / 0.01, abs=0.02)


def test_drives_bend_the_move_by_the_cross_talk_of_their_slides(tmp_path: Path) -> None:
    """Recorded slides against the linear loops of both, coupled by the mass they share: to the nanometre."""
    session = run(tmp_path, THERE_AND_BACK, drives=LINEAR)
    recording = session.recording
    job = read_job(tmp_path)
    assembly = make_ready(job, cutters_of(job)).tools[0].assembly
    drives, mass = assembly.drives(), assembly.inertia()
    loops = Loops(
        mass=mass,
        viscous=np.array([d.drive.viscous_friction for d in drives]),
        gains=[tune(d, i) for d, i in zip(drives, mass.diagonal(), strict=True)],
        period_s=assembly.spec.control_period_s,
        substeps=1,
    )
    state_map, given = loops.closed()
    told = np.vstack([np.zeros((2, 5)), recording.setpoint * [d.unit for d in drives]])
    state, predicted = np.zeros(20), np.zeros_like(recording.setpoint)
    for k in range(len(predicted)):
        state = state_map @ state + given @ told[k : k + 3].ravel()
        predicted[k] = state[:5] / [d.unit for d in drives]
    np.testing.assert_allclose(recording.actual, predicted, rtol=0, atol=1e-6)
    bent = np.abs(path(session, 6, 7)[:, 0] - 95.0).max() * 1e3
    assert 0.2 < bent < 50.0


SHIFT = 2.5
"""[mm]; its turn of the work, 6.73005°, is nearly a whole number of increments"""


def field_of(folder: Path, shift: str, reach: float) -> Field:
    """Depth field of the passes whose tool centre stands within `reach` [mm] of the plane z = -2."""
    session = run(folder, HOBBING.format(shift=shift))
    ((cutter, motion),) = session.motions
    near = np.abs(motion.centre[:, 2] + 2.0) < reach
    first, last = np.flatnonzero(near)[[0, -1]]
    part = CutterMotion(
        time_s=motion.time_s[first:last],
        work_angle=motion.work_angle[first:last],
        tool_angle=motion.tool_angle[first:last],
        centre=motion.centre[first:last],
        basis=motion.basis,
    )
    return tool_field(cutter, part, 23.3, (-8.0, 0.0))


def depth(field: Field, radius: float, degrees: np.ndarray) -> np.ndarray:
    """(n,) greatest depth [mm] at these angles of a ring at z = -2: above zero is cut away."""
    turn = np.radians(degrees)
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(len(turn), -2.0)])
    deepest = np.full(len(points), -np.inf)
    for k, point in enumerate(points):
        passes = field.near(point, 0.05)
        if len(passes):
            deepest[k] = field.evaluate(np.repeat(point[None], len(passes), axis=0), passes).depth.max()
    return deepest


def flanks(field: Field, radius: float) -> np.ndarray:
    """Angles [deg] at which the ring enters and leaves the gaps of two teeth, sorted."""
    coarse = np.linspace(0.0, 36.0, 145)
    inside = depth(field, radius, coarse) > 0.0
    at = np.flatnonzero(inside[1:] != inside[:-1])
    low, high, sign = coarse[at], coarse[at + 1], inside[at]
    for _ in range(18):
        middle = (low + high) / 2
        same = (depth(field, radius, middle) > 0.0) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return (low + high) / 2


def test_a_hob_shifted_along_y_with_its_turn_of_the_work_leaves_the_flank(tmp_path: Path) -> None:
    """ΔC = 360° ΔY cos β / (π z m_n) in the same block; ripple of 24 gashes and 0.25 mm feed: 0.25 µm."""
    turn = 360.0 * SHIFT * math.cos(math.radians(20.0)) / (math.pi * 20 * 2.0)
    still = field_of(tmp_path, "", 2.5)
    shifted = field_of(tmp_path, f"V{SHIFT} H{turn:.3f}", 2.5)
    for radius in (20.3, 21.3, 22.5):
        a, b = flanks(still, radius), flanks(shifted, radius)
        assert len(a) == len(b) == 4
        normal = np.radians(b - a) * radius * math.cos(math.radians(20.0)) * 1e3
        assert np.abs(normal).max() < 0.5


def test_a_hob_shifted_without_it_destroys_the_teeth(tmp_path: Path) -> None:
    """2.5 mm of shift are 6.7° of the work: more than a third of a pitch is cut from every tooth."""
    still, shifted = (field_of(tmp_path, shift, 6.0) for shift in ("", f"V{SHIFT}"))
    degrees = np.linspace(0.0, 18.0, 60, endpoint=False)
    kept = depth(still, 21.3, degrees) < 0.0
    gone = depth(shifted, 21.3, degrees) > 0.05
    assert 0.35 < kept.mean() < 0.65
    assert gone[kept].mean() > 0.5
