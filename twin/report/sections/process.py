"""The program beside the motion: which block did what, when."""

from twin.report import tables
from twin.report.charts.motion import motion_chart
from twin.report.data import ReportData
from twin.report.sections.section import Section, Tab


def process_section(report: ReportData) -> Section | None:
    """Show listing and plots; None where there is neither."""
    recording = report.recording
    if recording is None and not report.programs:
        return None
    motion = motion_chart(recording, report.rotary_axes, report.sync_error_arcsec) if recording else None
    return Section(
        name="process",
        tab=Tab.PROCESS,
        title="The program and what the machine did",
        values={
            "motion": motion,
            "recorded": recording is not None,
            "programs": [
                (program.name, tables.listing(program, report.messages)) for program in report.programs
            ],
        },
        own_page=True,
    )
