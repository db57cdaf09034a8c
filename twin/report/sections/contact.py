"""The collision that ended the run."""

from twin.report.charts.contact import contact_chart
from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def contact_section(report: ReportData) -> Section | None:
    """Draw the two bodies; None where nothing has touched."""
    if report.contact is None:
        return None
    moving, fixed = report.contact.bodies
    return Section(
        name="contact",
        tab=Tab.OVERVIEW,
        title="Collision",
        values={
            "found": report.contact.found,
            "moving": moving,
            "fixed": fixed,
            "chart": contact_chart(report.contact),
        },
    )
