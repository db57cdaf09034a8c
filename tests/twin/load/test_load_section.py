"""The section of the report: every axis that bears a force has its plots, and nothing is drawn without."""

from dataclasses import replace

import numpy as np
from polygon_job import Polygon

from twin.load.figures import load_figures, load_rows, load_words
from twin.report import ReportData, Row
from twin.report.charts.load import load_chart
from twin.report.sections.load import load_section

ROTARY = frozenset("YC")


def test_power_forces_and_give_are_drawn(tmp_path):
    physics = "cutting_load = true\nload_resolution_mm = 0.5\nk_c11 = 500.0"
    loaded = Polygon(tmp_path, physics=physics).loaded()
    recording = loaded.session.recording
    chart = load_chart(recording, ROTARY)
    assert chart is not None
    for text in ("power  [W]", "X  [N]", "Y  [N m]", "C  [N m]", "give  [µm]", "Tooth by tooth"):
        assert text in chart
    assert "Z  [N]" not in chart  # the insert is straight and cuts on its tip
    assert "nan" not in chart
    rows = load_rows(loaded, "Y")
    section = load_section(
        ReportData(
            title="a",
            recording=recording,
            rotary_axes=ROTARY,
            load=tuple(Row(label=label, value=value) for label, value in rows),
        )
    )
    assert section is not None
    assert section.values["head"] == rows
    figures = load_figures(loaded)["cutting_load"]
    assert recording.load is not None
    assert isinstance(figures, dict)
    assert figures["settled"] is True
    assert figures["largest_Y"] == np.abs(recording.load.axes[:, 2]).max()
    assert f"settled in {loaded.windows} windows of at most {loaded.rounds} rounds" in load_words(loaded)
    columns = tmp_path / "recording.npz"
    recording.save(columns)
    saved = np.load(columns)
    np.testing.assert_array_equal(saved["load_Y"], recording.load.axes[:, 2])
    assert saved["deflection_um"].shape == (len(recording.time_s), 3)
    assert load_chart(replace(recording, load=None), ROTARY) is None


def test_what_a_drive_has_is_drawn_where_forces_come_near_it(tmp_path):
    physics = "cutting_load = true\nload_resolution_mm = 0.5\nk_c11 = 200.0"
    loaded = Polygon(tmp_path, physics=physics).loaded()
    recording = loaded.session.recording
    assert recording.load is not None
    most = float(np.abs(recording.load.axes[:, 2]).max())
    for limit, drawn in ((0.5 * most, True), (1.5 * most, True), (2.0 * most, False)):
        chart = load_chart(recording, ROTARY, {"Y": limit})
        assert chart is not None
        assert ("load-Y-limit" in chart) is drawn
        assert "load-X-limit" not in chart
