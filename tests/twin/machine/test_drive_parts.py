"""What a drive is made of besides its loops: encoder, backlash, limits, induction motor."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mounted import (
    DELIVERED,
    EXACT,
    FRICTIONLESS,
    PERIOD,
    TOOL,
    WORK,
    X,
    changed,
    changed_drive,
    machine,
    move,
    ramp,
)

from controller.clock import Follow
from twin.machine import DriveKind, MachineError
from twin.machine.backlash import Backlash
from twin.machine.drive import RPM, SI_PER_DEG
from twin.machine.encoder import encoder

ARCSEC = SI_PER_DEG / 3600.0


def test_encoder_reads_whole_counts_of_a_wavy_scale() -> None:
    """Within half a count of q + a sin(n q); 18 000 counts a turn, 20 arcsec twice a turn."""
    spec = changed_drive(
        DELIVERED,
        "work_spindle",
        encoder_counts=18_000.0,
        encoder_cyclic_error=20.0,
        encoder_cyclic_order=2.0,
    )
    read = encoder(spec.drives["work_spindle"].at_axis(rotary=True))
    count = math.tau / 18_000
    for q in np.random.default_rng(3).uniform(-1e4, 1e4, 500):
        reading = read(q)
        assert abs(reading - (q + 20.0 * ARCSEC * math.sin(2 * q))) <= 0.5001 * count
        assert reading / count == pytest.approx(round(reading / count), abs=1e-6)


def test_slide_encoder_counts_turns_of_its_screw() -> None:
    """10 mm a turn, 1000 counts: steps of 10 µm; 3 µm once a turn."""
    drive = DELIVERED.drives["x_slide"]
    spec = changed_drive(DELIVERED, "x_slide", encoder_counts=1000.0)
    assert encoder(spec.drives["x_slide"].at_axis(rotary=False))(0.0234e-3) == pytest.approx(20e-6)
    spec = changed_drive(EXACT, "x_slide", encoder_cyclic_error=3.0)
    read = encoder(spec.drives["x_slide"].at_axis(rotary=False))
    assert read(2.5e-3) == pytest.approx(2.5e-3 + 3e-6)
    assert read(5.0e-3) == pytest.approx(5.0e-3)
    assert drive.encoder_cyclic_error == 0.0


def test_cyclic_error_of_the_encoder_turns_the_work() -> None:
    """The loop follows the reading, so a slow axis is off by -A sin(n q); the reading itself keeps to it."""
    spec = changed_drive(EXACT, "work_spindle", encoder_cyclic_error=30.0, encoder_cyclic_order=3.0)
    ticks = 22_000
    setpoint = np.zeros((ticks, 4))
    setpoint[:, WORK] = ramp(20.0, 40.0, ticks)
    feedback = move(machine(spec), setpoint)
    turn = slice(-18_000, None)  # one turn at 20 deg/s
    angle = np.radians(feedback.actual[turn, WORK])
    off = (feedback.actual - feedback.setpoint)[turn, WORK] * 3600.0
    amplitude = 2.0 * np.abs(np.mean(off * np.exp(-3j * angle)))
    assert amplitude == pytest.approx(30.0, rel=1e-3)
    assert off @ np.sin(3 * angle) < 0.0
    assert np.abs(feedback.readings - feedback.setpoint)[turn, WORK].max() * 3600.0 < 0.1


def test_counts_leave_less_than_themselves_on_a_moving_axis() -> None:
    """A coarse scale of 3.6 arcsec on C: the axis keeps to its setpoint within two counts."""
    spec = changed_drive(DELIVERED, "work_spindle", encoder_counts=360_000.0)
    setpoint = np.zeros((4000, 4))
    setpoint[:, WORK] = ramp(90.0, 180.0, 4000)
    off = (move(machine(spec), setpoint).actual - setpoint)[-2000:, WORK] * 3600.0
    assert 0.1 < np.abs(off).max() < 7.2


def test_backlash_is_lost_at_every_reversal() -> None:
    """12 µm on X: behind by half of it either way, so that turning round loses all of it."""
    spec = changed_drive(EXACT, "x_slide", backlash=12.0)
    t = np.arange(1, 4001) * PERIOD
    setpoint = np.zeros((4000, 4))
    setpoint[:, X] = 0.4 * np.sin(np.pi * t)  # there and back, twice
    feedback = move(machine(spec), setpoint)
    off = (feedback.readings - feedback.actual)[:, X] * 1e3
    going = np.gradient(feedback.readings[:, X])
    steady = (np.abs(np.cos(np.pi * t)) > 0.5) & (t > 0.1)
    np.testing.assert_allclose(off[steady], 6.0 * np.sign(going[steady]), rtol=0, atol=1e-9)
    assert np.abs(off).max() <= 6.0 + 1e-9


@given(st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=40), st.integers(1, 7))
def test_load_stays_in_its_play_and_moves_only_when_taken_along(motor: list[float], size: int) -> None:
    whole = Backlash(2.0, 10.0).follow(np.array(motor))
    assert (np.abs(whole - motor) <= 1.0 + 1e-12).all()
    before = np.concatenate([[0.0], whole[:-1]])
    touching = np.isclose(np.abs(whole - motor), 1.0, rtol=0, atol=1e-12)
    assert ((whole == before) | touching).all()
    parts = Backlash(2.0, 10.0)
    pieces = [parts.follow(np.array(motor[k : k + size])) for k in range(0, len(motor), size)]
    np.testing.assert_array_equal(np.concatenate(pieces), whole)


def test_a_push_beyond_friction_lays_the_load_against_its_flank() -> None:
    spec = changed_drive(EXACT, "work_spindle", backlash=40.0)
    friction = spec.drives["work_spindle"].coulomb_friction

    def pushed(torque: float) -> float:
        force = np.array([0.0, 0.0, 0.0, torque])
        feedback = move(machine(spec), np.zeros((500, 4)), load=lambda _, n: np.tile(force, (n, 1)))
        return float((feedback.actual - feedback.readings)[-1, WORK]) * 3600.0

    assert pushed(1.5 * friction) == pytest.approx(20.0, abs=1e-6)
    assert pushed(-1.5 * friction) == pytest.approx(-20.0, abs=1e-6)
    assert abs(pushed(0.5 * friction)) < 20.0


def test_motor_runs_no_faster_than_its_speed_limit() -> None:
    """The tool spindle at 6000 1/min, whatever is asked."""
    spec = changed(FRICTIONLESS, error_limit=1e9, overload_time_s=1e3)
    setpoint = np.zeros((1500, 4))
    setpoint[:, TOOL] = 60_000.0 * np.arange(1, 1501) * PERIOD
    actual = move(machine(spec), setpoint).actual[:, TOOL]
    np.testing.assert_allclose(np.diff(actual[-200:]) / PERIOD, 36_000.0, rtol=1e-6)


def test_a_motor_that_stands_at_its_limit_gives_an_alarm() -> None:
    """C pushed by 350 N m against 300: after the overload time, to the tick."""
    spec = changed(FRICTIONLESS, error_limit=1e9)
    push = np.array([0.0, 0.0, 0.0, 350.0])
    feedback = move(machine(spec), np.zeros((3000, 4)), load=lambda _, n: np.tile(push, (n, 1)))
    (alarm,) = feedback.alarms
    assert (alarm.number, alarm.axis) == ("SV0436", WORK)
    assert alarm.found == "work_spindle: motor at its limit of 300 N m for 1 s"
    assert 1000 <= feedback.ticks < 1040  # the loops need some ticks to ask for all of it


INDUCTION = changed_drive(EXACT, "tool_spindle", kind=DriveKind.VARIABLE_FREQUENCY)


@pytest.mark.parametrize("torque", [0.0, 4.0, -12.0, 30.0])
def test_induction_motor_slips_as_kloss_says(torque: float) -> None:
    """Steady state: torque of friction and load = 2 M_b / (s/s_b + s_b/s) solved for the slip s."""
    ticks, rpm = 3000, 900.0
    setpoint = np.zeros((ticks, 4))
    setpoint[:, TOOL] = ramp(6.0 * rpm, 6000.0, ticks)
    pull = np.array([0.0, 0.0, -torque, 0.0])
    feedback = move(machine(INDUCTION), setpoint, load=lambda _, n: np.tile(pull, (n, 1)))
    speed = float(np.diff(feedback.actual[-2:, TOOL])[0]) / PERIOD * SI_PER_DEG
    drive = INDUCTION.drives["tool_spindle"]
    asked = torque + drive.coulomb_friction + drive.viscous_friction * speed
    share = asked / drive.torque_limit
    slip = drive.breakdown_slip * RPM * (1.0 - math.sqrt(1.0 - share**2)) / share
    assert rpm * RPM - speed == pytest.approx(slip, rel=1e-5)
    assert not feedback.alarms


def test_induction_motor_stalls_beyond_its_breakdown_torque() -> None:
    setpoint = np.zeros((3000, 4))
    setpoint[:, TOOL] = ramp(5400.0, 6000.0, 3000)

    def load(first: int, n: int) -> np.ndarray:
        braked = np.arange(first, first + n) > 2000
        speed = np.where(braked, -41.0, 0.0)
        return np.outer(speed, [0.0, 0.0, 1.0, 0.0])

    feedback = move(machine(INDUCTION), setpoint, load=load)
    assert np.diff(feedback.actual[1990:2000, TOOL]).min() / PERIOD > 5000.0
    assert np.diff(feedback.actual[-2:, TOOL])[0] < 0.0


def test_a_servo_follows_an_induction_master_by_its_encoder() -> None:
    """Follow type: the work keeps to the measured hob within an arc second while the hob slips."""
    setpoint = np.zeros((4000, 4))
    setpoint[:, TOOL] = ramp(1800.0, 3600.0, 4000)
    follower = Follow(slave=WORK, master=TOOL, numerator=1, denominator=20, offset=0.0)
    pull = np.array([0.0, 0.0, -10.0, 0.0])
    feedback = move(
        machine(INDUCTION), setpoint, couplings=(follower,), load=lambda _, n: np.tile(pull, (n, 1))
    )
    assert feedback.actual[-1, TOOL] < setpoint[-1, TOOL] - 90.0
    off = (feedback.actual[:, WORK] - feedback.actual[:, TOOL] / 20)[-1000:] * 3600.0
    assert np.abs(off).max() < 1.0


def test_an_induction_motor_cannot_be_the_slave() -> None:
    follower = Follow(slave=TOOL, master=WORK, numerator=2, denominator=1, offset=0.0)
    with pytest.raises(MachineError, match="tool_spindle is the slave of the gear box"):
        move(machine(INDUCTION), np.zeros((3, 4)), couplings=(follower,))
