"""The sections of the page: each a module with a function, and a template of the same name.

To add one: a module here whose function takes the `ReportData` and returns a `Section`, or None where there
is nothing to show; its line in `SECTIONS`; its template `assets/sections/<name>.html`.
"""

from collections.abc import Callable

from twin.report.data import ReportData
from twin.report.sections.contact import contact_section
from twin.report.sections.flanks import flanks_section
from twin.report.sections.load import load_section
from twin.report.sections.maps import maps_section
from twin.report.sections.measured import measured_section
from twin.report.sections.messages import messages_section
from twin.report.sections.origin import origin_section
from twin.report.sections.part import part_section
from twin.report.sections.pitch import pitch_section
from twin.report.sections.polygon import polygon_section
from twin.report.sections.process import process_section
from twin.report.sections.section import Section, Tab
from twin.report.sections.sync import sync_section
from twin.report.sections.verdict import verdict_section

Builder = Callable[[ReportData], Section | None]
SECTIONS: tuple[Builder, ...] = (
    verdict_section,
    measured_section,
    messages_section,
    contact_section,
    part_section,
    maps_section,
    flanks_section,
    pitch_section,
    polygon_section,
    process_section,
    sync_section,
    load_section,
    origin_section,
)
"""in the order in which they stand within their tabs; they are built beside one another"""

__all__ = ["SECTIONS", "Builder", "Section", "Tab"]
