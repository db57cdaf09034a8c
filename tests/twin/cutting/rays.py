"""Where rays cross the cut surface, from the field of all passes alone: no grid, no mesh, no culling."""

import numpy as np

PAIRS = 400_000


def deepest(field, points):
    """Depth (n,) and gradient (n, 3) of the deepest of all passes at points (n, 3)."""
    passes = np.arange(field.passes.count)
    depth, gradient = np.zeros(len(points)), np.zeros((len(points), 3))
    rows = max(1, PAIRS // len(passes))
    for at in range(0, len(points), rows):
        part = points[at : at + rows]
        meeting = field.evaluate(
            np.repeat(part, len(passes), axis=0), np.tile(passes, len(part)), gradient=True
        )
        table = meeting.depth.reshape(len(part), -1)
        best = table.argmax(axis=1)
        depth[at : at + rows] = table.max(axis=1)
        gradient[at : at + rows] = meeting.gradient.reshape(len(part), -1, 3)[np.arange(len(part)), best]
    return depth, gradient


def crossing(field, points, along, *, rounds=8):
    """How far (n,) the cut surface stands from points (n, 3), along unit vectors (n, 3) into the part."""
    way = np.zeros(len(points))
    for _ in range(rounds):
        depth, gradient = deepest(field, points + way[:, None] * along)
        step = -depth / (gradient * along).sum(axis=1)
        way += np.clip(step, -0.05, 0.05)
        if np.abs(step).max() < 1e-7:
            return way
    raise AssertionError(f"rays not settled: {np.abs(step).max():g} mm")
