"""Rulings, sections 4 and 5: motion by hand, manual reference return, signals of the axes."""

import math

import pytest

from controller.language.source import parse_program
from controller.tables.parameters import delivered

RADIUS = {"8200#0": 1, "1006#3.X": 0}


# Manual mode


def test_jog_in_a_hold_goes_on_in_parallel(act) -> None:
    """After manual intervention the rest of the block is parallel, the registers are true, and the next
    absolute block is where it should be."""
    text = "G01 X-40. Z-100. F6000\nG01 Z-120.\nM30"
    found = act(text, "0.5 feed hold", "1.0 jog Z 5. F600", "3.0 cycle start")
    assert found.extents["Z"].machine[0] == -120.0
    assert found.absolute == {"X": -40.0, "Z": -120.0, "Y": 0.0, "C": 0.0}
    assert found.machine["Z"] == -120.0
    only = act("G01 X-40. Z-100. F6000\nM30", "0.5 feed hold", "1.0 jog Z 5. F600", "3.0 cycle start")
    assert only.absolute["Z"] == pytest.approx(-95.0, abs=1e-9)
    assert only.machine["Z"] == pytest.approx(-95.0, abs=1e-9)
    assert only.absolute["X"] == -40.0


def test_jog_speed_and_distance(act) -> None:
    """In programmed units, X in diameter; at F, or at the jog speed of parameter 1423."""
    found = act("M30", "1.0 jog X -20. F600")
    assert found.machine["X"] == -20.0
    assert found.cycle_time_s == pytest.approx(1.0 + 10.0 / 10.0 + 10.0 / 2000.0, rel=1e-9)
    found = act("M30", "1.0 jog Z -20.", parameters={"1423.Z": 1200})
    assert found.cycle_time_s == pytest.approx(1.0 + 20.0 / 20.0 + 20.0 / 2000.0, rel=1e-9)


def test_jog_while_the_program_runs_is_refused(act, warned) -> None:
    found = act("G04 X2.\nM30", "1.0 jog Z 5.")
    assert warned(found) == ["HT9131"]
    assert found.machine["Z"] == 0.0


def test_manual_mode_holds_and_auto_gives_back(act, warned) -> None:
    text = "G01 Z-50. F1200\nM30"
    found = act(text, "1.0 manual", "1.5 cycle start", "2.0 jog X 10.", "4.0 auto", "5.0 cycle start")
    assert warned(found) == ["HT9131"]
    assert (found.absolute["X"], found.absolute["Z"]) == (10.0, -50.0)


@pytest.mark.parametrize(
    ("gear", "master", "slave", "number"),
    [("G81 T20 L1", "Y", "C", "PS1595"), ("G51.2 P1 Q2", "C", "Y", "PS0220")],
)
def test_manual_mode_in_sync(act, gear: str, master: str, slave: str, number: str) -> None:
    """Manual mode keeps sync: jogging the master is refused, jogging the slave adds."""
    text = f"{gear}\nS60\nG01 Z-20. F60\nM30"
    refused = act(text, "2.0 feed hold", f"3.0 jog {master} 5.")
    assert refused.alarms[0].number == number
    assert refused.in_sync_at_end
    both = act(f"{gear}\nG04 X1.\nM05", "0.5 feed hold", f"0.6 jog {slave} 30.")
    assert both.turns[slave] == pytest.approx(30.0 / 360.0, rel=1e-12)
    ratio = 1 / 20 if slave == "C" else 2.0
    added = act(text, "2.0 feed hold", f"3.0 jog {slave} 30.")
    assert added.turns[slave] - ratio * added.turns[master] == pytest.approx(30.0 / 360.0, abs=1e-9)
    assert added.in_sync_at_end


@pytest.mark.parametrize(
    ("gear", "letter", "number"),
    [
        ("G81 T20 L1", "Y", "PS1595"),
        ("G81 T20 L1", "C", "PS1595"),
        ("G51.2 P1 Q2", "Y", "PS0220"),
        ("G51.2 P1 Q2", "C", "PS0220"),
    ],
)
def test_manual_return_of_a_sync_axis_is_refused(act, gear: str, letter: str, number: str) -> None:
    """G28 of a sync axis is refused (sections 2, 3), and so is the return by hand: sync would take the axis
    away from its reference point before it got there."""
    found = act(f"{gear}\nS60\nG01 Z-20. F60\nM30", "2 feed hold", f"3 reference return {letter}")
    assert found.alarms[0].number == number
    assert found.in_sync_at_end


def test_jog_of_the_axial_axis_turns_the_slave_of_a_helical_gear(act) -> None:
    """ΔZ counts all Z motion since G81, manual included."""
    text = "G81 T20 L1 Q2. P20.\nM00\nG80\nM30"
    found = act(text, "1 jog Z -20.", "5 cycle start")
    shift = 360 * 20 * math.sin(math.radians(20)) / (math.pi * 20 * 2)
    assert found.machine["C"] == pytest.approx(shift, abs=1e-6)
    assert found.absolute["C"] == pytest.approx(shift, abs=1e-6)


def test_jog_of_an_inclined_pair(act, warned) -> None:
    """±Jx is Cartesian: the inclined axis takes the orthogonal slide with it unless NOZAGC = 1, which
    independent motion needs (注意 4)."""
    both = act("M30", "1 jog Y 100.", setup="tilted", parameters=RADIUS)
    assert (both.machine["X"], both.machine["Y"]) == pytest.approx((57.735, 115.470), abs=1e-3)
    assert warned(both) == ["HT9136"]
    one = act("M30", "1 jog Y 100.", setup="tilted", parameters=RADIUS, signals={"NOZAGC": True})
    assert (one.machine["X"], one.machine["Y"]) == pytest.approx((0.0, 115.470), abs=1e-3)
    assert "HT9136" not in warned(one)
    live = act("M30", "0.5 signal NOZAGC=1", "1 jog Y 100.", setup="tilted", parameters=RADIUS)
    assert live.machine == one.machine


def test_jog_to_a_stroke_limit(act) -> None:
    (alarm,) = act("M30", "1 jog Z 500.").alarms
    assert alarm.number == "OT0500"


def test_mdi_runs_one_block_between_blocks(act, warned) -> None:
    text = "G04 X1.\nM00\nG04 X1.\nM30"
    found = act(text, "2 mdi G00 X-10. Z-5.", "5 cycle start")
    assert (found.absolute["X"], found.absolute["Z"]) == (-10.0, -5.0)
    assert found.cycle_time_s == 6.0
    assert 0 in found.blocks.line
    inside = act("G01 Z-50. F1200\nM30", "1.0 feed hold", "2.0 mdi G00 X5.", "3 cycle start")
    assert warned(inside) == ["HT9131"]
    wrong = act(text, "2 mdi G00 K5.")
    assert (wrong.alarms[0].number, wrong.alarms[0].span.file) == ("PS0009", "MDI")


# Manual reference return


@pytest.mark.parametrize(("azr", "x"), [(0, -57.735), (1, 0.0)])
def test_azr(act, azr: int, x: float) -> None:
    """AZR 8200#2 = 0: the manual return of the inclined axis moves the orthogonal slide, too; 1: it does not.
    From Y 100: the slide Y comes home from 115.470; X moves by −57.735 or stays."""
    text = "G28 Y0\nG28 X0\nG00 Y100.\nM00\nM30"
    found = act(text, "20 reference return Y", setup="tilted", parameters=RADIUS | {"8200#2": azr})
    assert found.machine["Y"] == pytest.approx(0.0, abs=1e-9)
    assert found.machine["X"] == pytest.approx(57.735 + x, abs=1e-3)


def test_the_orthogonal_axis_must_follow_at_once(act, warned) -> None:
    text = "M00\nM30"
    ok = act(text, "1 reference return Y", "9 reference return X", setup="tilted", parameters=RADIUS)
    assert (ok.alarms, warned(ok)) == ((), ["HT9130"])
    late = act(
        text, "1 reference return Y", "5 jog Z 1.", "9 reference return X", setup="tilted", parameters=RADIUS
    )
    assert "HT9120" in warned(late)
    azr = RADIUS | {"8200#2": 1}
    free = act(
        text, "1 reference return Y", "5 jog Z 1.", "9 reference return X", setup="tilted", parameters=azr
    )
    assert "HT9120" not in warned(free)


def test_manual_return_of_the_orthogonal_axis_first_alarms(act) -> None:
    """DS0020 at any time while the inclined axis is not on its reference point."""
    assert act("M30", "1 reference return X", setup="tilted", parameters=RADIUS).alarms[0].number == "DS0020"
    text = "G28 Y0\nG28 X0\nG00 Y10.\nM00\nM30"
    assert act(text, "9 reference return X", setup="tilted", parameters=RADIUS).alarms[0].number == "DS0020"


def test_manual_return_out_of_the_pair(act) -> None:
    found = act("G00 X-20. Z-30.\nM00\nM30", "5 reference return Z", "9 cycle start")
    assert (found.machine["X"], found.machine["Z"], found.absolute["Z"]) == (-20.0, 0.0, 0.0)
    assert found.signals["ZPZ"]
    assert not found.signals["ZPX"]


# Signals


def test_interlock_lets_a_block_wait(act, warned) -> None:
    text = "G00 Z-30.\nM30"
    plain = act(text).cycle_time_s
    found = act(text, "0 signal *ITZ=0", "4 signal *ITZ=1")
    assert found.cycle_time_s == pytest.approx(4.0 + plain, rel=1e-12)
    assert warned(act(text, "0 signal *ITZ=0")) == ["HT9130"]
    assert act(text, "0 signal *ITX=0").cycle_time_s == plain
    assert act(text, "0 signal SVFZ=1", "4 signal SVFZ=0").cycle_time_s == found.cycle_time_s


def test_mirror_image_moves_the_slide_the_other_way(act) -> None:
    found = act("G00 X-20. Z-30.\nM30", signals={"MIZ": True})
    assert (found.absolute["Z"], found.machine["Z"], found.machine["X"]) == (-30.0, 30.0, -20.0)


def test_displayed_speed_leaves_the_sync_pulses_out() -> None:
    """Hobbing, 注意事项: the speed display does not count the pulses of the gear box."""
    from controller.execution import Execution
    from controller.language.offsets import Offsets
    from controller.motion.axes import Circumstances

    text = "G81 T20 L1\nS300\nG01 Z-20. F600\nG80\nM30"
    execution = Execution(
        parse_program(text), delivered(), Offsets(), {}, circumstances=Circumstances(closed_form=False)
    )
    while not execution.done:
        execution.step()
    motion = execution.motion
    assert motion.timeline.tracks[2].speed(1.0) == 1800.0
    assert motion.displayed_speed(1.0) == pytest.approx(600.0, rel=1e-12)
