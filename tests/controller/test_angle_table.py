"""G10 L60 to L62: corrections against the work angle, on the setpoints that the machine gets."""

import math

import numpy as np
import pytest

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.laws.angle_table import RAMP_S
from controller.motion.sampling import read_at
from controller.tables.parameters import delivered

X, Z, Y, C = range(4)
"""columns of the hobbing set-up"""


def run(text, limit=4096, parameters=None):
    controller = Controller(parse_program(text), parameters=delivered("hobbing", parameters or {}))
    rows = []
    while (chunk := controller.propose(limit)).ticks:
        rows.append(np.array(chunk.setpoint))
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=rows[-1], actual=rows[-1]))
    return controller, np.concatenate(rows)


def table(x=(0.2, 0.0, -0.2, 0.0), c=(0.0, 0.03, 0.0, -0.03)):
    points = [f"G10 L60 P{k} X{a} C{b}" for k, (a, b) in enumerate(zip(x, c, strict=True), start=1)]
    return "\n".join([f"G10 L60 Q{len(x)}", *points])


HOB = "G28 U0 W0\nG28 H0 V0\n{before}\nG81 T20 L1\nS300\nG04 X4.\nS0\nG80\n{after}\nM30"


def test_the_law_is_straight_between_its_points_and_closes():
    values = np.array([1.0, 3.0, -2.0])
    angle = np.array([0.0, 60.0, 120.0, 180.0, 240.0, 300.0, 360.0, -60.0, 720.0 + 60.0])
    assert read_at(values, angle) == pytest.approx(
        [1.0, 2.0, 3.0, 0.5, -2.0, -0.5, 1.0, -0.5, 2.0], abs=1e-12
    )


def test_what_is_added_while_hobbing():
    """Against the same program without the table: X by half the programmed diameter, C by degrees."""
    _, plain = run(HOB.format(before=f"{table()}\nG04 X{RAMP_S}", after=""))
    controller, found = run(HOB.format(before=f"{table()}\nG10 L61", after=""))
    assert controller.alarms == ()
    assert len(found) == len(plain)
    added = found - plain
    angle = plain[:, C]
    moving = np.abs(np.diff(angle, prepend=angle[0])) > 0
    grid = np.arange(0.0, 361.0, 90.0)
    x = np.interp(angle % 360.0, grid, [0.1, 0.0, -0.1, 0.0, 0.1])
    c = np.interp(angle % 360.0, grid, [0.0, 0.03, 0.0, -0.03, 0.0])
    assert moving.sum() > 3000
    assert added[moving, X] == pytest.approx(x[moving], abs=1e-9)
    assert added[moving, C] == pytest.approx(c[moving], abs=1e-9)
    assert not added[:, [Z, Y]].any()


def test_it_comes_and_goes_without_a_jump():
    text = f"G28 U0 W0\n{table()}\nG10 L61\nG04 X1.\nG10 L62\nG04 X1.\nM30"
    _, found = run(text)
    x = found[:, X]
    assert x.max() == pytest.approx(0.1)
    assert (x[0] < 1e-3, x[-1]) == (True, 0.0)
    assert np.abs(np.diff(x)).max() == pytest.approx(0.1 / (RAMP_S * 1000), rel=1e-6)


@pytest.mark.parametrize("limit", [1, 7, 100])
def test_every_limit_gives_the_same_bits(limit):
    text = f"{table()}\nG10 L61\nG01 Z-2. F600\nG10 L62\nG01 Z2. F600\nM30"
    assert run(text)[1].tobytes() == run(text, limit)[1].tobytes()


def test_a_long_dwell_is_not_passed_over_while_it_comes_in():
    controller = Controller(
        parse_program(f"{table()}\nG10 L61\nG04 X30.\nM30"), parameters=delivered("hobbing", {})
    )
    assert controller.idle_ticks() == 0
    chunk = controller.propose(500)
    controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert controller.idle_ticks() > 29_000


def test_displays_do_not_count_it():
    found = dry_run(
        parse_program(f"G28 U0 W0\n{table()}\nG10 L61\n#500=#5041\nM30"), delivered("hobbing", {})
    )
    assert found.alarms == ()
    assert found.machine["X"] == 0.0


@pytest.mark.parametrize(
    ("text", "number", "words"),
    [
        ("G10 L60 Q2", "HT9012", "Q2"),
        ("G10 L60", "HT9012", "alone"),
        ("G10 L60 Q4 X1.", "HT9012", "Q4"),
        ("G10 L60 P1 X1.", "PS0030", "point 1 of a table of 0"),
        ("G10 L60 Q4\nG10 L60 P5 X1.", "PS0030", "point 5 of a table of 4"),
        ("G10 L60 Q4\nG10 L60 P1", "HT9012", "P1"),
        ("G10 L60 Q4\nG10 L60 P1 U1.", "PS0009", "U1."),
        ("G10 L60 Q4\nG10 L60 P1 Q3 X1.", "PS0009", "Q3"),
        ("G10 L61", "PS0030", "without points"),
        ("G10 L60 Q4\nG10 L61 P1", "PS0009", "P1"),
        ("G10 L63 P1 X1.", "HT9003", "L63"),
    ],
)
def test_what_is_no_table_is_refused(text, number, words):
    found = dry_run(parse_program(f"{text}\nM30"), delivered("hobbing", {}))
    (alarm,) = found.alarms
    assert alarm.number == number
    assert words in f"{alarm.found} {alarm.text}"


def test_the_follow_type_is_refused_on_either_side():
    parameters = {"201#7": "1"}
    for text in (
        f"G28 U0 W0\nG28 H0 V0\n{table()}\nG10 L61\nG81 T20 L1\nM30",
        f"G28 U0 W0\nG28 H0 V0\n{table()}\nG81 T20 L1\nG10 L61\nM30",
    ):
        found = dry_run(parse_program(text), delivered("hobbing", parameters))
        (alarm,) = found.alarms
        assert alarm.number == "HT9003"
        assert "follow type" in alarm.found
    assert math.isfinite(found.cycle_time_s)
