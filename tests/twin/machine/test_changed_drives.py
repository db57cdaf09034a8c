"""What a job changes of its machine, and what it is told where it cannot."""

import re
import shutil
from pathlib import Path

import pytest

from twin.errors import InputError
from twin.job import read_job
from twin.machine import MujocoMachine
from twin.machine.spec import MODELS
from twin.presets import cutters_of
from twin.setup import Ready, make_ready

SCENE = Path(__file__).parents[3] / "scenes" / "square_af10"


def made_ready(folder: Path, more: str) -> Ready:
    """The scene with `more` at the end of its [machine] table."""
    shutil.copy(SCENE / "program.nc", folder)
    text = (SCENE / "job.toml").read_text(encoding="utf-8")
    assert "\n\n[work]" in text
    (folder / "job.toml").write_text(text.replace("\n\n[work]", f"\n{more}\n\n[work]", 1), encoding="utf-8")
    job = read_job(folder)
    return make_ready(job, cutters_of(job))


def test_a_job_changes_drives_and_periods(tmp_path: Path) -> None:
    ready = made_ready(
        tmp_path,
        "control_period_s = 0.0005\nphysics_step_s = 0.00025\n"
        "[machine.drives.x_slide]\nposition_gain = 50\nbacklash = 4.0\n"
        '[machine.drives.tool_spindle]\nkind = "variable_frequency"',
    )
    spec = ready.spec
    assert (spec.control_period_s, spec.substeps) == (0.0005, 2)
    assert (spec.drives["x_slide"].position_gain, spec.drives["x_slide"].backlash) == (50.0, 4.0)
    assert spec.drives["tool_spindle"].kind.value == "variable_frequency"
    assert spec.drives["z_slide"].position_gain == 70.0
    MujocoMachine(ready.tools[0].assembly)


@pytest.mark.parametrize(
    ("more", "line", "message"),
    [
        ("[machine.drives.x_slide]\nmotor_inertia = -1", 6, "x_slide: motor_inertia = -1.0 must not be neg"),
        (
            "[machine.drives.x_slide]\nforce_limit = 1",
            6,
            "x_slide: unknown key 'force_limit' (valid: kind, tr",
        ),
        (
            "[machine.drives.cross]\nkv = 1",
            5,
            "drives: unknown key 'cross' (valid: x_slide, z_slide, tilted_",
        ),
        ('[machine.drives.x_slide]\nkind = "steam"', 6, "unknown kind 'steam' (valid: servo, variable_freq"),
        ('[machine.drives.x_slide]\nposition_gain = "a"', 6, "position_gain = 'a': expected a finite number"),
        ("[machine.drives.x_slide]\nposition_gain = nan", 6, "position_gain = nan is not a finite number"),
        (
            '[machine.drives.z_slide]\nkind = "variable_frequency"',
            6,
            "an induction motor needs its breakdown",
        ),
        (
            '[machine.drives.z_slide]\nkind = "variable_frequency"\nbreakdown_slip = 9',
            6,
            "an induction motor drives a spindle, not a slide (valid: servo)",
        ),
        (
            "physics_step_s = 0.0003",
            5,
            "0.001 is 3.33333 physics steps of 0.0003 s (it must be a whole number",
        ),
        ("control_period_s = 0.0015", 5, "control_period_s = 0.0015 is 1.5 physics steps of 0.001 s"),
        (
            "physics_step_s = 0.0007\ncontrol_period_s = 0.0007",
            6,
            "control_period_s = 0.0007 divides a second into 1428.57 parts (a whole fraction of a second",
        ),
        ("control_period_s = 0.0", 5, "machine: control_period_s = 0: must be above 0"),
    ],
)
def test_impossible_changes_are_refused_at_their_line(
    tmp_path: Path, more: str, line: int, message: str
) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as refusal:
        made_ready(tmp_path, more)
    assert refusal.value.place
    assert (refusal.value.place.file, refusal.value.place.line) == (str(tmp_path / "job.toml"), line)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("position_gain = 9000", r"x_slide: position_gain 9000 1/s makes the loop unstable \(stable below 6"),
        ("velocity_gain = 5000", r"the velocity loop is unstable .*\(stable below 1905 1/s\)"),
        (
            "integral_time_s = 1e-7",
            r"the velocity loop is unstable .*\(lengthen integral_time_s\)",
        ),
    ],
)
def test_unstable_drives_of_a_job_are_refused_with_their_limit(
    tmp_path: Path, more: str, message: str
) -> None:
    ready = made_ready(tmp_path, f"[machine.drives.x_slide]\n{more}")
    with pytest.raises(InputError, match=message) as refusal:
        MujocoMachine(ready.tools[0].assembly)
    assert str(refusal.value).startswith(str(tmp_path / "job.toml"))


def test_a_stiff_induction_motor_is_refused_with_its_limit(tmp_path: Path) -> None:
    more = '[machine.drives.tool_spindle]\nkind = "variable_frequency"\nbreakdown_slip = {}'
    ready = made_ready(tmp_path, more.format(1.0))
    with pytest.raises(InputError, match="unstable at this control period") as refusal:
        MujocoMachine(ready.tools[0].assembly)
    found = re.search(r"stable above ([0-9.]+) 1/min", str(refusal.value))
    assert found
    MujocoMachine(made_ready(tmp_path, more.format(1.01 * float(found[1]))).tools[0].assembly)
    with pytest.raises(InputError, match="unstable"):
        MujocoMachine(made_ready(tmp_path, more.format(0.99 * float(found[1]))).tools[0].assembly)


def test_a_job_brings_its_own_model(tmp_path: Path) -> None:
    """A folder from the job's own on; the message names it where it is not there, or broken."""
    mine = "./machines/mine"
    shutil.copy(SCENE / "program.nc", tmp_path)
    text = (SCENE / "job.toml").read_text(encoding="utf-8").replace('"hobbing_lathe"', f'"{mine}"')
    (tmp_path / "job.toml").write_text(text, encoding="utf-8")
    with pytest.raises(
        InputError, match=re.escape(f"unknown machine model '{mine}' (valid: hobbing_lathe; or")
    ):
        read_job(tmp_path)
    folder = tmp_path / "machines" / "mine"
    shutil.copytree(MODELS / "hobbing_lathe", folder)
    job = read_job(tmp_path)
    assert make_ready(job, cutters_of(job)).spec.folder == folder
    xml = folder / "hobbing_lathe.xml"
    xml.write_text(xml.read_text(encoding="utf-8").replace('mass="150"', 'mass="-150"'), encoding="utf-8")
    with pytest.raises(InputError, match=r"'mine': body 'z_slide' has a mass of -150 kg"):
        make_ready(job, cutters_of(job))
