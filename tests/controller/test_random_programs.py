"""Whatever comes in ends in a result or an alarm, and the clock moves what the dry run says."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.tables.alarms import ControllerError
from controller.tables.parameters import delivered

LETTERS = "GMTSFXZYCUWVHPQRLIKNOAB0123456789.-+;；()%/# \n"
WORDS = re.findall(
    r"\S+",
    """
G00 G01 G04 G28 G50 G53 G54 G57 G20 G21 G80 G81 G50.2 G51.2 G96 G97 G98 G99 M03 M05 M19 M30 M98 M99 T0101 S0
S300 S-300 F100 F2. X10. X-35. U-3. Z-5. W2. C90. H45. Y10. V-20 P20. P2 Q2. Q6 L1 T20 R5. A40. N10 / (c) ; O1
""",
)
OUT = st.sampled_from(
    [
        "G00 X-13.7",
        "G00 U1.3 W-2.1",
        "G01 Z-3.165 F300",
        "G04 P49",
        "G28 U0 W0",
        "G53 Z-3.",
        "G50 X43.2",
        "T0203",
        "G00 C212.",
        "H-500.",
        "G28 H0 V0",
        "S167 M03",
        "M05\nM19",
        "M05",
    ]
)
ENGAGE = st.sampled_from(["G81 T27 L2", "G81 T20 L-1 Q2. P20.", "G51.2 P3 Q6 R40. A50.", "G51.2 P1 Q-2"])
IN = st.sampled_from(
    [
        "S167",
        "S-90",
        "S0",
        "G00 W1.3",
        "G01 X-2. F900",
        "G04 P77",
        "G99 G01 W-0.3 F0.5\nG98",
        "H20.",
        "G28 W0",
    ]
)
HOME = "M05\nM19\nG28 H0 V0\n"


@settings(max_examples=150, deadline=None)
@given(st.text(LETTERS, max_size=80) | st.lists(st.lists(st.sampled_from(WORDS), max_size=4)))
def test_any_text_ends_in_a_result_or_an_alarm(text: str | list[list[str]]) -> None:
    """Robust: never another exception, never more than the first alarm."""
    program = text if isinstance(text, str) else "\n".join(" ".join(words) for words in text)
    try:
        result = dry_run(parse_program(program), delivered())
    except ControllerError as error:
        assert "error[HT9" in str(error)
        return
    assert len(result.alarms) <= 1
    assert np.isfinite([*result.absolute.values(), *result.machine.values(), result.cycle_time_s]).all()


@settings(max_examples=40, deadline=None)
@given(
    st.lists(OUT, max_size=4), ENGAGE, st.lists(IN, max_size=5), st.sampled_from([1, 7, 4096]), st.booleans()
)
def test_the_clock_moves_what_the_dry_run_says(
    before: list[str], engage: str, within: list[str], limit: int, follow: bool
) -> None:
    """Same alarms, same end, no axis faster than its parameters at any tick."""
    off = "G80" if engage.startswith("G81") else "G50.2"
    text = "\n".join([*before, HOME + engage, *within, "S0", off, "M30"])
    parameters = delivered("hobbing", {"201#2": 1, "201#7": int(follow)})
    expected = dry_run(parse_program(text), parameters)
    controller = Controller(parse_program(text), parameters=parameters)
    place = np.zeros(4)
    fastest = np.array([0.2, 0.25, 24.0, 24.0]) * (1 + 1e-6)
    while (chunk := controller.propose(limit)).ticks:
        rows = np.array(chunk.setpoint)
        for link in chunk.couplings:
            rows[:, link.slave] += link.offset + link.numerator / link.denominator * rows[:, link.master]
        assert (np.abs(np.diff(np.vstack([place, rows]), axis=0)) <= fastest).all()
        place = rows[-1]
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=rows, actual=rows))
    assert [a.number for a in controller.alarms] == [a.number for a in expected.alarms]
    assert [w.number for w in controller.warnings] == [w.number for w in expected.warnings]
    if expected.alarms:
        return
    assert place[0] * 2 == pytest.approx(expected.machine["X"], abs=1e-5)
    assert place[1] == pytest.approx(expected.machine["Z"], abs=1e-5)
    if not follow:
        assert controller.tick == pytest.approx(expected.cycle_time_s * 1000, abs=1.001)
        for column, letter in ((2, "Y"), (3, "C")):
            assert place[column] / 360 == pytest.approx(expected.turns[letter], abs=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        "S167 M03\nG00 X-1.\nS300\nM30",
        "G28 H0 V0\nS245 M03\nG04 P149\nM05\nM19\nG28 H0 V0\nG00 C227.\nG28 H0 V0\nM30",
    ],
)
def test_spindle_to_reference_and_end(drive, run, text: str) -> None:
    """Rounding is no travel, and M30 stops a spindle that is only about to turn."""
    assert drive(text).axis("C")[-1] / 360 == pytest.approx(run(text).turns["C"], abs=1e-9)
    assert np.abs(np.diff(drive(text).axis("C"))[-1]) < 0.002
