"""Alarms and warnings, in the order in which they came."""

from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def messages_section(report: ReportData) -> Section | None:
    """List them; None where there are none."""
    if not report.messages:
        return None
    return Section(
        name="messages", tab=Tab.OVERVIEW, title="Alarms and warnings", values={"messages": report.messages}
    )
