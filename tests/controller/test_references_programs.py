"""Reference points as programs and operators meet them: rulings, section 4; inclined axis, 手动参考点返回,
自动参考点返回, 注意 1 to 7. θ = −30°: 100 tan 30° = 57.735, 100 / cos 30° = 115.470."""

from collections.abc import Callable

import pytest

from controller.dry_run import DryRun, dry_run
from controller.language.source import parse_program
from controller.operator.actions import operator_event
from controller.tables.parameters import delivered

ON = {"8200#0": 1, "1006#3.X": 0}
HOME = "G28 Y0\nG28 X0\n"


@pytest.fixture
def operated() -> Callable[..., DryRun]:
    """A program on the tilted set-up and what the operator does at M00: one action every 10 s."""

    def _operated(text: str, *actions: str, parameters=None, signals=None) -> DryRun:
        events = [operator_event(do, time_s=10.0 * (k + 1)) for k, do in enumerate(actions)]
        values = delivered("tilted", ON | (parameters or {}))
        return dry_run(parse_program(text), values, None, signals, events=events)

    return _operated


def numbers(alarms) -> list[str]:
    return [alarm.number for alarm in alarms]


# By hand


@pytest.mark.parametrize(("azr", "machine_x", "absolute_x"), [(0, 0.0, 0.0), (1, 57.735, 57.735)])
def test_manual_return_of_the_inclined_axis(operated, azr: int, machine_x: float, absolute_x: float) -> None:
    """AZR 8200#2: 0 = the orthogonal axis moves, too, 1 = it does not. From Y100 X0, slides 57.735, 115.470:
    with 0 the tool goes along Y and both slides come home, with 1 the slide of X stays."""
    text = f"{HOME}G00 Y100.\nM00\nM30"
    result = operated(text, "reference return Y", "cycle start", parameters={"8200#2": azr})
    assert numbers(result.alarms) == []
    assert (result.machine["X"], result.machine["Y"]) == pytest.approx((machine_x, 0.0), abs=1e-3)
    assert (result.absolute["X"], result.absolute["Y"]) == pytest.approx((absolute_x, 0.0), abs=1e-3)


@pytest.mark.parametrize(
    ("azr", "actions", "warned"),
    [
        (0, ("reference return Y", "reference return X", "cycle start"), False),
        (0, ("reference return Y", "jog X 1."), True),
        (0, ("reference return Y", "cycle start"), True),
        (1, ("reference return Y", "jog X 1."), False),
    ],
)
def test_the_orthogonal_axis_must_follow_at_once(operated, azr: int, actions, warned: bool) -> None:
    """AZR = 0: its own return must follow at once, else a warning (注意 3)."""
    result = operated(f"{HOME}M00\nG00 X5.\nM30", *actions, parameters={"8200#2": azr})
    assert ("HT9120" in numbers(result.warnings)) is warned


def test_manual_return_in_the_wrong_order(operated) -> None:
    """After power-on the orthogonal axis first: DS0020; in order both are established and may move."""
    wrong = operated("M00\nM30", "reference return X")
    assert numbers(wrong.alarms) == ["DS0020"]
    right = operated("M00\nG00 X5. Y5.\nM30", "reference return Y", "reference return X", "cycle start")
    assert numbers(right.alarms) == []
    assert right.absolute["X"] == 5.0


def test_manual_return_of_the_orthogonal_axis_at_any_time(operated) -> None:
    """With the inclined axis not on its reference: DS0020 also when both are established (注意 2)."""
    away = operated(f"{HOME}G00 Y10.\nM00\nM30", "reference return X")
    assert numbers(away.alarms) == ["DS0020"]
    home = operated(f"{HOME}G00 X10.\nM00\nM30", "reference return X", "cycle start")
    assert numbers(home.alarms) == []
    assert home.absolute["X"] == 0.0


def test_jog_with_nozagc_loses_the_references(operated) -> None:
    """注意 4, 5: independent motion by hand needs NOZAGC = 1 (else a warning) and costs the references."""
    text = f"{HOME}M00\nG28 U0\nM30"
    with_signal = operated(text, "signal NOZAGC=1", "jog Y 10.", "cycle start")
    assert "HT9108" in numbers(with_signal.warnings)
    assert numbers(with_signal.alarms) == ["DS0020"]
    assert (with_signal.machine["X"], with_signal.machine["Y"]) == pytest.approx((0.0, 11.547), abs=1e-3)
    without = operated(text, "jog Y 10.", "cycle start")
    assert numbers(without.alarms) == []
    assert "HT9108" not in numbers(without.warnings)
    assert "HT9136" in numbers(without.warnings)
    assert "HT9136" not in numbers(with_signal.warnings)


def test_a_return_that_never_follows_is_warned_about_at_the_end(operated) -> None:
    result = operated(f"{HOME}M00\nM30", "reference return Y", "cycle start")
    assert "HT9120" in numbers(result.warnings)
    program = operated(f"{HOME}M00\nG28 U0\nM30", "reference return Y", "cycle start")
    assert "HT9120" not in numbers(program.warnings)


# G27


@pytest.mark.parametrize(
    ("blocks", "number"),
    [
        ("G27 X0", None),
        ("G27 Y0", None),
        ("G00 Y10.\nG27 X0", "DS0020"),
        ("G00 Y10.\nG00 Y0\nG27 X0", None),
        ("G27 X5.", "PS0092"),
        ("G27 Z5.", "PS0092"),
    ],
)
def test_reference_check(run, blocks: str, number: str | None) -> None:
    """G27 of the orthogonal axis with the inclined axis not on its reference: DS0020 at any time (注意 7)."""
    result = run(f"{HOME}{blocks}\nM30", "tilted", ON)
    assert numbers(result.alarms) == ([number] if number else [])


def test_g27_does_not_give_back_what_was_lost(run) -> None:
    """Both references lost with NOZAGC = 1: G27 finds Z and Y there, and the order rule still holds."""
    text = f"{HOME}G00 Y10.\nG00 Y0\nG27 Y0\nG28 U0\nM30"
    result = run(text, "tilted", ON, signals={"NOZAGC": True})
    assert numbers(result.alarms) == ["DS0020"]


# G30


def test_second_to_fourth_point(run) -> None:
    """Parameters 1241 to 1243; X in diameter as its display."""
    points = {"1241.X": 20.0, "1242.X": 30.0, "1243.X": 40.0, "1241.Z": -5.0}
    for p, x in ((2, 20.0), (3, 30.0), (4, 40.0)):
        assert run(f"G30 P{p} U0\nM30", parameters=points).machine["X"] == x
    assert run("G30 U0 W0\nM30", parameters=points).machine["Z"] == -5.0


@pytest.mark.parametrize(
    ("blocks", "number"),
    [
        ("G30 P2 U0", "DS0020"),
        ("G30 P2 V0", "PS0224"),
        ("G28 V0\nG30 P2 U0", "PS0224"),
        ("G28 V0\nG28 U0\nG30 P2 U0 V0", None),
    ],
)
def test_further_points_need_the_first(run, blocks: str, number: str | None) -> None:
    result = run(f"{blocks}\nM30", "tilted", ON)
    assert numbers(result.alarms) == ([number] if number else [])


@pytest.mark.parametrize(("arf", "x", "y"), [(0, -57.735 + 10.0, 100.0), (1, 10.0, 100.0)])
def test_g30_obeys_arf_as_g28_does(run, arf: int, x: float, y: float) -> None:
    """执行 G28/G30 指令时: with 0 the slide of X alone goes to 10, with 1 Cartesian X does."""
    parameters = ON | {"8209#0": arf, "1241.X": 10.0}
    result = run(f"{HOME}G00 X200. Y100.\nG30 P2 X200.\nM30", "tilted", parameters)
    assert (result.absolute["X"], result.absolute["Y"]) == pytest.approx((x, y), abs=1e-3)


# Parameters


def test_changed_parameters_ask_for_the_references_again(run) -> None:
    """注意 1: they are read at power-on, where an inclined pair has no references."""
    for changed in ({}, {"8210": 15000}, {"8209#0": 1}):
        result = run("G00 X1.\nM30", "tilted", ON | changed)
        assert numbers(result.alarms) == ["PS0224"]
