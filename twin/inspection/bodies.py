"""How many bodies a mesh holds: shells that neither enclose a cavity nor stand inside another body."""

import numpy as np

from twin.inspection.components import components
from twin.inspection.solid import Solid

CHIP = 1e-3
"""a shell of less than this part of the largest one's volume is a loose chip, no body"""


def separate_bodies(solid: Solid) -> int:
    """Count the bodies that stand beside each other; cavities, what lies within, and chips do not count."""
    # faces that share an edge are of one shell; a shared corner joins nothing
    shell = components(len(solid.faces), *solid.neighbours)
    count = int(shell.max()) + 1
    if count == 1:
        return 1
    a, b, c = (solid.vertices[solid.faces[:, i]] for i in range(3))
    volume = np.bincount(shell, weights=np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=count) / 6.0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    for corner in (a, b, c):
        np.minimum.at(low, shell, corner)
        np.maximum.at(high, shell, corner)
    large = np.flatnonzero(np.abs(volume) > CHIP * np.abs(volume).max())
    bodies = 0
    for one in large:
        others = large[large != one]
        inside = (low[others] <= low[one]).all(axis=1) & (high[others] >= high[one]).all(axis=1)
        # of two shells that fill the same box, the first is not inside the other
        same = (low[others] == low[one]).all(axis=1) & (high[others] == high[one]).all(axis=1)
        bodies += not (inside & ~(same & (others > one))).any()
    return bodies
