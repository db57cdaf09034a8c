"""Rulings, section 5: machine lock, dry run, RESET, emergency stop, and what alarms do to the gear box."""

import math

import numpy as np
import pytest

HOB = "G28 U0 W0\nG28 H0 V0\n"
RADIUS = {"8200#0": 1, "1006#3.X": 0}


# Machine lock and dry run


def test_machine_lock_moves_registers_not_slides(act) -> None:
    found = act("G00 X-20. Z-30.\nM30", "0 machine lock on")
    assert (found.absolute["X"], found.absolute["Z"]) == (-20.0, -30.0)
    assert (found.relative["X"], found.relative["Z"]) == (-20.0, -30.0)
    assert (found.machine["X"], found.machine["Z"]) == (0.0, 0.0)
    assert found.cycle_time_s == act("G00 X-20. Z-30.\nM30").cycle_time_s


def test_machine_lock_of_one_axis_is_mlk(act) -> None:
    by_switch = act("G00 X-20. Z-30.\nM30", "0 machine lock X on")
    by_signal = act("G00 X-20. Z-30.\nM30", signals={"MLKX": True})
    assert (by_switch.machine["X"], by_switch.machine["Z"]) == (0.0, -30.0)
    assert by_signal.machine == by_switch.machine
    assert by_signal.absolute == by_switch.absolute


def test_machine_lock_on_the_way_brakes_the_slides(act) -> None:
    """The slide cannot stop at once: it brakes; the block then goes on in the registers alone."""
    found = act("G01 Z-100. F6000\nM30", "0.5 machine lock on")
    assert found.absolute["Z"] == -100.0
    assert found.machine["Z"] == pytest.approx(-50.0, abs=1e-9)
    assert found.peaks["Z"].acceleration <= 2000.0 * (1 + 1e-9)


def test_machine_lock_does_not_act_on_master_and_slave(act) -> None:
    """Hobbing, 注意事项: 机床锁 is without effect on master and slave."""
    text = f"{HOB}G81 T20 L1\nS300\nG04 X2.\nG00 H30.\nG01 Z-20. F600\nS0\nG80\nM30"
    locked, free = act(text, "0 machine lock on"), act(text)
    assert locked.turns == free.turns
    assert (locked.machine["Z"], locked.absolute["Z"]) == (0.0, -20.0)


def test_mlk_acts_on_the_slide_of_an_inclined_pair(act) -> None:
    """The slides' table: MLKx is a signal of the slide: the inclined axis moves, the orthogonal slide
    does not follow it."""
    text = "G28 Y0\nG28 X0\nG00 Y100.\nM30"
    found = act(text, setup="tilted", parameters=RADIUS, signals={"MLKX": True})
    assert (found.machine["X"], found.machine["Y"]) == (0.0, pytest.approx(115.470, abs=1e-3))
    assert (found.absolute["X"], found.absolute["Y"]) == (0.0, 100.0)


def test_dry_run_replaces_feeds(act) -> None:
    """Parameter 1410 [mm/min]; G99 as well, which waits for no spindle then; rapids stay."""
    speed = 2000.0 / 60.0
    expected = 50.0 / speed + speed / 2000.0
    assert act("G01 Z-50. F60\nM30", "0 dry run on").cycle_time_s == pytest.approx(expected, rel=1e-9)
    text = "M03 S200\nG99 G01 Z-50. F0.1\nM30"
    assert act(text, "0 dry run on").blocks.duration_s[1] == pytest.approx(expected, rel=1e-9)
    assert act("G00 Z-50.\nM30", "0 dry run on").cycle_time_s == act("G00 Z-50.\nM30").cycle_time_s


# RESET and emergency stop


def test_reset_brakes_rewinds_and_stops_the_spindle(act, warned) -> None:
    text = "M03 S300\nG98 G01 Z-100. F6000\nM30"
    found = act(text, "1.0 reset")
    assert found.absolute["Z"] == pytest.approx(-100.0, abs=1e-9)
    found = act(text, "0.5 reset")
    assert warned(found) == ["HT9134"]
    assert found.absolute["Z"] == pytest.approx(-(0.5 - 0.025) * 100.0 - 2.5, abs=1e-9)
    assert found.cycle_time_s == pytest.approx(0.5 + 0.05 + 0.5 * 0.55 / 0.55, abs=0.06)
    again = act(text, "0.5 reset", "2 cycle start")
    assert again.blocks.line.tolist() == [1, 2, 1, 2, 3]
    assert again.absolute["Z"] == -100.0


def test_modal_codes_stay_at_reset(act) -> None:
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
def test_reset_and_sync(act, kept: int, in_sync: bool, gear: str, slave: str) -> None:
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


def test_reset_at_a_line_names_that_line(act) -> None:
    """Section 5, events at a line: the block of the line is the present one, behind a subprogram, too."""
    found = act("M98 P2\nG01 Z-1. F100\nM30\nO2\nG01 Z-5. F100\nM99", "line 2 reset")
    assert [(w.number, w.span and (w.span.line, w.span.column)) for w in found.warnings] == [
        ("HT9134", (2, 1))
    ]
    assert found.absolute["Z"] == -5.0


def test_reset_keeps_the_absolutes_true(act) -> None:
    """The sync motion and the braking of the slave are in the displays."""
    found = act(f"{HOB}G81 T20 L1\nS300\nG04 X9.\nM30", "5.0 reset")
    assert found.absolute["C"] == pytest.approx(found.machine["C"], abs=1e-6)


def test_emergency_stop_brakes_every_axis_by_itself(act, warned) -> None:
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
    assert warned(found) == ["HT9135"]


@pytest.mark.parametrize("follow", [0, 1])
@pytest.mark.parametrize("helical", ["", " Q2. P20."])
def test_emergency_stop_cancels_sync(act, sampled, follow: int, helical: str) -> None:
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
def test_emergency_stop_keeps_the_absolutes_true(act, text: str) -> None:
    """R of G51.2 counts as sync motion (section 3): what an E-stop leaves of it is displayed, as by RESET."""
    found = act(text, "0.1 emergency stop")
    assert found.machine["C"] > 0.0
    assert found.absolute["C"] == pytest.approx(found.machine["C"], abs=1e-9)


@pytest.mark.parametrize("text", ["G777\nM30", "G04 X1.\n#3000=1\nM30"])
def test_events_behind_an_alarm_are_told(act, warned, text: str) -> None:
    """Nothing is ever ignored silently: events that an alarm has cut off never came."""
    assert warned(act(text, "5 reset", "line 9 feed hold")) == ["HT9137", "HT9137"]


def test_after_an_emergency_stop_only_reset_mends_it(act, warned) -> None:
    text = "G01 Z-10. F600\nM30"
    found = act(text, "0.5 emergency stop", "1 cycle start", "1.5 jog X 1.", "2 reset", "3 cycle start")
    assert warned(found) == ["HT9135", "HT9131", "HT9131", "HT9134"]
    assert found.absolute["Z"] == -10.0


# Alarm classes


@pytest.mark.parametrize(
    ("block", "number", "in_sync"),
    [("G01 Q5", "PS0009", True), ("G01 Z-900. F8000", "OT0501", False), ("#3000=5(STOP)", "MC3005", True)],
)
def test_alarm_classes(act, block: str, number: str, in_sync: bool) -> None:
    """Program and user alarms leave sync on, all others cancel it."""
    found = act(f"G81 T20 L1\nS300\nG04 X1.\n{block}\nM30")
    assert found.alarms[0].number == number
    assert found.in_sync_at_end is in_sync
