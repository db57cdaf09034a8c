"""Closed-form motion against its own differential equation, and the quickest way against lower bounds."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.laws.segments import Phase, Track, clip, trapezoid
from controller.laws.wave import Wave
from controller.motion.sampling import positions

lengths = st.floats(1e-3, 1e3)
speeds = st.floats(0.1, 500.0)
rates = st.floats(10.0, 5000.0)


def check(phases: list[Phase], start_speed: float, length: float) -> None:
    """Continuous in position and speed, from start to standstill at the end."""
    position, speed = 0.0, start_speed
    for phase in phases:
        assert phase.duration >= 0.0
        assert phase.start == pytest.approx(position, abs=1e-9 * max(1.0, length))
        assert phase.speed == pytest.approx(speed, abs=1e-9 * max(1.0, start_speed, phase.speed))
        position, speed = phase.end, phase.end_speed
    assert position == pytest.approx(length, rel=1e-9)
    assert speed == pytest.approx(0.0, abs=1e-6 * max(phase.speed for phase in phases))


@given(lengths, speeds, rates)
def test_from_rest(length: float, speed: float, rate: float) -> None:
    """T = L/v + v/a where the speed is reached, else 2 √(L/a): the textbook times."""
    phases = trapezoid(length, speed=speed, acceleration=rate)
    check(phases, 0.0, length)
    assert all(abs(phase.acceleration) <= rate * (1 + 1e-12) for phase in phases)
    assert all(max(phase.speed, phase.end_speed) <= speed * (1 + 1e-12) for phase in phases)
    reached = length >= speed * speed / rate
    expected = length / speed + speed / rate if reached else 2.0 * math.sqrt(length / rate)
    assert sum(phase.duration for phase in phases) == pytest.approx(expected, rel=1e-9)


@given(lengths, speeds, rates, st.floats(0.01, 600.0))
def test_from_any_speed(length: float, speed: float, rate: float, start: float) -> None:
    phases = trapezoid(length, speed=speed, acceleration=rate, start_speed=start)
    check(phases, start, length)
    if start * start / (2.0 * rate) < length:
        assert all(abs(phase.acceleration) <= rate * (1 + 1e-12) for phase in phases)


@given(lengths, speeds, rates, st.floats(0.0, 1.0))
def test_a_motion_in_two_parts_is_the_same_motion(
    length: float, speed: float, rate: float, cut: float
) -> None:
    """Semigroup: stop thinking anywhere, plan the rest anew, arrive at the same time."""
    whole = trapezoid(length, speed=speed, acceleration=rate)
    total = sum(phase.duration for phase in whole)
    first = clip(whole, cut * total)
    if not first or length - first[-1].end < 1e-6 * length:
        return
    rest = trapezoid(
        length - first[-1].end, speed=speed, acceleration=rate, start_speed=max(first[-1].end_speed, 0.0)
    )
    both = sum(phase.duration for phase in first) + sum(phase.duration for phase in rest)
    assert both == pytest.approx(total, rel=1e-5, abs=1e-6)


def test_track_evaluates_its_polynomials() -> None:
    track = Track()
    track.add(0.0, 5.0)
    track.add(1.0, 5.0, 2.0, 4.0)
    track.add(2.0, 9.0, 6.0)
    track.add(3.0, 15.0)
    time = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.25, 3.0, 100.0])
    expected = [5.0, 5.0, 5.0, 6.5, 9.0, 10.5, 15.0, 15.0]
    assert positions(track, time).tolist() == expected
    assert [track.at(t) for t in time] == expected
    assert [track.speed(t) for t in (0.5, 1.5, 2.5, 3.5)] == [0.0, 4.0, 6.0, 0.0]
    assert track.still_until(0.0) == 1.0
    assert track.still_until(1.5) == 1.5
    assert track.still_until(3.0) == math.inf
    track.forget(2.1)
    assert positions(track, time[5:]).tolist() == expected[5:]


def test_the_sample_at_a_knot_does_not_know_what_is_planned_behind_it() -> None:
    """An operator may change everything from a tick on: the setpoint of that tick has been given already."""
    track = Track()
    track.add(1.0, 0.0, 3.0)
    before = positions(track, np.array([1.5, 2.1]))
    track.add(2.1, 7.0, 1.0)
    assert positions(track, np.array([1.5, 2.1])).tobytes() == before.tobytes()
    assert (track.at(2.1), track.speed(2.1)) == (7.0, 1.0)


def test_round_pieces_are_circles() -> None:
    """Two axes on the same angle: the radius is kept, and a turn at constant speed is uniform."""
    x, y = Track(), Track()
    x.add_round(1.0, Wave(10.0, 5.0, 0.0), 0.0, 0.5, 0.1)
    y.add_round(1.0, Wave(-3.0, 0.0, 5.0), 0.0, 0.5, 0.1)
    time = np.linspace(0.9, 6.0, 1000)
    moving = time > 1.0
    dx, dy = positions(x, time)[moving] - 10.0, positions(y, time)[moving] + 3.0
    assert np.hypot(dx, dy) == pytest.approx(5.0, abs=1e-12)
    tau = time[moving] - 1.0
    assert np.unwrap(np.arctan2(dy, dx)) == pytest.approx(0.5 * tau + 0.05 * tau**2, abs=1e-9)
    assert [x.at(t) for t in time[moving]] == pytest.approx((dx + 10.0).tolist(), abs=1e-12)
    step = 1e-6
    for t in (1.5, 3.0, 5.9):
        assert y.speed(t) == pytest.approx((y.at(t + step) - y.at(t - step)) / (2 * step), rel=1e-6)
    assert x.still_until(2.0) == 2.0


def test_a_later_command_replaces_what_was_planned_behind_it() -> None:
    track = Track()
    track.add(1.0, 0.0, 1.0)
    track.add(5.0, 4.0)
    track.add(2.0, 1.0, -1.0)
    assert positions(track, np.array([1.5, 2.0, 3.0, 6.0])).tolist() == [0.5, 1.0, 0.0, -3.0]
