"""Second page of the sheet: pitch and runout over the teeth."""

from twin.report import tables
from twin.report.charts.pitch import pitch_chart
from twin.report.data import ReportData
from twin.report.header import gear_header
from twin.report.sections.section import Section, Tab

ITEMS = ("single_pitch", "cumulative_pitch", "runout")


def pitch_section(report: ReportData) -> Section | None:
    """Draw bars and curves; None where the part is no gear."""
    gear = report.inspection.gear
    if gear is None:
        return None
    return Section(
        name="pitch",
        tab=Tab.SHEET,
        title="Pitch and runout",
        values={
            "header": gear_header(report, gear),
            "pitch": pitch_chart(gear),
            "rows": [row for row in tables.graded(gear) if row.item in ITEMS],
            "waves": tables.waves(gear),
        },
        own_page=True,
    )
