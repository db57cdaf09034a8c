"""The clock: chunks change nothing, feedback is the only thing that comes back, idle time costs nothing."""

import numpy as np
import pytest

from controller.clock import Feedback, MachineAlarm
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.events import EventKind
from controller.language.offsets import Offsets
from controller.language.source import parse_program
from controller.motion import sampling
from controller.tables.alarms import AlarmClass, ControllerError
from controller.tables.parameters import delivered

EVERYTHING = """G28 U0 W0
G28 H0 V0
G81 T20 L1 Q2. P20.
S300
G01 X-1.5 F500
G99 G01 Z-0.31 F2.
G98 G00 H7.
S-200
G00 Z0.5
S0
G80
G04 P33
G51.2 P1 Q2 R5.
S90
G01 Z1.1 F300
S0
G50.2
T0101
M03 S200
G99 G01 X-2. F0.1
M05
M30
"""


@pytest.mark.parametrize("follow", [0, 1])
@pytest.mark.parametrize("theoretical", [0, 1])
def test_every_limit_gives_the_same_bits(drive, follow: int, theoretical: int) -> None:
    """For the same program every `limit` gives bit-identical setpoints."""
    parameters = {"201#7": follow, "201#2": theoretical}
    runs = [drive(EVERYTHING, parameters=parameters, limit=limit) for limit in (4096, 7, 1)]
    assert runs[0].controller.alarms == ()
    assert len(runs[0].setpoint) > 3000
    for other in runs[1:]:
        assert other.setpoint.tobytes() == runs[0].setpoint.tobytes()
        for name in ("block", "sync", "tool"):
            assert np.array_equal(getattr(other, name), getattr(runs[0], name))
        assert other.controller.blocks == runs[0].controller.blocks


def test_propose_changes_nothing() -> None:
    controller = Controller(parse_program(EVERYTHING), parameters=delivered())
    first, again = controller.propose(100), controller.propose(100)
    assert controller.tick == 0
    assert first.setpoint.tobytes() == again.setpoint.tobytes()


def test_the_machine_may_stop_short(drive) -> None:
    """The controller commits exactly the ticks that have been advanced."""

    class Hesitant:
        def advance(self, chunk):
            n = max(1, chunk.ticks // 2)
            return Feedback(ticks=n, setpoint=chunk.setpoint[:n], actual=chunk.setpoint[:n])

    parameters = {"201#2": 1}
    assert drive(EVERYTHING, parameters=parameters, drives=Hesitant()).setpoint.tobytes() == (
        drive(EVERYTHING, parameters=parameters).setpoint.tobytes()
    )


def test_dry_run_and_clock_agree(drive) -> None:
    """The closed form that `check` reads is the motion that a run samples."""
    driven = drive(EVERYTHING, parameters={"201#2": 1})
    result = dry_run(parse_program(EVERYTHING), delivered("hobbing", {"201#2": 1}))
    assert len(driven.setpoint) == pytest.approx(result.cycle_time_s * 1000, abs=1)
    for letter, factor in (("X", 2.0), ("Z", 1.0)):
        assert driven.axis(letter)[-1] * factor == pytest.approx(result.machine[letter], abs=1e-6)
    assert driven.axis("Y")[-1] / 360 == pytest.approx(result.turns["Y"], abs=1e-9)


@pytest.mark.parametrize("tick_s", [0.001, 0.00025, 0.008])
def test_nothing_jumps(drive, tick_s: float) -> None:
    """Speeds and accelerations stay within the parameters at every tick."""
    driven = drive(EVERYTHING, tick_s=tick_s)
    speed = np.diff(driven.setpoint, axis=0) / tick_s
    acceleration = np.diff(speed, axis=0) / tick_s
    ramp = 3600.0 * (1 + 1e-6)
    assert np.abs(acceleration[:, 2:]).max() <= ramp + 1e-4 / tick_s
    assert np.abs(acceleration[:, :2]).max() <= 2000.0 * (1 + 1e-6)
    assert np.abs(speed[:, :2]).max() <= 250.0 * (1 + 1e-9)


def test_rows_name_their_blocks_tools_and_sync(drive) -> None:
    driven = drive("G00 X-10.\nT0203\nG01 Z-5. F600\nG81 T20 L1\nS60\nG04 X0.5\nS0\nG80\nM30")
    texts = np.array([block.text for block in driven.controller.blocks])[driven.block]
    x, z = driven.axis("X"), driven.axis("Z")
    assert set(texts[:-1][np.diff(x) != 0.0]) == {"G00 X-10."}
    assert set(texts[1:][np.diff(z) != 0.0]) == {"G01 Z-5. F600"}
    assert set(driven.tool[texts == "G00 X-10."]) == {0}
    assert set(driven.tool[texts == "G01 Z-5. F600"]) == {2}
    assert set(texts[driven.sync]) <= {"G81 T20 L1", "S60", "G04 X0.5", "S0", "G80"}
    assert [block.line for block in driven.controller.blocks] == list(range(1, 10))


def test_a_long_dwell_fills_no_memory_and_can_be_skipped() -> None:
    controller = Controller(parse_program("G04 X90000.\nG00 X-10.\nM30"), parameters=delivered())
    assert controller.propose(4096).ticks == 4096
    assert controller.idle_ticks() == 90_000_000
    controller.skip(90_000_000)
    chunk = controller.propose(4096)
    assert chunk.first_tick == 90_000_000
    assert chunk.setpoint[0, 0] < 0.0
    assert controller.idle_ticks() == 0
    with pytest.raises(ControllerError, match="at most the 0 idle ones"):
        controller.skip(1)


def test_a_turning_spindle_is_not_idle() -> None:
    controller = Controller(parse_program("G81 T20\nS10\nG04 X100.\nS0\nG80\nM30"), parameters=delivered())
    assert controller.idle_ticks() == 0


def test_alarm_comes_when_its_block_would_begin() -> None:
    """The machine finishes what stands before the block in alarm; the event comes at its end."""
    controller = Controller(parse_program("G01 X-10. F600\nG01 Q1\nM30"), parameters=delivered())
    events = []
    while (chunk := controller.propose(50)).ticks:
        assert controller.alarms == ()
        events += controller.commit(
            Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint)
        )
    assert controller.finished
    assert [event.kind for event in events] == [EventKind.ALARM]
    assert [alarm.number for alarm in controller.alarms] == ["PS0009"]
    assert events[0].tick == controller.tick == pytest.approx(500 + 5, abs=1)


def test_a_machine_alarm_ends_the_program() -> None:
    controller = Controller(parse_program("G01 X-10. F600\nM30"), parameters=delivered())
    chunk = controller.propose(50)
    alarms = (MachineAlarm(number="SV0411", axis=0, found="1.2 mm behind, 1.0 allowed"),)
    rows = chunk.setpoint[:20]
    events = controller.commit(Feedback(ticks=20, setpoint=rows, actual=rows, alarms=alarms))
    assert [event.alarm.number for event in events if event.alarm] == ["SV0411"]
    assert "X: 1.2 mm behind" in str(controller.alarms[0])
    assert controller.propose(50).ticks == 0
    assert (controller.finished, controller.tick) == (True, 20)


def test_unknown_machine_alarm_keeps_its_number_in_the_message() -> None:
    controller = Controller(parse_program("G01 X-10. F600\nM30"), parameters=delivered())
    controller.propose(5)
    alarm = MachineAlarm(number="SV9999", axis=None, found="smoke")
    controller.commit(Feedback(ticks=0, setpoint=np.zeros((0, 4)), actual=np.zeros((0, 4)), alarms=(alarm,)))
    assert "SV9999 smoke" in str(controller.alarms[0])
    assert controller.alarms[0].kind is AlarmClass.SERVO


def test_misuse_is_refused_with_words() -> None:
    controller = Controller(parse_program("G01 X-10. F600\nM30"), parameters=delivered())
    rows = np.zeros((6, 4))
    controller.propose(5)
    with pytest.raises(ControllerError, match="at most 5 as proposed"):
        controller.commit(Feedback(ticks=6, setpoint=rows, actual=rows))
    with pytest.raises(ControllerError, match="at least 1"):
        controller.propose(0)
    program = parse_program("M30")
    for tick_s in (0.0, -1.0, 0.0003, 2.0):
        with pytest.raises(ControllerError, match="fraction of a second"):
            Controller(program, parameters=delivered(), tick_s=tick_s)
    with pytest.raises(ControllerError, match=r"unknown signal 'NOZAG'.*NOZAGC"):
        Controller(program, parameters=delivered(), signals={"NOZAG": True})
    with pytest.raises(ControllerError, match="unknown work offset 'G60'"):
        Controller(program, parameters=delivered(), offsets=Offsets(work={"G60": {}}))
    with pytest.raises(ControllerError, match="unknown axis 'B'"):
        Controller(program, parameters=delivered(), offsets=Offsets(work={"G54": {"B": 1.0}}))
    with pytest.raises(ControllerError, match="tool offset 100"):
        Controller(program, parameters=delivered(), offsets=Offsets(tool={100: {}}))


def test_a_million_hob_turns_are_never_ticked(monkeypatch) -> None:
    """A dry run reads closed forms only: 55 hours of hobbing without one sample."""

    def sampled(*_: object) -> None:
        raise AssertionError("a dry run sampled the motion")

    monkeypatch.setattr(sampling, "setpoints", sampled)
    monkeypatch.setattr(sampling, "positions", sampled)
    program = parse_program("G81 T20 L1\nS300\nG99 G01 Z-300. F0.01\nS0\nG80\nM30")
    result = dry_run(program, delivered())
    assert result.turns["Y"] > 599_000
