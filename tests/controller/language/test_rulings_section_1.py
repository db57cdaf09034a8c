"""Rulings, section 1, sentence by sentence, where no other test of the language names it."""

import re
from pathlib import Path

import pytest

from controller.commands import Move, ReferenceReturn, SpindleSpeed, SurfaceSpeed
from controller.language.interpreter import Interpreter
from controller.language.offsets import Offsets
from controller.language.source import parse_program
from controller.tables.alarms import ALARMS, AlarmError
from controller.tables.codes import G_CODES, Support, g_name
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered

MUST_WORK = """
G00 Z1.|G01 Z2. F9|G02 U2. W-1. R1. F9|G03 U2. W-1. R1. F9|G04 P5|G10 P1 X1.|G17|G18|G20|G21|G22|G23|G27 X0
G28 U0|G30 U0|G31 Z1. F9|M03 S9|G32 Z2. F1.|G92 X1. Z1. F1.|M05|M19|G40|G50 X1.|G52 X1.|G53 X1.|G54|G55|G56
G57|G58|G59|G65 P9|G66 P9|G67|G71 U1. R1.|G72 W1. R1.|G73 U1. W1. R2|G74 R1.|G75 R1.|G76 P010060 Q50 R.1|G80
G81 T20|G80|G90 X1. Z1. F9|G94 X1. Z1.|G00|G96 S9|G97|G98|G99|G51.2 P1 Q2|G50.2|G61|G64|G70 P1 Q1|N1 G00 X1.
""".strip().replace("\n", "|")
TEXTS = """
PS0003 TOO MANY DIGIT · 0004 INVALID BREAK POINT OF WORDS · 0005 NO DATA AFTER ADDRESS · 0006 ILLEGAL USE OF
MINUS SIGN · 0007 ILLEGAL USE OF DECIMAL POINT · 0009 IMPROPER NC-ADDRESS · 0010 IMPROPER G-CODE · 0011 FEED
ZERO (COMMAND) · 0020 OVER TOLERANCE OF RADIUS · 0022 R OR I,J,K COMMAND NOT FOUND · 0030 ILLEGAL OFFSET
NUMBER · 0046 ILLEGAL REFERENCE RETURN COMMAND · 0060 SEQUENCE NUMBER NOT FOUND · 0197 C-AXIS COMMANDED IN
SPINDLE MODE · 0217 DUPLICATE G51.2 (COMMANDS) · 0218 NOT FOUND P/Q COMMAND · 0219 COMMAND G51.2/G50.2
INDEPENDENTLY · 0220 ILLEGAL COMMAND IN SYNCHR-MODE · 0224 ZERO RETURN NOT FINISHED · 1541 S-CODE ZERO ·
1544 S-CODE OVER MAX · 1593 EGB PARAMETER SETTING ERROR · 1594 EGB FORMAT ERROR · 1595 ILL-COMMAND IN EGB
MODE · 1596 EGB OVERFLOW · 5007 TOO LARGE DISTANCE · 5016 ILLEGAL COMBINATION OF M CODES · 5018 POLYGON
SPINDLE SPEED ERROR
"""


def test_the_form_of_a_program(read) -> None:
    """`%` optional, O0000 allowed, N, /, comments, ; or ；, CRLF, several O programs in one file."""
    lines = "%|O0000 (main)|N10G00X1.(c)Z2.; Z9.|/2N20 X3.；X9.|M98P2|M30|O0002|Z4.|M99|%|"
    text = lines.replace("|", "\r\n")
    for one in (text, text.replace("\r\n", "\n"), text.replace("%\r\n", "")):
        reading = read(one)
        assert reading.alarm is None
        assert (reading.machine["X"], reading.machine["Z"]) == (3.0, 4.0)
    assert read(text, signals={"BDT2": True}).machine["X"] == 1.0
    assert read(text, signals={"BDT1": True}).machine["X"] == 3.0


def test_addresses_of_the_axes(read) -> None:
    """X Z Y C absolute, U W V H their increments; X and U in diameter by 1006#3."""
    (move,) = read("G00 X8. Z3. Y20. C30.\nM30").of(Move)
    assert move.absolute == {0: 4.0, 1: 3.0, 2: 20.0, 3: 30.0}
    (move,) = read("G00 U8. W3. V20. H30.\nM30").of(Move)
    assert move.incremental == {0: 4.0, 1: 3.0, 2: 20.0, 3: 30.0}
    (move,) = read("G00 X8. Z3.\nM30", parameters={"1006#3.X": 0}).of(Move)
    assert move.absolute == {0: 8.0, 1: 3.0}


def test_a_and_b_where_an_axis_bears_that_name(read) -> None:
    assert read("G00 B90.\nM30", "tilted").of(Move)[0].absolute == {4: 90.0}
    assert read("G00 B90.\nM30").alarm.number == "PS0009"
    assert read("G00 A90.\nM30", parameters={"1020.Y": "A"}).of(Move)[0].absolute == {2: 90.0}
    assert read("G00 A90.\nM30").alarm.number == "PS0009"


def test_f_and_s_by_their_modes(read) -> None:
    """F per minute (G98) or per revolution (G99), S rpm (G97) or m/min (G96), G50 S clamps."""
    reading = read("M03 S700\nG98 G01 Z1. F120\nG99 Z2. F0.3\nG50 S900\nG96 S80\nM30")
    feeds = [move.feed for move in reading.of(Move)]
    assert [(f.value, f.per_revolution) for f in feeds] == [(2.0, False), (0.3, True)]
    assert [s.rpm for s in reading.of(SpindleSpeed)] == [700.0]
    assert [(s.speed, s.clamp) for s in reading.of(SurfaceSpeed)] == [(80.0, 900.0)]


@pytest.mark.parametrize("block", ["G81 T20. L1", "G81 T20 L1.", "G51.2 P2. Q6", "G51.2 P2 Q6."])
def test_plain_integers(alarm_in, block: str) -> None:
    """T, L of G81 and P, Q of G51.2 are plain integers."""
    assert alarm_in(f"{block}\nM30")[0] == ("PS1594" if "G81" in block else "PS0218")


def test_expressions_count_units_whatever_dpi_says(read) -> None:
    """A number from a variable is one of units: #1 = 10 moves 10 mm also with DPI = 0."""
    reading = read("#1=10\nG00 X#1 Z[-5]\nM30", parameters={"3401#0": 0})
    assert (reading.machine["X"], reading.machine["Z"], reading.warnings) == (10.0, -5.0, [])


def test_speeds_from_expressions_are_rounded(read) -> None:
    """S is a whole number: 1000 · 120 / (3.14 · 50) = 764.3 rpm is S764."""
    reading = read("#1=50.\nM03 S[1000*120/[3.14*#1]]\nM30")
    assert [s.rpm for s in reading.of(SpindleSpeed)] == [764.0]


def test_position_decides_meaning(read) -> None:
    """In a G81 block T is teeth and L starts, not a tool and not a count; in a G51.2 block A is the lead."""
    reading = read("G81 T20 L2\nG80\nM30")
    assert reading.interpreter.modal.tool == 0
    assert reading.steps[0][1].gear.ratio == 0.1
    polygon = read("G51.2 P1 Q2 A50.\nG50.2\nM30", parameters={"1020.Y": "A"})
    assert polygon.steps[0][1].gear.axial == 1


def test_every_code_that_must_work_does(read) -> None:
    """Rulings, section 1, "G codes that must work": none of them is unknown or left out."""
    text = "\n".join(["O1", *MUST_WORK.split("|"), "M30", "O9", "M99"])
    said = set(re.findall(r"G\d\d(?:\.\d)?", MUST_WORK))
    assert said | {"G41", "G42"} >= {
        g_name(code.tenths)
        for code in G_CODES.values()
        if code.support is Support.RUNS and code.tenths not in (110, 131, 190)
    }
    assert read(text).alarm is None


@pytest.mark.parametrize(
    "code", [g for g in G_CODES.values() if g.support is Support.NEVER], ids=lambda g: g.name
)
def test_what_does_not_run_says_so(alarm_in, read, code) -> None:
    """G41, G42 and every other real code of the control raise HT9003 with another way; none runs wrongly."""
    assert alarm_in(f"G00 X1.\n{code.name} X5.\nM30") == ("HT9003", 2, 1)
    assert read(f"{code.name}\nM30").alarm.remedy == code.instead


def test_unknown_codes_name_the_nearest(read) -> None:
    """PS0010 says which codes there are beside it."""
    remedy = read("G29\nM30").alarm.remedy
    assert {"G27", "G28", "G30", "G31"} <= set(remedy.split(", "))
    assert all(
        name in {g_name(k) for k, g in G_CODES.items() if g.support is Support.RUNS}
        for name in remedy.split(", ")
    )


def test_words_without_meaning_name_the_codes_they_belong_to(read) -> None:
    """Nothing is ever ignored silently: PS0009 at the word, and where it would have meant something."""
    assert read("G04 X1. P5\nM30").alarm.remedy.startswith("a block without P; it belongs to G04, G10, G30, ")
    assert read("G28 U0 F5 A3.\nM30").alarm.remedy == "a block without A; it belongs to G51.2"


def test_the_work_spindle_out_of_sync(read) -> None:
    """M03, M04, M05 and G96 mean the work spindle; a C word then needs M19 or G28 H0 first (PS0197)."""
    reading = read("M03 S100\nM04\nM05\nM30")
    assert [(s.axis, s.rpm) for s in reading.of(SpindleSpeed)] == [(3, 100.0), (3, -100.0), (3, 0.0)]
    turned = "M03 S100\nM05\n{}G00 C90.\nM30"
    assert read(turned.format("")).alarm.number == "PS0197"
    assert read(turned.format("M19\n")).alarm is None
    assert read(turned.format("G28 H0\n")).alarm is None
    assert read("M03 S100\nM05\nM19\nM30").of(ReferenceReturn)[0].axes == (3,)


def test_an_old_form_of_subprogram_calls(read) -> None:
    """M98 P30100: three times O0100; with eight digits the first four are the count."""
    text = "O1\nM98 P{}\nM30\nO0100\nG00 W1.\nM99\nO1234\nG00 W1.\nM99"
    assert read(text.format("30100")).machine["Z"] == 3.0
    assert read(text.format("00121234")).machine["Z"] == 12.0
    assert read(text.format("1234")).machine["Z"] == 1.0
    assert read(text.format("100 L7")).machine["Z"] == 7.0


@pytest.mark.parametrize(
    "block",
    [
        "G00 G98 G21 G54 S700 T0101 X1. K9",
        "G02 X9. Z9. R1. G99 F5",
        "G10 P1 X5. Z",
        "G10 L2 P1 X5. Y9. I1",
        "#1=#2/#3",
    ],
)
def test_a_block_in_alarm_leaves_no_trace(counting_motion, block: str) -> None:
    """A block is read whole, checked whole, then committed: modal state, offsets, variables and place."""
    machine = machine_data(delivered())
    interpreter = Interpreter(
        parse_program(f"G01 G99 G20 G55 F500 S100 M03\n{block}\nM30"), machine, Offsets(), {}
    )
    motion = counting_motion(4)
    interpreter.next(motion)
    modal, offsets, cursor = interpreter.modal, interpreter.offsets, interpreter.cursor
    for _ in range(2):
        with pytest.raises(AlarmError, match=r"program\.nc:2:"):
            interpreter.next(motion)
        assert interpreter.modal is modal
        assert interpreter.offsets is offsets
        assert interpreter.cursor == cursor == 1


def test_reset_rewinds(counting_motion) -> None:
    """RESET: the program is rewound, sync and spindle off as told, other modal codes and #100 stay."""
    text = "O1\n#100=#100+1\n#1=#1+1\nG55\nG81 T20\nM98 P2\nM30\nO2\nG00 Z[#100*10+#1]\nM99"
    interpreter = Interpreter(parse_program(text), machine_data(delivered()), Offsets(), {})
    motion = counting_motion(4)
    for turn, in_sync in ((1, True), (2, False)):
        steps = [interpreter.next(motion) for _ in range(4)]
        assert steps[-1].commands[0].absolute == {1: 10.0 * turn + 1.0}
        interpreter.stopped(in_sync=in_sync)
        assert interpreter.cursor == 0
        assert (interpreter.modal.gear is not None) is in_sync
        assert interpreter.modal.codes[G_CODES[550].group] == 550
        if in_sync:
            interpreter.stopped(in_sync=False)


def test_alarm_texts() -> None:
    """Rulings, "Alarm texts": Fanuc's words under Fanuc's numbers, kept because users know them."""
    rows = re.findall(r"(?:PS)?(\d{4}) ([A-Z][^·]+)", " ".join(TEXTS.split()))
    assert len(rows) == 28
    for number, text in rows:
        assert ALARMS[f"PS{number}"].text == text.strip()


def test_places_count_characters(read, tmp_path: Path) -> None:
    """Line and column from 1, in characters: a Chinese comment counts as many columns as it has signs."""
    alarm = read("(滚齿) G00 X1. Q5\nM30").alarm
    assert (alarm.span.line, alarm.span.column) == (1, 14)


@pytest.mark.parametrize(
    ("block", "column"), [("G00 X1. O5", 9), ("G00 X1. N20", 9), ("N10 N20 X1.", 5), ("N10 O5 X1.", 5)]
)
def test_no_label_is_ignored_silently(alarm_in, block: str, column: int) -> None:
    """O and N that stand where nothing would find them: PS0009, not a block without them."""
    assert alarm_in(f"{block}\nM30") == ("PS0009", 1, column)


def test_a_label_behind_an_o_number_is_found(read) -> None:
    reading = read("O0001 N10 G00 U1.\nIF [#5001 LT 4] GOTO 10\nM30")
    assert reading.alarm is None
    assert reading.machine["X"] == 4.0
