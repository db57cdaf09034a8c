"""Rulings, section 3 (polygon original), by sentence."""

import numpy as np
import pytest

HOME = "G28 U0 W0\nG28 H0 V0\n"
ECN = {"201#4": 1}


@pytest.mark.parametrize(
    ("block", "ratio"), [("P2 Q6", 3.0), ("P3 Q6", 2.0), ("P1 Q-2", -2.0), ("P2 Q4", 2.0)]
)
@pytest.mark.parametrize("speed", [300, -300])
def test_ratio_and_sense(run, block: str, ratio: float, speed: int) -> None:
    """Master = work, slave = tool, slave = master · Q / P; Q > 0 same direction; the sign of S is the
    master's."""
    result = run(f"{HOME}G51.2 {block}\nS{speed}\nG04 X10.\nS0\nG50.2\nM30")
    assert result.alarms == ()
    assert result.turns["C"] == pytest.approx(np.sign(speed) * 50.0, rel=1e-12)
    assert result.turns["Y"] == pytest.approx(ratio * result.turns["C"], rel=1e-14)


def test_ratio_at_every_tick(drive) -> None:
    driven = drive("G51.2 P3 Q7\nS200\nG04 X2.\nS-50\nG04 X1.\nS0\nG50.2\nM30")
    work, tool = driven.axis("C"), driven.axis("Y")
    assert np.abs(tool - work * 7 / 3).max() <= np.spacing(np.abs(tool).max())


@pytest.mark.parametrize(
    ("block", "number"),
    [
        ("G51.2 Q6", "PS0218"),
        ("G51.2 P2", "PS0218"),
        ("G51.2 P0 Q6", "PS0218"),
        ("G51.2 P1000 Q6", "PS0218"),
        ("G51.2 P2 Q0", "PS0218"),
        ("G51.2 P2 Q1000", "PS0218"),
        ("G51.2 P2 Q-1000", "PS0218"),
        ("G51.2 P2.5 Q6", "PS0218"),
        ("G51.2 P2 Q6 R-1.", "PS0218"),
        ("G51.2 P2 Q6 R10000.", "PS0218"),
        ("G51.2 P2 Q6 S300", "PS0219"),
        ("G51.2 P2 Q6 X1.", "PS0219"),
        ("G51.2 P2 Q6 G00", "PS0219"),
        ("G51.2 P2 Q6 M08", "PS0219"),
        ("G50.2 S0", "PS0219"),
        ("G50.2 G00", "PS0219"),
        ("G51.2 P999 Q-999 R9999.999 A-100.", None),
        ("N5 G51.2 P2 Q6", None),
    ],
)
def test_format(alarm_of, block: str, number: str | None) -> None:
    """P 1-999, Q −999..999 without 0, R 0..9999.999; alone in the block (PS0219)."""
    assert alarm_of(f"{block}\nG50.2\nM30") == number


@pytest.mark.parametrize(
    ("block", "number"),
    [
        ("G00 C90.", "PS0220"),
        ("G00 H90.", "PS0220"),
        ("G00 Y90.", "PS0220"),
        ("G00 V90.", "PS0220"),
        ("M03 S100", "PS0220"),
        ("G96 S100", "PS0220"),
        ("G20", "PS0220"),
        ("T0101", "PS0220"),
        ("G28 H0", "PS0220"),
        ("M30", "PS0220"),
        ("G81 T20", "PS0220"),
        ("G51.2 P2 Q6", "PS0217"),
        ("S2001", "PS1544"),
        ("S1334", "PS5018"),
        ("S1333", None),
        ("S0", None),
        ("M05", None),
        ("G00 X-5. Z-5.", None),
        ("G28 U0 W0", None),
    ],
)
def test_in_sync(alarm_of, block: str, number: str | None) -> None:
    """Neither master nor slave may be commanded (PS0220); S is the work speed; slave over its limit
    PS5018."""
    assert alarm_of(f"{HOME}G51.2 P2 Q6\n{block}\nS0\nG50.2\nM30") == number


def test_scallops_warn(run) -> None:
    """Q < 0 cuts scallops, not flats: warning."""
    assert [w.number for w in run("G51.2 P2 Q-6\nG50.2\nM30").warnings] == ["HT9103"]


def test_phase_r_turns_the_master_first(drive, run) -> None:
    """R: turned by the master in + at rapid before coupling, relative; it counts as sync motion."""
    driven = drive("G00 C10.\nG51.2 P2 Q6 R90.\nS60\nG04 X1.\nS0\nG50.2\nM30")
    work, tool = driven.axis("C"), driven.axis("Y")
    engaged = np.flatnonzero(driven.sync)
    assert work[engaged[0] - 1] == pytest.approx(100.0, abs=2e-3)
    assert np.abs(tool[engaged] - (work[engaged] - 100.0) * 3).max() < 1e-9
    result = run("G00 C10.\nG51.2 P2 Q6 R90.\nG50.2\nM30")
    assert (result.absolute["C"], result.machine["C"], result.absolute["Y"]) == (100.0, 100.0, 0.0)
    before = run("G00 C10.\nG51.2 P2 Q6 R90.\nG04 X1.")
    assert before.machine["C"] == 100.0
    assert before.absolute["C"] == 10.0


@pytest.mark.parametrize(("lead", "shift"), [("A100.", -180.0), ("A-100.", 180.0)])
def test_lead_shifts_the_tool(run, lead: str, shift: float) -> None:
    """A: the slave is shifted by +(Q/P)·360°·ΔZ/A; here ΔZ = −25, Q/P = 2."""
    result = run(f"G51.2 P3 Q6 {lead}\nS100\nG01 Z-25. F1000\nS0\nG50.2\nM30")
    assert 360 * (result.turns["Y"] - 2 * result.turns["C"]) == pytest.approx(shift, abs=1e-6)
    assert result.absolute["Y"] == pytest.approx(result.machine["Y"], abs=1e-6)


def test_displays_wait_for_g50_2(run) -> None:
    """Registers: machine only during sync; at G50.2 both absolutes += motion modulo 360; then absolute
    words work."""
    program = "G00 C10. Y20.\nG51.2 P2 Q6\nS300\nG04 X7.3\nS0\n"
    during = run(program)
    assert (during.absolute["C"], during.absolute["Y"]) == (10.0, 20.0)
    after = run(program + "G50.2\nM30")
    assert after.absolute["C"] == pytest.approx((10 + 360 * 5 * 7.3) % 360, abs=1e-5)
    assert after.absolute["Y"] == pytest.approx((20 + 360 * 15 * 7.3) % 360, abs=1e-5)
    again = run(program + "G50.2\nG00 C90. Y30.\nM30")
    assert (again.machine["C"], again.machine["Y"]) == (
        pytest.approx(90.0, abs=1e-6),
        pytest.approx(30.0, abs=1e-6),
    )


def test_repeated_g51_2(run) -> None:
    """Repeated G51.2 as 201#4 says: PS0217 when 0, the new ratio when 1, with the jump named."""
    program = "G51.2 P1 Q2\nS100\nG04 X2.\nG51.2 P1 Q3\nS0\nG50.2\nM30"
    (warning,) = run(program, parameters=ECN).warnings
    assert warning.found == "a jump of +100.000 rpm"
    assert run(program).alarms[0].number == "PS0217"


def test_r_again_while_turning_is_refused(alarm_of) -> None:
    assert alarm_of("G51.2 P1 Q2\nS100\nG51.2 P1 Q2 R5.\nM30", parameters=ECN) == "HT9008"


def test_inclined_axis_forbids_it(alarm_of) -> None:
    """988TD 倾斜轴, 不能一起使用的功能: polygon turning."""
    assert alarm_of("G51.2 P2 Q6\nM30", "tilted", {"8200#0": 1}) == "HT9014"
    assert alarm_of("G51.2 P2 Q6\nG50.2\nM30", "tilted") is None


def test_release_while_turning(drive) -> None:
    """The slave brakes, the master keeps S."""
    driven = drive("G51.2 P1 Q2\nS100\nG04 X1.\nG50.2\nG04 X1.\nM30")
    work, tool = np.diff(driven.axis("C")), np.diff(driven.axis("Y"))
    released = int(np.flatnonzero(driven.sync)[-1])
    assert work[released + 400] == pytest.approx(0.6, rel=1e-9)
    assert tool[released + 400] == pytest.approx(0.0, abs=1e-12)


def test_the_range_of_r_is_told_as_it_is(run) -> None:
    """R 0..9999.999°: the remedy of PS0218 names that, not a rounded 10000."""
    found = run("G51.2 P2 Q4 R10000.\nM30").alarms[0]
    assert (found.number, found.valid) == ("PS0218", "R 0 to 9999.999")


def test_lead_beside_the_speed_limit_of_the_tool(run) -> None:
    """Slave speed over its limit → PS5018, also where the lead A asks for what the sync motion leaves not."""
    text = "G51.2 P1 Q2 A1.\nS2000\nG04 X4.\nG01 Z{} F100\nS0\nG50.2\nM30"
    assert run(text.format(1)).alarms[0].number == "PS5018"
    slowed = run(text.format(-1))
    assert slowed.alarms == ()
    crawl = run("G51.2 P1 Q2 A0.001\nG01 Z-0.01 F100\nG50.2\nM30").warnings[0]
    assert (crawl.number, crawl.found) == ("HT9107", "100 mm/min asked for, 0.05 possible on this path")
    assert slowed.peaks["Y"].speed <= slowed.peaks["Y"].speed_limit * (1 + 1e-9)
