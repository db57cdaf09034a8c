"""Rulings, section 1: numbers, groups, addresses, subprograms, zero points, reference and machine
positions."""

import pytest

from controller.language.offsets import Offsets


@pytest.mark.parametrize(
    ("dpi", "block", "x", "z"),
    [
        (1, "G00 X-100 Z-5", -100.0, -5.0),
        (0, "G00 X-100. Z-5.", -100.0, -5.0),
        (0, "G00 X-100 Z-5000", -0.1, -5.0),
        (1, "G00 X-10.0009 Z-.0019", -10.0, -0.001),
        (1, "G00 U-10. W-3\nU-10. W1", -20.0, -2.0),
    ],
)
def test_numbers(run, dpi: int, block: str, x: float, z: float) -> None:
    """3401#0 (DPI) decides a number without a point; finer than one increment: truncated."""
    result = run(f"{block}\nM30", parameters={"3401#0": dpi})
    assert (result.machine["X"], result.machine["Z"]) == (x, z)


def test_increments_warn_with_what_was_read(run) -> None:
    """With DPI = 0 every length without a point gets a warning; zero and F do not."""
    result = run("G01 X-100 W0 F600\nM30", parameters={"3401#0": 0})
    (warning,) = result.warnings
    assert (warning.number, warning.found) == ("HT9104", "X-100, read as -0.1 mm")
    assert str(warning).startswith("program.nc:1:5: warning[HT9104]: ")


def test_g81_reads_q_and_p_by_dpi(run) -> None:
    """The same rule reads Q, P of G81: Q2 P20 with DPI 1, Q2000 P20000 with DPI 0; T, L plain."""
    text = "G81 T20 L1 {}\nG01 Z-20. F1000\nG80\nM30"
    units = run(text.format("Q2 P20"))
    counts = run(text.format("Q2000 P20000"), parameters={"3401#0": 0})
    assert counts.machine["C"] == units.machine["C"] != 0.0


def test_g51_2_reads_r_and_a_by_dpi(run) -> None:
    text = "G51.2 P3 Q6 {}\nG01 Z-25. F1000\nG50.2\nM30"
    units = run(text.format("R90 A100"))
    counts = run(text.format("R90000 A100000"), parameters={"3401#0": 0})
    assert counts.machine == units.machine
    assert units.machine["C"] == 90.0


def test_feed_per_turn_by_dpi(run) -> None:
    """F in G99 with DPI 0 counts 0.01 mm/rev, in G98 it is mm/min either way."""
    text = "M03 S100\nG99 G01 Z-10. F{}\nM05\nM30"
    assert (
        run(text.format("10"), parameters={"3401#0": 0}).cycle_time_s == run(text.format("0.1")).cycle_time_s
    )
    text = "G01 Z-10. F100\nM30"
    assert run(text, parameters={"3401#0": 0}).cycle_time_s == run(text).cycle_time_s


def test_inch_leads_and_modules(run) -> None:
    """G20: Q in 1/inch (25.4 of m 1), A in inch."""
    metric = run("G81 T20 Q2. P20.\nG01 Z-25.4 F1000\nG80\nM30")
    inch = run("G20\nG81 T20 Q12.7 P20.\nG01 Z-1. F40\nG80\nM30")
    assert inch.machine["C"] == pytest.approx(metric.machine["C"], abs=1e-6)
    metric = run("G51.2 P1 Q2 A50.8\nG01 Z-25.4 F1000\nG50.2\nM30")
    inch = run("G20\nG51.2 P1 Q2 A2.\nG01 Z-1. F40\nG50.2\nM30")
    assert inch.machine["Y"] == pytest.approx(metric.machine["Y"], abs=1e-6)


@pytest.mark.parametrize(
    ("target", "start", "turned"), [(90, 0, 90), (270, 0, -90), (10, 350, 20), (180, 0, 180)]
)
def test_rotary_axes_go_the_short_way(run, target: float, start: float, turned: float) -> None:
    result = run(f"G00 H{start}.\nG00 C{target}.\nM30")
    assert result.turns["C"] * 360 == pytest.approx(start + turned)
    assert result.absolute["C"] == target


def test_increments_of_rotary_axes_may_be_many_turns(run) -> None:
    result = run("G00 H725. V-370.\nM30")
    assert (result.turns["C"] * 360, result.turns["Y"] * 360) == pytest.approx((725.0, -370.0), rel=1e-14)
    assert (result.machine["C"], result.absolute["Y"]) == (5.0, 350.0)


def test_g28_through_an_intermediate_point(run) -> None:
    result = run("G00 X-100. Z-50.\nG28 U-20. W10.\nM30")
    assert (result.machine["X"], result.machine["Z"]) == (0.0, 0.0)
    assert result.extents["X"].machine == (-120.0, 0.0)
    result = run("G00 X-100.\nG28 X-150.\nM30", parameters={"1240.X": -30.0})
    assert result.machine["X"] == -30.0
    assert result.extents["X"].machine == (-150.0, 0.0)


def test_g28_of_rotary_axes_goes_to_the_nearest_reference(run) -> None:
    result = run("G00 H730. V-370.\nG28 H0 V0\nM30")
    assert (result.turns["C"], result.turns["Y"]) == (2.0, -1.0)


def test_offsets_and_coordinate_setting(run) -> None:
    """G54-G59, T offset, G50, G53; absolute in diameter."""
    offsets = Offsets(
        work={"G54": {"X": -400.0, "Z": -300.0}, "G55": {"Z": -310.0, "C": 15.0}},
        tool={7: {"X": 10.0, "Z": -2.0}},
        mounted={"X": 1.0},
    )
    start = run("M30", offsets=offsets)
    assert (start.absolute["X"], start.absolute["Z"]) == (399.0, 300.0)
    result = run("G00 X35. Z-25.\nM30", offsets=offsets)
    assert (result.machine["X"], result.machine["Z"]) == (-364.0, -325.0)
    result = run("T0307\nG00 X35. Z-25.\nM30", offsets=offsets)
    assert (result.machine["X"], result.machine["Z"]) == (-355.0, -327.0)
    result = run("G55 G00 Z-25. C0\nM30", offsets=offsets)
    assert (result.machine["Z"], result.machine["C"]) == (-335.0, 15.0)
    assert (result.absolute["X"], result.absolute["Z"]) == (-1.0, -25.0)
    result = run("G50 X60. Z2.\nG00 X50. W-1.\nG53 Z-7.\nM30")
    assert (result.machine["X"], result.absolute["X"], result.machine["Z"], result.absolute["Z"]) == (
        -10,
        50,
        -7,
        -5,
    )
    result = run("G50 U5.\nM30")
    assert result.absolute["X"] == 5.0


@pytest.mark.parametrize(
    ("text", "number", "column"),
    [
        ("G01 X-5. X-6. F100", "PS5074", 10),
        ("G01 X-5. U-6. F100", "PS5074", 10),
        ("G00 G01 X-5. F100", "PS5074", 5),
        ("G96 G97", "PS5074", 5),
        ("G100 X1.", "PS0010", 1),
        ("G50.3", "PS0010", 1),
        ("G01.11 X1.", "PS0010", 1),
        ("G-1", "PS0006", 1),
        ("G05", "PS0010", 1),
        ("G65 P9010", "PS0076", 5),
        ("G12.1", "HT9003", 1),
        ("G41", "HT9003", 1),
        ("M07", "HT9009", 1),
        ("M3.5", "PS0007", 1),
        ("M-3", "PS0006", 1),
        ("M03 M08", "PS5016", 5),
        ("T1", "HT9010", 1),
        ("T-101", "PS0006", 1),
        ("T01.1", "PS0007", 1),
        ("T12345", "HT9010", 1),
        ("N-1 G00", "PS0006", 1),
        ("B90.", "PS0009", 1),
        ("G00 D5", "PS0009", 5),
        ("G00 R5.", "PS0009", 5),
        ("P5", "PS0009", 1),
        ("G28", "HT9012", 1),
        ("G50", "HT9012", 1),
        ("G53", "HT9012", 1),
        ("G53 U5.", "PS0009", 5),
        ("M98", "PS0076", 1),
        ("M98 P7", "PS0076", 5),
        ("M99", "HT9011", 1),
        ("M99 P77", "PS0060", 5),
        ("G04 X1. Z5.", "PS0009", 9),
    ],
)
def test_refusals_are_placed(run, text: str, number: str, column: int) -> None:
    """Nothing is ever ignored silently; every alarm has its place."""
    (alarm,) = run(f"N1\n{text}\nM30").alarms
    assert alarm.span is not None
    assert (alarm.number, alarm.span.line, alarm.span.column) == (number, 2, column)


SUB = "O1\nM98 P2 L3\nM98 P20003\nG00 X-1.\nM30\nO2\nG00 W-1.\nM98 P3\nM99\nO3\nG00 H1.\nM99\n"


def test_subprograms(run) -> None:
    """M98 P L, the old form M98 P20003, nesting, M99."""
    result = run(SUB)
    assert result.alarms == ()
    assert (result.machine["Z"], result.machine["C"], result.machine["X"]) == (-3.0, 5.0, -1.0)


def test_m99_p_goes_on_behind_a_sequence_number(run) -> None:
    result = run("O1\nM98 P2\nG00 X-1.\nN50 G00 Z-1.\nM99 P70\nG00 X-2.\nN70 M30\nO2\nM99 P50")
    assert result.alarms == ()
    assert (result.machine["X"], result.machine["Z"]) == (0.0, -1.0)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("O1\nM98 P1\nM30", "PS0077"),
        ("O1\nM98 P2\nM30\nO2\nG00 X-1.", "PS5010"),
        ("O1\nN1 G00 X-1.\nM99 P1", "HT9011"),
    ],
)
def test_programs_without_end(alarm_of, text: str, number: str) -> None:
    assert alarm_of(text) == number


def test_steps_without_motion_end(run, monkeypatch) -> None:
    """A program that makes 10⁶ steps without motion ends in an alarm that names the line (here 10³)."""
    import controller.language.interpreter

    assert controller.language.interpreter.LONGEST_STANDSTILL == 1_000_000
    monkeypatch.setattr(controller.language.interpreter, "LONGEST_STANDSTILL", 1000)
    loop = "O1\nM98 P2 L99999999\nM30\nO2\n{}\nM99"
    (alarm,) = run(loop.format("G04 P0")).alarms
    assert alarm.span is not None
    assert (alarm.number, alarm.span.line in (5, 6)) == ("HT9006", True)
    assert run(loop.format("G00 W-1.")).alarms[0].number == "OT0501"


def test_block_skip_and_optional_stop(run) -> None:
    text = "/G00 X-1.\nN5 /2 G00 Z-1.\nM01\nM30"
    both = run(text)
    assert (both.machine["X"], both.machine["Z"], both.warnings) == (-1.0, -1.0, ())
    skipped = run(text, signals={"BDT2": True, "OPTIONAL_STOP": True})
    assert (skipped.machine["X"], skipped.machine["Z"]) == (-1.0, 0.0)
    assert [w.number for w in skipped.warnings] == ["HT9109"]


@pytest.mark.parametrize("bfa", [0, 1])
@pytest.mark.parametrize(
    ("block", "limit", "number"), [("Z-900.", -800.0, "OT0501"), ("Z450.", 400.0, "OT0500")]
)
def test_stroke_limit_1(run, bfa: int, block: str, limit: float, number: str) -> None:
    """1300#7 (BFA) = 1: the slide stops on the limit; 0: it brakes from there, v²/2a further on."""
    result = run(f"G01 {block} F6000\nM30", parameters={"1300#7": bfa})
    (alarm,) = result.alarms
    assert (alarm.number, alarm.kind.value) == (number, "overtravel")
    assert f"slide Z at its limit {limit:.3f}" in alarm.found
    over = 0.0 if bfa else 100.0**2 / (2 * 2000.0)
    assert result.machine["Z"] == pytest.approx(limit + (over if limit > 0 else -over), abs=1e-6)


def test_limit_of_a_diameter_axis_counts_in_diameter(run) -> None:
    result = run("G01 X-300. F1000\nM30", parameters={"1321.X": -250.0, "1300#7": 1})
    assert result.alarms[0].found == "slide X at its limit -250.000 mm"
    assert result.machine["X"] == -250.0


def test_back_inside_is_allowed(run) -> None:
    """A path that ends on the limit is inside; an axis that stands outside may only come back."""
    assert run("G01 Z-800. F8000\nM30").alarms == ()
    assert run("G00 Z-5.\nM30", parameters={"1320.Z": -1.0}).alarms == ()


def test_text_after_the_tape_is_said(run) -> None:
    result = run("%\nO1\nM30\n%\nG00 X1.")
    assert [(w.number, w.span.line) for w in result.warnings if w.span] == [("HT9110", 5)]


def test_missing_m30_is_said(run) -> None:
    result = run("G00 X-1.")
    assert result.machine["X"] == -1.0
    assert [w.number for w in result.warnings] == ["HT9105"]
