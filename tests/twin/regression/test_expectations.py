"""`[expect]`: what may stand there, how it is judged, and what is said."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.errors import InputError
from twin.inspection.inspection import inspect
from twin.inspection.keys import COMMON, GEAR, KEYS, POLYGON, figure, uncertainty
from twin.inspection.sheet import to_json
from twin.job import read_job
from twin.job.expect import Between, Expectation
from twin.regression.judge import misses, table

JOB = """\
[work]
diameter_mm = 20.0
length_mm = 10.0
[tool]
kind = "polygon_head"
inserts = 3
tip_radius_mm = 40.0
[program]
file = "program.nc"
[expect]
"""
LINE = JOB.count("\n") + 1


def expectations(tmp_path, *lines):
    (tmp_path / "program.nc").write_text("%\nM30\n%\n")
    (tmp_path / "job.toml").write_text(JOB + "\n".join(lines) + "\n")
    return read_job(tmp_path).expect


def test_every_form_is_read(tmp_path):
    found = expectations(
        tmp_path,
        "number_of_teeth = 20",
        'hand = "spur"',
        "undercut = false",
        "span_mm = {value = 15.33, tolerance = 0.005}",
        '"flanks.left.profile_total_um" = {max = 12}',
        "flanks.right.profile_total_um = {min = 1.5}",
        "root_diameter_mm = {min = 34.9, max = 35.1}",
        "accuracy_class.overall = {max = 8}",
        'alarms = ["PS1594"]',
        "warnings = []",
    )
    assert {one.key: one.wanted for one in found} == {
        "number_of_teeth": Between(low=20, high=20),
        "hand": "spur",
        "undercut": False,
        "span_mm": Between(low=15.33 - 0.005, high=15.33 + 0.005),
        "flanks.left.profile_total_um": Between(low=-math.inf, high=12.0),
        "flanks.right.profile_total_um": Between(low=1.5, high=math.inf),
        "root_diameter_mm": Between(low=34.9, high=35.1),
        "accuracy_class.overall": Between(low=-math.inf, high=8.0),
        "alarms": ("PS1594",),
        "warnings": (),
    }


def test_a_job_without_the_table_expects_nothing(tmp_path):
    (tmp_path / "program.nc").write_text("%\nM30\n%\n")
    (tmp_path / "job.toml").write_text(JOB.replace("[expect]\n", ""))
    assert read_job(tmp_path).expect == ()


@pytest.mark.parametrize(
    ("line", "text", "valid"),
    [
        ("number_of_teths = 20", "unknown key 'number_of_teths'", "number_of_teeth"),
        ("colour = 3", "unknown key 'colour'", "number_of_teeth"),
        ("flanks.left.profile_um = {max = 1}", "flanks.left.profile_um", "flanks.left.profile_form_um"),
        ('"flanks.top.helix_form_um" = {max = 1}', "flanks.top.helix_form_um", "flanks.left.helix_form_um"),
        ("span_mm = 15.33", "span_mm is measured and has a tolerance", "tolerance = 0.005"),
        ("span_mm = {value = 15.33}", "span_mm has value", "tolerance"),
        ("span_mm = {value = 1, max = 2}", "span_mm has max, value", "tolerance"),
        ("span_mm = {value = 1, tolerance = -0.1}", "tolerance = -0.1 is below 0", "tolerance"),
        ("span_mm = {min = nan}", "min = nan is not a finite number", "min"),
        ("span_mm = {min = true}", "min = True is not a finite number", "min"),
        ("span_mm = {min = 2, max = 1}", "min = 2 lies above max = 1", "min"),
        ("span_mm = {}", "span_mm", "tolerance"),
        ('span_mm = "15.33"', "span_mm = '15.33' is not a number", "tolerance"),
        ("number_of_teeth = 20.5", "number_of_teeth = 20.5 is not a whole number", "a whole number"),
        ("number_of_teeth = true", "number_of_teeth = True is not a whole number", "a whole number"),
        ('hand = "up"', "hand = 'up'", "spur, right, left or none"),
        ("hand = {max = 1}", "hand has no limits", "spur, right, left or none"),
        ("undercut = 1", "undercut = 1", "true or false"),
        ('alarms = "PS1594"', "alarms is a list", 'alarms = ["PS1594"]'),
        ("alarms = [1594]", "alarms is a list", 'alarms = ["PS1594"]'),
    ],
)
def test_what_cannot_be_expected_is_refused_with_its_line(tmp_path, line, text, valid):
    with pytest.raises(InputError) as refused:
        expectations(tmp_path, "number_of_sides = 6", line)
    assert text in refused.value.text
    assert valid in refused.value.remedy
    assert str(refused.value).startswith(f"{tmp_path / 'job.toml'}:{LINE + 1}: error: ")


def scalars(values, way=""):
    """Keys of single figures in nested tables, by their dotted way."""
    for name, value in values.items():
        key = f"{way}{name}"
        if isinstance(value, dict):
            yield from scalars(value, f"{key}.")
        elif not isinstance(value, list):
            yield key


def test_every_single_figure_of_an_inspection_has_its_key(parts, named):
    """Of a gear and a polygon as measured; what is not offered is named here."""
    told = {
        "tolerances_um",
        "flatness_limits_um",
        "reference",
        "nominal",
        "uncertainty",
        "unmeasured",
        "axis",
    }
    helical = inspect(
        *parts.gear_mesh(teeth=12, module=2.0, helix_deg=15.0, width=12.0),
        named(12, 2.0, 15.0, accuracy_class=8),
    )
    hexagon = inspect(
        *parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=3, sides=6, width=5.0)
    )
    for found, own in ((helical, GEAR), (hexagon, POLYGON)):
        keys = {
            key
            for key in scalars(to_json(found))
            if key.split(".")[0] not in told and ".uncertainty." not in key
        }
        assert keys - {"measuring_plane_mm", "reason"} == own.keys() | COMMON.keys()


def test_figures_and_their_uncertainty_are_found_by_key(parts, named):
    values = to_json(
        inspect(*parts.gear_mesh(teeth=12, module=2.0, helix_deg=15.0, width=12.0), named(12, 2.0, 15.0))
    )
    assert figure(values, "number_of_teeth") == 12
    assert figure(values, "flanks.left.profile_form_um") == values["flanks"]["left"]["profile_form_um"]
    assert figure(values, "across_flats_mm") is None
    assert figure({"kind": None}, "kind") == "none"
    assert uncertainty(values, "span_mm") == values["uncertainty"]["span_mm"]
    left = values["flanks"]["left"]["uncertainty"]
    assert uncertainty(values, "flanks.left.filtered.profile_form_um") == left["profile_form_um"]
    assert uncertainty(values, "number_of_teeth") == 0.0
    assert all(uncertainty(values, key) >= 0 for key in KEYS)


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(-2e3, 2e3))
def test_off_by_is_the_way_back_into_the_limits(a, b, value):
    between = Between(low=min(a, b), high=max(a, b))
    off = between.off(value)
    assert (off == 0) == (between.low <= value <= between.high)
    if off:
        edge = between.high if off > 0 else between.low
        assert off == value - edge
        assert (value > between.high) == (off > 0)


PART = {
    "kind": "gear",
    "number_of_teeth": 19,
    "hand": "right",
    "span_mm": 15.3401,
    "runout_um": None,
    "verdict": "out",
    "flanks": {"left": {"profile_total_um": 13.5}},
    "unmeasured": {"runout_um": "no ball fits"},
}


def expect(**wanted):
    return [Expectation(key=key, wanted=value) for key, value in wanted.items()]


def test_what_is_met_is_not_listed():
    wanted = expect(
        number_of_teeth=Between(low=19, high=19), hand="right", verdict="out", alarms=("B", "A"), warnings=()
    )
    assert misses(wanted, PART, alarms=["A", "B", "A"], warnings=[]) == ()
    assert table(()) == []


def test_the_table_says_what_missed_and_by_how_much():
    wanted = [
        *expect(
            number_of_teeth=Between(low=20, high=20),
            hand="spur",
            span_mm=Between(low=15.325, high=15.335),
            runout_um=Between(low=-math.inf, high=20.0),
            number_of_sides=Between(low=6, high=6),
            alarms=("PS1594",),
            warnings=(),
        ),
        Expectation(key="flanks.left.profile_total_um", wanted=Between(low=15, high=math.inf)),
    ]
    lines = table(misses(wanted, PART, alarms=["PS1593"], warnings=["HT1001"]))
    cells = [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in lines]
    assert cells == [
        ["key", "expected", "got", "off by"],
        ["number_of_teeth", "20", "19", "-1"],
        ["hand", "spur", "right"],
        ["span_mm", "15.325 to 15.335", "15.3401", "+0.0051"],
        ["runout_um", "at most 20", "not measured: no ball fits"],
        ["number_of_sides", "6", "not measured"],
        ["alarms", "PS1594", "PS1593", "missing PS1594, unexpected PS1593"],
        ["warnings", "none", "HT1001", "unexpected HT1001"],
        ["flanks.left.profile_total_um", "at least 15", "13.5", "-1.5"],
    ]


def test_a_part_that_is_nothing_says_why():
    (missed,) = misses(
        expect(number_of_teeth=Between(low=20, high=20), kind="none"), {"kind": None, "reason": "no teeth"}
    )
    assert missed.got == "not measured: no teeth"


def test_loads_of_a_run_can_be_expected(tmp_path):
    wanted = expectations(
        tmp_path,
        "cutting_load.largest_Y = {max = 40}",
        "cutting_load.settled = true",
        "cutting_load.rounds = 3",
    )
    run = {"cutting_load": {"largest_Y": 41.5, "settled": True, "rounds": 3}}
    (missed,) = misses(wanted, {**PART, **run})
    assert (missed.key, missed.got, missed.off_by) == ("cutting_load.largest_Y", "41.5", "+1.5")
    without = misses(wanted, PART)
    assert [one.got for one in without] == ["not measured"] * 3
