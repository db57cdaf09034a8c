"""The tooth of a hob by catalogue data: the negative of a basic rack (DIN 3972, ISO 53), as a chain."""

import math
from dataclasses import dataclass

from twin.errors import InputError

Chain = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RackTooth:
    """A symmetric straight-flanked tooth in the plane of its cutting edge. Lengths in mm, angles in rad."""

    width: float
    """on the reference line"""
    flank_angle: float
    """of the flank against the radial direction"""
    addendum: float
    """from the reference line up to the tip"""
    dedendum: float
    """down to the land"""
    tip_radius: float
    protuberance: float = 0.0
    """how far the tip stands out of the flank drawn on, at right angles to it"""
    protuberance_angle: float = 0.0
    """of the protuberance's own flank"""
    chamfer_height: float = 0.0
    """of the chamfer on the gear's tip, above the land"""
    chamfer_angle: float = 0.0
    """of the chamfer's flank"""

    def chain(self) -> Chain:
        """(half-width, depth below the tip[, radius of the arc to the next]) from the tip to the land.

        Raises InputError where the tip radius, the protuberance or the chamfer does not fit the tooth.
        """
        points = [*self._tip(), *self._foot()]
        return tuple(points)

    def _flank(self, depth: float) -> float:
        """Half-width of the flank, drawn on."""
        return self.width / 2.0 + (depth - self.addendum) * math.tan(self.flank_angle)

    def _tip(self) -> list[tuple[float, ...]]:
        """Flat, arc and protuberance, as far as the flank."""
        r, alpha, beta = self.tip_radius, self.flank_angle, self.protuberance_angle
        own = beta if self.protuberance else alpha
        # the arc touches a line parallel to the flank, the protuberance out of it
        flat = self._flank(r) + (self.protuberance - r) / math.cos(alpha)
        if flat < -1e-9:
            raise InputError(
                f"a tip radius of {r:.4g} mm leaves the tooth no tip",
                remedy=f"valid: 0 to {self._largest_radius():.4g} mm",
            )
        flat = max(flat, 0.0)
        # where the arc ends and its own flank begins
        end = flat + r * math.cos(own), r * (1.0 - math.sin(own))
        points: list[tuple[float, ...]] = [(flat, 0.0, r), end] if r else [(flat, 0.0)]
        if self.protuberance:
            way = (end[0] - self._flank(end[1])) / (math.tan(alpha) - math.tan(beta))
            points.append((end[0] + way * math.tan(beta), end[1] + way))
            if points[-1][1] > self.addendum:
                raise InputError(
                    f"the protuberance of {self.protuberance:g} mm reaches below the reference line",
                    remedy="a smaller protuberance_mm or a smaller protuberance_angle_deg",
                )
        return points

    def _largest_radius(self) -> float:
        alpha = self.flank_angle
        room = self._flank(0.0) * math.cos(alpha) + self.protuberance
        return max(room / (1.0 - math.sin(alpha)), 0.0)

    def _foot(self) -> list[tuple[float, ...]]:
        """The flank's end on the land, or the chamfer."""
        land = self.addendum + self.dedendum
        if not self.chamfer_height:
            return [(self._flank(land), land)]
        begin = land - self.chamfer_height
        if begin <= self.addendum:
            raise InputError(
                f"chamfer_height_mm {self.chamfer_height:g} reaches above the reference line",
                remedy=f"valid: less than {self.dedendum:g}",
            )
        wide = self._flank(begin) + self.chamfer_height * math.tan(self.chamfer_angle)
        return [(self._flank(begin), begin), (wide, land)]
