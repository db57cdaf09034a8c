"""Stiffness of the mounts: the machine's, the job's in its place, and what a free arbor would have."""

import pytest
from polygon_job import HEAD, JOB, PROGRAM

from twin.errors import InputError
from twin.job import read_job
from twin.load.stiffness import Stiffness, beam, stiffness_of
from twin.presets import cutters_of
from twin.setup import make_ready


def stiffness(folder, *, physics="", work="", extra="") -> Stiffness:
    (folder / "program.nc").write_text(PROGRAM.format(x=18.0), encoding="utf-8")
    text = JOB.format(
        material="C45", tool="polygon_head", size=HEAD, physics=f"cutting_load = true\n{physics}"
    )
    text = text.replace('clamping = "chuck"', work or 'clamping = "chuck"') + extra
    (folder / "job.toml").write_text(text, encoding="utf-8")
    job = read_job(folder)
    return stiffness_of(job, make_ready(job, cutters_of(job)))


def test_a_free_beam_by_hand():
    """3 E I / L³: I = π 21⁴/64 = 9546.6 mm⁴, and 210 000 N/mm² over 100 mm."""
    assert beam(21.0, 100.0) == pytest.approx(3 * 210e3 * 9546.6 / 1e6 / 1e3, rel=1e-4)
    assert beam(42.0, 200.0) == pytest.approx(2.0 * beam(21.0, 100.0))


def test_the_machine_s_figures_stand_where_the_job_says_nothing(tmp_path):
    """And a bar of 20 mm, 60 mm out of the chuck, is told to be softer: 3 E π 20⁴/64 / 60³ = 22.9 N/µm."""
    found = stiffness(tmp_path, work='clamping = "chuck"\nstick_out_mm = 60.0')
    assert (found.tool, found.work) == (100.0, 60.0)
    assert found.compliance_um_per_n == pytest.approx(1 / 100 + 1 / 60)
    assert found.free == pytest.approx(22.907, rel=1e-4)
    assert "would have 23 N/µm" in found.words()


def test_an_arbor_is_as_thick_as_the_job_says(tmp_path):
    found = stiffness(tmp_path, work="arbor_diameter_mm = 10.0\nstick_out_mm = 60.0")
    assert found.free == pytest.approx(22.907 / 16.0, rel=1e-4)


@pytest.mark.parametrize(
    ("physics", "work", "extra", "tool", "stands"),
    [
        ("tool_stiffness_n_per_um = 50.0\nwork_stiffness_n_per_um = 10.0", "", "", 50.0, 10.0),
        ("", 'clamping = "chuck"\nstick_out_mm = 20.0', "", 100.0, 60.0),  # 618 N/µm: not softer
        ("", 'clamping = "chuck"\nstick_out_mm = 60.0', "\n[setup.tailstock]\n", 100.0, 60.0),
        (
            "",
            'clamping = "chuck"\nstick_out_mm = 20.0',
            "\n[machine.mounts]\ntool_stiffness = 80.0\n",
            80.0,
            60.0,
        ),
    ],
)
def test_nothing_is_said_where_the_job_has_chosen(tmp_path, physics, work, extra, tool, stands):
    found = stiffness(tmp_path, physics=physics, work=work, extra=extra)
    assert (found.tool, found.work, found.free) == (tool, stands, None)
    assert "tailstock" not in found.words()


def test_a_mount_that_cannot_be_is_refused_with_its_line(tmp_path):
    with pytest.raises(InputError, match=r"mounts: work_stiffness = -1.0 must not be negative") as refused:
        stiffness(tmp_path, extra="\n[machine.mounts]\nwork_stiffness = -1.0\n")
    assert refused.value.place
    assert refused.value.place.line
