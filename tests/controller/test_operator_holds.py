"""Rulings, section 5: holds, overrides, single block, stops and skips, in sync and out of it."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

HOB = "G28 U0 W0\nG28 H0 V0\n"


# Feed hold and cycle start


def test_hold_brakes_along_the_path_and_cycle_start_goes_on(act, sampled) -> None:
    """100 mm/s, 2000 mm/s²: 50 ms to brake, 50 ms to speed up again, and the standstill between: each stop
    costs its standstill and one ramp of 50 ms."""
    plain = act("G01 X-200. Z-100. F6000\nM30").cycle_time_s
    held = act("G01 X-200. Z-100. F6000\nM30", "0.5 feed hold", "3.0 cycle start")
    rate = 2000.0 * math.sqrt(2.0)  # both axes go 1 : 1
    brake = 100.0 / rate
    assert held.cycle_time_s == pytest.approx(plain + (3.0 - 0.5 - brake) + brake, rel=1e-9)
    assert held.absolute == {"X": -200.0, "Z": -100.0, "Y": 0.0, "C": 0.0}
    assert held.warnings == ()
    _, motion, _ = sampled("G01 X-200. Z-100. F6000\nM30", "0.5 feed hold", "3.0 cycle start")
    assert np.abs(motion[:, 0] - motion[:, 1]).max() < 1e-9  # the path is kept
    assert np.ptp(motion[600:2900, 1]) == 0.0


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(0.0, 6.0), min_size=1, max_size=6),
    st.sampled_from(["G01 Z-100. F3000", "G00 Z-100.", "G02 X-40. Z-20. R20. F600", "G01 X-20. Z-3. F900"]),
)
def test_holds_anywhere_change_nothing_but_time(act, times: list[float], block: str) -> None:
    """However often it is held, the block ends where it would have, later by the standstills at least."""
    times = sorted(times)
    events = (
        [f"{t:.3f} feed hold" for t in times]
        + [f"{t + 0.4:.3f} cycle start" for t in times]
        + ["9 cycle start"]
    )
    plain, held = act(f"{block}\nM30"), act(f"{block}\nM30", *events)
    assert held.absolute == plain.absolute
    assert held.machine == pytest.approx(plain.machine, abs=1e-9)
    assert held.cycle_time_s >= plain.cycle_time_s - 1e-9
    for letter in "XZ":
        assert held.peaks[letter].speed <= plain.peaks[letter].speed * (1 + 1e-9)
        assert held.extents[letter].machine == pytest.approx(plain.extents[letter].machine, abs=1e-6)


def test_the_clock_of_a_dwell_stops_in_a_hold(act) -> None:
    assert act("G04 X2.\nM30", "0.5 feed hold", "10.5 cycle start").cycle_time_s == pytest.approx(
        12.0, rel=1e-12
    )


def test_hold_does_not_act_on_master_and_slave(sampled) -> None:
    """Hobbing, 注意事项: 进给保持 is without effect on master and slave; the feed axis stands."""
    text = f"{HOB}G81 T20 L1\nS300\nG01 Z-20. F600\nS0\nG80\nM30"
    _, motion, sync = sampled(text, "1.0 feed hold", "4.0 cycle start")
    assert np.ptp(motion[1100:3900, 1]) == 0.0
    assert np.diff(motion[1100:3900, 2]) == pytest.approx(1.8, abs=1e-9)
    assert np.abs(motion[sync, 3] * 20 - motion[sync, 2]).max() < 1e-8


def test_hold_does_not_stop_a_commanded_slave_alone(sampled) -> None:
    text = "G81 T20 L1\nG01 H90. F900\nG01 Z-5. F600\nG80\nM30"
    _, motion, _ = sampled(text, "1.0 feed hold", "20 cycle start")
    # 15 deg/s: H ends at 6 s although held; Z waits for cycle start
    assert motion[6003, 3] < motion[6004, 3] == pytest.approx(90.0, abs=1e-9)
    assert (motion[19_999, 1], motion[-1, 1]) == (0.0, -5.0)


def test_a_program_that_stays_held_ends_with_a_warning(act, warned) -> None:
    held = act("G01 Z-100. F6000\nM30", "0.5 feed hold")
    assert warned(held) == ["HT9130"]
    assert held.cycle_time_s == pytest.approx(0.55, rel=1e-12)
    assert held.absolute["Z"] == pytest.approx(-100.0 * (0.5 - 0.025) - 2.5, abs=1e-9)
    assert held.warnings[0].span is not None
    assert held.warnings[0].span.line == 1


def test_hold_between_blocks_and_start_at_once(act) -> None:
    text = "G00 Z-1.\nG04 X1.\nG00 Z-2.\nM30"
    assert act(text, "0.2 feed hold", "0.2 cycle start").cycle_time_s == act(text).cycle_time_s


# Overrides


@pytest.mark.parametrize("percent", [10, 50, 100, 150, 254])
def test_feed_override(act, percent: int) -> None:
    """On feeds, not on rapids, and not beyond the axis (HT9107)."""
    speed = min(20.0 * percent / 100.0, 8000.0 / 60.0)
    found = act("G01 Z-50. F1200\nM30", f"0 feed override {percent}")
    assert found.cycle_time_s == pytest.approx(50.0 / speed + speed / 2000.0, rel=1e-9)
    assert (
        act("G00 Z-50.\nM30", f"0 feed override {percent}").cycle_time_s == act("G00 Z-50.\nM30").cycle_time_s
    )


def test_feed_override_on_the_way(act) -> None:
    """From 20 to 10 mm/s on the way: the ramp takes 5 ms and covers 0.075 mm."""
    found = act("G01 Z-50. F1200\nM30", "1.0 feed override 50")
    done = 20.0 * (1.0 - 0.005) + 0.075
    rest = 50.0 - done - 0.025
    assert found.cycle_time_s == pytest.approx(1.005 + rest / 10.0 + 0.005, rel=1e-9)


def test_feed_override_zero_stands_still_and_never_hangs(act, sampled, warned) -> None:
    assert warned(act("G01 Z-50. F1200\nM30", "1.0 feed override 0")) == ["HT9130"]
    found = act("G01 Z-50. F1200\nM30", "1.0 feed override 0", "6.0 feed override 100")
    assert found.cycle_time_s == pytest.approx(50.0 / 20.0 + 0.01 + 5.0, rel=1e-9)
    assert found.absolute["Z"] == -50.0
    text = "M03 S200\nG99 G01 Z-20. F0.1\nM05\nM30"
    controller, motion, _ = sampled(text, "3.0 feed override 0")  # by the measured speed
    assert [w.number for w in controller.warnings] == ["HT9130"]
    assert len(motion) == pytest.approx(3000, abs=2)


@pytest.mark.parametrize(("percent", "speed"), [(100, 250.0), (50, 125.0), (25, 62.5), (0, 500.0 / 60.0)])
def test_rapid_override(act, percent: int, speed: float) -> None:
    """100, 50, 25 percent and F0 (parameter 1421); not on feeds."""
    found = act("G00 Z-300.\nM30", f"0 rapid override {percent}")
    assert found.cycle_time_s == pytest.approx(300.0 / speed + speed / 2000.0, rel=1e-9)
    cut = "G01 Z-30. F600\nM30"
    assert act(cut, f"0 rapid override {percent}").cycle_time_s == act(cut).cycle_time_s


@pytest.mark.parametrize(("gear", "off"), [("G81 T20 L1", "G80"), ("G51.2 P2 Q6", "G50.2")])
def test_spindle_override_holds_the_ratio(sampled, gear: str, off: str) -> None:
    """Spindle override acts with the ratio held; changing it while cutting warns."""
    text = f"{HOB}{gear}\nS300\nG04 X2.\nG01 Z-20. F300\nS0\n{off}\nM30"
    controller, motion, sync = sampled(text, "1.5 spindle override 120", "3.0 spindle override 50")
    master, slave, ratio = (2, 3, 1 / 20) if off == "G80" else (3, 2, 3.0)
    assert np.abs(motion[sync, slave] - motion[sync, master] * ratio).max() < 1e-8
    speed = np.diff(motion[:, master]) / 0.006
    assert speed[2300] == pytest.approx(360.0, rel=1e-9)
    assert speed[4800] == pytest.approx(150.0, rel=1e-9)
    assert [w.number for w in controller.warnings] == ["HT9132"]
    assert "spindle override 50" in controller.warnings[0].found


def test_spindle_override_stops_at_the_limit_of_the_slave(act) -> None:
    """120 percent of a hob speed at which the work is at its limit: the ratio is held, the limit kept."""
    text = "G81 T1 L1\nS1900\nG04 X9.\nS0\nG80\nM30"
    found = act(text, "0 spindle override 120")
    assert found.peaks["C"].speed == pytest.approx(2000.0, rel=1e-12)
    assert found.peaks["Y"].speed == pytest.approx(2000.0, rel=1e-12)


def test_spindle_override_zero_with_a_feed_per_turn_is_an_alarm_not_a_wait(act) -> None:
    text = "M03 S200\nG99 G01 Z-20. F0.1\nM05\nM30"
    for parameters in ({}, {"201#2": 1}):
        (alarm,) = act(text, "3.0 spindle override 0", parameters=parameters).alarms
        assert alarm.number == "HT9007"


def test_feed_per_turn_follows_the_spindle_override(act, sampled) -> None:
    """200 rpm · 0.1 mm = 20 mm/min; at 50 percent 10 mm/min."""
    text = "M03 S200\nG99 G01 Z-2. F0.1\nM05\nM30"
    _, motion, _ = sampled(text, "3.0 spindle override 50")
    speed = np.diff(motion[:, 1]) * 60_000
    assert speed[2500] == pytest.approx(-20.0, rel=1e-6)
    assert speed[5000] == pytest.approx(-10.0, rel=1e-6)
    ideal = act(text, "3.0 spindle override 50").cycle_time_s
    assert len(motion) == pytest.approx(1000 * ideal, abs=20)


# Single block, stops, skips


def test_single_block_stops_after_every_block(act, warned) -> None:
    text = "G04 X1.\nG04 X1.\nG04 X1.\nM30"
    found = act(
        text, "0 single block on", "5 cycle start", "10 cycle start", "11 single block off", "20 cycle start"
    )
    assert found.blocks.start_s.tolist() == [0.0, 5.0, 10.0, 20.0]
    assert warned(act(text, "0 single block on")) == ["HT9130"]


def test_m00_waits_for_cycle_start_where_an_operator_is(act, warned) -> None:
    assert warned(act("M00\nG04 X1.\nM30")) == ["HT9109"]
    assert act("M00\nG04 X1.\nM30").cycle_time_s == 1.0
    found = act("M00\nG04 X1.\nM30", "7 cycle start")
    assert (warned(found), found.cycle_time_s) == ([], 8.0)
    assert warned(act("M00\nG04 X1.\nM30", "0 feed override 90")) == ["HT9130"]


def test_optional_stop_and_block_skip_are_switches(act) -> None:
    text = "G04 X1.\nM01\n/2 G04 X10.\n/ G04 X100.\nM30"
    assert act(text, "0 block skip 2 on", "0 block skip on").cycle_time_s == 1.0
    assert act(text, "0 block skip 2 on", "0.5 block skip on", "0.6 block skip 2 off").cycle_time_s == 11.0
    found = act(text, "0 block skip 2 on", "0 block skip on", "0.5 optional stop on", "9 cycle start")
    assert found.cycle_time_s == 9.0


def test_an_event_at_a_line_acts_before_its_block(act, warned) -> None:
    text = "G04 X1.\nM01\n(comment)\nG04 X1.\nM30"
    assert act(text, "line 2 optional stop on", "8 cycle start").cycle_time_s == 9.0
    assert warned(act(text, "line 4 feed hold")) == ["HT9130"]
    assert act(text, "line 4 feed hold", "5 cycle start").cycle_time_s == 6.0
    looped = "M98 P1 L3\nM30\nO1\nG04 X1.\nM99"
    assert act(looped, "line 4 feed hold", "5 cycle start").cycle_time_s == 8.0  # the first time alone
