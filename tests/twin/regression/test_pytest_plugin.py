"""pytest run in pytest on folders of jobs."""

import subprocess
import sys
from pathlib import Path

import pytest

import twin.run  # noqa: F401 - numpy cannot be loaded anew for each inner run

pytest_plugins = ["pytester"]

JOB = """\
[work]
diameter_mm = 15.0
length_mm = 4.0
clamping = "chuck"
[tool]
kind = "polygon_head"
inserts = 2
tip_radius_mm = 40.0
[program]
file = "program.nc"
[nominal]
kind = "polygon"
number_of_sides = 4
across_flats_mm = 10.0
{expect}
"""
PROGRAM = """\
%
O0001
G28 U0 W0
G28 H0 V0
G54 G00 X20. Z3.
G51.2 P2 Q4
S300
G99 G01 X10. F1.
G01 Z-6. F1.
G01 X20. F2.
S0
{end}
M30
%
"""


@pytest.fixture
def suite(pytester, monkeypatch):
    """Write jobs, run pytest on them with the plugin of this tree, whatever is installed."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")

    def write(name, expect, end="G50.2"):
        folder = pytester.path / "jobs" / name
        folder.mkdir(parents=True)
        (folder / "job.toml").write_text(JOB.format(expect=expect))
        (folder / "program.nc").write_text(PROGRAM.format(end=end))

    def run(*options):
        return pytester.runpytest_inprocess("-p", "twin.regression.plugin", "jobs", *options)

    run.write = write
    return run


QUICK = ("--hobtwin-ideal", "--hobtwin-cell-mm", "0.5")


def test_jobs_pass_and_fail_by_their_expectations(suite):
    """A square of 10 mm: one job expects it, one a hexagon, one an alarm that comes; one expects nothing."""
    suite.write("square", '[expect]\nnumber_of_sides = 4\nverdict = "in"\nalarms = []')
    suite.write("hexagon", "[expect]\nnumber_of_sides = 6\nacross_flats_mm = {value = 10.5, tolerance = 0.1}")
    suite.write("alarming", '[expect]\nnumber_of_sides = 4\nalarms = ["PS0010"]', end="G999")
    suite.write("quiet", "")
    result = suite(*QUICK, "--hobtwin-out", "kept")
    result.assert_outcomes(passed=2, failed=1)
    lines = "\n".join(result.outlines)
    assert "2 of 2 in [expect] of" in lines
    result.stdout.re_match_lines(
        [
            r"  key +expected +got +off by",
            r"  number_of_sides +6 +4 +-2",
            r"  across_flats_mm +10.4 to 10.6 +(10\.0|9\.9)\d* +-0\.\d+",
        ]
    )
    assert "Traceback" not in lines
    kept = Path("kept")
    assert sorted(path.name for path in kept.iterdir()) == ["alarming", "hexagon", "square"]
    assert (kept / "square" / "report.html").is_file()


def test_jobs_are_deselected_by_name(suite):
    for name in ("one", "two"):
        suite.write(name, "[expect]\nnumber_of_sides = 4")
    result = suite("--collect-only", "-q", "-k", "not two")
    assert "jobs/one/job.toml::one" in result.outlines
    assert not any("two" in line.split("::")[-1] for line in result.outlines if "::" in line)


def test_a_job_that_cannot_be_read_fails_with_its_line(suite):
    suite.write("typo", "[expect]\nnumber_of_side = 4")
    suite.write("broken", "[expect\n")
    result = suite()
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(
        ["*typo*job.toml:16: error: unknown key 'number_of_side' in *number_of_sides*"]
    )
    result.stdout.fnmatch_lines(["*broken*job.toml:15:*: error: not TOML*"])
    assert "Traceback" not in "\n".join(result.outlines)


def test_the_plugin_loads_nothing_heavy():
    """Every pytest in the environment loads it."""
    code = (
        "import sys, twin.regression.plugin\n"
        "heavy = {'numpy', 'scipy', 'mujoco', 'manifold3d', 'trimesh', 'msgspec'} & set(sys.modules)\n"
        "sys.exit(', '.join(sorted(heavy)) or 0)"
    )
    found = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[3],
    )
    assert (found.returncode, found.stderr) == (0, "")


def test_other_files_are_left_alone(suite, pytester):
    """A job.toml of somebody else, and none at all."""
    (pytester.path / "jobs" / "other").mkdir(parents=True)
    (pytester.path / "jobs" / "other" / "job.toml").write_bytes(b"\xff\xfe nothing of ours")
    (pytester.path / "jobs" / "test_it.py").write_text("def test_it():\n    pass\n")
    suite().assert_outcomes(passed=1)
