"""Step and Bode checks: the drives in MuJoCo against the transfer function of their loop."""

from dataclasses import replace

import numpy as np
import pytest
from mounted import DELIVERED, EXACT, FRICTIONLESS, PERIOD, changed, machine, move

from twin.machine import MachineSpec, MujocoMachine, Setup
from twin.machine.loops import Loops
from twin.machine.servo import tune

HERTZ = np.array([2.0, 6.0, 10.0, 20.0, 34.0, 60.0, 90.0, 140.0, 220.0])
WITHOUT_STICTION = changed(EXACT, coulomb_friction=0.0)


def loops_of(driven: MujocoMachine) -> Loops:
    assembly = driven.assembly
    mass = assembly.inertia()
    return Loops(
        mass=mass,
        viscous=np.array([d.drive.viscous_friction for d in assembly.drives()]),
        gains=[tune(d, i) for d, i in zip(assembly.drives(), mass.diagonal(), strict=True)],
        period_s=assembly.spec.control_period_s,
        substeps=assembly.spec.substeps,
    )


def measured_response(spec: MachineSpec, setup: Setup, axis: int) -> np.ndarray:
    """(n, axes) response of all axes to small sines on one of them, all frequencies at once."""
    driven = machine(spec, setup)
    axes = len(driven.assembly.joints)
    settle, window = 800, 500  # [ticks]: every frequency has whole periods in the window
    t = np.arange(1, settle + window + 1) * spec.control_period_s
    setpoint = np.zeros((len(t), axes))
    setpoint[:, axis] = (1e-3 * np.sin(2 * np.pi * HERTZ * t[:, None]) / HERTZ).sum(axis=1)
    actual = move(driven, setpoint).actual
    given = np.fft.rfft(setpoint[settle:, axis])
    bins = np.rint(HERTZ * window * spec.control_period_s).astype(int)
    return np.fft.rfft(actual[settle:], axis=0)[bins] / given[bins, None]


@pytest.mark.parametrize("feedforward", [0.0, 1.0])
@pytest.mark.parametrize("axis", range(4))
def test_bode_of_every_axis(axis: int, feedforward: float) -> None:
    """Small signals, viscous friction on, nothing saturated: the sampled loop to the last digits."""
    spec = changed(WITHOUT_STICTION, velocity_feedforward=feedforward, acceleration_feedforward=feedforward)
    expected = loops_of(machine(spec)).frequency_response(HERTZ)[:, :, axis]
    found = measured_response(spec, Setup.HOBBING, axis)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7)
    if not feedforward:
        assert abs(expected[-1, axis]) < 0.3, "a check above the bandwidth"


def test_bode_of_the_coupled_slides_shows_their_cross_talk() -> None:
    """X and the tilted slide share mass: X answers to the tilted slide's setpoint, in mm per mm."""
    spec = replace(changed(WITHOUT_STICTION, acceleration_feedforward=0.0), physics_step_s=PERIOD / 2)
    expected = loops_of(machine(spec, Setup.TILTED)).frequency_response(HERTZ)[:, :, 2]
    found = measured_response(spec, Setup.TILTED, 2)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7)
    assert 0.01 < np.abs(expected[:, 0]).max() < 0.5


def test_sampled_response_tends_to_the_textbook_loop() -> None:
    """H(s) = (C (Kv + k_ff s) + k_a s²) / (s² + C (Kv + s)), C = Kp (1 + 1/(Ti s)) over the inertia: the
    difference shrinks with the period, by half when it is halved."""
    s = 2j * np.pi * HERTZ
    loops = loops_of(machine(FRICTIONLESS))
    for k, joint in enumerate(DELIVERED.setups[Setup.HOBBING]):
        drive = DELIVERED.drives[joint]
        pi = drive.velocity_gain * (1.0 + 1.0 / (drive.integral_time_s * s))
        above = pi * (drive.position_gain + drive.velocity_feedforward * s)
        textbook = (above + drive.acceleration_feedforward * s**2) / (s**2 + pi * (drive.position_gain + s))
        off = [
            np.abs(
                replace(loops, period_s=period).alone(k).frequency_response(HERTZ)[:, 0, 0] - textbook
            ).max()
            for period in (2e-5, 1e-5)
        ]
        assert off[0] < 5e-3
        assert 0.45 < off[1] / off[0] < 0.55


@pytest.mark.parametrize("setup", Setup)
def test_full_feedforward_on_free_bodies_follows_exactly(setup: Setup) -> None:
    """With k_ff = k_a = 1 and uncoupled bodies the loops have nothing to mend, whatever the motion."""
    spec = changed(FRICTIONLESS, velocity_feedforward=1.0, acceleration_feedforward=1.0)
    driven = machine(spec, setup)
    axes = len(driven.assembly.joints)
    t = np.arange(1, 2001)[:, None] * PERIOD
    free = [k for k, j in enumerate(driven.assembly.joints) if j not in {"x_slide", "tilted_slide"}]
    setpoint = np.zeros((len(t), axes))
    setpoint[:, free] = (np.sin(9.0 * t) * np.minimum(t, 1.0) + t**2)[:, [0] * len(free)] * 5.0
    np.testing.assert_allclose(move(driven, setpoint).actual, setpoint, rtol=0, atol=1e-9)


@pytest.mark.parametrize("axis", range(4))
def test_step_of_every_axis_is_the_inverse_transform_of_its_bode(axis: int) -> None:
    """The step response summed from the frequency response over one long period of a square wave."""
    spec = changed(WITHOUT_STICTION, velocity_feedforward=0.0, acceleration_feedforward=0.0)
    driven = machine(spec)
    n = 4000
    square = np.where(np.arange(n) < n // 2, 1e-3, 0.0)
    hertz = np.fft.rfftfreq(n, PERIOD)
    response = loops_of(driven).alone(axis).frequency_response(hertz)[:, 0, 0]
    expected = np.fft.irfft(response * np.fft.rfft(square), n)
    setpoint = np.zeros((3 * n, 4))
    setpoint[:, axis] = np.tile(square, 3)
    actual = move(driven, setpoint).actual[-n:, axis]
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-9)
    assert actual[n // 2 - 1] == pytest.approx(1e-3, rel=1e-6)
