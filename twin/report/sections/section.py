"""What a section of the page is."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum


class Tab(Enum):
    """Sheets of the page on a screen, in their order; in print they follow one another."""

    OVERVIEW = "Overview"
    """the verdict and what was measured"""
    PART = "Part"
    """in three dimensions, and its flanks unrolled"""
    SHEET = "Inspection sheet"
    """in the layout of measuring machines"""
    PROCESS = "Program and motion"
    """what the machine did, and when"""
    ANALYSIS = "Analysis"
    """why the part came out so: faults, budget, loads, compensation"""
    ORIGIN = "Origin"
    """job and provenance"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """One section, ready to be set.

    Its template is `assets/sections/<name>.html`, which sees `values` by their names and the macros of
    `assets/macros.html`; a style sheet or a script of the same name beside it is taken along.
    """

    name: str
    """of its files, and its anchor on the page"""
    tab: Tab
    title: str
    """its heading; none where empty"""
    values: Mapping[str, object] = field(default_factory=dict)
    own_page: bool = False
    """begins a page in print"""
