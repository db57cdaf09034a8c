"""The disc wheel: a body of revolution that cuts all around, as a form grinding wheel (geometry.md 4)."""

import math
from dataclasses import dataclass, fields
from typing import Annotated

import numpy as np
from msgspec import Meta

from twin.cutters.convex import ConvexPiece
from twin.cutters.cutter import Cutter
from twin.cutters.profile import ToothProfile, tooth_profile
from twin.cutters.rack import Chain, RackTooth
from twin.errors import InputError

LEVEL = 1e-9
"""Slope below which a side runs straight towards the axis."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DiscWheel:
    """A wheel by its axial profile, or as the straight-sided tooth of a basic rack."""

    outside_diameter_mm: Annotated[float, Meta(gt=0)]
    normal_module_mm: Annotated[float, Meta(gt=0)] | None = None
    """of a straight-sided wheel; None = by its profile"""
    pressure_angle_deg: Annotated[float, Meta(ge=0, lt=80)] = 20.0
    """of the straight sides"""
    addendum_factor: Annotated[float, Meta(gt=0)] = 1.25
    """in modules: from the tip to where it is half a pitch wide"""
    dedendum_factor: Annotated[float, Meta(gt=0)] = 1.25
    """in modules: from there to the end of its sides"""
    tip_radius_factor: Annotated[float, Meta(ge=0)] = 0.38
    """in modules"""
    profile: Chain | None = None
    """(half-width, depth below the tip[, radius of the arc to the next]) [mm] in the plane through the axis,
    from the tip inwards, never narrower; radius + bulging, − hollow"""
    width_mm: Annotated[float, Meta(gt=0)] | None = None
    """of the body below the profile; None = as wide as the profile ends"""
    swivel_deg: Annotated[float, Meta(ge=-90, le=90)] | None = None
    """setting angle, as the operator set it; None = the nominal helix angle"""

    def __post_init__(self) -> None:
        if (self.profile is None) == (self.normal_module_mm is None):
            raise InputError("a disc_wheel has either its profile or normal_module_mm")
        if self.profile is not None:
            preset = {f.name: f.default for f in fields(self)}
            for name in ("pressure_angle_deg", "addendum_factor", "dedendum_factor", "tip_radius_factor"):
                if getattr(self, name) != preset[name]:
                    raise InputError(
                        f"{name} stands beside profile, which says it all", remedy=f"without {name}"
                    )
        self.outline()

    @property
    def breadth_mm(self) -> float:
        """Of the wheel where it is widest."""
        return 2.0 * self.outline().half_width

    def outline(self) -> ToothProfile:
        """Profile of the wheel. Raises InputError where it bounds no wheel."""
        chain = self._sides()
        tip = self.outside_diameter_mm / 2.0
        wide, deep = chain[-1][0], chain[-1][1]
        if self.width_mm is not None:
            if self.width_mm < 2.0 * wide - 1e-9:
                raise InputError(
                    f"width_mm {self.width_mm:g} is less than the profile's {2 * wide:.4g} mm",
                    remedy=f"valid: {2 * wide:.4g} or more",
                )
            if self.width_mm > 2.0 * wide + 1e-9:
                chain = (*chain, (self.width_mm / 2.0, deep))
        profile = tooth_profile(chain, tip=tip, land=False, chords=True)
        sides = [s for piece in profile.pieces if isinstance(piece, ConvexPiece) for s in piece.sides]
        if any(side.normal[1] < -LEVEL for side in sides):
            raise InputError(
                "the wheel gets narrower somewhere below its tip",
                remedy="valid: as wide or wider towards the axis",
            )
        return profile

    def cutter(self, swivel: float) -> Cutter:
        """The wheel with its plane at `swivel` [rad] to the work axis, + right-hand as a helix."""
        return Cutter(
            gash_angle=np.zeros(0),
            gash_shift=np.zeros(0),
            profile=self.outline(),
            half_length=math.inf,
            shift=0.0,
            swivel=math.pi / 2.0 - swivel,
            twist=0.0,
        )

    def _sides(self) -> Chain:
        if self.profile is not None:
            return self.profile
        module = self.normal_module_mm or 0.0
        return RackTooth(
            width=math.pi * module / 2.0,
            flank_angle=math.radians(self.pressure_angle_deg),
            addendum=self.addendum_factor * module,
            dedendum=self.dedendum_factor * module,
            tip_radius=self.tip_radius_factor * module,
        ).chain()
