"""First page of the sheet: profile and helix of left and right flanks, with their figures."""

from twin.report.charts.traces import HELIX, MOST_TRACES, PROFILE, helix_chart, profile_chart
from twin.report.data import ReportData
from twin.report.header import gear_header
from twin.report.sections.section import Section, Tab
from twin.report.trace_table import trace_table


def flanks_section(report: ReportData) -> Section | None:
    """Draw the traces; None where the part is no gear."""
    gear = report.inspection.gear
    if gear is None:
        return None
    return Section(
        name="flanks",
        tab=Tab.SHEET,
        title="Profile and helix",
        values={
            "header": gear_header(report, gear),
            "profile": profile_chart(gear),
            "profile_table": trace_table(gear, PROFILE),
            "helix": helix_chart(gear),
            "helix_table": trace_table(gear, HELIX),
            "thinned": max(len(gear.left.profile), len(gear.right.profile)) > MOST_TRACES,
            "unmeasured": report.inspection.unmeasured,
        },
        own_page=True,
    )
