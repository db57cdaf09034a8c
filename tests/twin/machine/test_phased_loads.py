"""Loads that belong to a spindle's angle, and how far a drive gives way under a steady one."""

import numpy as np
import pytest
from mounted import FRICTIONLESS, PERIOD, TOOL, changed_drive, machine, move

from twin.machine.pressing import PhasedLoad, Pressing


class Pulses:
    """N m on the tool spindle, one period a degree, found on a motion of one degree a tick."""

    spindle = TOOL

    def angle_deg(self, first_tick: int, ticks: int) -> np.ndarray:
        return np.arange(first_tick, first_tick + ticks, dtype=float)

    parts = 4

    def impulse(self, first_tick: int, ticks: int) -> np.ndarray:
        # its mean over a tick is the force at the tick's start, wherever that begins
        at = first_tick + np.arange(ticks * self.parts + 1) / self.parts
        summed = np.zeros((len(at), 4))
        summed[:, TOOL] = 5.0 * (at**2 - at)
        return summed

    def __call__(self, first_tick: int, ticks: int) -> np.ndarray:
        forces = np.zeros((ticks, 4))
        forces[:, TOOL] = 10.0 * self.angle_deg(first_tick, ticks)
        return forces


def test_a_load_comes_with_its_angle_not_with_its_time() -> None:
    """The force is ten times the angle, so whatever the lag, force over angle is ten."""
    load = Pulses()
    assert isinstance(load, PhasedLoad)
    pressing = Pressing(load, 100, 50, 4)
    for row, lag in enumerate(np.linspace(-20.0, 20.0, 50)):
        angle = 100.0 + row + lag
        felt = pressing.feel(row, np.radians(angle), 1.0)
        assert felt[TOOL] == pytest.approx(10.0 * angle, rel=1e-9)
        assert felt[:TOOL] == [0.0, 0.0]
    assert len(pressing.felt) == 50


def test_an_edge_that_stands_or_goes_back_feels_nothing() -> None:
    pressing = Pressing(Pulses(), 100, 2, 4)
    assert pressing.feel(0, np.radians(100.0), 0.0) == [0.0] * 4
    assert pressing.feel(1, np.radians(101.0), -1.0) == [0.0] * 4


def test_a_load_without_a_motion_goes_by_the_clock() -> None:
    pressing = Pressing(lambda first, n: np.full((n, 4), float(first)), 7, 3, 4)
    assert pressing.feel(2, 123.0, -5.0) == [7.0] * 4


def test_steady_torque_bends_a_drive_without_integral_by_torque_over_loop_stiffness() -> None:
    """Kp Kv is what a position loop on a proportional velocity loop holds against: droop = T / (Kp Kv)."""
    spec = changed_drive(FRICTIONLESS, "tool_spindle", integral_time_s=1e9)
    driven = machine(spec)
    torque = 8.0
    load = np.zeros(4)
    load[TOOL] = -torque
    feedback = move(driven, np.zeros((1500, 4)), load=lambda _first, n: np.tile(load, (n, 1)))
    drive = spec.drives["tool_spindle"]
    stiffness = drive.velocity_gain * driven.assembly.inertia()[TOOL, TOOL] * drive.position_gain
    assert np.radians(feedback.actual[-1, TOOL]) == pytest.approx(-torque / stiffness, rel=1e-6)


def test_the_integral_takes_a_steady_torque_back() -> None:
    load = np.zeros(4)
    load[TOOL] = -8.0
    feedback = move(machine(FRICTIONLESS), np.zeros((2000, 4)), load=lambda _first, n: np.tile(load, (n, 1)))
    assert abs(feedback.actual[:, TOOL]).max() > 0.01
    assert feedback.actual[-1, TOOL] == pytest.approx(0.0, abs=1e-9)
    assert PERIOD == 1e-3
