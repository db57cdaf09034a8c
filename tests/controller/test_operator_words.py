"""Rulings, section 5: the words of an operator's event, and what is refused with what would be valid."""

import pytest

from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.operator.actions import ACTIONS, OperatorAction, operator_event, read_event
from controller.tables.alarms import ControllerError
from controller.tables.parameters import delivered


@pytest.mark.parametrize(
    ("words", "action", "fields"),
    [
        ("cycle start", OperatorAction.CYCLE_START, {}),
        ("Feed  Hold", OperatorAction.FEED_HOLD, {}),
        ("single block on", OperatorAction.SINGLE_BLOCK, {"on": True}),
        ("single block off", OperatorAction.SINGLE_BLOCK, {"on": False}),
        ("optional stop off", OperatorAction.OPTIONAL_STOP, {"on": False}),
        ("block skip on", OperatorAction.BLOCK_SKIP, {"number": 1, "on": True}),
        ("block skip 3 off", OperatorAction.BLOCK_SKIP, {"number": 3, "on": False}),
        ("feed override 80", OperatorAction.FEED_OVERRIDE, {"value": 80.0}),
        ("feed override 0", OperatorAction.FEED_OVERRIDE, {"value": 0.0}),
        ("rapid override 25", OperatorAction.RAPID_OVERRIDE, {"value": 25.0}),
        ("spindle override 120", OperatorAction.SPINDLE_OVERRIDE, {"value": 120.0}),
        ("machine lock on", OperatorAction.MACHINE_LOCK, {"axis": "", "on": True}),
        ("machine lock X off", OperatorAction.MACHINE_LOCK, {"axis": "X", "on": False}),
        ("dry run on", OperatorAction.DRY_RUN, {"on": True}),
        ("reset", OperatorAction.RESET, {}),
        ("emergency stop", OperatorAction.EMERGENCY_STOP, {}),
        ("manual", OperatorAction.MANUAL, {}),
        ("auto", OperatorAction.AUTO, {}),
        ("jog Z -5.0", OperatorAction.JOG, {"axis": "Z", "value": -5.0, "feed": None}),
        ("jog Z -5.0 F500", OperatorAction.JOG, {"axis": "Z", "value": -5.0, "feed": 500.0}),
        ("reference return Y", OperatorAction.REFERENCE_RETURN, {"axis": "Y"}),
        ("mdi G00 X100.", OperatorAction.MDI, {"text": "G00 X100."}),
        ("signal NOZAGC=1", OperatorAction.SIGNAL, {"text": "NOZAGC", "on": True}),
        ("signal *ITX=0", OperatorAction.SIGNAL, {"text": "*ITX", "on": False}),
    ],
)
def test_words(words: str, action: OperatorAction, fields: dict[str, object]) -> None:
    event = operator_event(words, time_s=1.5)
    assert (event.action, event.time_s, event.line) == (action, 1.5, None)
    assert {name: getattr(event, name) for name in fields} == fields


def test_every_action_has_words_that_name_it() -> None:
    assert set(ACTIONS) == set(OperatorAction)
    for action, entry in ACTIONS.items():
        assert entry.form.startswith(action.value)
        assert entry.meaning


@pytest.mark.parametrize(
    ("text", "time_s", "line"),
    [
        ("3.0 feed hold", 3.0, None),
        ("0 reset", 0.0, None),
        (".5 manual", 0.5, None),
        ("line 12 reset", None, 12),
    ],
)
def test_when(text: str, time_s: float | None, line: int | None) -> None:
    event = read_event(text)
    assert (event.time_s, event.line) == (time_s, line)


@pytest.mark.parametrize(
    ("text", "valid"),
    [
        ("3.0 feed hld", "feed hold"),
        ("3.0 single block", r"single block on\|off"),
        ("3.0 rapid override 30", "100, 50, 25 or 0"),
        ("3.0 feed override 300", "0 to 254"),
        ("3.0 jog Z", "jog Z -5.0"),
        ("3.0 jog Z 1e9", "jog Z"),
        ("3.0 jog Z 100000.", "99999.999"),
        ("3.0 jog Z 1. F0", "F greater than 0"),
        ("3.0 signal ZPX=1", "is an output.*NOZAGC"),
        ("3.0 signal ABC=1", "NOZAGC"),
        ("3.0 signal NOZAGC=2", "signal NOZAGC=1"),
        ("feed hold", "seconds or a line"),
        ("line 0 reset", "a line from 1"),
        ("-1 reset", "seconds or a line"),
        ("1e400 reset", "seconds or a line"),
        ("99999999999 reset", "a time from 0"),
        ("", "seconds or a line"),
    ],
)
def test_wrong_words_name_the_valid_ones(text: str, valid: str) -> None:
    with pytest.raises(ControllerError, match=valid):
        read_event(text)


def test_not_both_time_and_line() -> None:
    with pytest.raises(ControllerError, match="not both"):
        operator_event("reset", time_s=1.0, line=2)


def test_axes_and_signals_of_this_machine() -> None:
    program, events = parse_program("M30"), [operator_event("jog B 1.", time_s=0.0)]
    with pytest.raises(ControllerError, match=r"no axis B.*X, Z, Y, C"):
        dry_run(program, delivered(), events=events)
    with pytest.raises(ControllerError, match="no axis B"):
        Controller(program, parameters=delivered(), events=events)
    controller = Controller(program, parameters=delivered())
    with pytest.raises(ControllerError, match="no axis B"):
        controller.post(events[0])
    with pytest.raises(ControllerError, match="unknown signal"):
        controller.post(operator_event("signal MLKB=1"))


def test_the_past_is_past() -> None:
    program = parse_program("G04 X1.\nM30")
    controller = Controller(program, parameters=delivered())
    while (chunk := controller.propose(100)).ticks and controller.tick < 500:
        from controller.clock import Feedback

        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    with pytest.raises(ControllerError, match=r"now is 0.5 s"):
        controller.post(operator_event("reset", time_s=0.2))


def test_an_event_that_never_comes_is_said() -> None:
    program = parse_program("G04 X1.\nM30")
    events = [operator_event("feed override 50", time_s=9.0), operator_event("reset", line=7)]
    found = [w.found for w in dry_run(program, delivered(), events=events).warnings]
    assert found == ["feed override 50 at 9 s", "reset at line 7"]
