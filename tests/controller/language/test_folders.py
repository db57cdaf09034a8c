"""Rulings, section 1: several O programs in a file, in files beside it, and in a folder."""

from pathlib import Path

import pytest

from controller.language import source
from controller.language.source import load_program, parse_program
from controller.tables.alarms import AlarmError


def write(folder: Path, **texts: str) -> Path:
    for name, text in texts.items():
        (folder / name.replace("_", ".")).write_text(text, encoding="utf-8")
    return folder


def test_programs_beside_the_file(read, tmp_path: Path) -> None:
    """By the first O number in a file, else by its name; found for M98, G65 and G66."""
    write(
        tmp_path,
        main_nc="O1\nM98 P20\nG65 P30 Z4.\nM98 P40\nM30",
        anything_txt="%\n(sub)\nO0020\nG00 X1.\nM99\n%",
        O0030_nc="G00 Z#26\nM99",
        O40="G00 X5.\nM99",
        notes_md="O0040 is here",
    )
    reading = read(load_program(tmp_path / "main.nc"))
    assert reading.alarm is None
    assert (reading.machine["X"], reading.machine["Z"]) == (5.0, 4.0)


def test_alarms_name_the_file_beside(read, tmp_path: Path) -> None:
    write(tmp_path, main_nc="O1\nM98 P20\nM30", sub_nc="O20\nG00 X1.\nG01 Q5\nM99")
    alarm = read(load_program(tmp_path / "main.nc")).alarm
    assert str(alarm.span) == f"{tmp_path / 'sub.nc'}:3:5"
    write(tmp_path, main_nc="O1\nM98 P21\nM30")
    alarm = read(load_program(tmp_path / "main.nc")).alarm
    assert (alarm.number, alarm.span.line) == ("PS0076", 2)


def test_the_file_itself_comes_first(read, tmp_path: Path) -> None:
    write(tmp_path, main_nc="O1\nM98 P2\nM30\nO2\nG00 X1.\nM99", O2_nc="O2\nG00 X2.\nM99")
    assert read(load_program(tmp_path / "main.nc")).machine["X"] == 1.0


def test_a_folder_as_program(read, tmp_path: Path) -> None:
    """O0001 is run, else the lowest number."""
    write(tmp_path, a_nc="O7\nG00 X7.\nM30", b_nc="O3\nM98 P7\nM30")
    assert load_program(tmp_path).file == str(tmp_path / "b.nc")
    write(tmp_path, c_nc="O1\nM98 P3\nM30")
    assert load_program(tmp_path).file == str(tmp_path / "c.nc")


def test_unreadable_neighbours_do_not_matter(read, tmp_path: Path) -> None:
    write(tmp_path, main_nc="O1\nM98 P2\nM30")
    (tmp_path / "junk.nc").write_bytes(b"\0\xff\xfe" * 1000)
    (tmp_path / "O0002.nc").write_bytes(b"O2\nG00 \0X1\nM99")
    (tmp_path / "folder.nc").mkdir()
    (tmp_path / "gone.nc").symlink_to(tmp_path / "nowhere")
    alarm = read(load_program(tmp_path / "main.nc")).alarm
    assert (alarm.number, alarm.span.file, alarm.span.line) == ("HT9000", str(tmp_path / "O0002.nc"), 2)


def test_labels_are_those_of_the_program(read) -> None:
    """The same N in two programs; of several in one the next one behind the jump, else the first."""
    text = "O1\nN1 M98 P2\nGOTO 5\nG00 X9.\nN5 M30\nO2\nN5 #1=#1+1\nIF[#1 LT 3]GOTO5\nG00 Z#1\nM99"
    reading = read(text)
    assert (reading.machine["X"], reading.machine["Z"]) == (0.0, 3.0)


def test_long_programs_take_little_room() -> None:
    """Labels are eight bytes each, lines are the text alone."""
    count = 100_000
    program = parse_program("O1\n" + "\n".join(f"N{n} G01 X1. F1." for n in range(1, count)) + "\nM30")
    assert program.sequence(count - 1, 0) == count - 1
    (labels,) = program._labels.values()
    assert labels.itemsize * len(labels) == 8 * (count - 1)


@pytest.mark.parametrize(
    ("data", "number"),
    [
        (b"O1\n" + b"X" * 3_000_000, "HT9000"),
        (b"(" * 2000 + b"\nM30", "HT9004"),
        ("G00 X１\nM30".encode("utf-16"), "HT9000"),
        (b"G00 \x85X1\nM30", "PS0009"),
        ("G00 \u2028X1\nM30".encode(), "PS0009"),
    ],
)
def test_strange_files(read, tmp_path: Path, data: bytes, number: str) -> None:
    path = tmp_path / "a.nc"
    path.write_bytes(data)
    try:
        alarm = read(load_program(path)).alarm
    except AlarmError as error:
        alarm = error.alarm
    assert alarm.number == number


def test_devices_and_large_files_end(monkeypatch, tmp_path: Path) -> None:
    """A file without end is refused at the limit (here 1 KiB, as delivered 256 MiB)."""
    assert source.LARGEST_FILE == 256 * 2**20
    monkeypatch.setattr(source, "LARGEST_FILE", 1024)
    with pytest.raises(AlarmError, match="a very large file"):
        load_program("/dev/zero")
