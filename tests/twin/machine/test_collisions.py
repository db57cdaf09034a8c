"""The first tick that touches, and what is told of it, against distances worked by hand."""

import math
from itertools import pairwise

import numpy as np
import pytest
from mounted import DELIVERED

from controller.clock import Chunk, MachineAlarm
from controller.cnc import Controller
from controller.language.source import parse_program
from controller.tables.parameters import delivered
from twin.machine import (
    Assembly,
    Guarded,
    IdealMachine,
    MachineZero,
    MujocoMachine,
    Setup,
    ToolMount,
    WorkMount,
    assemble,
)

HOB = ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12)
BLANK = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0)
X, Z = 0, 1


def mounted(work: WorkMount = BLANK, tool: ToolMount = HOB, setup: Setup = Setup.HOBBING) -> Assembly:
    return assemble(DELIVERED, setup, work=work, tool=tool)


def path(*corners: tuple[float, float], step: float = 0.05) -> np.ndarray:
    """(n, 4) positions along straight lines between (X diameter at the tip, Z) of the part."""
    legs = []
    for (x0, z0), (x1, z1) in pairwise(corners):
        n = max(2, round(max(abs(x1 - x0) / 2, abs(z1 - z0)) / step))
        legs.append(np.column_stack([np.linspace(x0, x1, n), np.linspace(z0, z1, n)]))
    points = np.vstack(legs)
    out = np.zeros((len(points), 4))
    out[:, X], out[:, Z] = (points[:, 0] - 400.0) / 2, points[:, 1] - 300.0
    return out


def follow(
    assembly: Assembly, setpoint: np.ndarray, size: int = 4096
) -> tuple[int, tuple[MachineAlarm, ...]]:
    """Ticks made, and the alarms that ended them."""
    guarded, first = Guarded(IdealMachine(setpoint.shape[1]), assembly), 0
    while first < len(setpoint):
        part = setpoint[first : first + size]
        none = np.zeros(len(part))
        feedback = guarded.advance(
            Chunk(
                first_tick=first,
                setpoint=part,
                block=none.astype(np.int32),
                sync=none.astype(bool),
                tool=none.astype(np.int16),
            )
        )
        first += feedback.ticks
        assert len(feedback.actual) == len(feedback.setpoint) == feedback.ticks
        if feedback.alarms:
            return first, feedback.alarms
    return first, ()


@pytest.mark.parametrize("size", [1, 7, 4096])
def test_head_on_its_way_into_the_jaws_stops_at_the_first_tick_that_touches(size: int) -> None:
    """By hand: the head is a cylinder of 58 mm about the tool's axis from 85 mm below the work's axis down;
    there the circle of the jaws, Ø 186.8 and 12 mm before the chuck's face at Z-100, is 2 · 38.71 mm wide."""
    setpoint = path((38.0, -30.0), (38.0, -34.0), step=0.01)
    ticks, (alarm,) = follow(mounted(), setpoint, size)
    beside = (19.0 + 35.0) - math.sqrt(93.4**2 - 85.0**2)
    touches = -88.0 + math.sqrt(58.0**2 - beside**2)
    expected = int(np.argmax(setpoint[:, Z] + 300.0 <= touches)) + 1
    assert abs(ticks - expected) <= 1  # the distance itself is known to a micrometre
    assert (alarm.number, alarm.found) == ("HT9030", "carrier touches jaws")


def test_cutter_may_meet_the_blank() -> None:
    """Into the blank down to Ø 22, the arbor within it has 21."""
    assert follow(mounted(), path((60.0, -10.0), (22.0, -10.0)))[1] == ()


def test_head_that_reaches_the_blank_is_named() -> None:
    """A blank of Ø 400 under a small hob: the head, 58 mm about the tool's axis, gets there first."""
    big = WorkMount(diameter_mm=400.0, length_mm=20.0, arbor_diameter_mm=60.0)
    small = ToolMount(carrier_swivel_deg=90.0, radius_mm=20.0, length_mm=40.0, edges=8)
    ticks, (alarm,) = follow(mounted(big, small), path((460.0, -10.0), (300.0, -10.0)))
    assert alarm.found == "carrier touches blank"
    assert 0 < ticks < 1600


def test_random_walks_stop_where_looking_at_every_tick_would() -> None:
    """Against the distance of every pair at every tick."""
    rng = np.random.default_rng(8)
    for _ in range(6):
        corners = [(120.0, 40.0), *zip(rng.uniform(20, 200, 4), rng.uniform(-140, 40, 4), strict=True)]
        setpoint = path(*[(float(x), float(z)) for x, z in corners], step=2.0)
        assembly = mounted()
        guarded = Guarded(IdealMachine(4), assembly)
        shapes = guarded._first
        every = [min(shapes.distance(pair, row) for pair in shapes.pairs) for row in setpoint]
        touching = np.flatnonzero(np.array(every) <= 0.0)
        for size in (5, 4096):
            ticks, alarms = follow(assembly, setpoint, size)
            assert bool(alarms) == bool(len(touching))
            assert ticks == (touching[0] + 1 if len(touching) else len(setpoint))


@pytest.mark.parametrize("size", [1, 3, 4096])
def test_chunks_of_any_size_end_at_the_same_tick(size: int) -> None:
    setpoint = path((120.0, 40.0), (60.0, -20.0), (30.0, -140.0), step=0.5)
    assert follow(mounted(), setpoint, size) == follow(mounted(), setpoint, 64)


def test_each_tool_is_guarded_by_its_own_shape() -> None:
    """Behind the blank towards an arbor of Ø 21: the tip of the first hob is there at X21, one whose tips
    stand 5 mm less far out 10 mm of X later."""
    far = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0, stick_out_mm=300.0)
    small = ToolMount(carrier_swivel_deg=90.0, radius_mm=30.0, length_mm=80.0, edges=12)
    tools = {
        1: mounted(far),
        2: assemble(DELIVERED, Setup.HOBBING, work=far, tool=small, zero=MachineZero(x_mm=410.0)),
    }
    setpoint = path((80.0, -100.0), (0.0, -100.0), step=0.01)
    none = np.zeros(len(setpoint))
    for number, touches in ((1, 21.0), (2, 11.0)):
        feedback = Guarded(IdealMachine(4), tools).advance(
            Chunk(
                first_tick=0,
                setpoint=setpoint,
                block=none.astype(np.int32),
                sync=none.astype(bool),
                tool=np.full(len(setpoint), number, np.int16),
            )
        )
        (alarm,) = feedback.alarms
        assert alarm.found == "cutter touches arbor"
        assert 2.0 * feedback.actual[-1, X] + 400.0 == pytest.approx(touches, abs=0.03)


def test_alarm_names_bodies_time_and_line() -> None:
    """Through the controller, on the drives: the run ends in the block that collides."""
    program = parse_program("O1\nG28 U0 W0\nG00 X-362. Z-320.\nG98 G01 Z-345. F600.\nM30\n", file="a.nc")
    controller = Controller(program, parameters=delivered("hobbing"))
    guarded = Guarded(MujocoMachine(mounted()), mounted())
    while (chunk := controller.propose()).ticks:
        controller.commit(guarded.advance(chunk))
    (alarm,) = controller.alarms
    assert alarm.number == "HT9030"
    assert alarm.span
    assert (alarm.span.file, alarm.span.line) == ("a.nc", 4)
    assert alarm.found == f"carrier touches jaws, at {controller.tick * 1e-3:.3f} s"
    assert controller.finished
