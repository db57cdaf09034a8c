"""The short lane gives what the general way gives: the same commands, modal state, warnings and alarms."""

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from controller.language.interpreter import Interpreter
from controller.language.plain_lane import PlainLane

NUMBER = st.sampled_from(
    [
        "1",
        "-12.5",
        "+3.",
        ".25",
        "-.5",
        "0",
        "-0",
        "12345.678",
        "99999.999",
        "100000",
        "1.2345",
        "5.-",
        "1.2.3",
    ]
)
AXIS = st.tuples(st.sampled_from("XZUWYCVHB"), NUMBER).map("".join)
PLAIN = st.sampled_from("XUZW")
WORD = st.one_of(
    st.tuples(PLAIN, NUMBER).map("".join),
    AXIS,
    st.sampled_from(
        ["G00", "G01", "G0", "G1", "g01", "G001", "G54", "G99", "G98", "G20", "G21", "M03 S100", "M05"]
    ),
    st.tuples(st.just("F"), st.sampled_from(["100", "250.", "0.125", "0", "1234567.", "-5.", ".2"])).map(
        "".join
    ),
    st.sampled_from(
        ["N10", "N123456789", "/", "/2", "(c)", "; rest", "；x", "G04 P5", "#1", "T0101", "G81 T20", "G80"]
    ),
)
BLOCK = st.tuples(
    st.sampled_from(["", "N10 ", "N20"]),
    st.sampled_from(["", "G00 ", "G01", "G1 "]),
    st.sampled_from(["", "X10.5 ", "X-3", "U.5", "x4."]),
    st.sampled_from(["", " Z-2.", "W-1.25", "Z+100.001\t"]),
    st.sampled_from(["", " F100", "F0.125", "F250. ", "F0"]),
    st.sampled_from(["", ";", " ; (", "(c)"]),
).map("".join)
ARC = st.tuples(
    st.sampled_from(["G02", "G3", "G03 ", ""]),
    st.permutations(["U4.", "W-2."]).map("".join),
    st.sampled_from(
        ["R2.", "R-2.5", "R1.9", "I2.K0", "K-2.", "I2. R2.", "I0 K-1.995", "J1", "", "R0", "I1.5"]
    ),
    st.sampled_from(["", "F100.", "F-1", "X1.", "Y2.", "(arc)", "G18", "G17"]),
).map(" ".join)
MIXED = st.permutations(["G01", "X5.", "W-1.", "F80.", "(c)"]).flatmap(
    lambda words: st.integers(0, 5).map(lambda n: " ".join(words[:n]))
)
PROGRAM = st.lists(
    BLOCK | MIXED | ARC | st.lists(WORD, max_size=4).map(" ".join), min_size=1, max_size=12
).map("\n".join)


def outcome(read, monkeypatch: pytest.MonkeyPatch, text: str, setup: str, dpi: int, *, lane: bool) -> tuple:
    with monkeypatch.context() as patch:
        if not lane:
            patch.setattr(PlainLane, "read", lambda self, line, shown: None)
        reading = read(f"{text}\nM30", setup, parameters={"3401#0": dpi}, signals={"BDT2": True})
    assert isinstance(reading.interpreter, Interpreter)
    return (reading.steps, reading.warnings, reading.alarm, reading.machine, reading.interpreter.modal)


@settings(max_examples=400, deadline=None)
@given(text=PROGRAM, setup=st.sampled_from(["hobbing", "tilted"]), dpi=st.sampled_from([0, 1]))
@example(text="G99 M03 S100\nG01 X1. F0.2\nG98\nX2.", setup="hobbing", dpi=1)
@example(text="G20 F10\nG21 G01 X1.\nX2. F5", setup="hobbing", dpi=1)
@example(text="G01\nX5. F100\nX6\nG0X7\nX8\nG1X9", setup="hobbing", dpi=1)
@example(text="G18 G01 F100.\nG02 U4. W-2. R2.\nG03 W-2.U4.K-2.\nX5.Z1. R90.\nG1 X1.", setup="tilted", dpi=0)
@example(
    text="G99 M03 S100\nG02 F.5 U4. W-2. I2.\nM05\nU4. W-2. I2.\n(c)\nN5\nG00 Z5 X1", setup="hobbing", dpi=1
)
@example(text="G02 U4. W-2. R2. F50\nX9. Z9.\nG01 X1 R2.", setup="hobbing", dpi=1)
@example(text="G01 X1. F100\nF200\nX2.\nF0\nX3.", setup="hobbing", dpi=0)
def test_both_ways_agree(read, text: str, setup: str, dpi: int) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        short = outcome(read, monkeypatch, text, setup, dpi, lane=True)
        general = outcome(read, monkeypatch, text, setup, dpi, lane=False)
    assert short == general


def test_the_lane_is_taken(read, monkeypatch) -> None:
    """Plain blocks never reach the lexer."""
    from controller.language import syntax

    seen: list[str] = []
    lex = syntax.lex
    monkeypatch.setattr(syntax, "lex", lambda line, *rest: seen.append(line) or lex(line, *rest))
    read("G98 F100\nN10 G01 X10.123 Z-5.2 F100.\nN20 G00 X5. Z1.\nX4.\nM30")
    assert seen == ["G98 F100", "M30"]
    seen.clear()
    read("F100\nG1 F50. X 10. (c) Z-5.\nN20 G02 U4. W-2. R2.\nW-2. U4. I2.\n(a comment)\n\nN7\nM30")
    assert seen == ["F100", "M30"]
