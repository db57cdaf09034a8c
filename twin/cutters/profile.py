"""The outline of a cutting edge in its rake plane, as a signed depth.

Coordinates in the rake half-plane: `s` along the tool axis, `rho` the distance from it [mm]. Depth is
positive where the edge removes material, zero on the outline, minus the distance from it outside; it is
1-Lipschitz.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.chain import SAME, read_chain
from twin.cutters.pieces import Piece, tooth_pieces
from twin.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ToothProfile:
    """A row of equal symmetric teeth, or a single one; each the union of pieces without hollow corners.

    Everything below the root radius counts as cutting: the land between two teeth of a hob cuts as well.
    """

    tip: float
    """radius of the tip [mm]"""
    root: float
    """radius of the land between the teeth [mm]; -inf = none"""
    pitch: float
    """axial distance of the teeth [mm]; inf = a single tooth"""
    pieces: tuple[Piece, ...]
    """of the tooth, from its tip down"""

    @property
    def half_width(self) -> float:
        """Half the width of a tooth where it is widest above the land [mm]."""
        return max(piece.half_width for piece in self.pieces)

    def fold(self, s: Floats) -> Floats:
        """Axial distance to the centre of the nearest tooth, with the sign of the side."""
        if math.isinf(self.pitch):
            return s
        return s - self.pitch * np.rint(s / self.pitch)

    def depth(self, s: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Signed depth and its derivatives by `s` and `rho`, each of the inputs' shape."""
        local = self.fold(s)
        depth, by_s, by_rho = self.pieces[0].depth(np.abs(local), rho)
        for piece in self.pieces[1:]:
            other = piece.depth(np.abs(local), rho)
            deeper = other[0] > depth
            for mine, its in zip((depth, by_s, by_rho), other, strict=True):
                np.copyto(mine, its, where=deeper)
        land = self.root - rho
        below = land > depth
        if below.any():
            depth[below] = land[below]
            by_s[below] = 0.0
            by_rho[below] = -1.0
        by_s *= np.where(local < 0, -1.0, 1.0)
        return depth, by_s, by_rho

    def piece_depth(
        self, piece: Ints, tooth: Floats, s: Floats, rho: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Signed depth in one piece of the tooth with its middle at `tooth`, and its derivatives.

        This is a concave function, but for the known bend of a piece with hollow arcs; nowhere above `depth`.
        The number of a piece, beyond those of the tooth, stands for the land. All of the inputs' shape (m,).
        """
        local = s - tooth
        across = np.abs(local)
        if len(self.pieces) == 1:
            depth, by_s, by_rho = self.pieces[0].depth(across, rho)
        else:
            depth, by_s, by_rho = np.zeros(len(s)), np.zeros(len(s)), np.zeros(len(s))
            for number, one in enumerate(self.pieces):
                here = np.flatnonzero(piece == number)
                if len(here):
                    depth[here], by_s[here], by_rho[here] = one.depth(across.take(here), rho.take(here))
        by_s *= np.where(local < 0, -1.0, 1.0)
        land = np.flatnonzero(piece == len(self.pieces))
        if len(land):
            depth[land] = self.root - rho[land]
            by_s[land] = 0.0
            by_rho[land] = -1.0
        return depth, by_s, by_rho

    def teeth(self, low: float, high: float) -> Ints:
        """Numbers of the teeth, tooth k at k pitches, that reach between two positions above the land."""
        if math.isinf(self.pitch):
            return np.zeros(1, dtype=np.int64)
        first = math.ceil((low - self.half_width) / self.pitch)
        return np.arange(first, math.floor((high + self.half_width) / self.pitch) + 1)


def tooth_profile(
    points: Sequence[Sequence[float]],
    *,
    tip: float,
    land: bool,
    pitch: float = math.inf,
    chords: bool = False,
) -> ToothProfile:
    """The profile of a tooth from its chain of (half-width, depth[, radius to the next]) [mm].

    With a `land` the space between the teeth cuts from the last point's depth on; without, the tooth goes on
    straight down. A hollow arc makes one piece with its neighbours. With `chords` it becomes lines within
    `chain.CHORD`, and all pieces are convex, as `WheelField` needs them: only then is a point that passes a
    body of revolution deepest in it once. Raises InputError for a chain that bounds no tooth, or teeth that
    run into each other.
    """
    strokes = read_chain(points, tip, chords=chords)
    root = tip - points[-1][1] if land else -math.inf
    profile = ToothProfile(tip=tip, root=root, pitch=pitch, pieces=tooth_pieces(strokes, root))
    if 2.0 * profile.half_width > pitch + SAME:
        raise InputError(
            f"teeth {2.0 * profile.half_width:.4g} mm wide run into each other at a pitch of {pitch:.4g} mm",
            remedy="less depth, or less half-width",
        )
    return profile
