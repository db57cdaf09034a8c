"""Bad input: one clear line with its place, the exit code of the contract, nothing written."""

import shutil
from pathlib import Path

import pytest

from twin.cli import main

SCENE = Path(__file__).parents[2] / "scenes" / "hexagon_af17"


@pytest.fixture
def job(tmp_path):
    folder = tmp_path / "job"
    shutil.copytree(SCENE, folder)
    return folder


def run(job, capsys, *options):
    out = job.parent / "result"
    code = main(["run", str(job), "--out", str(out), "--quiet", "--ideal", *options])
    said = capsys.readouterr().err.strip()
    assert "Traceback" not in said
    return code, said, out


def edit(job, old, new, name="job.toml"):
    path = job / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("diameter_mm = 20.0", "diametre_mm = 20.0", 7, ["unknown key 'diametre_mm'", "valid: diameter_mm"]),
        ("diameter_mm = 20.0", "diameter_mm = -20.0", 7, ["work.diameter_mm", "> 0"]),
        ("diameter_mm = 20.0", 'diameter_mm = "20"', 7, ["work.diameter_mm", "float"]),
        ("diameter_mm = 20.0", "diameter_mm = nan", 7, ["finite"]),
        ("diameter_mm = 20.0", "diameter_mm = 20.0\nbore_mm = 20.0", 8, ["bore_mm"]),
        ('kind = "polygon_head"', 'kind = "laser"', 12, ["unknown kind 'laser'", "hob, polygon_head"]),
        ("inserts = 3", "inserts = 0", 13, ["tool.inserts"]),
        ('file = "program.nc"', 'file = "other.nc"', 18, ["other.nc"]),
        ('setup = "hobbing"', 'setup = "milling"', 4, ["machine.setup", "milling"]),
        ("number_of_sides = 6", "number_of_sides = 2", 22, ["at least 3 sides"]),
        ("[work]", "[work", 6, ["not TOML"]),
    ],
)
def test_a_job_that_cannot_be_is_refused_with_its_line(job, capsys, old, new, line, words):
    edit(job, old, new)
    code, said, out = run(job, capsys)
    assert code == 2
    assert said.count("\n") == 0
    assert f"job.toml:{line}" in said
    for word in words:
        assert word in said
    assert not out.exists()


@pytest.mark.parametrize("table", ["machine.parameters", "machine.signals", "setup.offsets.G99"])
def test_controller_settings_that_do_not_exist_are_refused(job, capsys, table):
    with (job / "job.toml").open("a", encoding="utf-8") as file:
        file.write(f'\n[{table}]\n"NONSENSE" = 1\n')
    code, said, out = run(job, capsys)
    assert code == 2
    assert said.count("\n") == 0
    assert not out.exists()


def test_a_missing_job_is_said(tmp_path, capsys):
    assert main(["run", str(tmp_path / "nothing")]) == 2
    assert "nothing" in capsys.readouterr().err


@pytest.mark.parametrize("content", [b"", b"%\n%\n", bytes(range(256)) * 4, b"\xff\xfe\x00\x01"])
def test_a_program_that_is_none_is_unreadable_input(job, capsys, content):
    (job / "program.nc").write_bytes(content)
    code, said, out = run(job, capsys)
    assert code == 2
    assert "program.nc" in said
    assert said.count("\n") == 0
    assert not out.exists()


def test_an_unknown_code_is_an_alarm_at_its_place(job, capsys):
    edit(job, "N0025 G54 G00", "N0025 G54 G999", name="program.nc")
    code, _, out = run(job, capsys)
    assert code == 1
    assert '"PS0010"' in (out / "alarms.json").read_text(encoding="utf-8")
    assert '"line": 5' in (out / "alarms.json").read_text(encoding="utf-8")


def test_a_folder_that_is_not_ours_is_left_alone(job, capsys):
    precious = job.parent / "result"
    precious.mkdir()
    (precious / "thesis.txt").write_text("do not lose me")
    code, said, out = run(job, capsys)
    assert code == 2
    assert "provenance.json" in said
    assert [p.name for p in out.iterdir()] == ["thesis.txt"]


def test_an_earlier_result_is_replaced_whole(job, capsys):
    out = job.parent / "result"
    out.mkdir()
    (out / "provenance.json").write_text("{}")
    (out / "stale.txt").write_text("old")
    code, _, _ = run(job, capsys, "--cell-mm", "0.4")
    assert code == 0
    assert not (out / "stale.txt").exists()
    assert (out / "report.html").is_file()
    assert not [p for p in job.parent.iterdir() if p.name.startswith(".result")]


def test_cell_sizes_that_make_no_sense_are_refused(job, capsys):
    for value in ("0", "-1", "nan"):
        assert main(["run", str(job), "--cell-mm", value]) == 2
        assert "--cell-mm" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ('model = "hobbing_lathe"', 'model = "../models"', 3, ["unknown machine model", "hobbing_lathe"]),
        ('clamping = "chuck"', 'clamping = "magnet"', 9, ["magnet", "arbor, chuck"]),
        ('clamping = "chuck"', "stick_out_mm = 1.0", 9, ["reach into the chuck"]),
        ("across_flats_mm = 17.0", "across_flats_mm = -1.0", 23, ["above 0"]),
    ],
)
def test_check_and_run_refuse_the_same_jobs(job, capsys, old, new, line, words):
    edit(job, old, new)
    code, said, _ = run(job, capsys)
    assert (code, main(["check", str(job)])) == (2, 2)
    assert said == capsys.readouterr().err.strip()
    assert f"job.toml:{line}" in said
    for word in words:
        assert word in said


def test_what_the_controller_refuses_has_its_line_in_the_job(job, capsys):
    edit(job, 'setup = "hobbing"', 'setup = "hobbing"\nsignals = { FOO = 1 }')
    code, said, _ = run(job, capsys)
    assert code == 2
    assert "job.toml:5" in said
    assert "NOZAGC" in said
