"""The run and the part on one page: `write_report(path, report)`."""

from twin.report.data import (
    Message,
    Part,
    Picture,
    Program,
    ReportData,
    Row,
    Severity,
    ToolOutline,
)
from twin.report.page import write_report

__all__ = [
    "Message",
    "Part",
    "Picture",
    "Program",
    "ReportData",
    "Row",
    "Severity",
    "ToolOutline",
    "write_report",
]
