"""Rulings, section 2, the follow type (201#7 = 1): the slave rides on the measured master."""

import numpy as np
import pytest

FOLLOW = {"201#7": 1}


def test_follow_rides_on_the_measured_master(drive) -> None:
    """Follow type: slave setpoint = ratio × measured master, from the phase both held."""

    class Lagging:
        """The hob lags by 20 ticks, the other drives are ideal."""

        def __init__(self) -> None:
            self.past = [0.0] * 20

        def advance(self, chunk):
            from controller.clock import Feedback

            setpoint = np.array(chunk.setpoint)
            actual = np.array(setpoint)
            for k, row in enumerate(setpoint):
                self.past.append(row[2])
                actual[k, 2] = self.past[-21]
                for link in chunk.couplings:
                    row[link.slave] += (
                        link.offset + link.numerator / link.denominator * actual[k, link.master]
                    )
                actual[k, 3] = row[3]
            self.actual = actual
            return Feedback(ticks=chunk.ticks, setpoint=setpoint, actual=actual)

    text = "G00 Y90.\nG81 T4 L1\nS300\nG04 X1.\nG80\nG04 X1.\nM30"
    driven = drive(text, parameters=FOLLOW, drives=Lagging())
    assert not driven.controller.alarms
    hob, work = driven.axis("Y"), driven.axis("C")
    lagging = np.concatenate([np.zeros(20), hob[:-20]])
    engaged = np.flatnonzero(driven.sync)
    phase = lagging[engaged[0] - 1]
    expected = (lagging[engaged] - phase) / 4
    assert np.abs(work[engaged] - expected).max() < 1e-9
    assert np.abs(np.diff(work)).max() < 0.46  # no jump at release: 75 rpm are 0.45 deg a tick
    assert work[-1] > work[engaged[-1]] + 0.9 * 450.0**2 / 7200.0


def test_follow_ignores_the_sign_of_s(run) -> None:
    """Hobbing, 注 4: the sense of the master does not depend on the sign of S; said as a warning."""
    result = run("G81 T20 L1\nS-300\nG04 X1.\nS0\nG80\nM30", parameters=FOLLOW)
    assert [w.number for w in result.warnings] == ["HT9106"]
    assert result.turns["Y"] > 0


def test_follow_and_interpolated_agree_on_an_ideal_machine(drive) -> None:
    text = "G81 T20 L1 Q2. P20.\nS300\nG01 Z-3. F200\nG00 H5.\nS0\nG80\nG00 C0\nM30"
    one, other = drive(text), drive(text, parameters=FOLLOW)
    assert one.axis("C")[-1] % 360 == pytest.approx(other.axis("C")[-1] % 360, abs=1e-9)
    assert np.abs(one.axis("C") - other.axis("C")[: len(one.axis("C"))]).max() < 2.0
