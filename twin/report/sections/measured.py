"""Size and shape, wanted beside found, and the flanks against their tolerances."""

from twin.report import tables, words
from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def measured_section(report: ReportData) -> Section | None:
    """Show the tables; None where nothing was recognised."""
    inspection = report.inspection
    if inspection.kind is None:
        return None
    gear = inspection.gear
    return Section(
        name="measured",
        tab=Tab.OVERVIEW,
        title="What was measured",
        values={
            "comparison": tables.comparison(inspection),
            "graded": tables.graded(gear) if gear else (),
            "class_reached": tables.class_reached(gear, "overall") if gear else "",
            "class_allowed": tables.class_allowed(inspection),
            "missing": words.missing(inspection),
        },
    )
