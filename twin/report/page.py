"""`report.html`: one file that opens anywhere, without network, and prints."""

import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from twin.errors import InputError, Place
from twin.report.data import ReportData
from twin.report.scale import number
from twin.report.sections import SECTIONS, Section, Tab

ASSETS = Path(__file__).parent / "assets"
STYLES = ("base.css", "charts.css")
PRINT = "print.css"
"""comes last: it has the last word"""
SCRIPT = "tabs.js"
"""comes last: the others hear which page it shows first"""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufffe\uffff]")
_SYMBOL = re.compile(r"\b([fF])_(H[αβ]|f[αβ]|[αβpr])\b(?!\.\w)")
_SUBSCRIPT = re.compile(r"_\{([^}]*)\}")


def write_report(path: Path, report: ReportData) -> None:
    """Write the page; InputError where the file cannot be written."""
    try:
        path.write_text(render(report), encoding="utf-8", errors="replace")
    except OSError as error:
        raise InputError(f"cannot write the report: {error.strerror}", place=Place(file=str(path))) from error


def render(report: ReportData) -> str:
    """Return the page as HTML."""
    # numpy leaves the interpreter free most of the time: the sections are built beside one another
    with ThreadPoolExecutor(2) as pool:
        built = list(pool.map(lambda build: build(report), SECTIONS))
    sections = [section for section in built if section is not None]
    tabs = [
        (tab, [(section, _set(section)) for section in sections if section.tab is tab])
        for tab in Tab
        if any(section.tab is tab for section in sections)
    ]
    html = _ENVIRONMENT.get_template("page.html").render(
        title=report.title,
        tabs=tabs,
        css=_joined((*STYLES, *_beside(sections, "css"), PRINT)),
        running_title=Markup(_css_string(report.title)),
        script=_joined((*_beside(sections, "js"), SCRIPT)),
    )
    return _CONTROL.sub("\ufffd", html)


def _set(section: Section) -> Markup:
    """The inside of a section."""
    return Markup(_ENVIRONMENT.get_template(f"sections/{section.name}.html").render(section.values))


def _beside(sections: list[Section], kind: str) -> list[str]:
    """Style sheets or scripts that sections bring along."""
    names = (f"sections/{section.name}.{kind}" for section in sections)
    return [name for name in names if (ASSETS / name).exists()]


def _joined(names: tuple[str, ...]) -> Markup:
    return Markup("\n".join((ASSETS / name).read_text(encoding="utf-8") for name in names))


def _symbols(text: str) -> Markup:
    """Text for HTML, the symbols of deviations in it with what follows `_` as subscript: f_Hα, F_p."""
    return Markup(_SYMBOL.sub(r"\1<sub>\2</sub>", str(escape(text))))


def _css_string(text: str) -> str:
    """A CSS string that ends nothing but itself: every character but letters and digits escaped."""
    return '"' + "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):x} " for c in text) + '"'


def lowered(text: str) -> Markup:
    """Text for HTML, what stands in `_{…}` as subscript."""
    return Markup(_SUBSCRIPT.sub(r"<sub>\1</sub>", str(escape(text))))


_ENVIRONMENT = Environment(
    loader=PackageLoader("twin.report", "assets"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
_ENVIRONMENT.globals["number"] = number
_ENVIRONMENT.filters["lowered"] = lowered
_ENVIRONMENT.filters["symbols"] = _symbols
