"""Rulings, section 5, and what sections 2 to 4 say of the operator: each action has the effect the originals
give it, in sync and out of it."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import DryRun, dry_run
from controller.language.source import parse_program
from controller.operator.actions import read_event
from controller.tables.parameters import delivered

HOB = "G28 U0 W0\nG28 H0 V0\n"
RADIUS = {"8200#0": 1, "1006#3.X": 0}


def act(text: str, *events: str, setup: str = "hobbing", parameters=None, signals=None) -> DryRun:
    return dry_run(
        parse_program(text),
        delivered(setup, parameters),
        signals=signals,
        events=[read_event(event) for event in events],
    )


def sampled(text: str, *events: str, setup: str = "hobbing", parameters=None):
    """Setpoints (n, axes), sync and block texts of a run on ideal drives."""
    controller = Controller(
        parse_program(text),
        parameters=delivered(setup, parameters),
        events=[read_event(event) for event in events],
    )
    rows, sync = [np.zeros((0, len(controller.axes)))], []
    while (chunk := controller.propose()).ticks:
        rows.append(chunk.setpoint)
        sync.append(chunk.sync)
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    return controller, np.concatenate(rows), np.concatenate(sync)


def numbers(result: DryRun) -> list[str]:
    return [warning.number for warning in result.warnings]


# Feed hold and cycle start


def test_hold_brakes_along_the_path_and_cycle_start_goes_on() -> None:
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
def test_holds_anywhere_change_nothing_but_time(times: list[float], block: str) -> None:
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


def test_the_clock_of_a_dwell_stops_in_a_hold() -> None:
    assert act("G04 X2.\nM30", "0.5 feed hold", "10.5 cycle start").cycle_time_s == pytest.approx(
        12.0, rel=1e-12
    )


def test_hold_does_not_act_on_master_and_slave() -> None:
    """Hobbing, 注意事项: 进给保持 is without effect on master and slave; the feed axis stands."""
    text = f"{HOB}G81 T20 L1\nS300\nG01 Z-20. F600\nS0\nG80\nM30"
    _, motion, sync = sampled(text, "1.0 feed hold", "4.0 cycle start")
    assert np.ptp(motion[1100:3900, 1]) == 0.0
    assert np.diff(motion[1100:3900, 2]) == pytest.approx(1.8, abs=1e-9)
    assert np.abs(motion[sync, 3] * 20 - motion[sync, 2]).max() < 1e-8


def test_hold_does_not_stop_a_commanded_slave_alone() -> None:
    text = "G81 T20 L1\nG01 H90. F900\nG01 Z-5. F600\nG80\nM30"
    _, motion, _ = sampled(text, "1.0 feed hold", "20 cycle start")
    # 15 deg/s: H ends at 6 s although held; Z waits for cycle start
    assert motion[6003, 3] < motion[6004, 3] == pytest.approx(90.0, abs=1e-9)
    assert (motion[19_999, 1], motion[-1, 1]) == (0.0, -5.0)


def test_a_program_that_stays_held_ends_with_a_warning() -> None:
    held = act("G01 Z-100. F6000\nM30", "0.5 feed hold")
    assert numbers(held) == ["HT9130"]
    assert held.cycle_time_s == pytest.approx(0.55, rel=1e-12)
    assert held.absolute["Z"] == pytest.approx(-100.0 * (0.5 - 0.025) - 2.5, abs=1e-9)
    assert held.warnings[0].span is not None
    assert held.warnings[0].span.line == 1


def test_hold_between_blocks_and_start_at_once() -> None:
    text = "G00 Z-1.\nG04 X1.\nG00 Z-2.\nM30"
    assert act(text, "0.2 feed hold", "0.2 cycle start").cycle_time_s == act(text).cycle_time_s


# Overrides


@pytest.mark.parametrize("percent", [10, 50, 100, 150, 254])
def test_feed_override(percent: int) -> None:
    """On feeds, not on rapids, and not beyond the axis (HT9107)."""
    speed = min(20.0 * percent / 100.0, 8000.0 / 60.0)
    found = act("G01 Z-50. F1200\nM30", f"0 feed override {percent}")
    assert found.cycle_time_s == pytest.approx(50.0 / speed + speed / 2000.0, rel=1e-9)
    assert (
        act("G00 Z-50.\nM30", f"0 feed override {percent}").cycle_time_s == act("G00 Z-50.\nM30").cycle_time_s
    )


def test_feed_override_on_the_way() -> None:
    """From 20 to 10 mm/s on the way: the ramp takes 5 ms and covers 0.075 mm."""
    found = act("G01 Z-50. F1200\nM30", "1.0 feed override 50")
    done = 20.0 * (1.0 - 0.005) + 0.075
    rest = 50.0 - done - 0.025
    assert found.cycle_time_s == pytest.approx(1.005 + rest / 10.0 + 0.005, rel=1e-9)


def test_feed_override_zero_stands_still_and_never_hangs() -> None:
    assert numbers(act("G01 Z-50. F1200\nM30", "1.0 feed override 0")) == ["HT9130"]
    found = act("G01 Z-50. F1200\nM30", "1.0 feed override 0", "6.0 feed override 100")
    assert found.cycle_time_s == pytest.approx(50.0 / 20.0 + 0.01 + 5.0, rel=1e-9)
    assert found.absolute["Z"] == -50.0
    text = "M03 S200\nG99 G01 Z-20. F0.1\nM05\nM30"
    controller, motion, _ = sampled(text, "3.0 feed override 0")  # by the measured speed
    assert [w.number for w in controller.warnings] == ["HT9130"]
    assert len(motion) == pytest.approx(3000, abs=2)


@pytest.mark.parametrize(("percent", "speed"), [(100, 250.0), (50, 125.0), (25, 62.5), (0, 500.0 / 60.0)])
def test_rapid_override(percent: int, speed: float) -> None:
    """100, 50, 25 percent and F0 (parameter 1421); not on feeds."""
    found = act("G00 Z-300.\nM30", f"0 rapid override {percent}")
    assert found.cycle_time_s == pytest.approx(300.0 / speed + speed / 2000.0, rel=1e-9)
    cut = "G01 Z-30. F600\nM30"
    assert act(cut, f"0 rapid override {percent}").cycle_time_s == act(cut).cycle_time_s


@pytest.mark.parametrize(("gear", "off"), [("G81 T20 L1", "G80"), ("G51.2 P2 Q6", "G50.2")])
def test_spindle_override_holds_the_ratio(gear: str, off: str) -> None:
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


def test_spindle_override_stops_at_the_limit_of_the_slave() -> None:
    """120 percent of a hob speed at which the work is at its limit: the ratio is held, the limit kept."""
    text = "G81 T1 L1\nS1900\nG04 X9.\nS0\nG80\nM30"
    found = act(text, "0 spindle override 120")
    assert found.peaks["C"].speed == pytest.approx(2000.0, rel=1e-12)
    assert found.peaks["Y"].speed == pytest.approx(2000.0, rel=1e-12)


def test_spindle_override_zero_with_a_feed_per_turn_is_an_alarm_not_a_wait() -> None:
    text = "M03 S200\nG99 G01 Z-20. F0.1\nM05\nM30"
    for parameters in ({}, {"201#2": 1}):
        (alarm,) = act(text, "3.0 spindle override 0", parameters=parameters).alarms
        assert alarm.number == "HT9007"


def test_feed_per_turn_follows_the_spindle_override() -> None:
    """200 rpm · 0.1 mm = 20 mm/min; at 50 percent 10 mm/min."""
    text = "M03 S200\nG99 G01 Z-2. F0.1\nM05\nM30"
    _, motion, _ = sampled(text, "3.0 spindle override 50")
    speed = np.diff(motion[:, 1]) * 60_000
    assert speed[2500] == pytest.approx(-20.0, rel=1e-6)
    assert speed[5000] == pytest.approx(-10.0, rel=1e-6)
    ideal = act(text, "3.0 spindle override 50").cycle_time_s
    assert len(motion) == pytest.approx(1000 * ideal, abs=20)


# Single block, stops, skips


def test_single_block_stops_after_every_block() -> None:
    text = "G04 X1.\nG04 X1.\nG04 X1.\nM30"
    found = act(
        text, "0 single block on", "5 cycle start", "10 cycle start", "11 single block off", "20 cycle start"
    )
    assert found.blocks.start_s.tolist() == [0.0, 5.0, 10.0, 20.0]
    assert numbers(act(text, "0 single block on")) == ["HT9130"]


def test_m00_waits_for_cycle_start_where_an_operator_is() -> None:
    assert numbers(act("M00\nG04 X1.\nM30")) == ["HT9109"]
    assert act("M00\nG04 X1.\nM30").cycle_time_s == 1.0
    found = act("M00\nG04 X1.\nM30", "7 cycle start")
    assert (numbers(found), found.cycle_time_s) == ([], 8.0)
    assert numbers(act("M00\nG04 X1.\nM30", "0 feed override 90")) == ["HT9130"]


def test_optional_stop_and_block_skip_are_switches() -> None:
    text = "G04 X1.\nM01\n/2 G04 X10.\n/ G04 X100.\nM30"
    assert act(text, "0 block skip 2 on", "0 block skip on").cycle_time_s == 1.0
    assert act(text, "0 block skip 2 on", "0.5 block skip on", "0.6 block skip 2 off").cycle_time_s == 11.0
    found = act(text, "0 block skip 2 on", "0 block skip on", "0.5 optional stop on", "9 cycle start")
    assert found.cycle_time_s == 9.0


def test_an_event_at_a_line_acts_before_its_block() -> None:
    text = "G04 X1.\nM01\n(comment)\nG04 X1.\nM30"
    assert act(text, "line 2 optional stop on", "8 cycle start").cycle_time_s == 9.0
    assert numbers(act(text, "line 4 feed hold")) == ["HT9130"]
    assert act(text, "line 4 feed hold", "5 cycle start").cycle_time_s == 6.0
    looped = "M98 P1 L3\nM30\nO1\nG04 X1.\nM99"
    assert act(looped, "line 4 feed hold", "5 cycle start").cycle_time_s == 8.0  # the first time alone


# Machine lock and dry run


def test_machine_lock_moves_registers_not_slides() -> None:
    found = act("G00 X-20. Z-30.\nM30", "0 machine lock on")
    assert (found.absolute["X"], found.absolute["Z"]) == (-20.0, -30.0)
    assert (found.relative["X"], found.relative["Z"]) == (-20.0, -30.0)
    assert (found.machine["X"], found.machine["Z"]) == (0.0, 0.0)
    assert found.cycle_time_s == act("G00 X-20. Z-30.\nM30").cycle_time_s


def test_machine_lock_of_one_axis_is_mlk() -> None:
    by_switch = act("G00 X-20. Z-30.\nM30", "0 machine lock X on")
    by_signal = act("G00 X-20. Z-30.\nM30", signals={"MLKX": True})
    assert (by_switch.machine["X"], by_switch.machine["Z"]) == (0.0, -30.0)
    assert by_signal.machine == by_switch.machine
    assert by_signal.absolute == by_switch.absolute


def test_machine_lock_on_the_way_brakes_the_slides() -> None:
    """The slide cannot stop at once: it brakes; the block then goes on in the registers alone."""
    found = act("G01 Z-100. F6000\nM30", "0.5 machine lock on")
    assert found.absolute["Z"] == -100.0
    assert found.machine["Z"] == pytest.approx(-50.0, abs=1e-9)
    assert found.peaks["Z"].acceleration <= 2000.0 * (1 + 1e-9)


def test_machine_lock_does_not_act_on_master_and_slave() -> None:
    """Hobbing, 注意事项: 机床锁 is without effect on master and slave."""
    text = f"{HOB}G81 T20 L1\nS300\nG04 X2.\nG00 H30.\nG01 Z-20. F600\nS0\nG80\nM30"
    locked, free = act(text, "0 machine lock on"), act(text)
    assert locked.turns == free.turns
    assert (locked.machine["Z"], locked.absolute["Z"]) == (0.0, -20.0)


def test_mlk_acts_on_the_slide_of_an_inclined_pair() -> None:
    """The slides' table: MLKx is a signal of the slide: the inclined axis moves, the orthogonal slide
    does not follow it."""
    text = "G28 Y0\nG28 X0\nG00 Y100.\nM30"
    found = act(text, setup="tilted", parameters=RADIUS, signals={"MLKX": True})
    assert (found.machine["X"], found.machine["Y"]) == (0.0, pytest.approx(115.470, abs=1e-3))
    assert (found.absolute["X"], found.absolute["Y"]) == (0.0, 100.0)


def test_dry_run_replaces_feeds() -> None:
    """Parameter 1410 [mm/min]; G99 as well, which waits for no spindle then; rapids stay."""
    speed = 2000.0 / 60.0
    expected = 50.0 / speed + speed / 2000.0
    assert act("G01 Z-50. F60\nM30", "0 dry run on").cycle_time_s == pytest.approx(expected, rel=1e-9)
    text = "M03 S200\nG99 G01 Z-50. F0.1\nM30"
    assert act(text, "0 dry run on").blocks.duration_s[1] == pytest.approx(expected, rel=1e-9)
    assert act("G00 Z-50.\nM30", "0 dry run on").cycle_time_s == act("G00 Z-50.\nM30").cycle_time_s


# RESET and emergency stop


def test_reset_brakes_rewinds_and_stops_the_spindle() -> None:
    text = "M03 S300\nG98 G01 Z-100. F6000\nM30"
    found = act(text, "1.0 reset")
    assert found.absolute["Z"] == pytest.approx(-100.0, abs=1e-9)
    found = act(text, "0.5 reset")
    assert numbers(found) == ["HT9134"]
    assert found.absolute["Z"] == pytest.approx(-(0.5 - 0.025) * 100.0 - 2.5, abs=1e-9)
    assert found.cycle_time_s == pytest.approx(0.5 + 0.05 + 0.5 * 0.55 / 0.55, abs=0.06)
    again = act(text, "0.5 reset", "2 cycle start")
    assert again.blocks.line.tolist() == [1, 2, 1, 2, 3]
    assert again.absolute["Z"] == -100.0


def test_modal_codes_stay_at_reset() -> None:
    """G01 and F of before are in force when the program begins anew."""
    text = "X-5.\nG01 Z-50. F600\nM30"
    first = act(text)
    again = act(text, "1.0 reset", "5 cycle start")
    assert first.blocks.duration_s[0] < 0.1  # rapid at power-on
    assert again.absolute["X"] == -5.0
    moved = act("G01 F600\nX-5.\nG04 X9.\nG00\nM30", "3.0 reset", "4 mdi X0", "5 auto")
    assert moved.cycle_time_s == pytest.approx(4.0 + 2.5 / 10 + 10 / 2000, rel=1e-9)


@pytest.mark.parametrize(("kept", "in_sync"), [(0, False), (1, True)])
@pytest.mark.parametrize(("gear", "slave"), [("G81 T20 L1", "C"), ("G51.2 P1 Q2", "Y")])
def test_reset_and_sync(kept: int, in_sync: bool, gear: str, slave: str) -> None:
    """RESET cancels unless 201#3 = 1."""
    found = act(f"{gear}\nS100\nG01 Z-50. F600\nM30", "2.0 reset", parameters={"201#3": kept})
    assert found.in_sync_at_end is in_sync
    (interval,) = found.sync
    assert interval.first_line == 1
    if not in_sync:
        assert interval.end_s == pytest.approx(2.0 + 10.0 / 2000.0, rel=1e-9)
        assert all(found.signals[f"MV{letter}"] is False for letter in "XZYC")
    else:
        assert found.signals["MVC"] is found.signals["MVY"] is True


def test_reset_at_a_line_names_that_line() -> None:
    """Section 5, events at a line: the block of the line is the present one, behind a subprogram, too."""
    found = act("M98 P2\nG01 Z-1. F100\nM30\nO2\nG01 Z-5. F100\nM99", "line 2 reset")
    assert [(w.number, w.span and (w.span.line, w.span.column)) for w in found.warnings] == [
        ("HT9134", (2, 1))
    ]
    assert found.absolute["Z"] == -5.0


def test_reset_keeps_the_absolutes_true() -> None:
    """The sync motion and the braking of the slave are in the displays."""
    found = act(f"{HOB}G81 T20 L1\nS300\nG04 X9.\nM30", "5.0 reset")
    assert found.absolute["C"] == pytest.approx(found.machine["C"], abs=1e-6)


def test_emergency_stop_brakes_every_axis_by_itself() -> None:
    """All axes at once, each as hard as it can: the path is left, the displays know."""
    text = "G01 X-100. Z-100. F6000\nM30"
    parameters = {"1660.X": 500.0}
    found = act(text, "1.0 emergency stop", parameters=parameters)
    rate = 500.0 * math.sqrt(5.0)  # of the path: X goes 50 in radius, Z 100
    path = 100.0 * (1.0 - 50.0 / rate)
    x, z = path / math.sqrt(5.0), 2.0 * path / math.sqrt(5.0)
    vx, vz = 100.0 / math.sqrt(5.0), 200.0 / math.sqrt(5.0)
    assert found.machine["X"] / 2 == pytest.approx(-x - vx**2 / 1000.0, abs=1e-6)
    assert found.machine["Z"] == pytest.approx(-z - vz**2 / 4000.0, abs=1e-6)
    assert found.absolute["X"] == pytest.approx(found.machine["X"], abs=1e-6)
    assert found.absolute["Z"] == pytest.approx(found.machine["Z"], abs=1e-6)
    assert numbers(found) == ["HT9135"]


@pytest.mark.parametrize("follow", [0, 1])
@pytest.mark.parametrize("helical", ["", " Q2. P20."])
def test_emergency_stop_cancels_sync(follow: int, helical: str) -> None:
    text = f"G81 T20 L1{helical}\nS300\nG01 Z-20. F600\nS0\nG80\nM30"
    parameters = {"201#7": follow, "201#3": 1}
    found = act(text, "1.0 emergency stop", parameters=parameters)
    assert not found.in_sync_at_end
    assert found.cycle_time_s == pytest.approx(1.5, rel=1e-6)  # the hob brakes for half a second
    assert found.absolute["C"] == pytest.approx(found.machine["C"], abs=1e-5)
    assert found.absolute["Y"] == pytest.approx(found.machine["Y"], abs=1e-5)
    _, motion, sync = sampled(text, "1.0 emergency stop", parameters=parameters)
    assert not sync[-1]
    change = np.abs(np.diff(motion, n=2, axis=0)).max(axis=0) * 1e6
    assert change[1] <= 2000.0 * (1 + 1e-6)
    assert change[2] <= 3600.0 * (1 + 1e-6)


@pytest.mark.parametrize("text", ["G51.2 P1 Q2 R90.\nG50.2\nM30", "M03 S100\nG04 X5.\nM30"])
def test_emergency_stop_keeps_the_absolutes_true(text: str) -> None:
    """R of G51.2 counts as sync motion (section 3): what an E-stop leaves of it is displayed, as by RESET."""
    found = act(text, "0.1 emergency stop")
    assert found.machine["C"] > 0.0
    assert found.absolute["C"] == pytest.approx(found.machine["C"], abs=1e-9)


@pytest.mark.parametrize("text", ["G777\nM30", "G04 X1.\n#3000=1\nM30"])
def test_events_behind_an_alarm_are_told(text: str) -> None:
    """Nothing is ever ignored silently: events that an alarm has cut off never came."""
    assert numbers(act(text, "5 reset", "line 9 feed hold")) == ["HT9137", "HT9137"]


def test_after_an_emergency_stop_only_reset_mends_it() -> None:
    text = "G01 Z-10. F600\nM30"
    found = act(text, "0.5 emergency stop", "1 cycle start", "1.5 jog X 1.", "2 reset", "3 cycle start")
    assert numbers(found) == ["HT9135", "HT9131", "HT9131", "HT9134"]
    assert found.absolute["Z"] == -10.0


# Alarm classes


@pytest.mark.parametrize(
    ("block", "number", "in_sync"),
    [("G01 Q5", "PS0009", True), ("G01 Z-900. F8000", "OT0501", False), ("#3000=5(STOP)", "MC3005", True)],
)
def test_alarm_classes(block: str, number: str, in_sync: bool) -> None:
    """Program and user alarms leave sync on, all others cancel it."""
    found = act(f"G81 T20 L1\nS300\nG04 X1.\n{block}\nM30")
    assert found.alarms[0].number == number
    assert found.in_sync_at_end is in_sync


# Manual mode


def test_jog_in_a_hold_goes_on_in_parallel() -> None:
    """After manual intervention the rest of the block is parallel, the registers are true, and the next
    absolute block is where it should be."""
    text = "G01 X-40. Z-100. F6000\nG01 Z-120.\nM30"
    found = act(text, "0.5 feed hold", "1.0 jog Z 5. F600", "3.0 cycle start")
    assert found.extents["Z"].machine[0] == -120.0
    assert found.absolute == {"X": -40.0, "Z": -120.0, "Y": 0.0, "C": 0.0}
    assert found.machine["Z"] == -120.0
    only = act("G01 X-40. Z-100. F6000\nM30", "0.5 feed hold", "1.0 jog Z 5. F600", "3.0 cycle start")
    assert only.absolute["Z"] == pytest.approx(-95.0, abs=1e-9)
    assert only.machine["Z"] == pytest.approx(-95.0, abs=1e-9)
    assert only.absolute["X"] == -40.0


def test_jog_speed_and_distance() -> None:
    """In programmed units, X in diameter; at F, or at the jog speed of parameter 1423."""
    found = act("M30", "1.0 jog X -20. F600")
    assert found.machine["X"] == -20.0
    assert found.cycle_time_s == pytest.approx(1.0 + 10.0 / 10.0 + 10.0 / 2000.0, rel=1e-9)
    found = act("M30", "1.0 jog Z -20.", parameters={"1423.Z": 1200})
    assert found.cycle_time_s == pytest.approx(1.0 + 20.0 / 20.0 + 20.0 / 2000.0, rel=1e-9)


def test_jog_while_the_program_runs_is_refused() -> None:
    found = act("G04 X2.\nM30", "1.0 jog Z 5.")
    assert numbers(found) == ["HT9131"]
    assert found.machine["Z"] == 0.0


def test_manual_mode_holds_and_auto_gives_back() -> None:
    text = "G01 Z-50. F1200\nM30"
    found = act(text, "1.0 manual", "1.5 cycle start", "2.0 jog X 10.", "4.0 auto", "5.0 cycle start")
    assert numbers(found) == ["HT9131"]
    assert (found.absolute["X"], found.absolute["Z"]) == (10.0, -50.0)


@pytest.mark.parametrize(
    ("gear", "master", "slave", "number"),
    [("G81 T20 L1", "Y", "C", "PS1595"), ("G51.2 P1 Q2", "C", "Y", "PS0220")],
)
def test_manual_mode_in_sync(gear: str, master: str, slave: str, number: str) -> None:
    """Manual mode keeps sync: jogging the master is refused, jogging the slave adds."""
    text = f"{gear}\nS60\nG01 Z-20. F60\nM30"
    refused = act(text, "2.0 feed hold", f"3.0 jog {master} 5.")
    assert refused.alarms[0].number == number
    assert refused.in_sync_at_end
    both = act(f"{gear}\nG04 X1.\nM05", "0.5 feed hold", f"0.6 jog {slave} 30.")
    assert both.turns[slave] == pytest.approx(30.0 / 360.0, rel=1e-12)
    ratio = 1 / 20 if slave == "C" else 2.0
    added = act(text, "2.0 feed hold", f"3.0 jog {slave} 30.")
    assert added.turns[slave] - ratio * added.turns[master] == pytest.approx(30.0 / 360.0, abs=1e-9)
    assert added.in_sync_at_end


@pytest.mark.parametrize(
    ("gear", "letter", "number"),
    [
        ("G81 T20 L1", "Y", "PS1595"),
        ("G81 T20 L1", "C", "PS1595"),
        ("G51.2 P1 Q2", "Y", "PS0220"),
        ("G51.2 P1 Q2", "C", "PS0220"),
    ],
)
def test_manual_return_of_a_sync_axis_is_refused(gear: str, letter: str, number: str) -> None:
    """G28 of a sync axis is refused (sections 2, 3), and so is the return by hand: sync would take the axis
    away from its reference point before it got there."""
    found = act(f"{gear}\nS60\nG01 Z-20. F60\nM30", "2 feed hold", f"3 reference return {letter}")
    assert found.alarms[0].number == number
    assert found.in_sync_at_end


def test_jog_of_the_axial_axis_turns_the_slave_of_a_helical_gear() -> None:
    """ΔZ counts all Z motion since G81, manual included."""
    text = "G81 T20 L1 Q2. P20.\nM00\nG80\nM30"
    found = act(text, "1 jog Z -20.", "5 cycle start")
    shift = 360 * 20 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    assert found.machine["C"] == pytest.approx(shift, abs=1e-6)
    assert found.absolute["C"] == pytest.approx(shift, abs=1e-6)


def test_jog_of_an_inclined_pair() -> None:
    """±Jx is Cartesian: the inclined axis takes the orthogonal slide with it unless NOZAGC = 1, which
    independent motion needs (注意 4)."""
    both = act("M30", "1 jog Y 100.", setup="tilted", parameters=RADIUS)
    assert (both.machine["X"], both.machine["Y"]) == pytest.approx((57.735, 115.470), abs=1e-3)
    assert numbers(both) == ["HT9136"]
    one = act("M30", "1 jog Y 100.", setup="tilted", parameters=RADIUS, signals={"NOZAGC": True})
    assert (one.machine["X"], one.machine["Y"]) == pytest.approx((0.0, 115.470), abs=1e-3)
    assert "HT9136" not in numbers(one)
    live = act("M30", "0.5 signal NOZAGC=1", "1 jog Y 100.", setup="tilted", parameters=RADIUS)
    assert live.machine == one.machine


def test_jog_to_a_stroke_limit() -> None:
    (alarm,) = act("M30", "1 jog Z 500.").alarms
    assert alarm.number == "OT0500"


def test_mdi_runs_one_block_between_blocks() -> None:
    text = "G04 X1.\nM00\nG04 X1.\nM30"
    found = act(text, "2 mdi G00 X-10. Z-5.", "5 cycle start")
    assert (found.absolute["X"], found.absolute["Z"]) == (-10.0, -5.0)
    assert found.cycle_time_s == 6.0
    assert 0 in found.blocks.line
    inside = act("G01 Z-50. F1200\nM30", "1.0 feed hold", "2.0 mdi G00 X5.", "3 cycle start")
    assert numbers(inside) == ["HT9131"]
    wrong = act(text, "2 mdi G00 K5.")
    assert (wrong.alarms[0].number, wrong.alarms[0].span.file) == ("PS0009", "MDI")


# Manual reference return


@pytest.mark.parametrize(("azr", "x"), [(0, -57.735), (1, 0.0)])
def test_azr(azr: int, x: float) -> None:
    """AZR 8200#2 = 0: the manual return of the inclined axis moves the orthogonal slide, too; 1: it does not.
    From Y 100: the slide Y comes home from 115.470; X moves by −57.735 or stays."""
    text = "G28 Y0\nG28 X0\nG00 Y100.\nM00\nM30"
    found = act(text, "20 reference return Y", setup="tilted", parameters=RADIUS | {"8200#2": azr})
    assert found.machine["Y"] == pytest.approx(0.0, abs=1e-9)
    assert found.machine["X"] == pytest.approx(57.735 + x, abs=1e-3)


def test_the_orthogonal_axis_must_follow_at_once() -> None:
    text = "M00\nM30"
    ok = act(text, "1 reference return Y", "9 reference return X", setup="tilted", parameters=RADIUS)
    assert (ok.alarms, numbers(ok)) == ((), ["HT9130"])
    late = act(
        text, "1 reference return Y", "5 jog Z 1.", "9 reference return X", setup="tilted", parameters=RADIUS
    )
    assert "HT9120" in numbers(late)
    azr = RADIUS | {"8200#2": 1}
    free = act(
        text, "1 reference return Y", "5 jog Z 1.", "9 reference return X", setup="tilted", parameters=azr
    )
    assert "HT9120" not in numbers(free)


def test_manual_return_of_the_orthogonal_axis_first_alarms() -> None:
    """DS0020 at any time while the inclined axis is not on its reference point."""
    assert act("M30", "1 reference return X", setup="tilted", parameters=RADIUS).alarms[0].number == "DS0020"
    text = "G28 Y0\nG28 X0\nG00 Y10.\nM00\nM30"
    assert act(text, "9 reference return X", setup="tilted", parameters=RADIUS).alarms[0].number == "DS0020"


def test_manual_return_out_of_the_pair() -> None:
    found = act("G00 X-20. Z-30.\nM00\nM30", "5 reference return Z", "9 cycle start")
    assert (found.machine["X"], found.machine["Z"], found.absolute["Z"]) == (-20.0, 0.0, 0.0)
    assert found.signals["ZPZ"]
    assert not found.signals["ZPX"]


# Signals


def test_interlock_lets_a_block_wait() -> None:
    text = "G00 Z-30.\nM30"
    plain = act(text).cycle_time_s
    found = act(text, "0 signal *ITZ=0", "4 signal *ITZ=1")
    assert found.cycle_time_s == pytest.approx(4.0 + plain, rel=1e-12)
    assert numbers(act(text, "0 signal *ITZ=0")) == ["HT9130"]
    assert act(text, "0 signal *ITX=0").cycle_time_s == plain
    assert act(text, "0 signal SVFZ=1", "4 signal SVFZ=0").cycle_time_s == found.cycle_time_s


def test_mirror_image_moves_the_slide_the_other_way() -> None:
    found = act("G00 X-20. Z-30.\nM30", signals={"MIZ": True})
    assert (found.absolute["Z"], found.machine["Z"], found.machine["X"]) == (-30.0, 30.0, -20.0)


def test_displayed_speed_leaves_the_sync_pulses_out() -> None:
    """Hobbing, 注意事项: the speed display does not count the pulses of the gear box."""
    from controller.execution import Execution
    from controller.language.offsets import Offsets
    from controller.motion.axes import Circumstances

    text = "G81 T20 L1\nS300\nG01 Z-20. F600\nG80\nM30"
    execution = Execution(
        parse_program(text), delivered(), Offsets(), {}, circumstances=Circumstances(closed_form=False)
    )
    while not execution.done:
        execution.step()
    motion = execution.motion
    assert motion.timeline.tracks[2].speed(1.0) == 1800.0
    assert motion.displayed_speed(1.0) == pytest.approx(600.0, rel=1e-12)
