"""What an operator does on a running controller: posted live or listed, in any chunks, the same bits."""

from dataclasses import replace

import numpy as np
import pytest

from controller.clock import Feedback
from controller.cnc import Controller
from controller.language.source import parse_program
from controller.operator.actions import operator_event
from controller.tables.parameters import delivered

PROGRAM = """G28 U0 W0
G28 H0 V0
G81 T20 L1 Q2. P20.
S300
G01 X-1.5 F500
G99 G01 Z-0.31 F2.
G98 G00 H7.
G04 X0.3
S0
G80
G02 X1.5 Z-2. R3. F300
M03 S200
G99 G01 X-2. F0.1
M05
M30
"""
EVENTS = [
    (0.31, "feed hold"),
    (0.40, "jog Z -0.5"),
    (1.20, "cycle start"),
    (1.35, "spindle override 80"),
    (1.50, "feed override 150"),
    (2.00, "machine lock on"),
    (2.20, "machine lock off"),
    (2.40, "rapid override 25"),
    (3.00, "single block on"),
    (4.50, "cycle start"),
    (5.40, "mdi G00 Z1."),
    (5.50, "single block off"),
    (5.60, "cycle start"),
    (6.10, "feed override 0"),
    (6.40, "feed override 100"),
    (7.30, "dry run on"),
]


class Slack:
    """Drives that lag a little, so that what is measured is not what is commanded."""

    def __init__(self, axes: int) -> None:
        self.at = np.zeros(axes)

    def advance(self, chunk) -> Feedback:
        setpoint = np.array(chunk.setpoint)
        actual = np.empty_like(setpoint)
        for k, row in enumerate(setpoint):
            for link in chunk.couplings:
                row[link.slave] += link.offset + link.numerator / link.denominator * self.at[link.master]
            self.at = self.at + 0.2 * (row - self.at)
            actual[k] = self.at
        return Feedback(ticks=chunk.ticks, setpoint=setpoint, actual=actual)


def listed(parameters, limit: int):
    events = [operator_event(do, time_s=time) for time, do in EVENTS]
    return driven(Controller(parse_program(PROGRAM), parameters=parameters, events=events), limit)


def driven(controller: Controller, limit: int, post=()):
    machine, rows, waiting = Slack(4), [], list(post)
    while (chunk := controller.propose(limit)).ticks or waiting:
        left = round(waiting[0][0] * 1000) - controller.tick if waiting else limit + 1
        if chunk.ticks == 0:  # it stands until somebody acts
            controller.post(operator_event(waiting[0][1], time_s=waiting.pop(0)[0]))
            continue
        if left <= chunk.ticks:  # the machine stops there, and the operator acts now
            controller.post(operator_event(waiting.pop(0)[1]))
            chunk = replace(chunk, setpoint=chunk.setpoint[:left])
        feedback = machine.advance(chunk)
        controller.commit(feedback)
        rows.append(feedback.setpoint)
    return controller, np.concatenate(rows)


@pytest.mark.parametrize("follow", [0, 1])
def test_every_limit_and_every_way_gives_the_same_bits(follow: int) -> None:
    parameters = delivered("hobbing", {"201#7": follow})
    controller, reference = listed(parameters, 4096)
    assert controller.alarms == ()
    assert len(reference) > 7500
    for limit in (1, 7):
        _, rows = listed(parameters, limit)
        assert rows.tobytes() == reference.tobytes()
    # the same actions on a controller that knows of none of them when the program starts
    plain = Controller(parse_program(PROGRAM), parameters=parameters)
    live, rows = driven(plain, 10, post=EVENTS)
    assert rows.tobytes() == reference.tobytes()
    assert live.blocks == controller.blocks
    assert [str(w) for w in live.warnings] == [str(w) for w in controller.warnings]


def test_now_is_the_tick_of_the_next_commit() -> None:
    """Motion planned beyond it is planned anew; what was proposed before is as it was."""
    program = parse_program("G01 Z-100. F6000\nM30")
    controller = Controller(program, parameters=delivered())
    chunk = controller.propose(4096)
    controller.post(operator_event("feed hold"))
    rows = chunk.setpoint[:200]
    controller.commit(Feedback(ticks=200, setpoint=rows, actual=rows))
    rest = controller.propose(4096).setpoint[:, 1]
    # 100 mm/s at 2000 mm/s²: 50 ms and 2.5 mm of braking from z(0.2) = -(0.2 - 0.025) * 100
    assert rows[-1, 1] == pytest.approx(-17.5, abs=1e-9)
    assert rest[-1] == pytest.approx(-20.0, abs=1e-9)
    assert len(rest) == 50
    assert controller.propose(4096).setpoint[0, 1] == pytest.approx(rest[0])


def test_a_program_left_standing_ends_and_can_be_taken_up_again() -> None:
    events = [operator_event("feed hold", time_s=0.1)]
    controller = Controller(parse_program("G01 Z-20. F6000\nM30"), parameters=delivered(), events=events)
    while (chunk := controller.propose(64)).ticks:
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert controller.finished
    assert [w.number for w in controller.warnings] == ["HT9130"]
    controller.post(operator_event("cycle start"))
    assert not controller.finished
    last = np.zeros((0, 4))
    while (chunk := controller.propose(64)).ticks:
        last = chunk.setpoint
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert last[-1, 1] == pytest.approx(-20.0, abs=1e-12)
    assert controller.warnings == ()


def test_attended_it_waits_and_spindles_turn_on() -> None:
    """Somebody may act at any time: ticks are proposed in which the gear box turns and the axes stand."""
    events = [operator_event("feed hold", time_s=0.7)]
    program = parse_program("G81 T20\nS60\nG01 Z-10. F60\nS0\nG80\nM30")
    controller = Controller(program, parameters=delivered(), events=events, attended=True)
    rows = []
    for _ in range(300):
        chunk = controller.propose(10)
        assert chunk.ticks == 10
        rows.append(chunk.setpoint)
        controller.commit(Feedback(ticks=10, setpoint=chunk.setpoint, actual=chunk.setpoint))
    motion = np.concatenate(rows)
    assert np.ptp(motion[800:, 1]) == 0.0
    assert np.diff(motion[800:, 3]).min() == pytest.approx(0.018, rel=1e-9)  # 60 rpm / 20
    controller.post(operator_event("cycle start"))
    ticks = 0
    while (chunk := controller.propose(4096)).ticks:
        ticks += chunk.ticks
        last = chunk.setpoint[-1]
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert controller.finished
    assert last[1] == pytest.approx(-10.0, abs=1e-12)
    assert ticks > 9000


def test_a_line_event_that_is_posted_waits_for_the_next_time() -> None:
    program = parse_program("M98 P1 L3\nM30\nO1\nG04 X1.\nM99")
    controller = Controller(program, parameters=delivered())
    chunk = controller.propose(1500)
    controller.post(operator_event("feed hold", line=4))
    controller.commit(Feedback(ticks=1500, setpoint=chunk.setpoint, actual=chunk.setpoint))
    total = 1500
    while (chunk := controller.propose(4096)).ticks:
        total += chunk.ticks
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    assert total == 2000
    assert [w.number for w in controller.warnings] == ["HT9130"]
