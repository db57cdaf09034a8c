"""Rulings, section 1: custom macro B - variables, expressions, statements, calls, system variables."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.commands import Move, ProgramStop, ShiftCoordinates
from controller.language.offsets import Offsets
from controller.tables.alarms import AlarmClass


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1+2*3", 7),
        ("[1+2]*3", 9),
        ("2-3-4", -5),
        ("24/4/3", 2),
        ("7 MOD 4 * 2", 6),
        ("2+6 AND 3", 4),
        ("1 OR 6 AND 5", 5),
        ("6 XOR 3", 5),
        ("-2*3", -6),
        ("5--3", 8),
        ("SQRT[9]+ABS[-4]", 7),
        ("SIN[30]*COS[60]", 0.25),
        ("ATAN[1]/[-1]", 135),
        ("ATAN[-1,1]", 315),
        ("ATAN[1]", 45),
        ("ATAN[1]/2", 22.5),
        ("POW[2,10]", 1024),
        ("LN[EXP[2]]", 2),
        ("ROUND[1.5]+FIX[-1.9]+FUP[1.1]", 3),
        ("BIN[18]+BCD[12]", 30),
        ("[3 GT 2]+[3 LT 2]", 1),
        (".5+5.", 5.5),
        ("#0+4", 4),
        ("(depth) 2 (per side) *3", 6),
        ("sin[90]+12mod5", 3),
    ],
)
def test_expressions(value, expression: str, expected: float) -> None:
    """Functions first, then * / MOD AND, then + - OR XOR, then comparisons."""
    assert value(expression) == pytest.approx(expected, rel=1e-12)


TREES = st.recursive(
    st.integers(0, 999).map(str) | st.sampled_from(["#1", "#2", "0.5", "12.25"]),
    lambda inner: st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"[{t[0]}{t[1]}{t[2]}]"),
    max_leaves=8,
)


@settings(max_examples=60, deadline=None)
@given(TREES)
def test_arithmetic_is_that_of_python(read, tree: str) -> None:
    """Nested up to five brackets; deeper is PS0118."""
    depth = max((tree[:k].count("[") - tree[:k].count("]") for k in range(len(tree) + 1)), default=0)
    reading = read(f"#1=3\n#2=-7.5\n#500={tree}\n#501=#500/100000000000\nG00 Z#501\nM30")
    if depth > 5:
        assert reading.alarm and reading.alarm.number == "PS0118"
        return
    expected = eval(tree.replace("[", "(").replace("]", ")").replace("#1", "3.0").replace("#2", "(-7.5)"))
    if abs(expected) < 9e14:
        assert reading.of(Move)[-1].absolute[1] == round(expected / 1e11, 3)


@pytest.mark.parametrize(
    ("lines", "z"),
    [
        ("#1=2\n#[#1+1]=5\nG00 Z#3", 5),
        ("#1=2\n#2=7\nG00 Z#[#1]", 7),
        ("#101=1\n#102=-3.5\nG00 Z-#102", 3.5),
        ("#1=1.23456\nG00 Z#1", 1.235),
        ("#1=1.23456\nG00 Z[ROUND[#1*10]/10]", 1.235),
        ("#1=1\n#1=#1+1\n#1=#1*#1\nG00 Z#1", 4),
        ("#1=0\nG#1 Z-4.", -4),
        ("#3=7\nG00Z[#3*2-4]X1.", 10),
    ],
)
def test_variables_in_words(read, lines: str, z: float) -> None:
    """Indirect numbers, signs, and rounding of a word to the least increment."""
    reading = read(f"{lines}\nM30")
    assert reading.alarm is None
    assert reading.machine["Z"] == pytest.approx(z, abs=1e-12)


def test_null_value_leaves_a_word_out(read) -> None:
    """A word of an undefined variable is as if it were not written; #0 is always undefined."""
    (move,) = read("#1=5\n#1=#0\nG00 X#1 Z-3.\nM30").of(Move)
    assert (move.absolute, move.incremental) == ({1: -3.0}, {})
    assert read("#2=#1\nIF[#2 EQ #0]GOTO5\nG00 Z1.\nN5 M30").steps[0][0] == 4


@pytest.mark.parametrize(
    ("program", "z"),
    [
        ("#1=0\nWHILE[#1 LT 5]DO1\n#1=#1+1\nG00 W-1.\nEND1\nM30", -5),
        ("#1=0\nN1 #1=#1+1\nG00 W-1.\nIF[#1 LT 4]GOTO1\nM30", -4),
        ("#1=9\nIF[#1 GT 5]THEN #1=2\nG00 Z#1\nM30", 2),
        ("GOTO 20\nG00 Z1.\nN20 M30", 0),
        ("#5=20\nGOTO#5\nG00 Z1.\nN20 G00 Z2.\nM30", 2),
        ("GOTO[10*2]\nG00 Z1.\nN20 G00 Z2.\nM30", 2),
        ("WHILE[1 EQ 0]DO2\nG00 Z1.\nEND2\nM30", 0),
        ("#1=0\nDO1\n#1=#1+1\nG00 W1.\nIF[#1 EQ 3]GOTO9\nEND1\nN9 M30", 3),
        ("#1=0\nWHILE[#1 LT 5]DO1\n#1=#1+1；END1\nG00 W1.\nEND1\nM30", 5),  # ； begins an annotation
        ("#1=0\nIF[[#1 EQ 0] AND [2 GT 1]]GOTO9\nG00 Z1.\nN9 M30", 0),
        ("N5 G00 W1.\n#1=#1+1\nIF[#1 EQ 1]GOTO5\nM30\nN5 G00 W10.\nM30", 11),
    ],
)
def test_flow(read, program: str, z: float) -> None:
    """IF, THEN, GOTO (forward from its block, then from the top), WHILE, DO, END."""
    reading = read(program)
    assert reading.alarm is None
    assert reading.machine["Z"] == z


def test_loops_nest_three_deep(read) -> None:
    text = (
        "#1=0\nWHILE[#1 LT 2]DO1\n#2=0\nWHILE[#2 LT 3]DO2\n#3=0\nWHILE[#3 LT 4]DO3\n"
        "G00 W1.\n#3=#3+1\nEND3\n#2=#2+1\nEND2\n#1=#1+1\nEND1\nM30"
    )
    assert read(text).machine["Z"] == 2 * 3 * 4


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("IF #1 EQ 2 GOTO 5", ("PS0114", 1, 4)),
        ("IF[#1 EQ 2]G00 X1.", ("PS0114", 1, 12)),
        ("IF[#1]GOTO 5", ("PS0114", 1, 3)),
        ("WHILE[#1 LT 2]", ("PS0114", 1, 15)),
        ("#1", ("PS0114", 1, 3)),
        ("#1=", ("PS0114", 1, 4)),
        ("##1=2", ("PS0114", 1, 2)),
        ("#1=POW[2]", ("PS0114", 1, 10)),
        ("#1=FOO[2]", ("PS0114", 1, 4)),
        ("#1=1 #2=2", ("PS0127", 1, 6)),
        ("#1=1 G00", ("PS0127", 1, 6)),
        ("#[1/2]=1", ("PS0115", 1, 1)),
        ("#40=1", ("PS0115", 1, 1)),
        ("G00 X#200", ("PS0115", 1, 6)),
        ("#0=1", ("PS0116", 1, 1)),
        ("#4001=1", ("PS0116", 1, 1)),
        ("#1=ASIN[2]", ("PS0119", 1, 4)),
        ("#1=TAN[90]", ("PS0119", 1, 4)),
        ("#1=LN[0]", ("PS0119", 1, 4)),
        ("#1=5 MOD 0", ("PS0112", 1, 6)),
        ("#1=1234567890123", ("PS0003", 1, 4)),
        ("END1", ("PS0124", 1, 1)),
        ("DO1\nDO1\nEND1\nEND1", ("PS0124", 1, 1)),
        ("DO4", ("PS0126", 1, 3)),
        ("GOTO 0", ("PS0128", 1, 6)),
        ("GOTO #1", ("PS0128", 1, 6)),
        ("GOTO 123456789", ("PS0128", 1, 6)),
        ("#3000=201(X)", ("PS0119", 1, 1)),
        ("G00 X#1 GOTO 5", ("PS0127", 1, 9)),
        ("N#1 G00", ("PS0114", 1, 2)),
        ("#1=50.3\nG#1", ("PS0010", 2, 1)),
        ("#1=1e9", ("PS0127", 1, 5)),
    ],
)
def test_refusals(alarm_in, text: str, expected: tuple[str, int, int]) -> None:
    """Each fault of a macro has its number and its place."""
    assert alarm_in(f"{text}\nM30") == expected


# G65, G66, G67


LETTERS = dict(
    zip(
        "ABCIJKDEFHMQRSTUVWXYZ",
        (1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 13, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26),
        strict=True,
    )
)


@pytest.mark.parametrize(("letter", "number"), LETTERS.items())
def test_letter_map_of_g65(read, letter: str, number: int) -> None:
    """A1 B2 C3 I4 J5 K6 D7 E8 F9 H11 M13 Q17 R18 S19 T20 U21 V22 W23 X24 Y25 Z26."""
    reading = read(f"O1\nG65 P2 {letter}7.\nM30\nO2\nG00 Z#{number}\nM99")
    assert (reading.alarm, reading.machine["Z"]) == (None, 7.0)


def test_second_argument_list_of_g65(read) -> None:
    """A B C, then I J K up to ten times; of two for one variable the later one holds."""
    triples = " ".join(f"I{3 * n}. J{3 * n + 1}. K{3 * n + 2}." for n in range(10))
    expected = [-1, -2, -3, *range(30)]
    checks = "\n".join(f"#{500 + n}=#{n}" for n in range(1, 34))
    shown = "\n".join(f"G00 Z#{500 + n}" for n in range(1, 34))
    reading = read(f"O1\nG65 P2 A-1. B-2. C-3. {triples}\n{shown}\nM30\nO2\n{checks}\nM99")
    assert [move.absolute[1] for move in reading.of(Move)] == expected
    assert read("O1\nG65 P2 I1. I4. D5.\nM30\nO2\nG00 Z#7\nM99").machine["Z"] == 5.0
    assert read("O1\nG65 P2 " + "I1. " * 11 + "\nM30\nO2\nM99").alarm.number == "PS0129"


def test_locals_belong_to_their_level(read) -> None:
    """A macro has its own #1-#33, a subprogram those of its caller; #100 and #500 belong to all."""
    text = (
        "O1\n#1=1\n#100=1\nG65 P2 A5. L2\nM98 P3\nG00 X#1 Z#100\nM30\n"
        "O2\n#100=#100+#1\n#1=99\nM99\nO3\n#1=#1+1\nM99"
    )
    reading = read(text)
    assert (reading.absolute["X"], reading.absolute["Z"]) == (2.0, 11.0)


def test_modal_call(read) -> None:
    """G66 calls its macro behind every block with motion, until G67; not for its own moves."""
    text = "O1\nG66 P2 A2. L2\nG00 Z10.\nM08\nG00 Z20.\nG67\nG00 Z30.\nM30\nO2\nG00 U-#1\nM99"
    reading = read(text)
    assert [line for line, command in reading.steps if isinstance(command, Move)] == [3, 10, 10, 5, 10, 10, 7]
    assert reading.absolute["X"] == -8.0
    assert read("O1\nG66 P2\nG66 P2\nM30\nO2\nM99").alarm.number == "HT9012"


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("G65", ("PS0076", 2, 1)),
        ("G65 P9", ("PS0076", 2, 5)),
        ("G65 P2 G01", ("PS0129", 2, 8)),
        ("G65 P2 N5", ("PS0129", 2, 8)),
        ("G00 G65 P2", ("PS0129", 2, 1)),
        ("G01 G65 P2", ("PS0129", 2, 1)),
        ("G65 P2 L0", ("HT9012", 2, 8)),
        ("G65 P2 P3", ("PS5074", 2, 8)),
    ],
)
def test_calls_refused(alarm_in, call: str, expected: tuple[str, int, int]) -> None:
    assert alarm_in(f"O1\n{call}\nM30\nO2\nM99") == expected


def test_nesting_limits(alarm_in) -> None:
    """Ten levels of M98 (PS0077), five of G65 (PS0122)."""
    chain = "".join(f"O{n}\n{{}} P{n + 1}\nM99\n" for n in range(2, 14))
    assert alarm_in("O1\nM98 P2\nM30\n" + chain.format(*["M98"] * 12)) == ("PS0077", 32, 5)
    assert alarm_in("O1\nG65 P2\nM30\n" + chain.format(*["G65"] * 12)) == ("PS0122", 17, 5)


# System variables


def test_user_alarm(read) -> None:
    """#3000 = n: alarm MC3000 + n of the user's class, with the words of the comment."""
    alarm = read("G81 T20\n#3000=12(NO BLANK)\nM30").alarm
    assert (alarm.number, alarm.found, alarm.kind) == ("MC3012", "NO BLANK", AlarmClass.USER)
    assert str(alarm).startswith("program.nc:2:1: error[MC3012]: USER ALARM: found NO BLANK; valid: ")


def test_stop_with_message(read, run) -> None:
    """#3006 = 1 stops with the words of its comment; without an operator that is a warning."""
    reading = read("#3006=1(TURN THE PART)\nM30")
    assert [stop.message for stop in reading.of(ProgramStop)] == ["TURN THE PART"]
    warnings = run("#3006=1(TURN THE PART)\nM30").warnings
    assert [(w.number, w.found) for w in warnings] == [("HT9114", "TURN THE PART")]


def test_timers(read) -> None:
    """#3001 counts milliseconds, #3002 hours; both can be set."""
    assert read("G04 X2.5\nG00 Z[#3001/1000]\nM30").machine["Z"] == 2.5
    assert read("G04 X2.\n#3001=500\nG04 X1.\nG00 Z[#3001/1000]\nM30").machine["Z"] == 1.5
    assert read("G04 X36000.\nG00 Z#3002\nM30").machine["Z"] == 10.0


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (4001, 1),
        (4002, 97),
        (4004, 23),
        (4005, 99),
        (4006, 21),
        (4007, 40),
        (4010, 80),
        (4012, 67),
        (4014, 55),
        (4015, 64),
        (4016, 18),
        (4020, 50.2),
        (4109, 0.25),
        (4113, 8),
        (4114, 70),
        (4115, 7),
        (4119, 900),
        (4120, 203),
    ],
)
def test_modal_variables(read, number: int, expected: float) -> None:
    """#4001 ff. the modal codes by group, #4101 ff. the last words."""
    text = f"O7\nG01 G99 G55 S900 T0203\nM03\nN70 F0.25 M08\n#100=#{number}\nM05\nG00 G98 Z#100\nM30"
    assert read(text).of(Move)[-1].absolute[1] == pytest.approx(expected, abs=1e-9)


def test_positions(read) -> None:
    """#5001 end of block, #5021 machine, #5041 present, #5061 skip, #5081 tool offset: X in diameter."""
    offsets = Offsets(work={"G54": {"X": -100.0, "Z": -50.0}}, tool={2: {"X": 6.0, "Z": 1.0}})
    text = "T0202\nG00 X30. Z-5.\n{}\nG53 X0 Z0\nG50 X0 Z0\nG00 X#100 Z#101\nM30"
    for base, x, z in ((5000, 30, -5), (5040, 30, -5), (5020, 30 - 100 + 6, -5 - 50 + 1), (5080, 6, 1)):
        reading = read(text.format(f"#100=#{base + 1}\n#101=#{base + 2}"), offsets=offsets)
        assert reading.stations[-1] == (x, z)
    reading = read("G31 Z-7. F100\n#100=#5062\nG00 Z0\nG00 Z[#100*2]\nM30")
    assert reading.machine["Z"] == -14.0
    assert read("#100=#5061\nIF[#100 EQ #0]GOTO5\nG00 Z1.\nN5 M30").machine["Z"] == 0.0


def test_positions_in_inches(read) -> None:
    """Under G20 a system variable counts inches."""
    assert read("G00 X50.8 Z-25.4\nG20\n#100=#5041\n#101=#5042\nG00 X[#100+1] Z#101\nM30").machine == {
        "X": pytest.approx(76.2),
        "Z": pytest.approx(-25.4),
        "Y": 0.0,
        "C": 0.0,
    }


def test_offsets_as_variables(read) -> None:
    """#2001 wear X, #2101 wear Z, #2701 and #2801 geometry, #5221 ff. work offsets; all can be written."""
    offsets = Offsets(tool={3: {"X": 4.0}})
    text = "#2003=0.5\n#2103=-1.\n#2803=3.\nT0303\nG00 X#2703 Z[#2003+#2103]\nM30"
    reading = read(text, offsets=offsets)
    assert (reading.absolute["X"], reading.absolute["Z"]) == (4.0, -0.5)
    assert reading.machine["X"] == pytest.approx(4.0 + 4.5)
    assert reading.machine["Z"] == pytest.approx(-0.5 + 2.0)
    reading = read("#5222=-30.\nG00 Z5.\n#5242=7.\nG55 Z5.\nM30")
    assert [shift.shift for shift in reading.of(ShiftCoordinates)] == [{1: -30.0}, {1: 37.0}]
    assert reading.machine["Z"] == 12.0


# What has no end


@pytest.mark.parametrize(
    "text",
    [
        "N1 G00 Z1.\nGOTO 1",
        "O1\nN1 M98 P2\nM30\nO2\nM99 P1",
        "DO1\nG00 Z1.\nEND1\nM30",
        "#1=1\nWHILE[#1 EQ 1]DO1\nG04 X1.\nEND1\nM30",
        "G00 Z1.\nM99",
        "N5 GOTO5",
    ],
)
def test_loops_without_end_are_said(alarm_in, text: str) -> None:
    """A jump back that finds everything as it was will not end (HT9011)."""
    assert alarm_in(text)[0] == "HT9011"


def test_loops_that_something_ends_are_not(read) -> None:
    assert read("N1 G00 W-1.\nIF[#5042 GT -4]GOTO1\nM30").machine["Z"] == -4.0
    text = "#500=#500+1\nIF[#500 GE 3]GOTO9\nG00 W1.\nM99\nN9 M30"
    assert read(text).machine["Z"] == 2.0


def test_repetitions_are_bounded(alarm_in, monkeypatch) -> None:
    """200 000 jumps back or repeated calls, moving or not, are HT9015 (here 10²)."""
    import controller.language.flow

    assert controller.language.flow.MOST_REPETITIONS == 200_000
    monkeypatch.setattr(controller.language.flow, "MOST_REPETITIONS", 100)
    assert alarm_in("O1\nM98 P2 L99999999\nM30\nO2\nG00 U1.\nU-1.\nM99")[0] == "HT9015"
    assert alarm_in("WHILE[1 EQ 1]DO1\n#1=#1+1\nG00 Z1.\nEND1\nM30")[0] == "HT9015"
    assert alarm_in("O1\nG65 P2 L5000\nM30\nO2\nG00 Z1.\nM99")[0] == "HT9015"


def test_steps_without_motion_name_their_line(alarm_in, monkeypatch) -> None:
    """Rulings, section 1: 10⁶ steps without motion end in an alarm that names the line (here 10²)."""
    import controller.language.interpreter

    monkeypatch.setattr(controller.language.interpreter, "LONGEST_STANDSTILL", 100)
    number, line, _ = alarm_in("#1=0\nN1 #1=#1+1\nGOTO1\nM30")
    assert (number, line in (2, 3)) == ("HT9006", True)


def test_deep_or_long_expressions_are_alarms(alarm_in) -> None:
    for text, number in (
        ("#1=" + "[" * 900, "PS0118"),
        ("#1=" + "#[" * 600, "PS0118"),
        ("#1=" + "-" * 1900 + "1\nG00 Z#1", None),
        ("#1=" + "+1" * 900, None),
        ("#1=" + "SIN[" * 400, "PS0118"),
        ("#1=" + "9" * 1900, "PS0003"),
        ("G00 X" + "9" * 400, "PS0003"),
        ("#" + "9" * 400 + "=1", "PS0003"),
        ("IF[" * 300, "PS0114"),
    ):
        found = alarm_in(f"{text}\nM30")
        assert (found and found[0]) == number


def test_huge_values_are_alarms(alarm_in) -> None:
    assert alarm_in("#1=10\nWHILE[#1 GT 0]DO1\n#1=#1*#1\nEND1\nM30")[0] == "PS0111"
    assert alarm_in("#1=EXP[600]\nG00 Z#1\nM30") == ("PS5007", 2, 5)
    assert alarm_in("#1=EXP[600]\nG#1\nM30") == ("PS0010", 2, 1)
