"""Rays and passes that meet in some motion, or would in one close by: where to look again."""

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField
from twin.load.ray_ends import SLACK, Ends

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CLOSE_BY = 12e-3
"""[mm] by which edges may stand elsewhere against the metal in a motion close by"""
NEAR = SLACK
"""[mm] of depth that a contact may lack: twice and a half what such a motion can give it, for the ray may
stand longer as well"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contacts:
    """Pairs of rays and passes, (n,) each."""

    ray: Ints
    index: Ints
    """of the pass, in the motion that they were found on"""
    angle: Floats
    """of the tool [rad] where the pass's edge points along tool angle 0: with `shift` its name in others"""
    shift: Floats
    """of the pass [mm]"""
    high: Floats
    """to which the ray reached when it was looked at [mm]"""
    ends: Ends

    @classmethod
    def near(cls, field: DepthField, ray: Ints, index: Ints, high: Floats, ends: Ends) -> "Contacts":
        """Those of the pairs that meet, or lack no more than NEAR."""
        rows = np.flatnonzero(ends.depth > -NEAR)
        ray, index, p = ray[rows], index[rows], field.passes
        names = {"angle": p.angle[index], "shift": p.shift[index]}
        return cls(ray=ray, index=index, **names, high=high[rows], ends=ends.of(rows))

    @classmethod
    def joined(cls, parts: list["Contacts"]) -> "Contacts":
        """One after the other."""
        none = np.zeros(0)
        empty = cls(
            ray=none.astype(np.int64),
            index=none.astype(np.int64),
            angle=none,
            shift=none,
            high=none,
            ends=Ends.unknown(0),
        )
        columns = [f.name for f in fields(cls)[:-1]]
        parts = [empty, *parts]
        values = {name: np.concatenate([getattr(part, name) for part in parts]) for name in columns}
        return cls(**values, ends=Ends.joined([part.ends for part in parts]))

    def with_ends(self, ends: Ends) -> "Contacts":
        """The same with their ends in another motion."""
        return replace(self, ends=ends)

    def passes_of(self, field: DepthField) -> Ints | None:
        """(n,) their passes in a field; None where one of them is not there, or not once."""
        numbers, first, inverse = np.unique(self.index, return_index=True, return_inverse=True)
        found = np.zeros(len(numbers), dtype=np.int64)
        for k, one in enumerate(first):
            same = (field.passes.angle == self.angle[one]) & (field.passes.shift == self.shift[one])
            at = np.flatnonzero(same)
            if len(at) != 1:
                return None
            found[k] = at[0]
        return found[inverse]
