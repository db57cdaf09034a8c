"""`hobtwin new` as a user meets it."""

import pytest

from twin.cli import main


@pytest.mark.parametrize(
    "part",
    [
        ("gear", "--module", "2", "--teeth", "31", "--helix", "12"),
        ("polygon", "--sides", "8", "--across-flats", "22"),
    ],
)
def test_a_draft_checks_clean(part, tmp_path, capsys):
    folder = tmp_path / "draft"
    assert main(["new", *part, "--out", str(folder)]) == 0
    assert f"next: hobtwin run {folder}" in capsys.readouterr().out
    assert sorted(path.name for path in folder.iterdir()) == ["job.toml", "program.nc"]
    assert main(["check", str(folder), "--strict"]) == 0


def test_a_folder_with_something_in_it_is_left_alone(tmp_path, capsys):
    (tmp_path / "mine.txt").write_text("kept")
    assert main(["new", "gear", "--module", "2", "--teeth", "20", "--out", str(tmp_path)]) == 2
    assert "not an empty folder: nothing was written" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_a_folder_that_cannot_be_made(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    code = main(
        ["new", "polygon", "--sides", "6", "--across-flats", "17", "--out", str(tmp_path / "file" / "x")]
    )
    assert code == 2
    assert capsys.readouterr().err.count("\n") == 1
