"""Flanks and faces laid flat: deviations put in by formula come back at their places."""

from dataclasses import replace

import numpy as np
import pytest

from twin.inspection.nominal import GearNominal
from twin.report.charts.maps import MOST_SHOWN, map_chart
from twin.report.colours import Scale
from twin.report.sections.maps import maps_section
from twin.report.unrolled import NOWHERE, map_deviation, unroll


def values(part, formula):
    """The part with a deviation by (n,) angle, radius and z where it had one."""
    x, y, z = part.vertices.T
    new = formula(np.arctan2(y, x), np.hypot(x, y), z)
    return replace(part, deviation_um=np.where(np.isfinite(part.deviation_um), new, np.nan))


@pytest.fixture(scope="module")
def gear(sample):
    return sample.gear_part(around=60, along=40), sample.gear_inspection()


def test_each_flank_has_its_own_map(gear):
    """Tooth k counts clockwise from +X: left flanks lie on its counter-clockwise side."""
    part, inspection = gear

    def code(angle, _radius, _z):
        tooth = np.round(-angle / (2 * np.pi / 20)) % 20
        side = np.sin(angle + tooth * 2 * np.pi / 20) < 0
        return tooth + 100.0 * side

    part = values(part, code)
    maps = map_deviation(part, unroll(part, inspection))
    assert maps.deviation_um.shape[0] == 40
    for k, one in enumerate(maps.deviation_um):
        np.testing.assert_allclose(one[np.isfinite(one)], k % 20 + 100.0 * (k >= 20), atol=1e-3)
        assert np.isfinite(one).mean() > 0.95


def test_rows_run_with_z_and_columns_with_the_roll_length(gear):
    part, inspection = gear
    base = 20.0 * np.cos(np.radians(20.0))
    part = values(part, lambda _angle, radius, z: 10.0 * z + np.sqrt(np.maximum(radius**2 - base**2, 0.0)))
    maps = map_deviation(part, unroll(part, inspection))
    _, height, width = maps.deviation_um.shape
    low, high = maps.across
    roll = low + (np.arange(width) + 0.5) / width * (high - low)
    z = maps.z[1] - (np.arange(height) + 0.5) / height * (maps.z[1] - maps.z[0])
    assert maps.z == (-20.0, 0.0)
    assert high == pytest.approx(np.sqrt(22.0**2 - base**2), abs=1e-6)
    expected = 10.0 * z[:, None] + roll
    for one in maps.deviation_um:
        there = np.isfinite(one)
        np.testing.assert_allclose(one[there], expected[there], atol=0.02)


def test_faces_of_a_polygon(sample):
    part, inspection = sample.hexagon_part(), sample.polygon_inspection()
    unrolled = unroll(part, inspection)
    maps = map_deviation(part, unrolled)
    assert maps.deviation_um.shape[0] == 6
    # A 48.5, R 40, ratio 2: flat in the middle, 13.04 µm lower at the edges, on every face alike
    for one in maps.deviation_um:
        assert np.nanmax(one) == pytest.approx(0.0, abs=0.1)
        assert np.nanmin(one) == pytest.approx(-13.04, abs=0.5)
    # from edge to edge but for the strip of triangles about each edge, which belongs to two faces
    edge = 8.5 * np.tan(np.pi / 6)
    assert -edge < maps.across[0] < -edge + 0.1
    assert edge - 0.1 < maps.across[1] < edge


def test_what_is_not_measured_is_on_no_map(gear):
    part, inspection = gear
    nothing = replace(part, deviation_um=np.full(len(part.vertices), np.nan))
    assert map_deviation(nothing, unroll(nothing, inspection)) is None
    assert (unroll(part, inspection).patch != NOWHERE).any()


def test_many_teeth_are_thinned_and_it_is_said(sample):
    inspection = sample.gear_inspection()
    reference = GearNominal(number_of_teeth=200, normal_module_mm=0.5)
    wheel = replace(inspection.gear, number_of_teeth=200, reference=reference)
    part = sample.gear_part(teeth=200, module=0.5, bore=20.0, around=30, along=6)
    inspection = replace(inspection, gear=wheel)
    unrolled = unroll(part, inspection)
    chart = map_chart(unrolled, map_deviation(part, unrolled), Scale(limit_um=10.0, beyond=0.0))
    assert len(chart.tiles) == 2 * MOST_SHOWN
    assert chart.left_out == 80
    assert {tile.name for tile in chart.tiles} >= {"1", "200"}
    section = maps_section(sample.report(part=part, inspection=inspection))
    assert section.values["chart"].left_out == 80


def test_a_part_that_was_not_recognised_has_no_maps(sample):
    report = sample.report(inspection=replace(sample.gear_inspection(), gear=None, reason="no teeth"))
    assert maps_section(report) is None
