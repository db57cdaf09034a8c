"""A probing cycle that goes wrong ends in an alarm with the figures, the machine drawn back."""

import numpy as np
import pytest
from touching import PERFECT, cycle, job_with, probed

from twin.machine import MachineError

START = "G00 X140. Z-6."


def run(folder, *lines, ideal=True, faults=None, **probe):
    return probed(job_with(faults, **PERFECT | probe), cycle(folder, *lines), ideal=ideal)


def drawn_back(session, x=140.0):
    """X stands where it came from, by the setpoint: machine zero is X400, the probe reaches 20 mm further."""
    return session.recording.setpoint[-1, 0] == pytest.approx(x / 2 - 200.0 + 20.0, abs=1e-6)


@pytest.mark.parametrize("ideal", [True, False])
def test_a_probe_that_never_triggers(tmp_path, ideal):
    session = run(tmp_path, "G00 X140. Z10.", "G65 P9810 A6. D110. Q0.5 R0.3 F60.", ideal=ideal)
    (alarm,) = session.alarms
    assert (alarm.number, alarm.found) == ("MC3001", "PROBE NEVER TRIGGERED")
    assert session.common[501] == 0
    assert session.common[502] == pytest.approx(54.7)
    assert drawn_back(session)


@pytest.mark.parametrize("ideal", [True, False])
def test_a_probe_that_triggers_at_once(tmp_path, ideal):
    """Two tenths inside of the band before it looks: the stylus is pushed back already; servo
    axes still settle then."""
    session = run(tmp_path, START, "G65 P9810 A6. D77. Q0.3 R0.3 F60.", ideal=ideal)
    (alarm,) = session.alarms
    assert (alarm.number, alarm.found) == ("MC3002", "PROBE TRIGGERED AT ONCE")
    assert session.common[502] == pytest.approx(38.8, abs=10e-3)
    assert drawn_back(session)


def test_too_few_touches(tmp_path):
    session = run(tmp_path, START, "G65 P9810 A2. D78. Q0.3 R0.3 F60.")
    (alarm,) = session.alarms
    assert alarm.number == "MC3003"
    assert drawn_back(session)


def test_a_band_out_of_round(tmp_path):
    """40 µm with e = 50 µm: more than 20 µm and than e/4."""
    faults = {"band_out_of_round_mm": 0.04, "band_lobes": 3}
    session = run(tmp_path, START, "G65 P9810 A12. D78. Q0.3 R0.3 F60.", faults=faults)
    (alarm,) = session.alarms
    assert alarm.number == "MC3004"
    assert session.common[516] == pytest.approx(0.04, abs=1e-3)
    assert drawn_back(session)


@pytest.mark.parametrize("ideal", [True, False])
def test_a_stylus_driven_into_the_band_breaks(tmp_path, ideal):
    session = run(tmp_path, START, "G01 X60. F600", ideal=ideal)
    (alarm,) = session.alarms
    assert alarm.number == "HT9031"
    assert "its overtravel is 4 mm" in alarm.found
    front = session.recording.setpoint[-1, 0] + 200.0 - 20.0
    assert front == pytest.approx(39.05 - 4.0, abs=0.1)


@pytest.mark.parametrize("ideal", [True, False])
def test_teeth_are_no_band(tmp_path, ideal):
    session = run(tmp_path, "G00 X140. Z-20.", "G31 X90. F600", ideal=ideal)
    (alarm,) = session.alarms
    assert alarm.number == "HT9031"
    assert "no reference band" in alarm.found


def test_a_skip_with_another_tool_in_place(tmp_path):
    with pytest.raises(MachineError, match=r"T01 in place.*the touch probe is T09.*T0909"):
        run(tmp_path, START, "G28 U0", "T0101", "G31 X300. F600")


def test_a_dwell_between_does_not_lose_the_stylus(tmp_path):
    """Long standstills are passed over: the touch comes the same."""
    session = run(tmp_path, START, "G04 X30.", "G65 P9810 A3. D78. Q0.3 R0.3 F60.", "G04 X30.", ideal=False)
    assert session.alarms == ()
    assert np.isfinite(session.common[514])
