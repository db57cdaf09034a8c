"""Step and frequency response as the command shows them, and what it says of machines that it cannot show."""

from xml.etree import ElementTree

import numpy as np
import pytest

from twin.cli.main import main
from twin.machine import load_machine
from twin.machine.response import delivered_responses

JOB = """[machine]
model = "hobbing_lathe"
[machine.drives.x_slide]
position_gain = 35.0
velocity_feedforward = 0.0
acceleration_feedforward = 0.0
backlash = 5.0
[machine.drives.tool_spindle]
kind = "variable_frequency"
breakdown_slip = 120.0
[machine.parameters]
"9005#0.Y" = 1
"201#7" = 1
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


@pytest.fixture(scope="module")
def pairs():
    return delivered_responses(load_machine("hobbing_lathe"))


def test_what_mujoco_does_is_what_the_closed_loop_says(pairs):
    assert {bare.joint for bare, _ in pairs} == {
        "x_slide", "z_slide", "tilted_slide", "work_spindle", "tool_spindle"
    }  # fmt: skip
    for found in (one for pair in pairs for one in pair):
        np.testing.assert_allclose(found.step, found.step_law, rtol=0, atol=1e-9)
        assert found.off < 1e-9


def test_a_loop_without_feed_forward_is_the_continuous_cascade_at_low_frequencies(pairs):
    """Textbook: PI velocity loop L = ω_v (1 + 1/(T_i s)) / s in a position loop Kv H / (s + Kv H); the
    force is held for a period, and the speed is that over the last one: half a period each way inside."""
    bare = next(bare for bare, _ in pairs if bare.joint == "x_slide")
    drive = bare.drive.drive
    gain, speed, reset = drive.position_gain, drive.velocity_gain, 1.0 / drive.integral_time_s

    def cascade(hertz):
        s = 2j * np.pi * hertz
        late = np.exp(-s * 1e-3 / 2.0)
        forward = speed * (1.0 + reset / s) / s * late
        inner = forward / (1.0 + forward * late)
        return gain * inner / (s + gain * inner)

    hertz = np.linspace(1.0, 50.0, 5000)
    edge = hertz[np.argmax(np.abs(cascade(hertz)) < np.sqrt(0.5))]
    assert bare.bandwidth_hz == pytest.approx(edge, rel=0.01)
    phase = np.degrees(np.angle(cascade(10.0)))
    assert bare.phase_at_10_hz_deg == pytest.approx(phase, abs=0.5)
    assert bare.overshoot < 0.001


def test_the_command_draws_every_axis_of_a_job(tmp_path, capsys):
    (tmp_path / "job.toml").write_text(JOB, encoding="utf-8")
    (tmp_path / "program.nc").write_text("M30\n", encoding="utf-8")
    out = tmp_path / "deeper" / "drives.svg"
    assert main(["machine", str(tmp_path), "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "x_slide         0     0     " in said
    assert "tool_spindle" not in said, "an induction motor has no loop"
    svg = out.read_text(encoding="utf-8")
    assert ElementTree.fromstring(svg).tag.endswith("svg")
    assert "Kv 35 1/s" in svg
    assert "nan" not in svg


def test_what_is_neither_model_nor_job(tmp_path, capsys):
    assert main(["machine", "no_such_lathe"]) == 2
    assert "hobbing_lathe" in capsys.readouterr().err
    (tmp_path / "job.toml").write_text(JOB.replace("gain = 35.0", "gain = 9000.0"), encoding="utf-8")
    (tmp_path / "program.nc").write_text("M30\n", encoding="utf-8")
    assert main(["machine", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert "position_gain 9000" in said
    assert "job.toml:4" in said
