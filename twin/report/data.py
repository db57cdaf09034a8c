"""All that a report shows, as plain values: the caller fills it in, `write_report` only lays it out."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import PurePath

import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Floats, Inspection
from twin.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One line of a two-column table."""

    label: str
    value: str


class Severity(Enum):
    """How much a message weighs."""

    ALARM = "alarm"
    """stopped the program"""
    WARNING = "warning"
    """did not"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """An alarm or a warning with its place in the program."""

    severity: Severity
    number: str
    """for example "PS0005" """
    text: str
    file: str = ""
    line: int | None = None
    """from 1"""
    column: int | None = None
    """from 1, in characters"""
    found: str = ""
    """what stood or happened there"""
    remedy: str = ""
    """what would have been valid"""

    @property
    def place(self) -> str:
        """`file:line:column`, as far as known."""
        return self._placed(self.file)

    @property
    def short_place(self) -> str:
        """The same without the folders of the file."""
        return self._placed(PurePath(self.file).name if self.file else "")

    def _placed(self, file: str) -> str:
        return ":".join(str(part) for part in (file, self.line, self.column) if part not in ("", None))


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """The cut part as a mesh in the part frame: Z = work axis, origin in the front face, material at z <= 0.

    Raises ValueError where the arrays do not fit together.
    """

    vertices: Floats
    """(n, 3) [mm], finite"""
    faces: NDArray[np.integer]
    """(m, 3) indices into `vertices`, counter-clockwise seen from outside"""
    deviation_um: Floats
    """(n,) + = material outside the nominal; NaN = not on a measured face"""
    face_time_s: Floats = field(default_factory=lambda: np.zeros(0))
    """(m,) when each face was cut, in the recording's time; NaN = never, as the blank's own skin; (0,) where
    nobody knows"""

    def __post_init__(self) -> None:
        n = len(self.vertices)
        if self.vertices.shape != (n, 3) or not np.isfinite(self.vertices).all():
            raise ValueError(f"part vertices: expected finite (n, 3), got shape {self.vertices.shape}")
        if self.faces.shape != (len(self.faces), 3):
            raise ValueError(f"part faces: expected (m, 3), got shape {self.faces.shape}")
        if len(self.faces) and (self.faces.min() < 0 or self.faces.max() >= n):
            raise ValueError(f"part faces: indices must lie in 0 … {n - 1}")
        if self.deviation_um.shape != (n,):
            raise ValueError(f"part deviation_um: expected ({n},), got shape {self.deviation_um.shape}")
        if self.face_time_s.shape not in ((0,), (len(self.faces),)):
            raise ValueError(
                f"part face_time_s: expected ({len(self.faces)},) or (0,), got shape {self.face_time_s.shape}"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Program:
    """One NC program as the controller read it."""

    name: str
    """of the file, as messages and the recording's blocks have it"""
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolOutline:
    """The cylinder about a tool."""

    number: int
    radius_mm: float
    half_length_mm: float
    """inf where it is longer than any cut needs"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Two bodies of the machine that touched, and everything about them that can."""

    bodies: tuple[str, str]
    point: Floats
    """(3,) [mm] in the part frame at C0"""
    shapes: tuple[tuple[str, Floats], ...]
    """body and corners (n, 3) [mm] of each convex shape"""
    found: str
    """the alarm's own words"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A picture made elsewhere, for example of the machine."""

    caption: str
    png: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportData:
    """Everything on the page. What is left out is said to be missing, never drawn empty."""

    title: str
    """name of the job"""
    job: tuple[Row, ...] = ()
    """what was asked for: machine, work, tool, program"""
    provenance: tuple[Row, ...] = ()
    """versions, hashes of the inputs, chunking"""
    timing: tuple[Row, ...] = ()
    """where the time of the run went"""
    recording: Recording | None = None
    rotary_axes: frozenset[str] = frozenset()
    """letters of the recording's axes that turn [deg]; the others slide [mm]"""
    messages: tuple[Message, ...] = ()
    """alarms and warnings, in the order in which they came"""
    part: Part | None = None
    inspection: Inspection = field(default_factory=Inspection)
    programs: tuple[Program, ...] = ()
    pictures: tuple[Picture, ...] = ()
    tools: tuple[ToolOutline, ...] = ()
    sync_error_arcsec: Floats | None = None
    """(n,) of the work against the tool, one a sample of the recording, NaN out of sync"""

    load: tuple[Row, ...] = ()
    """the cutting forces in figures; their course stands in the recording"""
    drive_limits: Mapping[str, float] = field(default_factory=dict)
    """by axis letter, what its drive has against them [N, N m]; nothing for axes that no force moves"""

    contact: Contact | None = None
    """where the run ended in a collision"""

    @property
    def solid_part(self) -> Part | None:
        """The part, where it has a face to show."""
        return self.part if self.part is not None and len(self.part.faces) else None
