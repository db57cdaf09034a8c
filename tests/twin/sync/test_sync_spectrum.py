"""Synchronisation error and its spectrum against errors put in by hand."""

import numpy as np
import pytest

from controller.clock import Chunk, Feedback, Geared
from twin.sync import spectrum, sync_error


def geared(**values: object) -> Geared:
    return Geared(
        **({"first": 0, "last": 4, "slave": 2, "master": 1, "numerator": 1, "denominator": 20} | values)
    )  # pyright: ignore[reportArgumentType]


def error_of(gear: Geared, off: list[float], encoder: list[float] | None = None) -> np.ndarray:
    """Of four ticks in which the axes (Z, hob, work) stand this far from their setpoints."""
    setpoint = np.arange(12.0).reshape(4, 3)
    actual = setpoint + np.array(off)
    chunk = Chunk(
        first_tick=0,
        setpoint=setpoint,
        block=np.zeros(4, np.int32),
        sync=np.ones(4, bool),
        tool=np.zeros(4, np.int16),
        gears=(gear,),
    )
    measured = None if encoder is None else actual + np.array(encoder)
    return sync_error(chunk, Feedback(ticks=4, setpoint=setpoint, actual=actual, measured=measured))


def test_error_is_what_the_slave_owes_to_master_and_slide() -> None:
    interpolated, follow = geared(follow=False), geared(follow=True)
    assert error_of(interpolated, [0, 0, 0.001]) == pytest.approx(3.6)
    assert error_of(interpolated, [0, 0.2, 0.01]) == pytest.approx(0.0, abs=1e-9)
    assert error_of(interpolated, [5.0, 0.2, 0]) == pytest.approx(-36.0)
    # the follow type was told ratio x measured: the master's lag costs nothing, its encoder's error does
    assert error_of(follow, [0, 0.2, 0]) == pytest.approx(0.0, abs=1e-9)
    assert error_of(follow, [0, 0.2, 0], [0, 0.02, 0]) == pytest.approx(3.6)
    helical = geared(follow=False, slides=((0, -2.0),))
    assert error_of(helical, [0.001, 0, 0]) == pytest.approx(7.2)
    assert error_of(helical, [0.001, 0.2, 0.01 - 0.002]) == pytest.approx(0.0, abs=1e-9)


def test_error_is_told_only_in_sync_and_for_ticks_that_were_made() -> None:
    late = error_of(geared(follow=False, first=2, last=9), [0, 0, 0.001])
    assert np.isnan(late[:2]).all()
    assert late[2:] == pytest.approx(3.6)


def hobbing(seconds: float, tick: float = 1e-3, rpm: float = 15.0):
    """Time, work and hob angle: 0.5 s of ramp, then constant speed; 20 hob turns a work turn, backwards."""
    t = np.arange(1, round(seconds / tick) + 1) * tick
    work = -6.0 * rpm * np.where(t < 0.5, t**2, t - 0.25)
    return t, work, 20.0 * work


def test_lines_put_in_are_found_at_their_orders() -> None:
    t, work, hob = hobbing(30.0)
    turned = np.radians(work)
    error = -12.0 + 5.0 * np.sin(turned + 0.3) + 3.0 * np.cos(20 * turned) + 0.5 * np.sin(46 * turned)
    error[t < 0.2] = np.nan
    found = spectrum(t, error, work, hob)
    assert found
    assert found.begin_s >= 0.5
    assert (found.work_rpm, found.tool_rpm) == pytest.approx((-15.0, -300.0), rel=1e-9)
    assert found.mean_arcsec == pytest.approx(-12.0, abs=1e-3)
    assert found.rms_arcsec == pytest.approx(np.sqrt((25 + 9 + 0.25) / 2), rel=1e-3)
    lines = found.strongest(3)
    assert [line[0] for line in lines] == pytest.approx([1.0, 20.0, 46.0])
    assert [line[1] for line in lines] == pytest.approx([0.05, 1.0, 2.3])
    assert [line[2] for line in lines] == pytest.approx([5.0, 3.0, 0.5], abs=1e-3)


def test_the_longest_stretch_at_constant_speed_is_taken() -> None:
    """15 rpm for 10 s, then 30 rpm for 20 s: the later one."""
    t, slow, _ = hobbing(10.0)
    late = t[-1] + np.arange(1, 20_001) * 1e-3
    work = np.concatenate([slow, slow[-1] - 180.0 * (late - t[-1])])
    time = np.concatenate([t, late])
    error = np.where(time > 10.0, -8.0, -4.0)
    found = spectrum(time, error, work, 20 * work)
    assert found
    assert found.begin_s > 10.0
    assert found.mean_arcsec == pytest.approx(-8.0)
    assert found.work_rpm == pytest.approx(-30.0)


@pytest.mark.parametrize("seconds", [0.0, 0.05, 3.0])
def test_less_than_a_turn_has_no_spectrum(seconds: float) -> None:
    t, work, hob = hobbing(seconds)
    assert spectrum(t, np.zeros(len(t)), work, hob) is None


def test_nothing_in_sync_has_no_spectrum() -> None:
    t, work, hob = hobbing(20.0)
    assert spectrum(t, np.full(len(t), np.nan), work, hob) is None
