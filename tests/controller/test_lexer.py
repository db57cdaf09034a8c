import pytest

from controller.language.lexer import lex
from controller.tables.alarms import AlarmError


def words(line: str) -> list[tuple[str, str, int]]:
    return [(word.address, word.text, word.column) for word in lex(line, "a.nc", 3)]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("N0040 S300;          刀具轴按", [("N", "0040", 1), ("S", "300", 7)]),
        ("N0120 G80 ；      解除 G81 (", [("N", "0120", 1), ("G", "80", 7)]),
        ("G01X-35.5F.2", [("G", "01", 1), ("X", "-35.5", 4), ("F", ".2", 10)]),
        ("g01 x 12.", [("G", "01", 1), ("X", "12.", 5)]),
        ("G50.2 (G81 X;) M05", [("G", "50.2", 1), ("M", "05", 16)]),
        ("/2 N1 G00 X+5", [("/", "2", 1), ("N", "1", 4), ("G", "00", 7), ("X", "+5", 11)]),
        ("X100.-5"[:5], [("X", "100.", 1)]),
        ("%", []),
        ("", []),
        ("X\t1 \u3000Z2", [("X", "1", 1), ("Z", "2", 6)]),
    ],
)
def test_words_and_columns(line: str, expected: list[tuple[str, str, int]]) -> None:
    assert words(line) == expected


@pytest.mark.parametrize(
    ("line", "number", "column"),
    [
        ("G01 X123456789", "PS0003", 5),
        ("G01 X0.12345678", "PS0003", 5),
        ("G01 X ;", "PS0005", 5),
        ("G01 X F ;", "PS0005", 5),
        ("G01 Z", "PS0005", 5),
        ("G01 X-", "PS0005", 5),
        ("G01 X--5", "PS0006", 5),
        ("G01 X5-5", "PS0006", 5),
        ("G01 X1.2.3", "PS0007", 5),
        ("G01 X.", "PS0007", 5),
        ("G01 100", "PS0004", 5),
        ("G01 X5 -3", "PS0004", 8),
        ("G01 X5 ) Z3", "PS0004", 8),
        ("G01 /X5", "PS0004", 5),
        ("G01 @", "PS0009", 5),
        ("G01 Ø5", "PS0009", 5),
        ("G01 (open", "HT9004", 5),
        ("G01 X5 #100 = 5", "PS0127", 8),
        ("G01 X[1+2", "PS0114", 10),
        ("G01 X#", "PS0114", 7),
        ("G01 X]", "PS0005", 5),
        ("G01 X5 GOTO 5", "PS0127", 8),
    ],
)
def test_faults_are_placed(line: str, number: str, column: int) -> None:
    """Rulings, section 1: an address without a number is PS0005, never skipped; PS0003-PS0009 each its
    fault."""
    with pytest.raises(AlarmError) as caught:
        lex(line, "a.nc", 3)
    alarm = caught.value.alarm
    assert alarm.span is not None
    assert (alarm.number, alarm.span.line, alarm.span.column) == (number, 3, column)
    assert str(alarm).startswith(f"a.nc:3:{column}: error[{number}]: ")


def test_eight_digits_are_allowed() -> None:
    assert words("X12345.678") == [("X", "12345.678", 1)]
