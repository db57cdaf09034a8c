"""Tools and blanks in a job.toml: what they become, and what is refused with its line."""

import math

import numpy as np
import pytest

from twin.errors import InputError
from twin.job import read_job
from twin.presets import cutters_of

JOB = """[work]
{work}
[tool]
{tool}
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = 20
normal_module_mm = 2.0
helix_angle_deg = 15.0
"""
WORK = "diameter_mm = 44.0\nlength_mm = 20.0"
HOB = 'kind = "hob"\nnormal_module_mm = 2.0\noutside_diameter_mm = 70.0'
WHEEL = 'kind = "disc_wheel"\noutside_diameter_mm = 80.0'


@pytest.fixture
def read(tmp_path):
    def reader(*, work=WORK, tool=HOB):
        (tmp_path / "program.nc").write_text("%\nO1\nM30\n%\n", encoding="utf-8")
        path = tmp_path / "job.toml"
        path.write_text(JOB.format(work=work, tool=tool), encoding="utf-8")
        return read_job(path)

    return reader


def test_helical_gashes_by_default_cross_the_thread_at_right_angles(read):
    """The lead is pi d_0 / tan gamma_0, left-hand for a right-hand hob."""
    tool = HOB + '\ngash = "helical"\nstarts = 2'
    (cutter,) = cutters_of(read(tool=tool)).values()
    gamma = math.asin(4.0 / 65.0)
    assert cutter.twist == pytest.approx(-2.0 * math.pi / (math.pi * 65.0 / math.tan(gamma)))
    (given,) = cutters_of(read(tool=tool + "\ngash_lead_mm = -3000.0")).values()
    assert given.twist == pytest.approx(-2.0 * math.pi / 3000.0)


def test_profile_of_a_hob_stands_between_tip_and_land(read):
    (cutter,) = cutters_of(read(tool=HOB + "\nprofile = [[0.3, 0, 0.5], [0.75, 0.4], [2.4, 5.0]]")).values()
    profile = cutter.profile
    assert (profile.tip, profile.root) == (35.0, 30.0)
    depth, _, _ = profile.depth(np.array([0.75, 2.4, 0.3, 3.0]), np.array([34.6, 30.0, 35.0, 29.0]))
    np.testing.assert_allclose(depth, [0.0, 0.0, 0.0, 1.0], atol=1e-12)


def test_wheel_is_set_at_the_helix_angle_unless_told(read):
    (cutter,) = cutters_of(read(tool=WHEEL + "\nnormal_module_mm = 2.0")).values()
    assert cutter.revolved
    assert math.degrees(cutter.swivel) == pytest.approx(90.0 - 15.0)
    (told,) = cutters_of(read(tool=WHEEL + "\nnormal_module_mm = 2.0\nswivel_deg = 14.0")).values()
    assert math.degrees(told.swivel) == pytest.approx(76.0)


def test_profile_of_a_blank_tells_its_size(read):
    work = read(work="profile = [[0, 40], [-1, 44], [-20, 44.0]]\nbore_mm = 12").work
    assert (work.diameter_mm, work.length_mm) == (44.0, 20.0)
    np.testing.assert_allclose(work.blank().outer_radius(np.array([-0.5, -10.0])), [21.0, 22.0])


@pytest.mark.parametrize(
    ("more", "line", "said"),
    [
        ({"tool": HOB + "\nprofile = [[0.5, 0.0], [0.4, nan]]"}, 8, "profile = nan is not a finite number"),
        ({"tool": HOB + "\nprofile = [[0.5, 0.0], [0.4, 5.0], [0.5, 4.0]]"}, 4, "runs up again from depth 5"),
        ({"tool": HOB + '\nprofile = [["x", 0.0], [0.4, 5.0]]'}, 8, "Expected `float`, got `str`"),
        ({"tool": HOB + "\ngash_lead_mm = 3000.0"}, 4, "the gashes are straight"),
        ({"tool": WHEEL}, 4, "either its profile or normal_module_mm"),
        ({"work": WORK + "\nprofile = [[0, 40], [-21, 44]]"}, 4, "length_mm 20 contradicts"),
        ({"work": "profile = [[0, 40], [-21, 44], [-20, 44]]"}, 2, "runs back from z -21 to -20"),
        ({"work": "profile = 3"}, 2, "work.profile: Expected `array | null`, got `int`"),
        ({"work": WORK + "\nbore_mm = 44.0"}, 4, "bore_mm 44 is not inside diameter_mm 44"),
        ({"work": "length_mm = 3.0"}, 1, "missing required field `diameter_mm`"),
    ],
)
def test_what_contradicts_itself_is_refused_at_its_line(read, more, line, said):
    with pytest.raises(InputError, match=said.replace("|", r"\|")) as refused:
        read(**more)
    assert refused.value.place.line == line
