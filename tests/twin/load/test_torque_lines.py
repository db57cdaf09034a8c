"""The largest line of the torque's spectrum: pulses of known frequency, strength and shape."""

import numpy as np
import pytest

from twin.load.lines import largest_line
from twin.load.timeline import CuttingLoad, joined

TICK_S = 1e-3


def cut(torque, *, first=0, rate=1.8):
    """A cut with a torque (n,) on the tool, which turns by `rate` [deg] a tick."""
    ticks = first + np.flatnonzero(torque)
    axes = np.zeros((len(ticks), 4))
    axes[:, 2] = torque[ticks - first]
    every = first + np.arange(len(torque), dtype=np.int64)
    return CuttingLoad(
        spindle=2,
        angle=(every, np.asarray(rate * (every + 1.0), dtype=np.float64)),
        cell=ticks,
        axes=axes,
        tool=np.zeros((len(ticks), 3)),
        power_w=np.abs(axes[:, 2]),
        removed_mm3=np.ones(len(ticks)),
        compliance_um_per_n=0.02,
    )


def test_edges_that_come_evenly_are_the_line_of_their_frequency():
    """12 edges at 300 1/min: 60 Hz. 15 of 50 samples in three pulses have their third harmonic
    at 2/50 sin(0.3 π) / sin(π/50) = 0.515 of their height; torque that grows slowly is no line."""
    tick = np.arange(20_000)
    torque = -10.0 * (3 * tick % 50 < 15) * (0.5 + tick / 20_000)
    line = largest_line(cut(torque), TICK_S)
    assert line
    assert line.hz == pytest.approx(60.0, abs=0.05)
    assert line.per_turn == pytest.approx(12.0, abs=0.01)
    assert line.amplitude == pytest.approx(10.0 * 0.515, rel=0.01)


def test_a_sine_over_a_mean_has_its_own_amplitude_whichever_way_the_tool_turns():
    tick = np.arange(6_000)
    torque = (
        20.0 + 5.0 * np.sin(2 * np.pi * 47.5 * TICK_S * tick) + 2.0 * np.sin(2 * np.pi * 90 * TICK_S * tick)
    )
    for rate in (3.6, -3.6):
        line = largest_line(cut(torque, rate=rate), TICK_S)
        assert line
        assert line.hz == pytest.approx(47.5, abs=0.1)
        assert line.amplitude == pytest.approx(5.0, rel=0.01)
        assert line.per_turn == pytest.approx(4.75, rel=0.01)


def test_the_cut_that_takes_most_energy_is_heard():
    tick = np.arange(4_000)
    small, large = (a * (1.2 + np.sin(2 * np.pi * f * TICK_S * tick)) for a, f in ((3.0, 80.0), (30.0, 33.0)))
    line = largest_line(joined([cut(small), cut(large, first=9_000), cut(small, first=20_000)]), TICK_S)
    assert line
    assert line.hz == pytest.approx(33.0, abs=0.2)


def test_nothing_is_heard_of_no_cut_or_of_some_turns():
    assert largest_line(cut(np.zeros(500)), TICK_S) is None
    assert largest_line(cut(np.ones(500)), TICK_S) is None
