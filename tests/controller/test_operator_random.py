"""Whatever an operator does, whenever: the controller ends, and its displays tell where the axes are."""

import math

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.operator.actions import operator_event
from controller.tables.parameters import delivered

HOBBING = """G28 U0 W0
G28 H0 V0
G81 T20 L1 Q2. P20.
S300
G01 X-5. F600
G99 G01 Z-1. F2.
G98 G00 H7.
G04 X0.4
S0
G80
G00 X0 Z0
M30"""
POLYGON = """G28 U0 W0
G28 H0 V0
G51.2 P1 Q2 R90. A100.
S90
G01 X-4. F600
G99 Z-2. F0.5
G98 G00 X0
S0
G50.2
M01
M30"""
TURNING = """M03 S400
G99 G01 X-4. F0.1
G32 Z-5. F1.5
G98 G02 X4. Z-9. R6. F500
G31 Z-12. F300
G96 S50
G50 S900
G01 X-8. F400
G97 S200
G00 X0 Z0
M05
M30"""
INCLINED = """G28 Y0
G28 X0
G00 Y30.
G01 X-20. Y10. F900
G17 G03 X-20. Y10. I-5. J2. F600
G53 X0
G28 Y5.
M30"""
WORDS = [
    "cycle start",
    "feed hold",
    "single block on",
    "single block off",
    "optional stop on",
    "feed override 0",
    "feed override 100",
    "feed override 200",
    "rapid override 0",
    "rapid override 25",
    "rapid override 100",
    "spindle override 50",
    "spindle override 120",
    "dry run on",
    "dry run off",
    "reset",
    "emergency stop",
    "manual",
    "auto",
    "jog X 2.",
    "jog Z -1.5 F900",
    "jog C 20.",
    "jog Y 3.",
    "reference return Z",
    "reference return Y",
    "mdi G00 Z-3.",
    "mdi G01 U1. F200",
    "signal *ITX=0",
    "signal *ITX=1",
]
LOCKS = [
    "machine lock on",
    "machine lock off",
    "machine lock Z on",
    "signal NOZAGC=1",
    "signal NOZAGC=0",
    "signal MIZ=1",
]

moments = st.one_of(
    st.floats(0.0, 8.0).map(lambda t: {"time_s": t}), st.integers(1, 12).map(lambda line: {"line": line})
)
programs = st.sampled_from(
    [
        (HOBBING, "hobbing", {}),
        (HOBBING, "hobbing", {"201#7": 1}),
        (HOBBING, "hobbing", {"201#3": 1, "201#2": 1}),
        (POLYGON, "hobbing", {}),
        (TURNING, "hobbing", {}),
        (INCLINED, "tilted", {"8200#0": 1}),
    ]
)


def events_of(words: list[str]) -> st.SearchStrategy:
    return st.lists(st.tuples(st.sampled_from(words), moments), max_size=9).map(
        lambda chosen: [operator_event(do, **moment) for do, moment in chosen]
    )


@settings(max_examples=100, deadline=None, phases=(Phase.explicit, Phase.generate, Phase.shrink))
@given(programs, events_of(WORDS))
def test_displays_stay_true(program, events) -> None:
    """Without machine lock, mirror and NOZAGC the work coordinates are the Cartesian place of the slides,
    whatever was held, jogged, reset or stopped on the way; and no axis was ever beyond its limits."""
    text, setup, parameters = program
    found = dry_run(parse_program(text), delivered(setup, parameters), events=events)
    machine, absolute = found.machine, found.absolute
    if setup == "hobbing":
        assert absolute["X"] == pytest.approx(machine["X"], abs=1e-5)
    else:
        theta = math.radians(-30.0)
        assert absolute["Y"] == pytest.approx(machine["Y"] * math.cos(theta), abs=1e-5)
        cartesian = machine["X"] + 2.0 * machine["Y"] * math.sin(theta)
        assert absolute["X"] == pytest.approx(cartesian, abs=1e-5)
    assert absolute["Z"] == pytest.approx(machine["Z"], abs=1e-5)
    if setup == "hobbing" and not found.in_sync_at_end and not found.alarms and text is not TURNING:
        for letter in "YC":
            error = math.remainder(absolute[letter] - machine[letter], 360.0)
            assert error == pytest.approx(0.0, abs=1e-4), letter
    for letter, peak in found.peaks.items():
        rotary = letter in "CAB" or (letter == "Y" and setup == "hobbing")
        assert rotary or peak.speed <= peak.speed_limit * (1 + 1e-9)
        assert rotary or peak.acceleration <= peak.acceleration_limit * (1 + 1e-9)
    assert min(found.blocks.duration_s, default=0.0) >= 0.0


@settings(max_examples=50, deadline=None)
@given(programs, events_of(WORDS + LOCKS))
def test_it_always_ends(program, events) -> None:
    text, setup, parameters = program
    found = dry_run(parse_program(text), delivered(setup, parameters), events=events)
    assert math.isfinite(found.cycle_time_s)


@settings(max_examples=8, deadline=None, phases=(Phase.explicit, Phase.generate))
@given(st.sampled_from([(HOBBING, {}), (HOBBING, {"201#7": 1}), (POLYGON, {})]), events_of(WORDS))
def test_setpoints_never_jump(program, events) -> None:
    """Every tick of every axis stays within its acceleration, and any chunking gives the same bits."""
    text, parameters = program
    runs = []
    for limit in (4096, 13):
        controller = Controller(
            parse_program(text), parameters=delivered("hobbing", parameters), events=events
        )
        rows = [np.zeros((1, 4))]
        while (chunk := controller.propose(limit)).ticks:
            setpoint = np.array(chunk.setpoint)
            for row in setpoint:
                for link in chunk.couplings:
                    row[link.slave] += link.offset + link.numerator / link.denominator * row[link.master]
            rows.append(setpoint)
            controller.commit(Feedback(ticks=chunk.ticks, setpoint=setpoint, actual=setpoint))
        runs.append(np.concatenate(rows))
    assert runs[0].tobytes() == runs[1].tobytes()
    change = np.abs(np.diff(runs[0][:, :2], n=2, axis=0)).max(axis=0, initial=0.0) * 1e6
    assert change.max() <= 2000.0 * (1 + 1e-5)
