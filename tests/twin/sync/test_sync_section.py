"""The section of the report: lines put in stand in its table, and in its drawing."""

import numpy as np
from markupsafe import Markup

from twin.report.charts.sync import sync_chart
from twin.sync import spectrum


def test_chart_marks_the_tool_and_lines_are_listed_by_size() -> None:
    t = np.arange(1, 30_001) * 1e-3
    work = 90.0 * t
    error = -3.0 + 2.0 * np.sin(np.radians(work)) + 0.5 * np.sin(np.radians(20 * work)) + 0.001 * np.sin(work)
    found = spectrum(t, error, work, 20 * work)
    assert found
    assert [round(order) for order, _, _ in found.strongest(9)] == [1, 20]
    chart = sync_chart(found)
    assert isinstance(chart, Markup)
    for text in (">tool<", "tool × 2", "tool × 3", "sync-turn", "sync-orders"):
        assert text in chart
    assert len(chart) < 60_000


def test_a_still_error_is_drawn() -> None:
    t = np.arange(1, 10_001) * 1e-3
    found = spectrum(t, np.zeros(len(t)), 90.0 * t, 90.0 * t)
    assert found
    assert found.strongest(5) == []
    assert "nan" not in sync_chart(found)
