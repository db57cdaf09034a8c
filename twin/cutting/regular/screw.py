"""Charts laid out on the screw of a steady motion, so that stretches of gaps are images of a few templates.

The nodes of all gaps stand where the screw takes those of the first ones. A *strip* is what one turn of the
screw through all gaps makes of the length of a gap; the templates are the strips at mid-face of as many gaps
as the screw leaves unconnected.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.regular.indexing import Indexing
from twin.cutting.regular.steady import Steady

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SHORTEST = 2
"""Strips along the face, at least, for images to be worth while."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Nodes along the gaps, on the screw."""

    z: Floats
    """(nz + 1,) [mm]"""
    lift: Floats
    """(gaps,) by which each gap's nodes stand higher [mm]"""
    template: Ints
    """(gaps,) gap of which each is an image"""
    cells: int
    """along the gap in a strip"""
    begin: Ints
    """(gaps,) node where the strip begins in which a gap is the template's image of the same round"""
    turns: Ints
    """(gaps,) turns of the hob from the template to that strip"""
    round_turns: int
    """turns of the hob from one strip of a gap to the next higher one"""

    @property
    def templates(self) -> tuple[Ints, Ints]:
        """Gaps (t,) of the templates, and the nodes (t, 2) that they reach from and to."""
        gap = np.unique(self.template)
        return gap, np.stack([self.begin[gap], self.begin[gap] + self.cells], axis=1)

    @property
    def most_turns(self) -> int:
        """Turns of the hob between a template and any of its images, at most."""
        gap, ends = np.meshgrid(np.arange(len(self.lift)), [0, len(self.z) - 2])
        return int(np.abs(self.later(gap, self.strip(gap, ends))).max())

    def strip(self, gap: Ints, k: Ints) -> Ints:
        """Number of the strip in which the cell from node k on lies; 0 at `begin`."""
        return (k - self.begin[gap]) // self.cells

    def column(self, gap: Ints, k: Ints) -> Ints:
        """Node of the template whose image node k is."""
        return self.begin[self.template[gap]] + (k - self.begin[gap]) % self.cells

    def later(self, gap: Ints, strip: Ints) -> Ints:
        """Turns of the hob by which strips come after their templates."""
        return self.turns[gap] + strip * self.round_turns


def lay_out(indexing: Indexing, steady: Steady, z_range: tuple[float, float], along: float) -> Layout | None:
    """Nodes about `along` [mm] apart that reach past both ends of a face; None where it is too short."""
    teeth, rise = indexing.teeth, steady.rise
    apart = math.gcd(steady.step, teeth)
    orbit = teeth // apart
    whole = orbit * abs(rise)
    if not whole:
        return None
    rounds = max(round(2.0 * along / whole), 1)
    length = rounds * whole
    if SHORTEST * length > z_range[1] - z_range[0]:
        return None
    cells = 2 * math.ceil(length / (2.0 * along) - 1e-9)
    step = length / cells
    count = math.ceil((z_range[1] - z_range[0]) / step) + 3
    first = 0.5 * (z_range[0] + z_range[1]) - 0.5 * (count + 1) * step
    z = first + step * np.arange(count + 1, dtype=np.float64)
    middle = (count - cells) // 2
    template, turns = np.zeros(teeth, dtype=np.int64), np.zeros(teeth, dtype=np.int64)
    gap = np.arange(apart)
    for number in range(orbit):
        template[gap], turns[gap] = np.arange(apart), number
        gap = (gap + steady.step) % teeth
    # the image stands `turns · rise` higher; whole rounds bring it back to the template's height
    high = turns * rise
    back = np.floor(high / length).astype(np.int64)
    rest = high - back * length
    nodes = np.floor(rest / step + 1e-9).astype(np.int64)
    per_round = rounds * orbit * (1 if rise > 0 else -1)
    return Layout(
        z=z,
        lift=np.maximum(rest - nodes * step, 0.0),
        template=template,
        cells=cells,
        begin=middle + nodes,
        turns=turns - back * per_round,
        round_turns=per_round,
    )
