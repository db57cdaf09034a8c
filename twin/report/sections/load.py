"""Cutting forces: what they were, and what they did to the machine."""

from twin.report.charts.load import load_chart
from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def load_section(report: ReportData) -> Section | None:
    """Draw power and forces; None for a run without cutting forces, or one that cut nothing."""
    chart = (
        load_chart(report.recording, report.rotary_axes, report.drive_limits) if report.recording else None
    )
    if chart is None:
        return None
    return Section(
        name="load",
        tab=Tab.ANALYSIS,
        title="Cutting forces",
        values={"head": [(row.label, row.value) for row in report.load], "chart": chart},
        own_page=True,
    )
