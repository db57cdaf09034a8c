"""The signal table of the inclined-axis original: names, frames, levels, refusals; outputs from a state."""

import pytest

from controller.laws.inclined import Frame, InclinedPair
from controller.motion.interlock import holds_back, induced_past_interlock
from controller.motion.outputs import output_signals
from controller.motion.reference import References
from controller.span import Span
from controller.tables.alarms import AlarmError, ControllerError
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered
from controller.tables.signals import (
    SIGNALS,
    AxisInput,
    Direction,
    Inputs,
    check_signals,
    misprinted,
    spelled,
)

LETTERS = ("X", "Z", "Y", "C")
PAIR = InclinedPair(inclined=2, orthogonal=0, angle=-30.0)
SLIDE = "*+L{x} *-L{x} *DEC{x} SVF{x} DTCH{x} MI{x} MLK{x} INP{x} MMI{x} MDTCH{x} MV{x}"
CARTESIAN = "*IT{x} +J{x} -J{x} +MIT1 +MIT2 ZP{x} ZP2{x} ZP3{x} ZP4{x}"


@pytest.mark.parametrize(
    ("names", "frame"), [(SLIDE, Frame.SLIDES), (CARTESIAN, Frame.CARTESIAN)], ids=["slides", "cartesian"]
)
def test_frames_of_the_original(names: str, frame: Frame) -> None:
    """本功能与各轴输入输出信号之间的关系: every row of its table, 倾斜 or 正交."""
    assert {SIGNALS[name].frame for name in names.split()} == {frame}


ADDRESSES = """*IT{x} G130 *+L{x} G114 *-L{x} G116 *DEC{x} X009 SVF{x} G126 DTCH{x} G124 +J{x} G100 -J{x} G102
MI{x} G106 +MIT1 X004.2 +MIT2 X004.4 MLK{x} G108 INP{x} F104 MMI{x} F108 MDTCH{x} F110 MV{x} F102 ZP{x} F094
ZP2{x} F096 ZP3{x} F098 ZP4{x} F100 NOZAGC G63.5"""


def test_addresses_of_the_original() -> None:
    words = iter(ADDRESSES.split())
    assert {name: SIGNALS[name].address for name in ADDRESSES.split()[::2]} == dict(
        zip(words, words, strict=True)
    )


def test_every_row_has_meaning_and_clause() -> None:
    assert all(row.meaning and row.clause for row in SIGNALS.values())
    assert all(row.modelled for row in SIGNALS.values() if row.direction is Direction.OUTPUT)


def test_an_active_low_signal_stands_at_one() -> None:
    idle = Inputs.of({}, LETTERS)
    assert all(not idle.columns(kind) for kind in AxisInput)
    given = Inputs.of({"*ITX": False, "*+LZ": True, "MLKY": True, "MIC": False}, LETTERS)
    assert given.columns(AxisInput.INTERLOCK) == {0}
    assert given.columns(AxisInput.PLUS_SWITCH) == frozenset()
    assert given.columns(AxisInput.LOCK) == {2}
    assert given.columns(AxisInput.MIRROR) == frozenset()
    assert given.changed("*ITX", True).columns(AxisInput.INTERLOCK) == frozenset()


@pytest.mark.parametrize("name", ["NOZAGC", "NOGAGC", "NOZOGC", " nozagc "])
def test_misprints_are_the_signal(name: str) -> None:
    """Rulings, section 4: NOZAGC is also misprinted NOGAGC, NOZOGC; accepted with a note."""
    assert Inputs.of({name: True}, LETTERS).on("NOZAGC")
    noted = misprinted([name])
    assert [note.number for note in noted] == (["HT9124"] if "NOZAGC" not in name.upper() else [])


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("FOO", "unknown signal 'FOO' (valid: NOZAGC, *ITx, *+Lx"),
        ("*ITB", "unknown signal '*ITB'"),
        ("*IT", "unknown signal '*IT'"),
        ("", "unknown signal ''"),
        ("ITX", "unknown signal 'ITX'"),
        ("*IT{x}", "unknown signal '*IT{x}'"),
        ("ZPX", "is an output"),
        ("PSW01", "is an output"),
        ("*DECX", "not modelled by the twin"),
        ("+JX", "jog X 5."),
        ("+MIT1", "not modelled by the twin"),
    ],
)
def test_what_cannot_be_set(name: str, message: str) -> None:
    with pytest.raises(ControllerError) as caught:
        check_signals({name: True}, LETTERS)
    assert message in str(caught.value)


def test_letters_are_those_of_the_machine() -> None:
    assert spelled("*ITB", ("X", "Z", "Y", "C", "B")) == "*ITB"
    assert spelled("MLKC") == "MLKC"


def test_interlock_acts_on_the_commanded_axis_servo_off_on_the_slide() -> None:
    both = Inputs.of({"*ITX": False, "SVFY": True}, LETTERS)
    assert holds_back(both, commanded=(0,), moving=(0,)) == "*ITX = 1"
    assert holds_back(both, commanded=(2,), moving=(0, 2)) == "SVFY = 0"
    assert holds_back(both, commanded=(1,), moving=(1,)) is None
    only_x = Inputs.of({"*ITX": False}, LETTERS)
    assert holds_back(only_x, commanded=(2,), moving=(0, 2)) is None


def test_interlock_of_the_orthogonal_axis_does_not_stop_induced_motion() -> None:
    """*ITx, 备注: 并不会互锁倾斜轴的移动引起的正交轴的移动; interlock both."""
    only_x = Inputs.of({"*ITX": False}, LETTERS)
    span = Span(file="a.nc", line=3)
    note = induced_past_interlock(only_x, PAIR, (2,), (0, 2), span)
    assert note is not None
    assert (note.number, note.span) == ("HT9121", span)
    assert "slide X moves with Y" in note.found
    assert induced_past_interlock(only_x, PAIR, (2,), (2,), span) is None
    assert induced_past_interlock(only_x, None, (2,), (0, 2), span) is None
    assert induced_past_interlock(Inputs.of({}, LETTERS), PAIR, (2,), (0, 2), span) is None


def test_outputs_of_a_state() -> None:
    parameters = delivered("hobbing", {"6910": 1, "6930": 10.0, "6950": -10.0, "6925": 4, "6945": 90})
    machine = machine_data(parameters)
    inputs = Inputs.of({"MIX": True, "DTCHZ": True}, machine.letters)
    references = References.at_power_on(4, None)
    references.establish((0,))
    references.establish((1,), point=3)
    out = output_signals(
        machine, inputs, references, slides=(5.0, 0.0, 0.0, 91.0), moves=lambda column: column == 3
    )
    on = {name for name, level in out.items() if level}
    assert on == {"INPX", "INPZ", "INPY", "MVC", "ZPX", "ZP3Z", "MMIX", "MDTCHZ", "PSW01"}
    assert {row.pattern for row in SIGNALS.values() if row.direction is Direction.OUTPUT} >= {
        name if name.startswith("PSW") else name[:-1] + "{x}" for name in out
    }


@pytest.mark.parametrize(("x", "on"), [(5.0, True), (5.001, False), (-5.0, True), (-5.001, False)])
def test_position_switch_counts_programmed_units_of_the_slide(x: float, on: bool) -> None:
    """注意 9: in slide coordinates; X in diameter, so 10 is 5 of travel."""
    machine = machine_data(delivered("hobbing", {"6912": 1, "6932": 10.0, "6952": -10.0}))
    still = Inputs.of({}, machine.letters)
    references = References.at_power_on(4, None)
    out = output_signals(machine, still, references, slides=(x, 0, 0, 0), moves=lambda _: False)
    assert out["PSW03"] is on


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"6910": 5}, "6910 = 5, no axis"),
        ({"6911": 1, "6931": -1.0, "6951": 1.0}, "6931 = -1 below 6951 = 1"),
        ({"1324.Z": -1.0}, "1324.Z = -1 below 1325.Z = 0"),
        ({"1323.X": 1.0}, "1322.X = 0 below 1323.X = 1"),
    ],
)
def test_contradicting_areas_and_switches(parameters: dict[str, float], words: str) -> None:
    with pytest.raises(AlarmError) as caught:
        machine_data(delivered("hobbing", parameters))
    assert caught.value.alarm.number == "HT9005"
    assert words in caught.value.alarm.found
