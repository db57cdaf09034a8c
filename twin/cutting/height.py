"""How high places of the stock stand above the edge of the tooth that removes them.

The outline of a tooth can be made of several pieces that overlap. What two of them remove counts for the
first, but its height is that above the outline of both: its depth in the piece that it is deepest in.
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.cells import points
from twin.cutting.field import DepthField
from twin.cutting.fields import Field
from twin.cutting.meeting import Meeting
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def above(sweep: Sweep, at: Floats, bite: Ints) -> tuple[Ints, Floats, Meeting]:
    """Heights (n, k) of places (n, k, 3) above the edges of the teeth whose bites (n,) remove them [mm].

    Places are radius [mm], angle [rad], z [mm]. Returns as well the bites (n,) of the pieces that the highest
    of each row's places belong to, and how these meet the middle ones.
    """
    met = [sweep.evaluate(points(where), bite) for where in at.transpose(1, 0, 2)]
    height = np.stack([meeting.depth for meeting in met], axis=1)
    top, middle, owner = height.max(axis=1), met[len(met) // 2], bite.copy()
    tool = sweep.tool(bite)
    for n, field in enumerate(sweep.fields):
        mates = _mates(field)
        here = np.flatnonzero(tool == n)
        own = bite[here] - sweep.first(tool[here])
        for step in mates.T:
            off = step.take(own % field.bites)
            rows = here[off != 0]
            other = bite[rows] + off[off != 0]
            found = [sweep.evaluate(points(where), other) for where in at[rows].transpose(1, 0, 2)]
            depth = np.stack([meeting.depth for meeting in found], axis=1)
            height[rows] = np.maximum(height[rows], depth)
            some = depth.max(axis=1) > top[rows]
            higher = rows[some]
            top[higher], owner[higher] = depth[some].max(axis=1), other[some]
            one = found[len(met) // 2].of(some)
            for name in ("depth", "s", "rho", "instant"):
                getattr(middle, name)[higher] = getattr(one, name)
    return owner, np.maximum(height, 0.0), middle


def _mates(field: Field) -> Ints:
    """(bites, k) what leads from the number of a bite to those of its tooth's other pieces; 0 = no more.

    The land between the teeth has none.
    """
    tooth = field.tooth
    land = isinstance(field, DepthField) and field.has_land
    same = tooth[:, None] == tooth
    if land:
        same[-1], same[:, -1] = False, False
    np.fill_diagonal(same, val=False)
    step = np.arange(len(tooth)) - np.arange(len(tooth))[:, None]
    mates = np.zeros((len(tooth), int(same.sum(axis=1).max(initial=0))), dtype=np.int64)
    for number, others in enumerate(same):
        mates[number, : others.sum()] = step[number, others]
    return mates
