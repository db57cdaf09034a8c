"""Where the part comes from: job, versions, hashes, time taken."""

from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def origin_section(report: ReportData) -> Section:
    """Show all rows that there are."""
    return Section(
        name="origin",
        tab=Tab.ORIGIN,
        title="Where this comes from",
        values={"job": report.job, "timing": report.timing, "provenance": report.provenance},
        own_page=True,
    )
