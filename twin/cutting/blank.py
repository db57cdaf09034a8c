"""The blank: a turned body about the z axis, which may have been cut before."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from twin.cutting.section import Section
from twin.errors import InputError

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Blank:
    """A turned blank from z = 0 (front face) to z = −length.

    Raises InputError for an outline that is no turned body of that size.
    """

    diameter_mm: float
    """its largest"""
    length_mm: float
    bore_mm: float = 0.0
    profile: tuple[tuple[float, float], ...] | None = None
    """(z, diameter) [mm] of its steps, cones and chamfers from the front face on; None = a cylinder"""
    section: Section | None = None
    """of a blank that has gaps already; None = it is round"""

    def __post_init__(self) -> None:
        sizes = self.diameter_mm, self.length_mm, self.bore_mm
        if not (all(math.isfinite(size) for size in sizes) and min(sizes[:2]) > 0 and self.bore_mm >= 0):
            raise InputError(
                f"no blank of diameter {self.diameter_mm:g} mm, length {self.length_mm:g} mm, "
                f"bore {self.bore_mm:g} mm"
            )
        if self.bore_mm >= self.diameter_mm:
            raise InputError(f"bore_mm {self.bore_mm:g} is not inside diameter_mm {self.diameter_mm:g}")
        if self.profile is not None:
            self._check(self.profile)

    @property
    def radius(self) -> float:
        """Outer radius [mm]."""
        return self.diameter_mm / 2.0

    @property
    def z_range(self) -> tuple[float, float]:
        """Lowest and highest z [mm]."""
        return -self.length_mm, 0.0

    def steps(self) -> Floats:
        """(n, 2) of (z, outer radius) from the front face to the back [mm]."""
        profile = self.profile or ((0.0, self.diameter_mm), (-self.length_mm, self.diameter_mm))
        return np.array(profile, dtype=np.float64) * [1.0, 0.5]

    def outline(self) -> Floats:
        """(n, 2) of (r, z), counter-clockwise; r = 0 where it reaches the axis."""
        low, high = self.z_range
        inner = self.bore_mm / 2.0
        return np.vstack([[inner, low], self.steps()[::-1, ::-1], [inner, high]])

    def outer_radius(self, z: Floats) -> Floats:
        """Of the section at z between the faces [mm]; at a step, that of one of its sides."""
        at, radius = self.steps()[::-1].T
        return np.interp(z, at, radius)

    def least_radius(self, low: Floats, high: Floats) -> Floats:
        """The smallest outer radius between two heights, lower and higher ones of one shape [mm]."""
        least = np.minimum(self.outer_radius(low), self.outer_radius(high))
        for z, radius in self.steps():
            np.minimum(least, radius, out=least, where=(low <= z) & (z <= high))
        return least

    def contains(self, points: Floats) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie strictly inside."""
        r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        low, high = self.z_range
        inside = (r < self.outer_radius(z)) & (2.0 * r > self.bore_mm) & (z > low) & (z < high)
        return inside if self.section is None else inside & self.section.contains(points)

    def _check(self, profile: tuple[tuple[float, float], ...]) -> None:
        if len(profile) < 2:
            raise InputError("a blank's profile needs at least two points", remedy="[[z, diameter], …] in mm")
        if not all(math.isfinite(value) for point in profile for value in point):
            raise InputError("the blank's profile has a number that is not finite")
        for number, ((z0, d0), (z1, d1)) in enumerate(pairwise(profile), start=1):
            if z1 > z0:
                raise InputError(
                    f"the blank's profile runs back from z {z0:g} to {z1:g} mm between its points {number} "
                    f"and {number + 1}",
                    remedy="valid: from the front face, z = 0, towards the chuck",
                )
            if z1 == z0 and d1 == d0:
                raise InputError(f"points {number} and {number + 1} of the blank's profile are the same")
        for (z0, _), (z1, _), (z2, _) in zip(profile, profile[1:], profile[2:], strict=False):
            if z0 == z1 == z2:
                raise InputError(f"three points of the blank's profile stand at z {z0:g} mm")
        if profile[0][0] != 0:
            raise InputError(
                f"the blank's profile begins at z {profile[0][0]:g} mm", remedy="valid: 0, the front face"
            )
        least, largest = min(d for _, d in profile), max(d for _, d in profile)
        if least <= self.bore_mm:
            raise InputError(
                f"the blank's profile has a diameter of {least:g} mm",
                remedy=f"valid: more than the bore, {self.bore_mm:g} mm",
            )
        for name, said, found in (
            ("diameter_mm", self.diameter_mm, largest),
            ("length_mm", self.length_mm, -profile[-1][0]),
        ):
            if not math.isclose(said, found, rel_tol=1e-12):
                raise InputError(
                    f"{name} {said:g} contradicts the blank's profile, which says {found:g}",
                    remedy=f"without {name}",
                )
