"""Charts read back from their SVG: what is drawn is what was measured."""

import re
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from twin.inspection.result import Trace
from twin.report.charts.motion import envelope, motion_chart, speed_rpm, sync_spans
from twin.report.charts.pitch import pitch_chart
from twin.report.charts.polygon import deviations, section_chart
from twin.report.charts.traces import MOST_TRACES, helix_chart, mean_line, profile_chart, ratio
from twin.report.scale import nice_ceiling, nice_floor, number, plain

DRAWN = 0.02
"""points of an SVG stand within this of where they belong [mm]: coordinates end at 0.01"""


def paths(svg, gid):
    """The vertices (n, 2) of a line [mm], y upwards, and how many pieces it has."""
    outline = re.search(rf'<path id="{gid}"[^>]* d="([^"]*)"', svg)[1]
    numbers = np.array(re.findall(r"-?\d+(?:\.\d+)?", outline), float).reshape(-1, 2)
    return numbers * [1, -1], outline.count("M")


def boxes(svg, gid):
    """Left, top, width and height of a rectangle [mm]."""
    tag = re.search(rf'<rect id="{gid}"[^>]*>', svg)[0]
    return np.array([float(re.search(rf' {key}="([^"]*)"', tag)[1]) for key in ("x", "y", "width", "height")])


def line_through(x, y):
    """Slope and offset of y over x; fails where they do not lie on one line."""
    slope, offset = np.polyfit(x, y, 1)
    assert np.abs(slope * np.asarray(x) + offset - y).max() < DRAWN
    return slope, offset


@pytest.mark.parametrize(("kind", "chart"), [("profile", profile_chart), ("helix", helix_chart)])
@pytest.mark.parametrize(("side", "outward"), [("left", -1), ("right", 1)])
def test_traces_are_the_measured_ones(sample, kind, chart, side, outward):
    gear = sample.gear_inspection().gear
    svg = chart(gear)
    scales = set()
    for trace in getattr(getattr(gear, side), kind):
        drawn, _ = paths(svg, f"{kind}-{side}-{trace.tooth}")
        across, _ = line_through(trace.deviation_um, drawn[:, 0])
        along, _ = line_through(trace.position, drawn[:, 1])
        assert np.sign(across) == outward
        assert along > 0
        scales.add((round(abs(across), 2), round(along, 2)))
    assert len(scales) == 1


def test_mean_lines_have_the_slope_that_was_put_in():
    position = np.linspace(0.0, 10.0, 301)
    wave = 3.0 * np.cos(
        2 * np.pi * position / 2.0
    )  # four whole waves over the range: symmetric about its middle
    trace = Trace(
        tooth=1,
        position=position,
        deviation_um=7.0 * (position - 5.0) / 8.0 + wave + 100.0 * (position > 9.0),
        evaluation=(1.0, 9.0),
        slope_um=7.0,
        form_um=6.0,
        total_um=0.0,
    )
    (start, low), (end, high) = mean_line(trace)
    assert (start, end) == pytest.approx((1.0, 9.0), abs=1e-9)
    assert high - low == pytest.approx(7.0, abs=1e-6)


@pytest.mark.parametrize(("kind", "chart"), [("profile", profile_chart), ("helix", helix_chart)])
def test_the_scale_box_tells_the_truth(sample, kind, chart):
    """The box is as large as it says, and on paper the ratios hold: the drawing is in millimetres."""
    gear = sample.gear_inspection().gear
    svg = chart(gear)
    trace = getattr(gear.left, kind)[0]
    drawn, _ = paths(svg, f"{kind}-left-1")
    per_um, _ = line_through(trace.deviation_um, drawn[:, 0])
    per_mm, _ = line_through(trace.position, drawn[:, 1])
    um, magnified = re.search(r">(\d+) µm  (\d+):1<", svg).groups()
    mm, along = re.search(r">([\d.]+) mm  ([\d.:]+)<", svg).groups()
    width, height = boxes(svg, f"{kind}-scale-box")[2:]
    assert width == pytest.approx(float(um) * abs(per_um), abs=DRAWN)
    assert height == pytest.approx(float(mm) * per_mm, abs=DRAWN)
    # within the 0.01 mm that coordinates end at, over the range of the trace
    assert abs(per_um) * 1e3 == pytest.approx(float(magnified), abs=1e3 * DRAWN / np.ptp(trace.deviation_um))
    paper, part = map(float, along.split(":"))
    assert per_mm == pytest.approx(paper / part, abs=DRAWN / np.ptp(trace.position))


@pytest.mark.parametrize(("scale", "words"), [(500.0, "500:1"), (1.0, "1:1"), (0.5, "1:2"), (0.2, "1:5")])
def test_ratios_as_draughtsmen_write_them(scale, words):
    assert ratio(scale) == words


def test_the_tolerance_band_is_as_wide_as_the_tolerance_about_the_middle_of_the_trace(sample):
    gear = sample.gear_inspection().gear
    svg = profile_chart(gear)
    trace = gear.right.profile[1]
    drawn, _ = paths(svg, "profile-right-6")
    per_um, zero = line_through(trace.deviation_um, drawn[:, 0])
    band, _ = paths(svg, "profile-right-6-band")
    assert np.ptp(band[:, 0]) == pytest.approx(22.0 * per_um, abs=2 * DRAWN)
    low, high = trace.evaluation
    inside = trace.deviation_um[(trace.position >= low) & (trace.position <= high)]
    middle = zero + per_um * (inside.min() + inside.max()) / 2
    assert band[:, 0].mean() == pytest.approx(middle, abs=2 * DRAWN)


def test_a_band_much_wider_than_the_traces_is_left_out(sample):
    gear = sample.gear_inspection().gear
    svg = profile_chart(replace(gear, tolerances_um={"profile_total": 2000.0}))
    assert "-band" not in svg
    assert "tolerance" not in svg


def test_a_gap_in_a_trace_is_a_gap_in_the_line(sample):
    gear = sample.gear_inspection().gear
    first = gear.left.profile[0]
    holed = first.deviation_um.copy()
    holed[200:220] = np.nan
    left = replace(gear.left, profile=(replace(first, deviation_um=holed), *gear.left.profile[1:]))
    drawn, pieces = paths(profile_chart(replace(gear, left=left)), "profile-left-1")
    assert pieces == 2
    assert len(drawn) == 480 - 20
    line_through(holed[np.isfinite(holed)], drawn[:, 0])


def test_of_many_teeth_some_are_drawn(sample):
    gear = sample.gear_inspection().gear
    many = tuple(replace(gear.left.profile[0], tooth=k) for k in range(1, 41))
    svg = profile_chart(replace(gear, left=replace(gear.left, profile=many)))
    drawn = {int(k) for k in re.findall(r'id="profile-left-(\d+)"', svg)}
    assert len(drawn) == MOST_TRACES
    assert {1, 40} <= drawn


def test_destroyed_teeth_are_drawn_too(sample):
    gear = sample.gear_inspection().gear
    torn = tuple(replace(t, deviation_um=1e4 * t.deviation_um) for t in gear.left.profile)
    svg = profile_chart(replace(gear, left=replace(gear.left, profile=torn)))
    drawn, _ = paths(svg, "profile-left-1")
    line_through(torn[0].deviation_um, drawn[:, 0])


@pytest.mark.parametrize("side", ["left", "right"])
def test_pitch_bars_and_curve(sample, side):
    gear = sample.gear_inspection().gear
    svg = pitch_chart(gear)
    flank = getattr(gear, side)
    bars = np.array([boxes(svg, f"pitch-{side}-single-{k}") for k in range(1, 21)])
    # a bar hangs from or stands on zero, as the sign of its value is
    above = flank.pitch_um > 0
    zero = np.where(above, bars[:, 1] + bars[:, 3], bars[:, 1])
    assert np.ptp(zero) < 2 * DRAWN
    heights = np.where(above, bars[:, 3], -bars[:, 3])
    slope, offset = line_through(flank.pitch_um, heights)
    assert slope > 0
    assert abs(offset) < DRAWN
    curve, _ = paths(svg, f"pitch-{side}-cumulative")
    assert line_through(flank.cumulative_um, curve[:, 1])[0] > 0
    assert line_through(np.arange(1, 21), curve[:, 0])[0] > 0


def test_section_is_magnified_about_the_true_polygon(sample):
    polygon = sample.polygon_inspection().polygon
    svg = section_chart(polygon)
    true, _ = paths(svg, "section-true")
    drawn, _ = paths(svg, "section-outline")
    centre = true.mean(axis=0)
    per_mm = np.linalg.norm(true - centre, axis=1).mean() / (8.5 / np.cos(np.pi / 6))
    exact = polygon.section @ [1, 1j]
    face = np.rint(np.angle(exact) / (np.pi / 3))
    normal = np.exp(1j * np.pi / 3 * face)
    at = (drawn - centre) @ [1, 1j] / per_mm
    deviation = (exact * np.conj(normal)).real - 8.5
    outwards, zero = line_through(deviation, (at * np.conj(normal)).real - 8.5)
    assert outwards == pytest.approx(50, abs=0.2)
    assert zero == pytest.approx(0.0, abs=2 * DRAWN / per_mm)
    # Three inserts on R 40, A 48.5: 13.04 µm lower at the corners than at mid-face.
    assert deviation.min() * 1e3 == pytest.approx(-13.04, abs=0.5)


@given(turn=st.floats(-400, 400), bow=st.floats(-100, 100))
@settings(max_examples=50, deadline=None)
def test_deviation_of_a_section_whatever_its_orientation(turn, bow):
    along = np.linspace(-4.0, 4.0, 41)
    dent = bow * (along / 4.0) ** 2
    directions = np.radians(turn) + 2 * np.pi / 6 * np.arange(6)
    points = np.concatenate([(8.5 + dent * 1e-3 + 1j * along) * np.exp(1j * a) for a in directions])
    polygon = SimpleNamespace(
        faces=[SimpleNamespace(direction_deg=np.degrees(a)) for a in directions],
        section=np.stack([points.real, points.imag], -1),
    )
    face, place, deviation = deviations(polygon, 17.0)
    np.testing.assert_array_equal(face, np.repeat(np.arange(6), 41))
    np.testing.assert_allclose(place, np.tile(along, 6), atol=1e-9)
    np.testing.assert_allclose(deviation, np.tile(dent, 6), atol=1e-6)


@given(
    hnp.arrays(np.float64, st.integers(2, 3000), elements=st.floats(-1e6, 1e6)),
    st.integers(1, 60),
)
@settings(max_examples=80, deadline=None)
def test_an_envelope_keeps_real_samples_and_every_peak(value, columns):
    time = np.arange(len(value)) * 0.25
    kept_time, kept = envelope(time, value, columns)
    index = np.rint(kept_time / 0.25).astype(int)
    np.testing.assert_array_equal(value[index], kept)
    assert (np.diff(index) > 0).all()
    assert (index[0], index[-1]) == (0, len(value) - 1)
    assert len(kept) <= 2 * columns + 2
    for run in np.array_split(index, 1) if len(value) <= 2 * columns else _runs(len(value), columns):
        assert value[run].max() == value[np.intersect1d(run, index)].max()
        assert value[run].min() == value[np.intersect1d(run, index)].min()


def _runs(n, columns):
    edges = np.linspace(0, n, columns + 1).astype(int)
    return [np.arange(a, b) for a, b in pairwise(edges)]


def test_a_spike_of_one_sample_reaches_the_page(sample):
    recording = sample.recording(100_000)
    svg = motion_chart(recording, frozenset("YC")).svg
    drawn, _ = paths(svg, "motion-Z-error")
    error = recording.setpoint[:, 1] - recording.actual[:, 1]
    time, kept = envelope(recording.time_s, error)
    slope, _ = line_through(kept, drawn[:, 1])
    assert line_through(time, drawn[:, 0])[0] > 0
    assert np.ptp(drawn[:, 1]) == pytest.approx(slope * np.ptp(error), abs=DRAWN)
    assert np.ptp(error) > 0.08


def test_spindles_are_drawn_as_speed(sample):
    recording = sample.recording(2000)
    drawn, _ = paths(motion_chart(recording, frozenset("YC")).svg, "motion-Y-setpoint")
    speed = np.diff(recording.setpoint[:, 2]) / np.diff(recording.time_s) / 6
    _, kept = envelope(recording.time_s[1:], speed)
    assert speed.max() == pytest.approx(300.0)
    line_through(kept, drawn[:, 1])


def test_speed_of_a_steady_spindle_and_of_standing_time():
    time = np.array([0.0, 0.1, 0.1, 0.3])
    np.testing.assert_allclose(speed_rpm(time, 6 * 250 * time), [250, np.nan, 250])


def test_sync_spans(sample):
    recording = sample.recording(1000)
    spans = sync_spans(recording)
    inside = sum(((recording.time_s >= a) & (recording.time_s < b)).sum() for a, b in spans)
    assert inside == recording.sync.sum()
    every = replace(recording, sync=np.ones(1000, bool))
    assert sync_spans(every) == [(0.0, recording.time_s[-1])]
    assert sync_spans(replace(recording, sync=np.zeros(1000, bool))) == []


@given(st.floats(1e-9, 1e9))
def test_round_figures_enclose_a_value(value):
    assert nice_floor(value) <= value * (1 + 1e-9)
    assert nice_ceiling(value) >= value * (1 - 1e-9)
    assert nice_ceiling(value) <= 2.5 * value * (1 + 1e-9)
    assert nice_floor(value) >= value / 2.5 * (1 - 1e-9)


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "–"), (float("nan"), "–"), (float("inf"), "–"), (-0.04, "0.0"), (-3.25, "−3.2"), (12.0, "12.0")],
)
def test_numbers_in_words(value, text):
    assert number(value) == text


def test_units_stand_behind_a_space_but_degrees():
    assert (number(-1.5, 2, "µm"), number(20, 1, "°"), plain(0.5, "mm")) == ("−1.50 µm", "20.0°", "0.5 mm")


def test_what_stands_still_is_drawn_as_a_level_line(sample):
    """Rounding of a spindle at rest is no curve: it is not drawn larger than a thousandth."""
    recording = sample.recording(500)
    noise = 1e-9 * np.sin(np.arange(500.0))
    still = replace(recording, setpoint=np.zeros((500, 4)), actual=np.repeat(noise[:, None], 4, axis=1))
    svg = motion_chart(still, frozenset("YC")).svg
    for axis in "XZYC":
        drawn, _ = paths(svg, f"motion-{axis}-error")
        assert np.ptp(drawn[:, 1]) < 0.1
