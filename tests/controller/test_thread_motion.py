"""G32 in motion: speed and angle of the spindle rule, and nothing else."""

import math

import numpy as np
import pytest

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.operator.actions import read_event
from controller.tables.parameters import delivered

THREAD = "M03 S300\nG32 Z-30. F2.\nG00 X10.\nZ0\nX0\nG04 X0.123\nG32 Z-30. F2.\nM05\nM30"


def sampled(text: str, *events: str, parameters=None):
    controller = Controller(
        parse_program(text),
        parameters=delivered("hobbing", parameters),
        events=[read_event(e) for e in events],
    )
    rows, blocks = [np.zeros((0, 4))], []
    while (chunk := controller.propose()).ticks:
        rows.append(chunk.setpoint)
        blocks.append(chunk.block)
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    return controller, np.concatenate(rows), np.concatenate(blocks)


def test_lead_and_same_angle_in_every_pass() -> None:
    """300 rpm · 2 mm: 10 mm/s after the run-up; at one Z the spindle has the same angle in each pass."""
    _, motion, blocks = sampled(THREAD)
    angles = []
    for number in (1, 6):
        z, c = motion[blocks == number, 1], motion[blocks == number, 3]
        cut = (z < -5.0) & (z > -25.0) & (np.gradient(z) < -0.0099)
        assert np.polyfit(c[cut] / 360.0, z[cut], 1)[0] == pytest.approx(-2.0, rel=1e-9)
        angles.append((c[cut][0] + z[cut][0] / 2.0 * 360.0) % 360.0)
    assert angles[0] == pytest.approx(angles[1], abs=1e-6)


def test_start_angle() -> None:
    """Q: a second start, half a turn further."""
    starts = []
    for q in ("", " Q180."):
        _, motion, _ = sampled(f"M03 S300\nG32 Z-30. F2.{q}\nM05\nM30", parameters={"3401#0": 1})
        first = int(np.flatnonzero(np.diff(motion[:, 1]))[0])
        starts.append(motion[first, 3] % 360.0)
    assert (starts[1] - starts[0]) % 360.0 == pytest.approx(180.0, abs=2.0)  # within one tick


def test_no_override_and_no_hold_within_a_pass() -> None:
    """Feed override does not act on a thread, the spindle override waits, a hold acts after the pass."""
    text = "M03 S300\nG32 Z-30. F2.\nG00 X10.\nM05\nM30"
    _, plain, _ = sampled(text)
    _, other, _ = sampled(
        text, "1.0 feed override 50", "1.1 spindle override 50", "1.2 feed hold", "9 cycle start"
    )
    end = int(np.flatnonzero(plain[:, 1] == plain[-1, 1])[0])
    assert other[: end + 1, 1] == pytest.approx(plain[: end + 1, 1], abs=1e-9)
    assert np.ptp(other[end + 1 : 8990, 0]) == 0.0
    assert other[8990:, 0].max() == pytest.approx(5.0, abs=1e-12)
    assert np.diff(other[:, 3])[8000] == pytest.approx(0.9, rel=1e-9)  # then 150 rpm


def test_spindle_at_standstill_is_an_alarm() -> None:
    """Not an endless wait; and a lead that the axis cannot follow is none either."""
    program = "M03 S300\nM05\nM19\nG32 Z-30. F2.\nM30"
    assert dry_run(parse_program(program), delivered()).alarms[0].number == "HT9007"
    fast = "M03 S2000\nG32 Z-30. F5.\nM30"
    assert dry_run(parse_program(fast), delivered()).alarms[0].number == "HT9020"
    stopped = "M03 S300\nG04 X1.\nG32 Z-30. F2.\nM30"
    events = [read_event("1.2 spindle override 0")]
    found = dry_run(parse_program(stopped), delivered(), events=events)
    assert found.cycle_time_s < 20.0


def test_threads_one_behind_the_other_are_one_helix() -> None:
    """G32 right behind G32: the second goes on in the groove of the first."""
    _, motion, blocks = sampled("M03 S300\nG32 Z-20. F2.\nG32 Z-40. F2.\nM05\nM30")
    grooves = []
    for number in (1, 2):
        z, c = motion[blocks == number, 1], motion[blocks == number, 3]
        cut = np.isclose(np.gradient(z), -0.01, rtol=1e-9)
        grooves.append(float(np.median((c[cut] + z[cut] / 2.0 * 360.0) % 360.0)))
    assert math.remainder(grooves[0] - grooves[1], 360.0) == pytest.approx(0.0, abs=1e-6)


def test_taper_thread_counts_the_longer_axis() -> None:
    _, motion, blocks = sampled("M03 S300\nG32 X-10. Z-30. F2.\nM05\nM30")
    z, x, c = motion[blocks == 1, 1], motion[blocks == 1, 0], motion[blocks == 1, 3]
    cut = np.isclose(np.gradient(z), -0.01, rtol=1e-9)
    assert np.polyfit(c[cut] / 360.0, z[cut], 1)[0] == pytest.approx(-2.0, rel=1e-9)
    assert x[cut] == pytest.approx(z[cut] / 6.0, abs=1e-9)
