"""What an inspection found. Lengths in mm, deviations in µm, angles in degrees; None = not measurable."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal

Floats = NDArray[np.float64]


class Verdict(Enum):
    """The judgement against the nominal."""

    IN = "in"
    OUT = "out"
    NOT_GRADED = "not_graded"


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """One curve evaluated about its least-squares line and parabola."""

    slope_um: float
    """rise of the line over the evaluated range"""
    form_um: float
    """band along the line"""
    total_um: float
    """range of the deviation"""
    crowning_um: float
    """height of the parabola's middle over its ends, + = barrelled"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wave:
    """One order of the waviness."""

    order: int
    """waves per turn of the gear"""
    amplitude_um: float
    """half of peak to valley"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trace:
    """One deviation trace along one flank, normal to it in the transverse plane."""

    tooth: int
    """from 1, clockwise from the one nearest C0"""
    position: Floats
    """(m,) roll length [mm] of a profile trace, z [mm] of a helix trace"""
    deviation_um: Floats
    """(m,) + = material outside the nominal flank"""
    evaluation: tuple[float, float]
    """evaluated range of `position`"""
    slope_um: float
    """rise of the mean line over the evaluated range: + = material towards the tip, + = larger |helix angle|
    (right-hand on a spur gear)"""
    form_um: float
    """band along the mean line"""
    total_um: float
    """range of the deviation"""
    crowning_um: float = math.nan
    """C_alpha or C_beta by a second-order fit, + = barrelled"""
    filtered: Figures | None = None
    """the same behind the Gaussian low-pass filter"""
    facets: Figures | None = None
    """the same of what the mesh's chords alone put into the trace"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Flank:
    """All left or all right flanks of a gear.

    Slopes and crownings are signed means over the traces, the others the largest.
    """

    profile: tuple[Trace, ...]
    helix: tuple[Trace, ...]
    pitch_um: Floats
    """(z,) single pitch deviation on the measuring circle, from each tooth to the next; NaN: no flank"""
    cumulative_um: Floats
    """(z,) place of each flank against tooth 1, + = further on in the sense of numbering"""
    profile_slope_um: float | None
    profile_form_um: float | None
    profile_total_um: float | None
    helix_slope_um: float | None
    helix_form_um: float | None
    helix_total_um: float | None
    single_pitch_um: float | None
    cumulative_pitch_um: float | None
    profile_crowning_um: float | None = None
    """C_alpha"""
    helix_crowning_um: float | None = None
    """C_beta"""
    filtered: Mapping[str, float | None] = field(default_factory=dict)
    """field of a profile or helix figure -> its value behind the Gaussian filter"""
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    """field -> how much of it the mesh's own facets can make [µm]"""
    profile_waviness: tuple[Wave, ...] = ()
    """largest orders, largest first"""
    helix_waviness: tuple[Wave, ...] = ()
    """none on a spur gear: all points of a trace share one rotation angle"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GearResult:
    """A gear as found, and against its nominal."""

    number_of_teeth: int
    normal_module_mm: float
    helix_angle_deg: float
    hand: str
    """"spur" | "right" | "left" """
    lead_mm: float | None
    """None for a spur gear"""
    profile_shift: float
    """x of the tooth thickness found, for the module found"""
    tip_diameter_mm: float
    root_diameter_mm: float
    span_teeth: int | None
    span_mm: float | None
    pin_diameter_mm: float | None
    """of the balls"""
    over_pins_mm: float | None
    """mean over opposite balls"""
    runout_um: float | None
    """F_r, range of the depth of a ball in every gap"""
    flank_offset_um: float | None
    """how far all flanks lie outside the reference's on average, normal to them: too thick a tooth is +"""
    left: Flank
    right: Flank
    reference: GearNominal
    """what the traces are measured against: the given nominal, or the best fit where none was given"""
    profile_range_mm: tuple[float, float]
    """diameters between which profiles are evaluated"""
    teeth_range_mm: tuple[float, float]
    """z between which the teeth have their full depth"""
    measuring_plane_mm: float
    """z of profile and pitch measurement"""
    phase_deg: float
    """angle of tooth 1's centre in that plane"""
    accuracy_class: dict[str, int | None] = field(default_factory=dict)
    """class reached per item and "overall"; None = worse than 11 or outside the standard's range"""
    accuracy_class_filtered: dict[str, int | None] = field(default_factory=dict)
    """the same by the filtered values"""
    tolerances_um: dict[str, float] = field(default_factory=dict)
    """per item, of the nominal's class"""
    tooth_thickness_mm: float | None = None
    """s_n, normal to the teeth along the reference circle, mean of all"""
    chordal_thickness_mm: float | None = None
    """its chord, as a tooth caliper reads it"""
    chordal_height_mm: float | None = None
    """of the tip over that chord, where the caliper is set"""
    form_diameter_mm: float | None = None
    """where the usable flank begins"""
    tip_form_diameter_mm: float | None = None
    """where it ends: at a tip chamfer, or at the tip"""
    undercut: bool = False
    """below the usable flank material is lacking"""
    chamfered: bool = False
    """the flanks end below the tips"""
    helix_range_mm: tuple[float, float] | None = None
    """z between which helices are evaluated"""
    ball_depth_um: Floats = field(default_factory=lambda: np.zeros(0))
    """(z,) how far out a ball lies in the gap behind each tooth, clockwise, against the mean; empty where
    balls were not measured"""
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    """field -> how much of it the mesh's own facets can make, in the unit of the field"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """One face of a polygon, from its least-squares plane."""

    direction_deg: float
    """of its outward normal at mid-length, from the part's +X counter-clockwise"""
    distance_mm: float
    """of the least-squares plane from the axis"""
    width_mm: float
    """from edge to edge"""
    mid_distance_mm: float
    """of the middle of the face from the axis"""
    bow_um: float
    """+ convex"""
    flatness_um: float
    twist_deg_per_mm: float
    """+ right-hand"""


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonResult:
    """A polygon as found."""

    number_of_sides: int
    across_flats_mm: float
    """mean width at mid-face: opposed least-squares planes, plus what the faces bow out there"""
    across_flats_planes_mm: float
    """mean width between opposed plain least-squares planes"""
    across_flats_caliper_mm: float | None
    """largest width as a caliper's parallel jaws read it; None where no face stands opposite another"""
    across_flats_caliper_least_mm: float | None
    """smallest width so read"""
    across_corners_mm: float
    """mean"""
    across_corners_least_mm: float
    """smallest"""
    bow_um: float
    """mean height of the middle of the faces over the chord from edge to edge, + convex"""
    flatness_um: float
    """largest of the faces, about their least-squares planes, twist taken out"""
    twist_deg_per_mm: float
    """of whole sections over the length, + right-hand"""
    hand: str
    """"none" | "right" | "left" """
    concentricity_um: float
    """diameter of the zone about the work axis that holds the axis of the faces"""
    angles_deg: Floats
    """(n,) between each face and the next"""
    faces: tuple[Face, ...]
    """counter-clockwise from the one nearest C0"""
    range_mm: tuple[float, float]
    """z between which the faces have their full depth"""
    section: Floats
    """(m, 2) outline at mid-length [mm]"""
    reference: PolygonNominal | None
    flatness_class: str | None = None
    """H, K or L of ISO 2768-2 that the flatness holds; "worse" than L or beyond its table"""
    flatness_limits_um: Mapping[str, float] = field(default_factory=dict)
    """H, K, L of ISO 2768-2 for the longest side of the faces"""
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    """field -> how much of it the mesh's own facets can make, in the unit of the field"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """The part's own axis, as found and taken out before measuring."""

    datum: str
    """"bore" | "tip circle" | "corners" """
    diameter_mm: float
    """of the cylinder through it"""
    at_z_mm: float
    """height at which `x_mm` and `y_mm` hold: the middle of the datum"""
    x_mm: float
    y_mm: float
    tilt_x_deg: float
    """lean of the axis towards +X as z rises"""
    tilt_y_deg: float
    """towards +Y"""
    roundness_um: float
    """range of the datum's points about the cylinder"""

    @property
    def offset_mm(self) -> float:
        """Distance from the mesh's Z axis at `at_z_mm`."""
        return math.hypot(self.x_mm, self.y_mm)

    @property
    def tilt_deg(self) -> float:
        """Angle with the mesh's Z axis."""
        along = (math.tan(math.radians(lean)) for lean in (self.tilt_x_deg, self.tilt_y_deg))
        return math.degrees(math.atan(math.hypot(*along)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Inspection:
    """The result of one inspection: a gear, a polygon, or a reason why it is neither."""

    gear: GearResult | None = None
    polygon: PolygonResult | None = None
    nominal: Nominal | None = None
    axis: Axis | None = None
    """where one was looked for"""
    verdict: Verdict = Verdict.NOT_GRADED
    findings: tuple[str, ...] = ()
    """sentences: why the verdict is what it is, most important first"""
    reason: str = ""
    """why kind is null, where it is"""
    unmeasured: dict[str, str] = field(default_factory=dict)
    """result key -> why it is null"""

    @property
    def kind(self) -> str | None:
        """`gear`, `polygon` or None."""
        return "gear" if self.gear else "polygon" if self.polygon else None
