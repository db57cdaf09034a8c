"""What a job.toml may say, table by table. Lengths in mm, angles in degrees."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

from msgspec import Meta

import models
from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.errors import Place
from twin.faults.table import Faults
from twin.grinding.precut import PrecutGear
from twin.inspection.nominal import Nominal
from twin.job.expect import Expectation
from twin.job.locate import line_of
from twin.load.material import Physics
from twin.probing.probe import Probe

MODELS = Path(models.__file__).parent
Positive = Annotated[float, Meta(gt=0)]
Size = Annotated[float, Meta(ge=0.1, le=5000.0)]
"""of a body of the machine"""
NotNegative = Annotated[float, Meta(ge=0)]
Tool = Hob | PolygonHead | DiscWheel


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineTable:
    """`[machine]`"""

    model: str = "hobbing_lathe"
    """a folder of `models/`; with a slash, as `./my_lathe`, a folder from the job's own on"""
    setup: Literal["hobbing", "tilted"] = "hobbing"
    parameters: dict[str, int | float | str] = field(default_factory=dict)
    """controller parameters: number, #bit, .axis"""
    signals: dict[str, bool | Annotated[int, Meta(ge=0, le=1)]] = field(default_factory=dict)
    """input signals from the start"""
    control_period_s: float | None = None
    """in place of the model's"""
    physics_step_s: float | None = None
    drives: dict[str, dict[str, float | str]] = field(default_factory=dict)
    """joint -> key of machine.toml -> value in place of the model's"""
    mounts: dict[str, float] = field(default_factory=dict)
    """the same of what carries tool and work"""

    def changes(self) -> dict[str, Any]:
        """What the job changes of the model's parameter file, laid out as the file is."""
        periods = {"control_period_s": self.control_period_s, "physics_step_s": self.physics_step_s}
        tables = {"drives": self.drives, "mounts": self.mounts}
        return {k: v for k, v in periods.items() if v is not None} | {k: v for k, v in tables.items() if v}


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkTable:
    """`[work]`: the blank, from Z0 (front face) to Z-length"""

    diameter_mm: Positive
    """the largest; with a profile it may be left out, and so may the length"""
    length_mm: Positive
    bore_mm: NotNegative = 0.0
    profile: tuple[tuple[float, float], ...] | None = None
    """[[z, diameter], …] of steps, cones and chamfers, from the front face (z = 0) on"""
    gear: PrecutGear | None = None
    """gaps that were cut before; None = a turned blank"""
    material: str = "16MnCr5"
    clamping: Literal["arbor", "chuck"] = "arbor"
    arbor_diameter_mm: Positive | None = None
    """left out = 0.6 of the root diameter"""
    stick_out_mm: Positive | None = None
    """front face from the chuck's face; left out = length + 80"""

    def blank(self) -> Blank:
        """The body to be cut. Raises InputError where it contradicts itself."""
        return Blank(
            diameter_mm=self.diameter_mm,
            length_mm=self.length_mm,
            bore_mm=self.bore_mm,
            profile=self.profile,
            section=self.gear.section(self.diameter_mm / 2.0) if self.gear else None,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """`[setup] reference`: part coordinates of machine zero"""

    X: float = 400.0
    """diameter at the tool tip"""
    Z: float = 300.0
    """tool centre from the front face"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tailstock:
    """`[setup] tailstock`: a live centre in the front face, on a quill"""

    hole_diameter_mm: Size | None = None
    """where the cone enters the front face; left out = 8, or 2 more than the bore"""
    point_angle_deg: Annotated[float, Meta(ge=20, le=120)] = 60.0
    """of the whole cone"""
    centre_diameter_mm: Size = 30.0
    """behind the cone"""
    centre_length_mm: Size = 40.0
    """from the cone's end to the quill"""
    quill_diameter_mm: Size = 60.0
    quill_length_mm: Size = 150.0
    """up to the barrel, which is twice as thick"""

    def hole(self, bore_mm: float) -> float:
        """Diameter of the centre hole in a part with this bore [mm]."""
        return self.hole_diameter_mm or max(8.0, bore_mm + 2.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SetupTable:
    """`[setup]`"""

    reference: Reference = field(default_factory=Reference)
    tailstock: Tailstock | None = None
    offsets: dict[str, dict[str, float]] = field(default_factory=dict)
    """G54 … G59 -> axis -> machine coordinate of the part zero; replaces the preset"""
    tool_offsets: dict[str, dict[str, float]] = field(default_factory=dict)
    """T number -> axis -> offset; replaces the preset"""


@dataclass(frozen=True, slots=True, kw_only=True)
class InspectionTable:
    """`[inspection]`"""

    datum: Literal["band", "spindle", "fit"] = "band"
    """measured about the blank's own axis, about the axis it turned about, or about the axis of its bore, or
    else its tips, as found on the part"""


@dataclass(frozen=True, slots=True, kw_only=True)
class EventTable:
    """One of `[[events]]`: what the operator does, and when"""

    do: str
    """as `feed hold`, `feed override 80`, `jog Z -5.0`"""
    time_s: NotNegative | None = None
    """from the start of the program; this or `line`"""
    line: Annotated[int, Meta(ge=1)] | None = None
    """when the block of this line of the program begins"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """A whole job: machine, blank, tools, program, and what the part should be."""

    name: str
    path: Path
    """of job.toml"""
    machine: MachineTable
    work: WorkTable
    setup: SetupTable
    tools: dict[int, Tool]
    """by T number; a single `[tool]` has number 0 and is mounted without a T word"""
    program: Path
    nominal: Nominal | None
    inspection: InspectionTable
    faults: Faults = field(default_factory=Faults)
    probe: Probe | None = None
    """the touch probe, where the machine has one"""
    physics: Physics = field(default_factory=Physics)
    events: tuple[EventTable, ...] = ()
    expect: tuple[Expectation, ...] = ()
    """what a run must come to"""

    @property
    def model_folder(self) -> Path:
        """Of the machine model: one of ours, or one from the job's folder on."""
        model = self.machine.model
        return (self.path.parent if "/" in model else MODELS) / model

    def place(self, *path: str) -> Place:
        """Where a key stands in the job file, for messages found after reading it."""
        text = self.path.read_text(encoding="utf-8")
        return Place(file=str(self.path), line=line_of(text, path))
