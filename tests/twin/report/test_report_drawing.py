"""The drawing layer: round ticks, true lines, escaped words."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.report.drawing import Drawing, Plot, ticks
from twin.report.drawing.ticks import tick_text


@given(st.floats(-1e3, 1e3), st.floats(1e-3, 1e6), st.integers(2, 12))
def test_ticks_are_round_inside_and_not_too_many(low, length, most):
    high = low + length
    found = ticks(low, high, most)
    assert len(found) <= most
    assert all(low - 1e-6 * length <= value <= high + 1e-6 * length for value in found)
    if len(found) > 1:
        step = found[1] - found[0]
        mantissa = step / 10 ** np.floor(np.log10(step) + 1e-9)
        assert min(abs(mantissa - m) for m in (1, 2, 5, 10)) < 1e-3
    # any range holds two figures, where two are allowed to stand
    if most >= 4:
        assert len(found) >= 2


@pytest.mark.parametrize("span", [(1.0, 1.0), (2.0, 1.0), (np.nan, 1.0), (0.0, np.inf)])
def test_no_range_has_no_ticks(span):
    assert ticks(*span) == ()


@pytest.mark.parametrize(
    ("value", "step", "text"),
    [(-0.5, 0.5, "−0.5"), (0.30000000000000004, 0.1, "0.3"), (-1e-17, 0.2, "0"), (1500.0, 500.0, "1500")],
)
def test_ticks_in_words(value, step, text):
    assert tick_text(value, step) == text


@given(
    st.lists(st.tuples(st.floats(-50, 250), st.floats(-3, 9)), min_size=1, max_size=20),
    st.sets(st.integers(0, 19)),
)
def test_a_curve_stands_where_its_values_are_and_stops_at_gaps(points, gaps):
    x, y = (np.array(column) for column in zip(*points, strict=True))
    y[[k for k in gaps if k < len(y)]] = np.nan
    drawing = Drawing("d", 100.0, 60.0)
    plot = Plot(drawing, left=10.0, top=5.0, width=80.0, height=40.0, x=(-50.0, 250.0), y=(-3.0, 9.0))
    plot.curve(x, y, "trace", id="c")
    found = re.search(r'<path id="d-c"[^>]* d="([^"]*)"', drawing.svg("test"))
    there = np.isfinite(y)
    if not there.any():
        assert found is None
        return
    drawn = np.array(re.findall(r"-?\d+\.\d+", found[1]), float).reshape(-1, 2)
    expected = np.stack([10.0 + (x + 50.0) / 300.0 * 80.0, 45.0 - (y + 3.0) / 12.0 * 40.0], -1)[there]
    np.testing.assert_allclose(drawn, expected, atol=0.0051)
    pieces = np.count_nonzero(there & ~np.concatenate([[False], there[:-1]]))
    assert found[1].count("M") == pieces


def test_words_are_escaped_and_subscripts_stand_lower():
    drawing = Drawing("d", 10.0, 10.0)
    drawing.text(1.0, 2.0, '<b>&_{Hα}"> x')
    words, tags = [], []

    class Reader(HTMLParser):
        def handle_data(self, data):
            words.append(data)

        def handle_starttag(self, tag, attrs):
            tags.append((tag, dict(attrs)))

    Reader().feed(str(drawing.svg('"quoted" <name>')))
    assert "".join(words) == '<b>&Hα"> x'
    assert [tag for tag, _ in tags] == ["svg", "text", "tspan", "tspan"]
    assert tags[0][1]["aria-label"] == '"quoted" <name>'
    # down by as much as up again
    assert sum(float(attrs["dy"]) for tag, attrs in tags if tag == "tspan") == pytest.approx(0.0)


def test_an_empty_range_is_widened():
    plot = Plot(Drawing("d", 10, 10), left=0, top=0, width=10, height=10, x=(3.0, 3.0), y=(1.0, 1.0))
    assert (float(plot.across(3.0)), float(plot.down(1.0))) == (5.0, 5.0)
