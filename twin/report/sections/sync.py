"""How well the gear box kept: synchronisation error at constant speed, and where it comes from."""

from twin.report.charts.sync import sync_chart
from twin.report.data import ReportData
from twin.report.scale import number
from twin.report.sections.section import Section, Tab

LINES = 6
"""of the spectrum that are listed"""


def sync_section(report: ReportData) -> Section | None:
    """Draw error and orders; None where the work never made a whole turn in sync at constant speed."""
    found = report.recording.sync_spectrum if report.recording else None
    if found is None:
        return None
    return Section(
        name="sync",
        tab=Tab.ANALYSIS,
        title="Synchronisation of the gear box",
        values={
            "head": (
                ("Work", f"{number(abs(found.work_rpm), 3)} rpm"),
                ("Tool", f"{number(abs(found.tool_rpm), 3)} rpm"),
                ("At", f"{number(found.begin_s, 1)} to {number(found.end_s, 1)} s"),
                ("Mean", f"{number(found.mean_arcsec, 2)}″"),
                ("rms about it", f"{number(found.rms_arcsec, 3)}″"),
                ("Peak to valley", f"{number(found.peak_to_peak_arcsec, 3)}″"),
            ),
            "chart": sync_chart(found),
            "lines": [
                (number(order, 2), number(per_tool, 3), number(amplitude, 3))
                for order, per_tool, amplitude in found.strongest(LINES)
            ],
        },
    )
