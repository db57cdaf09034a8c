"""The flanks of a gear as a feeler finds them on what the passes leave: no mesh, hence no facets."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.fields import Field
from twin.cutting.motion import RigidTransform
from twin.cutting.rays import crossings, depths
from twin.errors import PartError
from twin.inspection.flanks import TIP_LIMIT, usual_teeth
from twin.inspection.involute import Involute
from twin.inspection.reading import SENSES, Placed

Floats = NDArray[np.float64]

POINTS = 240
"""of a trace"""
SCANNED = 24
"""points about the axis to each pitch, where the teeth are looked for"""
PITCHES = 4
FARTHEST = 0.4
"""modules that a flank may stand off before its tooth counts as destroyed"""
UM = 1e3


@dataclass(frozen=True, slots=True, kw_only=True)
class Felt:
    """Deviations of left and right flanks along the tangent to the base circle [µm], + = material outside.

    NaN where nothing was felt. The gear is turned to the mean of all flanks.
    """

    gear: Involute
    phase: float
    """angle of tooth 1's centre at mid-face [rad]"""
    roll: Floats
    """(m,) roll lengths of the profiles [mm]"""
    height: Floats
    """(m,) z of the helices [mm]"""
    profile: Floats
    """(2, teeth traced, m)"""
    helix: Floats
    """(2, teeth traced, m)"""
    pitch: Floats
    """(2, z) of all flanks, clockwise, at mid-depth and mid-face"""
    offset: float
    """mean of all flanks [µm]"""


def feel(
    fields: tuple[Field, ...],
    gear: Involute,
    blank: Blank,
    *,
    datum: RigidTransform | None = None,
    phase: float = 0.0,
) -> Felt:
    """Feel the flanks of a gear that fills the blank's length; tooth 1 is the one nearest to `phase` [rad].

    `datum` takes the part frame to that of the measurement. Raises PartError where no teeth are to be found.
    """
    feeler = _Feeler(fields, datum or RigidTransform())
    low, high = blank.z_range
    middle = 0.5 * (low + high)
    pitch = 2 * math.pi / gear.teeth
    found = _phase(feeler, gear, middle)
    found -= pitch * round((found - phase) / pitch)
    placed = Placed(gear=gear, phase=found, middle=middle, low=low, high=high)
    every = np.arange(gear.teeth)
    at = gear.measuring_diameter / 2
    index = np.stack([feeler.way(placed, (every, side), (at, middle), FARTHEST) for side in SENSES])
    if not np.isfinite(index).all():
        missing = np.flatnonzero(~np.isfinite(index).all(axis=0))
        raise PartError(
            f"{len(missing)} of {gear.teeth} teeth have no flank within {FARTHEST:g} modules of its place"
        )
    turn = float(index[0].mean() - index[1].mean()) / 2
    placed = Placed(
        gear=gear, phase=placed.phase + turn / gear.base_radius, middle=middle, low=low, high=high
    )
    index -= np.array([[1.0], [-1.0]]) * turn
    start, end = (float(gear.roll_length(d)) for d in (gear.form_diameter, gear.tip_diameter))
    roll = np.linspace(start, start + TIP_LIMIT * (end - start), POINTS)
    height = np.linspace(*placed.helix_range, POINTS)
    traced = np.array(usual_teeth(gear.teeth))[:, None]
    reach = FARTHEST / 4
    return Felt(
        gear=gear,
        phase=placed.phase,
        roll=roll,
        height=height,
        profile=UM
        * np.stack([feeler.way(placed, (traced, s), (gear.radius_at(roll), middle), reach) for s in SENSES]),
        helix=UM * np.stack([feeler.way(placed, (traced, s), (at, height), reach) for s in SENSES]),
        pitch=UM * (index - index.mean()),
        offset=UM * float(index.mean()),
    )


class _Feeler:
    """Rays to nominal flanks, from the frame of the measurement into that of the part."""

    def __init__(self, fields: tuple[Field, ...], datum: RigidTransform) -> None:
        self._fields, self._datum = fields, datum

    def depths(self, points: Floats) -> Floats:
        """How deep points (n, 3) lie inside what is cut away [mm]."""
        return depths(self._fields, (points - self._datum.translation) @ self._datum.rotation)

    def way(
        self,
        placed: Placed,
        flank: tuple[NDArray[np.int64], float],
        place: tuple[Floats | float, Floats | float],
        reach: float,
    ) -> Floats:
        """How far [mm] flanks stand out of their places, tangent to the base circle.

        `flank` are teeth and side, `place` radius and z [mm], all of any shapes; `reach` in modules.
        """
        gear = placed.gear
        tooth, side = flank
        radius, z = place
        shape = np.broadcast_shapes(np.shape(tooth), np.shape(radius), np.shape(z))
        tooth, radius, z = (np.broadcast_to(v, shape).ravel() for v in (tooth, radius, z))
        angle = placed.phase - 2 * math.pi * tooth / gear.teeth + gear.twist * (z - placed.middle)
        angle = angle + side * gear.half_tooth(radius)
        points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])
        out = angle + side * (math.pi / 2 - np.arccos(np.minimum(gear.base_radius / radius, 1.0)))
        along = np.column_stack([np.cos(out), np.sin(out), np.zeros(len(out))])
        into = self._datum.rotation
        part = (points - self._datum.translation) @ into
        return crossings(self._fields, part, along @ into, reach=reach * gear.module).reshape(shape)


def _phase(feeler: _Feeler, gear: Involute, middle: float) -> float:
    """Angle of a tooth's centre at mid-face [rad], from where material stands over a few pitches."""
    angle = 2 * math.pi / gear.teeth * np.arange(PITCHES * SCANNED) / SCANNED
    at = gear.measuring_diameter / 2
    points = np.column_stack([at * np.cos(angle), at * np.sin(angle), np.full(len(angle), middle)])
    solid = feeler.depths(points) < 0
    if solid.all() or not solid.any():
        raise PartError(
            f"no teeth stand on Ø {2 * at:.3f} mm: {'nothing' if solid.all() else 'all'} is cut away"
        )
    return float(np.angle(np.exp(1j * gear.teeth * angle[solid]).sum())) / gear.teeth
