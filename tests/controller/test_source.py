import codecs
from pathlib import Path

import pytest

from controller.language.source import load_program, parse_program
from controller.tables.alarms import AlarmError


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "gbk"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_text_in_any_usual_form(tmp_path: Path, encoding: str, end: str) -> None:
    """Rulings, section 1: LF or CRLF, UTF-8 or GBK."""
    lines = ["%", "O0001 (滚齿)", "G00 X10.；快速", "M30", "%"]
    path = tmp_path / "a.nc"
    path.write_bytes(end.join(lines).encode(encoding))
    program = load_program(path)
    assert program.lines == lines[:4]
    assert program.starts == {1: 1}


@pytest.mark.parametrize(
    ("data", "number", "line", "column"),
    [
        (b"G00 X1\nG00 \x00X2", "HT9000", 2, 5),
        (b"\x7fELF\x02\x01\x01\x00", "HT9000", 1, 5),
        (b"\xff\xff\xff", "HT9000", None, None),
        (b"G01 X" + b"1" * 5000, "HT9000", 1, 2001),
        (b"", "HT9001", 1, 1),
        (b"%\n(only a comment)\n;\n%\n", "HT9001", 1, 1),
        (codecs.BOM_UTF8, "HT9001", 1, 1),
        (b"O1\nM99\nO1\nM30", "HT9012", 3, 1),
    ],
)
def test_what_is_no_program(
    tmp_path: Path, data: bytes, number: str, line: int | None, column: int | None
) -> None:
    path = tmp_path / "junk.nc"
    path.write_bytes(data)
    with pytest.raises(AlarmError) as caught:
        load_program(path)
    span = caught.value.alarm.span
    assert span is not None
    assert (caught.value.alarm.number, span.line, span.column) == (number, line, column)


def test_missing_file_and_empty_folder_are_named(tmp_path: Path) -> None:
    for path, number in ((tmp_path / "none.nc", "HT9000"), (tmp_path, "HT9001"), (Path("a\0b"), "HT9000")):
        with pytest.raises(AlarmError, match=rf"error\[{number}\]") as caught:
            load_program(path)
        assert str(path) in str(caught.value)


def test_programs_and_sequence_numbers() -> None:
    program = parse_program("O1\nN10 G00\nM98 P2\nM30\nO2 (O3)\n(O4)\n/N20 M99\n%\n\nrest")
    assert program.starts == {1: 0, 2: 4}
    assert program.end_of(0) == 4
    assert program.end_of(4) == 7
    assert program.sequence(20, 4) == 6
    assert program.sequence(20, 0) is None
    assert program.after_tape == 10
