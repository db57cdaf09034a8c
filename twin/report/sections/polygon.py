"""The sheet of a polygon: its section against the true one, and its faces."""

from twin.report import tables
from twin.report.charts.polygon import section_chart
from twin.report.data import ReportData
from twin.report.header import polygon_header
from twin.report.sections.section import Section, Tab


def polygon_section(report: ReportData) -> Section | None:
    """Draw section and faces; None where the part is no polygon."""
    polygon = report.inspection.polygon
    if polygon is None:
        return None
    return Section(
        name="polygon",
        tab=Tab.SHEET,
        title="Section and faces",
        values={
            "header": polygon_header(report, polygon),
            "section": section_chart(polygon),
            "comparison": tables.comparison(report.inspection),
            "faces": polygon.faces,
        },
        own_page=True,
    )
