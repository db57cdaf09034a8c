"""The drives in MuJoCo against closed forms of the servo loop and of rigid-body mechanics."""

import math
import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mounted import DELIVERED, EXACT, FRICTIONLESS, PERIOD, TOOL, WORK, X, Z, changed, machine
from scipy.linalg import expm

from controller.clock import Chunk, Feedback, Follow, Load, Machine, Watch, WatchKind
from twin.errors import InputError
from twin.machine import (
    Drive,
    IdealMachine,
    MachineError,
    MachineSpec,
    Setup,
)
from twin.machine.loops import Loops
from twin.machine.servo import tune


def chunk_of(
    setpoint: np.ndarray, first: int = 0, couplings: tuple[Follow, ...] = (), watch: Watch | None = None
) -> Chunk:
    n = len(setpoint)
    return Chunk(
        first_tick=first,
        setpoint=setpoint,
        block=np.zeros(n, np.int32),
        sync=np.zeros(n, np.bool_),
        tool=np.zeros(n, np.int16),
        couplings=couplings,
        watch=watch,
    )


def run(
    on: Machine,
    setpoint: np.ndarray,
    couplings: tuple[Follow, ...] = (),
    load: Load | None = None,
    sizes: Iterator[int] | None = None,
) -> Feedback:
    """Feed the whole of `setpoint`, in chunks of the given sizes."""
    first, parts = 0, []
    while first < len(setpoint):
        size = len(setpoint) if sizes is None else next(sizes)
        parts.append(on.advance(chunk_of(setpoint[first : first + size], first, couplings), load))
        first += parts[-1].ticks
    return Feedback(
        ticks=first,
        setpoint=np.vstack([p.setpoint for p in parts]),
        actual=np.vstack([p.actual for p in parts]),
    )


def ramp(speed: float, acceleration: float, ticks: int) -> np.ndarray:
    """Position [unit] of an axis that accelerates from rest to `speed` [unit/s]."""
    t = np.arange(1, ticks + 1) * PERIOD
    reached = speed / acceleration
    return np.where(t < reached, acceleration * t**2 / 2, speed * (t - reached / 2))


def hobbing_motion(ticks: int, rpm: float = 300.0, ratio: float = 20.0) -> np.ndarray:
    """All four axes at once: gear box by interpolation, Z feed, X in and still."""
    setpoint = np.zeros((ticks, 4))
    setpoint[:, TOOL] = ramp(6.0 * rpm, 3600.0, ticks)
    setpoint[:, WORK] = setpoint[:, TOOL] / ratio
    setpoint[:, Z] = -ramp(0.5, 50.0, ticks)
    setpoint[:, X] = -np.minimum(ramp(20.0, 500.0, ticks), 30.0)
    return setpoint


def test_spindles_settle_within_arc_seconds() -> None:
    feedback = run(machine(), hobbing_motion(6000))
    error = (feedback.setpoint - feedback.actual)[2000:]
    assert np.abs(error[:, [TOOL, WORK]]).max() * 3600 < 0.1
    assert np.abs(error[:, [X, Z]]).max() < 1e-4


@pytest.mark.parametrize("k_ff", [0.0, 0.9, 1.0])
@pytest.mark.parametrize("spec", [EXACT, FRICTIONLESS], ids=["friction", "frictionless"])
def test_lag_at_constant_speed_is_that_of_the_position_loop(k_ff: float, spec: MachineSpec) -> None:
    """geometry.md, section 5: lag = (1 - k_ff) v / Kv, friction or not: the integrator carries it."""
    speeds = np.array([20.0, -8.0, 1800.0, -90.0])
    setpoint = np.column_stack([np.sign(v) * ramp(abs(v), 4.0 * abs(v), 3000) for v in speeds])
    feedback = run(machine(changed(spec, velocity_feedforward=k_ff)), setpoint)
    gains = np.array([spec.drives[j].position_gain for j in spec.setups[Setup.HOBBING]])
    lag = (feedback.setpoint - feedback.actual)[-500:]
    np.testing.assert_allclose(lag, np.tile((1 - k_ff) * speeds / gains, (500, 1)), rtol=1e-6, atol=1e-6)


def test_step_response_is_that_of_the_continuous_loop() -> None:
    """Against the exact solution of J q'' = Kp e + Ki ∫e, e = -Kv (q - r) - q', sampled ten times finer.

    A step given at tick 0 stands at its end. Holding the force for a period T, and taking the speed as the
    difference over the last one, delays the velocity loop by about T, which at bandwidth w shifts the
    response by less than w T / 2 of the step.
    """
    deviation = {}
    for period in (1e-4, 5e-5):
        spec = changed(FRICTIONLESS, velocity_feedforward=0.0, acceleration_feedforward=0.0)
        spec = replace(spec, control_period_s=period, physics_step_s=period)
        step = np.array([0.01, -0.02, 0.05, 0.02])  # small enough for the force limits
        ticks = np.rint(0.002 * np.arange(1, 196) / period).astype(int)
        feedback = run(machine(spec), np.tile(step, (int(0.4 / period), 1)))
        for axis, joint in enumerate(spec.setups[Setup.HOBBING]):
            drive = spec.drives[joint]
            kv, kp, ki = drive.position_gain, drive.velocity_gain, drive.velocity_gain / drive.integral_time_s
            # of (q - r, q', ∫e) over the inertia, which cancels
            error = np.array([-kv, -1.0, 0.0])
            system = np.array([[0.0, 1.0, 0.0], kp * error + [0.0, 0.0, ki], error])
            step_map = expm(system * 0.002)
            state, exact = np.array([-1.0, 0.0, 0.0]), np.zeros(len(ticks))
            for k in range(len(ticks)):
                state = step_map @ state
                exact[k] = 1.0 + state[0]
            assert exact[0] < 0.1
            assert exact[-1] > 0.999
            measured = feedback.actual[ticks, axis] / step[axis]
            deviation[joint, period] = np.abs(measured - exact).max()
            assert deviation[joint, period] < drive.velocity_gain * period / 2
    for joint in DELIVERED.setups[Setup.HOBBING]:
        assert 0.45 < deviation[joint, 5e-5] / deviation[joint, 1e-4] < 0.55, "first order in the period"


@pytest.mark.parametrize("setup", Setup)
def test_stability_map_predicts_the_physics(setup: Setup) -> None:
    """`Loops` against MuJoCo from the same start: small, frictionless, two physics steps a period."""
    spec = replace(
        changed(FRICTIONLESS, velocity_feedforward=0.0, acceleration_feedforward=0.0),
        physics_step_s=PERIOD / 2,
    )
    driven = machine(spec, setup)
    k = len(spec.setups[setup])
    offset = np.linspace(0.001, 0.002, k)
    feedback = run(driven, np.tile(offset, (200, 1)))
    assembly = driven.assembly
    mass = assembly.inertia()
    gains = [tune(d, i) for d, i in zip(assembly.drives(), mass.diagonal(), strict=True)]
    step, _ = Loops(mass=mass, viscous=np.zeros(k), gains=gains, period_s=PERIOD, substeps=2).closed()
    unit = np.where(["spindle" in j for j in assembly.joints], np.pi / 180, 1e-3)
    state = np.concatenate([-offset * unit, np.zeros(2 * k), -offset * unit])
    for tick in range(1, 200):  # the step reaches the loop after tick 0
        state = step @ state
        np.testing.assert_allclose(feedback.actual[tick], offset + state[:k] / unit, rtol=0, atol=1e-12)


def test_holding_speed_costs_friction_and_load() -> None:
    """Force at constant speed = Coulomb + viscous · v - load, to the last digits of the integrator."""
    driven = machine(EXACT)
    pull = np.array([500.0, -300.0, 2.0, -30.0])
    run(driven, hobbing_motion(4000), load=lambda first, n: np.tile(pull, (n, 1)))
    speeds = np.array([0.0, -0.5e-3, np.radians(1800.0), np.radians(90.0)])
    drives = [DELIVERED.drives[j] for j in driven.assembly.joints]
    expected = [
        d.coulomb_friction * np.sign(v) + d.viscous_friction * v - f
        for d, v, f in zip(drives, speeds, pull, strict=True)
    ]
    force = [driven.data.actuator(j).force[0] for j in driven.assembly.joints]
    np.testing.assert_allclose(force[1:], expected[1:], rtol=1e-6)
    assert abs(force[X] - expected[X]) <= drives[X].coulomb_friction  # at rest friction holds part of it


def test_force_at_the_limit_accelerates_as_newton_says() -> None:
    """Twice the acceleration that the limit can give: v = F t / J, and no windup afterwards."""
    driven = machine(FRICTIONLESS)
    inertia = driven.assembly.inertia().diagonal()
    limits = np.array([d.force_limit for d in driven.assembly.drives()])
    reach = limits / inertia * np.array([1e3, 1e3, 180 / np.pi, 180 / np.pi])  # [mm/s² | deg/s²]
    t = np.arange(1, 13)[:, None] * PERIOD
    feedback = run(driven, reach * t**2)
    velocity = np.diff(feedback.actual[2:], axis=0) / PERIOD
    np.testing.assert_allclose(np.diff(velocity, axis=0) / PERIOD, np.tile(reach, (8, 1)), rtol=1e-6)
    settled = driven.advance(chunk_of(np.tile(feedback.setpoint[-1], (2000, 1)), 12))
    np.testing.assert_allclose(settled.actual[-1], feedback.setpoint[-1], rtol=1e-9)


@pytest.mark.parametrize("size", [1, 7, 4096])
def test_a_load_beyond_the_drive_ends_the_chunk_in_an_alarm(size: int) -> None:
    """C is held by 300 N m; 700 N m turn it away as Newton says until the error limit."""
    driven, first, alarms = machine(FRICTIONLESS), 0, ()
    push = np.array([0.0, 0.0, 0.0, -700.0])
    while not alarms:
        feedback = driven.advance(chunk_of(np.zeros((size, 4)), first), lambda _, n: np.tile(push, (n, 1)))
        first, alarms = first + feedback.ticks, feedback.alarms
    (alarm,) = alarms
    assert (alarm.number, alarm.axis) == ("SV0410", WORK)
    assert alarm.found.startswith("work_spindle: following error ")
    assert alarm.found.endswith(" deg, limit 180 deg")
    assert feedback.actual[-1, WORK] < -180.0
    inertia = driven.assembly.inertia()[WORK, WORK]
    free_fall = math.sqrt(2 * math.pi * inertia / (700.0 - 300.0))
    assert first * PERIOD == pytest.approx(free_fall, abs=3 * PERIOD)


def test_a_motion_beyond_the_drive_is_named() -> None:
    setpoint = np.zeros((100, 4))
    setpoint[:, X] = np.arange(100) * 5.0  # 300 m/min at once
    feedback = machine().advance(chunk_of(setpoint))
    assert [(a.number, a.axis) for a in feedback.alarms] == [("SV0411", X)]
    error = np.abs(feedback.setpoint - feedback.actual)[:, X]
    limit = DELIVERED.drives["x_slide"].error_limit
    assert (error[:-1] <= limit).all()
    assert error[-1] > limit


def test_no_drift_over_thousands_of_turns() -> None:
    """3000 tool turns at 3000 rpm: the error of the second half stays within that of the first."""
    ticks = 61_000
    setpoint = np.zeros((ticks, 4))
    setpoint[:, TOOL] = ramp(18_000.0, 36_000.0, ticks)
    setpoint[:, WORK] = setpoint[:, TOOL] / 7
    feedback = run(machine(EXACT), setpoint)
    assert feedback.actual[-1, TOOL] / 360 > 3000
    error = np.abs(feedback.setpoint - feedback.actual)[:, [TOOL, WORK]]
    settled, late = error[3000:30_000].max(axis=0), error[-3000:].max(axis=0)
    rounding = 8 * np.spacing(feedback.actual[-1, [TOOL, WORK]])
    assert (late <= settled + rounding).all()
    assert (late * 3600 < 1e-3).all()


FOLLOWER = Follow(slave=WORK, master=TOOL, numerator=3, denominator=41, offset=1.25)


@pytest.mark.parametrize("k_ff", [0.8, 1.0])
def test_follower_lags_its_measured_master_as_theory_says(k_ff: float) -> None:
    """geometry.md, section 5, follow type: own lag (1 - k_ff) w_C / Kv_C behind the measured hob."""
    setpoint = np.zeros((4000, 4))
    setpoint[:, TOOL] = ramp(3600.0, 7200.0, 4000)
    spec = changed(EXACT, velocity_feedforward=k_ff)
    feedback = run(machine(spec), setpoint, couplings=(FOLLOWER,))
    wanted = 1.25 + 3 * feedback.actual[:, TOOL] / 41
    np.testing.assert_array_equal(feedback.setpoint[:, WORK], wanted)
    lag = (wanted - feedback.actual[:, WORK])[-500:]
    theory = (1 - k_ff) * (3600.0 * 3 / 41) / spec.drives["work_spindle"].position_gain
    np.testing.assert_allclose(lag, theory, rtol=1e-5, atol=1e-6)


@given(sizes=st.lists(st.integers(1, 200), min_size=1), follow=st.booleans(), loaded=st.booleans())
@settings(max_examples=10, deadline=None)
def test_chunks_do_not_change_a_bit(sizes: list[int], follow: bool, loaded: bool) -> None:
    def load(first: int, ticks: int) -> np.ndarray:
        return np.sin(np.arange(first, first + ticks))[:, None] * [100.0, 50.0, 1.0, 10.0]

    setpoint = hobbing_motion(600)
    couplings = (FOLLOWER,) if follow else ()
    if follow:
        setpoint[:, WORK] = 0.0
    whole = run(machine(), setpoint, couplings, load if loaded else None)

    def forever() -> Iterator[int]:
        while True:
            yield from sizes

    pieces = run(machine(), setpoint, couplings, load if loaded else None, forever())
    np.testing.assert_array_equal(pieces.actual, whole.actual)
    np.testing.assert_array_equal(pieces.setpoint, whole.setpoint)


def test_ideal_machine_is_where_it_is_told() -> None:
    setpoint = hobbing_motion(500)
    feedback = run(IdealMachine(4), setpoint, sizes=iter([1, 7, 492]))
    np.testing.assert_array_equal(feedback.actual, setpoint)
    np.testing.assert_array_equal(feedback.setpoint, setpoint)


def test_ideal_gear_box_is_exact_after_a_million_turns() -> None:
    """Integers: 41 tool turns are 3 work turns, whatever the count."""
    setpoint = np.zeros((3, 4))
    setpoint[:, TOOL] = 360.0 * 41 * np.array([0, 1, 25_000])
    feedback = run(IdealMachine(4), setpoint, couplings=(FOLLOWER,))
    np.testing.assert_array_equal(feedback.actual[:, WORK], 1.25 + 360.0 * 3 * np.array([0, 1, 25_000]))


IN_POSITION = Watch(kind=WatchKind.IN_POSITION, timeout_ticks=3000)


@pytest.mark.parametrize("size", [1, 7, 4096])
def test_in_position_ends_the_chunk_where_it_first_holds(size: int) -> None:
    """Oracle: the same motion unwatched, and the first tick with every following error within its width."""
    setpoint = np.zeros((3000, 4))
    setpoint[:, X], setpoint[:, TOOL] = -0.5, 20.0
    free = run(machine(), setpoint)
    width = np.array([DELIVERED.drives[j].in_position for j in DELIVERED.setups[Setup.HOBBING]])
    holds = (np.abs(free.setpoint - free.actual) <= width).all(axis=1)
    expected = int(np.argmax(holds)) + 1
    assert 10 < expected < 3000
    driven, first, signals = machine(), 0, {}
    while not signals.get("in_position"):
        feedback = driven.advance(chunk_of(setpoint[first : first + size], first, watch=IN_POSITION))
        np.testing.assert_array_equal(feedback.actual, free.actual[first : first + feedback.ticks])
        first, signals = first + feedback.ticks, feedback.signals
    assert first == expected
    assert signals == {"in_position": True, "timeout": False}


def test_speed_reached_waits_for_the_spindle() -> None:
    """A speed commanded at once: the drive needs J w / (M - friction) to get there."""
    speed = 6000.0  # [deg/s]
    setpoint = np.zeros((4000, 4))
    setpoint[:, WORK] = speed * np.arange(1, 4001) * PERIOD
    watch = Watch(kind=WatchKind.SPEED_REACHED, latch_axes=(WORK,), timeout_ticks=4000)
    driven = machine()
    feedback = driven.advance(chunk_of(setpoint, watch=watch))
    drive = DELIVERED.drives["work_spindle"]
    inertia = driven.assembly.inertia()[WORK, WORK]
    least = 0.95 * math.radians(speed) * inertia / (drive.torque_limit - drive.coulomb_friction)
    assert feedback.signals == {"speed_reached": True, "timeout": False}
    assert least <= feedback.ticks * PERIOD <= 1.3 * least + 0.01
    reached = np.diff(feedback.actual[-2:, WORK])[0] / PERIOD
    assert abs(reached - speed) <= 0.05 * speed


@pytest.mark.parametrize("size", [1, 40, 4096])
def test_a_watch_that_never_holds_times_out(size: int) -> None:
    """A load beyond the drive keeps it off its place."""
    driven, first, signals = machine(), 0, {}
    watch = replace(IN_POSITION, timeout_ticks=100)
    push = np.array([0.0, 0.0, 0.0, 400.0])
    while not signals.get("timeout"):
        chunk = chunk_of(np.tile([0.0, 0.0, 0.0, -1.0], (size, 1)), first, watch=watch)
        feedback = driven.advance(chunk, lambda _, n: np.tile(push, (n, 1)))
        first, signals = first + feedback.ticks, feedback.signals
    assert first == 100
    assert signals == {"in_position": False, "timeout": True}


@pytest.mark.parametrize("on", [machine, lambda: IdealMachine(4)], ids=["mujoco", "ideal"])
def test_skip_is_refused_by_name(on) -> None:
    with pytest.raises(MachineError, match=r"skip \(G31\) needs a touch probe"):
        on().advance(chunk_of(np.zeros((3, 4)), watch=Watch(kind=WatchKind.SKIP, timeout_ticks=9)))


@pytest.mark.parametrize("on", [machine, lambda: IdealMachine(4)], ids=["mujoco", "ideal"])
def test_broken_chunks_are_refused(on) -> None:
    refused = on()
    with pytest.raises(ValueError, match=r"setpoint: expected \(n, 4\), got \(3, 5\)"):
        refused.advance(chunk_of(np.zeros((3, 5))))
    with pytest.raises(ValueError, match="chunk starts at tick 7, the machine stands at 0"):
        refused.advance(chunk_of(np.zeros((3, 4)), 7))
    with pytest.raises(ValueError, match="setpoint of axis 2 is not finite at tick 1"):
        refused.advance(chunk_of(np.array([[0.0] * 4, [0.0, 0.0, math.nan, 0.0]])))
    with pytest.raises(ValueError, match="an axis follows twice, or follows a follower"):
        refused.advance(chunk_of(np.zeros((3, 4)), couplings=(FOLLOWER, FOLLOWER)))
    assert refused.advance(chunk_of(np.zeros((0, 4)))).actual.shape == (0, 4)


def test_a_load_of_the_wrong_shape_is_refused() -> None:
    with pytest.raises(ValueError, match=r"load: expected \(3, 4\), got \(3, 5\)"):
        machine().advance(chunk_of(np.zeros((3, 4))), lambda _, n: np.zeros((n, 5)))


def test_broken_physics_is_an_error_not_a_reset(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo logs its warning to the working directory
    with pytest.raises(MachineError, match="motion broke down between ticks 0 and 3"):
        machine().advance(chunk_of(np.zeros((3, 4))), lambda _, n: np.full((n, 4), 1e300))
    with pytest.raises(ValueError, match="load: not finite between ticks 0 and 3"):
        machine().advance(chunk_of(np.zeros((3, 4))), lambda _, n: np.full((n, 4), math.nan))


def test_unstable_gains_are_refused_with_the_limit_that_separates_them() -> None:
    """Just below the stated limit a kick dies out in the physics, just above it grows."""
    joint = "work_spindle"

    def with_gain(kv: float) -> MachineSpec:
        drive: Drive = replace(FRICTIONLESS.drives[joint], position_gain=kv)
        return replace(FRICTIONLESS, drives={**FRICTIONLESS.drives, joint: drive})

    with pytest.raises(InputError) as refusal:
        machine(with_gain(1e6))
    found = re.search(rf"{joint}: position_gain 1e\+06 .*stable below ([0-9.e+]+) 1/s", str(refusal.value))
    assert found
    limit = float(found[1])
    with pytest.raises(InputError, match="stable below"):
        machine(with_gain(1.001 * limit))
    kick = np.zeros((4000, 4))
    kick[:, WORK] = 1e-6
    error = np.abs(run(machine(with_gain(0.99 * limit)), kick).actual[:, WORK] - 1e-6)
    assert error[-100:].max() < 1e-3 * error[:100].max()


def test_an_unstable_velocity_loop_is_refused() -> None:
    with pytest.raises(InputError, match="x_slide: the velocity loop is unstable"):
        machine(changed(DELIVERED, velocity_gain=4000.0))
