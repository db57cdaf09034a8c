"""The polygon-turning head: inserts with straight edges parallel to the tool axis (geometry.md 3)."""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from msgspec import Meta

from twin.cutters.cutter import Cutter
from twin.cutters.profile import ToothProfile
from twin.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonHead:
    """A cutter head whose axis is parallel to the work's."""

    inserts: Annotated[int, Meta(ge=1, le=100)]
    """P"""
    tip_radius_mm: Annotated[float, Meta(gt=0)]
    """R"""
    edge_width_mm: Annotated[float, Meta(gt=0)] = 2.0
    corner_radius_mm: Annotated[float, Meta(ge=0)] = 0.0

    def __post_init__(self) -> None:
        if 2.0 * self.corner_radius_mm > self.edge_width_mm:
            raise InputError(
                f"corner_radius_mm {self.corner_radius_mm:g} is more than half of edge_width_mm "
                f"{self.edge_width_mm:g}",
                remedy=f"valid: 0 to {self.edge_width_mm / 2:g}",
            )

    def cutter(self) -> Cutter:
        """The head with insert 0 at tool angle 0."""
        return Cutter(
            gash_angle=2.0 * math.pi * np.arange(self.inserts) / self.inserts,
            gash_shift=np.zeros(self.inserts),
            profile=ToothProfile(
                tip=self.tip_radius_mm,
                corner_s=self.edge_width_mm / 2.0 - self.corner_radius_mm,
                corner_radius=self.corner_radius_mm,
                flank_angle=0.0,
                root=-math.inf,
                pitch=math.inf,
            ),
            half_length=math.inf,
            shift=0.0,
            swivel=0.0,
        )
