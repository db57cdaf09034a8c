"""`[faults]` of a job: what is wrong, in the terms of whoever measures it."""

from dataclasses import dataclass, field
from typing import Annotated

from msgspec import Meta

NotNegative = Annotated[float, Meta(ge=0)]
Small = Annotated[float, Meta(ge=0, le=1)]
Tilt = Annotated[float, Meta(gt=-10, lt=10)]


@dataclass(frozen=True, slots=True, kw_only=True)
class SlideTilt:
    """How far the way of the Z slide leans from the work axis: the tool comes off it as it moves to +Z."""

    xz: Tilt = 0.0
    """towards +X, in the X-Z plane"""
    yz: Tilt = 0.0
    """towards +Y, in the Y-Z plane"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Faults:
    """`[faults]`: all nought on a machine without fault.

    Phases of the work count from the part's +X, which points to the tool at C0, counter-clockwise seen
    from +Z; angles of the hob from its first gash, in its positive sense of rotation.
    """

    work_eccentricity_mm: NotNegative = 0.0
    """the blank's own axis off the work spindle's, in the middle of the blank's length"""
    work_eccentricity_phase_deg: float = 0.0
    """where the blank's axis stands from the spindle's"""
    band_out_of_round_mm: Small = 0.0
    """range of the reference bands' radius about the turn; only a touch probe sees it"""
    band_lobes: Annotated[int, Meta(ge=2, le=100)] = 2
    """waves of it about the turn"""
    band_lobes_phase_deg: float = 0.0
    """where a crest stands"""
    work_tilt_deg: Tilt = 0.0
    """the blank's own axis against the work spindle's; both meet in the middle of the blank's length"""
    work_tilt_phase_deg: float = 0.0
    """to which side the blank's front end leans"""
    hob_runout_mm: Small = 0.0
    """e_h: the hob's own axis beside the tool spindle's, parallel to it; a dial reads twice that"""
    hob_runout_angle_deg: float = 0.0
    """where on the hob it stands out the most"""
    hob_wobble_mm: Small = 0.0
    """the hob's own axis leans against the tool spindle's and crosses it in the hob's middle: how far a point
    on its outside diameter swings along the axis, to each side"""
    hob_wobble_angle_deg: float = 0.0
    """to which side of the hob the positive end of its axis leans"""
    hob_gash_error_deg: tuple[Tilt, ...] = ()
    """how far each rake face stands ahead of its place, in the positive sense of rotation"""
    hob_lead_error_um_per_turn: float = 0.0
    """how much longer the thread's lead is"""
    swivel_error_deg: Tilt = 0.0
    """the tool carrier swivelled that much more than it was set to"""
    encoder_cyclic_arcsec: dict[str, float] = field(default_factory=dict)
    """rotary axis -> amplitude A: at angle θ its encoder reads θ + A sin(order θ)"""
    encoder_cyclic_order: dict[str, Annotated[int, Meta(ge=1, le=100_000)]] = field(default_factory=dict)
    """rotary axis -> waves per turn; 1 where it is left out"""
    x_drift_um_per_min: float = 0.0
    """how fast the tool moves off the work along X, unseen by the encoder, from the program's start on"""
    slide_tilt_deg: SlideTilt = field(default_factory=SlideTilt)
    """of the Z slide's way; size is held in the middle of the blank's length"""
