"""`hobtwin check` as a user meets it: forms of output, exit codes, options, and what it does not load."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from twin.cli import main

ROOT = Path(__file__).parents[3]
SCENES = ROOT / "scenes"
PROGRAMS = ROOT / "tests" / "programs"
ALARM_KEYS = {"number", "class", "text", "file", "line", "column", "found", "remedy"}
HEAVY = ("mujoco", "scipy", "manifold3d", "trimesh", "jinja2", "rich", "lxml", "networkx")


@pytest.fixture
def check(tmp_path, capsys):
    """Check a text, or a path: exit code, standard output, standard error."""

    def _check(target, *options):
        if isinstance(target, str):
            path = tmp_path / "program.nc"
            path.write_text(target, encoding="utf-8")
            target = path
        code = main(["check", str(target), *options])
        said = capsys.readouterr()
        assert "Traceback" not in said.err
        return code, said.out, said.err

    return _check


SQUARE = "O1\nG00 X80. Z5.\nG98 G01 X40. F600.\nM30\n"


def test_lengths_are_millimetres_in_inch_programs_too(check):
    """X 2 inch is 50.8 mm, and the report says so."""
    found = json.loads(check("O1\nG20 G00 X2. Z-1.\nM30\n", "--format", "json")[1])
    assert found["units"] == {"linear": "mm", "rotary": "deg"}
    assert (found["final"]["absolute"]["X"], found["final"]["absolute"]["Z"]) == (50.8, -25.4)
    assert "at the end, mm | deg" in check("O1\nG20 G00 X2. Z-1.\nM30\n")[1]


def test_json_is_one_object_with_the_keys_of_the_contract(check):
    """X 40 mm in diameter = 20 mm of slide at 600 mm/min: 2 s and the time to reach the feed."""
    code, out, err = check(SQUARE, "--format", "json")
    found = json.loads(out)
    assert (code, err) == (0, "")
    assert found["alarms"] == found["warnings"] == found["advice"] == []
    assert found["final"]["absolute"] == {"X": 40.0, "Z": 5.0, "Y": 0.0, "C": 0.0}
    assert found["final"]["machine"] == found["final"]["absolute"]
    assert found["extents"]["X"] == {"absolute": [0.0, 80.0], "machine": [0.0, 80.0]}
    lines = dict(zip(found["blocks"]["line"], found["blocks"]["duration_s"], strict=True))
    # trapezoid: s / v + v / a
    assert lines[3] == pytest.approx(20.0 / 10.0 + 10.0 / 2000.0, abs=1e-6)
    assert found["cycle_time_s"] == pytest.approx(sum(lines.values()), abs=1e-5)
    assert found["peaks"]["X"]["speed"] <= found["peaks"]["X"]["speed_limit"] == 12000.0
    assert found["sync"] == []
    assert found["in_sync_at_end"] is False
    assert found["read_on"] == 0


def test_an_alarm_has_its_eight_keys(check):
    code, out, _ = check("O1\nG01 X F100.\nM30\n", "--format", "json")
    found = json.loads(out)
    assert code == 1
    (alarm,) = found["alarms"]
    assert set(alarm) == ALARM_KEYS
    assert (alarm["number"], alarm["class"], alarm["line"], alarm["column"]) == ("PS0005", "program", 2, 5)
    assert alarm["file"].endswith("program.nc")


def test_sync_is_reported_with_its_lines(check):
    """Hobbing, 编程示例: engaged by the block of G81, released by that of G80."""
    code, out, _ = check(PROGRAMS / "ok" / "hobbing_original.nc", "--format", "json")
    found = json.loads(out)
    text = (PROGRAMS / "ok" / "hobbing_original.nc").read_text(encoding="utf-8").splitlines()
    (sync,) = found["sync"]
    assert code == 0
    assert sync["kind"] == "hobbing"
    assert "G81" in text[sync["first_line"] - 1]
    assert "G80" in text[sync["last_line"] - 1]
    assert sync["start_s"] < sync["end_s"] <= found["cycle_time_s"]
    assert found["turns"]["Y"] == pytest.approx(20.0 * found["turns"]["C"], abs=1e-5)
    assert found["peaks"]["Y"]["speed"] == pytest.approx(300.0)
    assert found["peaks"]["C"]["speed"] == pytest.approx(15.0)


def test_text_says_alarms_first_and_lines_up_its_columns(check):
    code, out, _ = check(SCENES / "hexagon_af17_original")
    lines = out.splitlines()
    assert code == 0
    assert lines[0].startswith(f"{SCENES / 'hexagon_af17_original' / 'program.nc'}:6:1: warning[HT9202]")
    head = next(k for k, line in enumerate(lines) if line.startswith("travel"))
    ends = {len(line) for line in lines[head : head + 3]}
    assert len(ends) == 1
    assert "  X               17.000  400.000" in out
    assert "polygon turning" in out
    assert lines[-1].startswith("cycle time 12.1 s; 0 alarm(s), 1 warning(s)")


def test_github_form_escapes_and_names_the_place(check):
    code, out, _ = check("O1\nG00 X1. (50%)\nG999\n", "--format", "github")
    assert code == 1
    assert out.startswith("::error file=")
    assert ",line=3,col=1::PS0010: " in out


def test_strict_makes_warnings_findings_and_notes_not(check, tmp_path):
    assert check(SCENES / "stopped_halfway")[0] == 0
    assert check(SCENES / "stopped_halfway", "--strict")[0] == 1
    folder = tmp_path / "fast"
    folder.mkdir()
    for name in ("job.toml", "program.nc"):
        text = (SCENES / "spur_m2_z20" / name).read_text(encoding="utf-8")
        (folder / name).write_text(text.replace("N0040 S300", "N0040 S1500"), encoding="utf-8")
    code, out, _ = check(folder, "--strict", "--format", "json")
    found = json.loads(out)
    assert code == 0
    assert found["warnings"] == []
    assert [one["number"] for one in found["advice"]] == ["HT9262"]


def test_advice_that_warns_stands_among_the_warnings(check):
    """Rulings, section 3: the twin compares P with the mounted tool and warns when they differ."""
    _, out, _ = check(SCENES / "wrong_hand", "--format", "json")
    found = json.loads(out)
    assert [one["number"] for one in found["warnings"]] == ["HT9222"]
    assert set(found["warnings"][0]) == ALARM_KEYS
    assert set(found["advice"][0]) == ALARM_KEYS | {"weight", "value"}


def test_keep_going_lists_what_a_line_says_by_itself(check):
    """Only alarms that no position and no modal state could excuse."""
    text = """O1
G01 X5.
G00 X1..5
G04 P10
S-300
G81 L1
G51.2 P2
G50.2 X1.
E5
R5.
G999
M77
X5. X6.
T5
#1=[2
G01 Z
M30
"""
    code, out, _ = check(text, "--keep-going", "--format", "json")
    found = json.loads(out)
    assert code == 1
    assert [(one["number"], one["line"]) for one in found["alarms"]] == [
        ("PS0011", 2),
        ("PS0007", 3),
        ("PS1594", 6),
        ("PS0218", 7),
        ("PS0219", 8),
        ("PS0009", 9),
        ("PS0010", 11),
        ("HT9009", 12),
        ("PS5074", 13),
        ("HT9010", 14),
        ("PS0005", 16),
    ]
    assert found["read_on"] == 10
    assert found["cycle_time_s"] == 0.0
    _, out, _ = check(text, "--keep-going")
    assert "behind it, read line by line, not run:" in out


def test_keep_going_finds_nothing_in_a_program_that_is_right(check):
    """Every program that runs to its end has no line that is wrong by itself."""
    from controller.language.source import load_program
    from controller.read_on import alarms_behind
    from controller.tables.parameters import delivered

    for path in sorted((PROGRAMS / "ok").glob("*.nc")):
        assert alarms_behind(load_program(path), delivered(), 0) == (), path


def test_trace_is_alone_on_standard_output(check):
    code, out, err = check("O1\nG00 X1.\nG01 X2.\n", "--trace")
    assert code == 1
    assert out == "     2  RAPID           X1.000\n     3  ALARM           PS0011\n"
    assert "error[PS0011]" in err
    code, out, err = check(SQUARE, "--trace", "--format", "json")
    assert (code, out) == (2, "")


def test_events_act_at_a_time_or_a_line(check):
    """A dwell of 2 s held for 5 s lasts 7 s; rulings, section 5."""
    text = "O1\nG04 X2.\nM30\n"
    plain = json.loads(check(text, "--format", "json")[1])["cycle_time_s"]
    held = check(text, "--event", "1.0 feed hold", "--event", "6.0 cycle start", "--format", "json")[1]
    assert json.loads(held)["cycle_time_s"] - plain == pytest.approx(5.0, abs=2e-3)
    reset = json.loads(check(SQUARE, "--event", "line 3 reset", "--format", "json")[1])
    assert reset["final"]["absolute"]["X"] == 80.0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--signal", "FOO=1"), ["--signal", "'FOO'", "NOZAGC"]),
        (("--signal", "NOZAGC=2"), ["NOZAGC=0 or NOZAGC=1"]),
        (("--signal", "NOZAGC"), ["--signal", "name=value"]),
        (("--parameter", "99999=1"), ["--parameter", "99999", "valid"]),
        (("--parameter", "1320=1"), ["--parameter", "1320.X"]),
        (("--event", "3.0 jump"), ["--event", "'jump'", "feed hold"]),
        (("--event", "feed hold"), ["--event", "3.0 feed hold"]),
        (("--event", "3.0 jog Q 5"), ["--event", "no axis Q", "X, Z, Y, C"]),
        (("--event", "line 0 reset"), ["--event"]),
    ],
)
@pytest.mark.parametrize("target", [SQUARE, SCENES / "spur_m2_z20"], ids=["program", "job"])
def test_unknown_options_name_what_would_be_valid(check, target, options, words):
    code, out, err = check(target, *options)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    for word in words:
        assert word in err


def test_a_job_whose_program_cannot_be_read_is_unusable_input(check, tmp_path):
    for name in ("job.toml", "program.nc"):
        (tmp_path / name).write_bytes((SCENES / "spur_m2_z20" / name).read_bytes())
    (tmp_path / "program.nc").write_bytes(b"\xff\xfe\x00\x01")
    code, out, err = check(tmp_path)
    assert (code, out) == (2, "")
    assert "HT9000" in err


def test_a_folder_without_job_or_program_is_named(check, tmp_path):
    folder = tmp_path / "empty"
    folder.mkdir()
    code, out, err = check(folder)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert "empty" in err
    assert "job.toml" in err


def test_events_of_a_job_are_read_and_refused_at_their_place(check, tmp_path):
    for name in ("job.toml", "program.nc"):
        (tmp_path / name).write_bytes((SCENES / "hexagon_af17" / name).read_bytes())
    job = tmp_path / "job.toml"
    text = job.read_text(encoding="utf-8")
    plain = json.loads(check(tmp_path, "--format", "json")[1])["cycle_time_s"]
    events = '\n[[events]]\ntime_s = 5.0\ndo = "feed hold"\n\n[[events]]\ntime_s = 7.0\ndo = "{}"\n'
    job.write_text(text + events.format("cycle start"), encoding="utf-8")
    code, out, _ = check(tmp_path, "--format", "json")
    assert code == 0
    # two seconds of standing, a braking and a starting ramp more
    assert json.loads(out)["cycle_time_s"] - plain == pytest.approx(2.0, abs=0.05)
    job.write_text(text + events.format("jump"), encoding="utf-8")
    line = len((text + events).splitlines())
    code, _, err = check(tmp_path)
    assert code == 2
    assert f"job.toml:{line}: error: unknown operator action 'jump'" in err


@pytest.mark.parametrize(
    ("events", "line", "words"),
    [
        ('[[events]]\ndo = "reset"\n', 1, ["time_s or its line"]),
        ('[[events]]\ntime_s = 1.0\nline = 3\ndo = "reset"\n', 1, ["time_s or its line"]),
        ('[[events]]\ntime_s = 1.0\ndo = "reset"\n[[events]]\ntime_s = -1.0\ndo = "reset"\n', 5, ["time_s"]),
        ('[[events]]\nline = 1\ndo = "reset"\n[[events]]\nline = 0\ndo = "reset"\n', 5, ["line", ">= 1"]),
        ('[[events]]\nline = 1\ndo = "reset"\nwhen = 3\n', 4, ["unknown key 'when'", "time_s"]),
        ("[[events]]\nline = 1\n", 1, ["do"]),
        ("[events]\nline = 1\n", 1, ["[[events]]"]),
    ],
)
def test_events_that_cannot_be_are_refused_with_their_line(check, tmp_path, events, line, words):
    for name in ("job.toml", "program.nc"):
        (tmp_path / name).write_bytes((SCENES / "hexagon_af17" / name).read_bytes())
    job = tmp_path / "job.toml"
    before = job.read_text(encoding="utf-8")
    job.write_text(before + events, encoding="utf-8")
    code, _, err = check(tmp_path)
    assert code == 2
    assert f"job.toml:{len(before.splitlines()) + line}:" in err
    for word in words:
        assert word in err


def _loaded(*arguments):
    """Modules that a fresh process has loaded after a check."""
    code = (
        "import sys\nfrom twin.cli import main\n"
        f"main({['check', *arguments]!r})\n"
        "print(*sorted(sys.modules), file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    return set(done.stderr.split())


def test_a_bare_program_loads_nothing_heavy():
    """Start-up under 0.3 s: the controller alone, no physics, no job reader."""
    modules = _loaded("tests/programs/ok/hobbing_original.nc", "--format", "json")
    assert "controller.dry_run" in modules
    assert not modules & {*HEAVY, "numpy", "msgspec", "twin.job", "twin.presets", "twin.advice.adviser"}


def test_a_job_loads_neither_physics_nor_meshes():
    modules = _loaded("scenes/spur_m2_z20")
    assert "twin.advice.adviser" in modules
    assert not modules & set(HEAVY)


def test_contradicting_parameters_are_an_alarm_in_json_too(check):
    """Rulings, section 4: 8211 = 0 contradicts itself in the original."""
    code, out, err = check(
        SQUARE, "--setup", "tilted", "--parameter", "8200#0=1", "--parameter", "8211=0", "--format", "json"
    )
    found = json.loads(out)
    assert (code, err) == (1, "")
    assert [one["number"] for one in found["alarms"]] == ["HT9005"]
    assert found["final"] == {"absolute": {}, "machine": {}}


@pytest.mark.parametrize(("text", "number", "code"), [("O1\nM30\nO1\n", "HT9012", 1), ("%\n", "HT9001", 2)])
def test_a_program_refused_whole_keeps_the_form_of_output(check, text, number, code):
    found, out, _ = check(text, "--format", "json")
    assert (found, [one["number"] for one in json.loads(out)["alarms"]]) == (code, [number])
    found, out, _ = check(text, "--format", "github")
    assert found == code
    assert out.startswith("::error file=")
    assert f"::{number}: " in out
