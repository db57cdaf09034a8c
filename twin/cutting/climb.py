"""Linear programs in a few unknowns, many at once: how far up a slope some planes let one go."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDS = 24
FLAT = 1e-9
"""share of a slope that counts as none"""


def highest(rise: Floats, slope: Floats, room: Floats) -> Floats:
    """Ways (n, d) from the origin along which rise · way is the largest, where slope · way <= room.

    By gradient projection: straight up until planes are in the way, along these, and off one that holds back.
    `rise` (n, d); `slope` (n, k, d); `room` (n, k), not negative, inf for no plane. Planes must enclose the
    origin; after ROUNDS the way may be shorter than the best.
    """
    n, dimensions = rise.shape
    way = np.zeros((n, dimensions))
    held = np.full((n, dimensions), -1)
    left = np.arange(n)
    room = room.copy()
    for _ in range(ROUNDS):
        if not len(left):
            break
        own, goal = held[left], rise[left]
        normal = slope[left[:, None], own] * (own >= 0)[:, :, None]
        along = _along(goal, normal)
        stuck = (along * along).sum(axis=1) <= FLAT**2 * (goal * goal).sum(axis=1)
        done = np.zeros(len(left), dtype=bool)
        if stuck.any():
            at = np.flatnonzero(stuck)
            push = np.where(own[at] >= 0, _pushes(goal[at], normal[at]), 0.0)
            worst = push.argmin(axis=1)
            pulls = push[np.arange(len(at)), worst] < -FLAT * np.linalg.norm(goal[at], axis=1)
            held[left[at[pulls]], worst[pulls]] = -1
            done[at[~pulls]] = True
        go = np.flatnonzero(~stuck)
        item = left[go]
        speed = np.einsum("nkx,nx->nk", slope[item], along[go])
        near = speed > FLAT * np.linalg.norm(along[go], axis=1)[:, None]
        for slot in range(dimensions):
            some = np.flatnonzero(own[go, slot] >= 0)
            near[some, own[go[some], slot]] = False
        far = np.where(near, room[item] / np.where(near, speed, 1.0), np.inf)
        first = far.argmin(axis=1)
        share = far[np.arange(len(item)), first]
        free = own[go].argmin(axis=1)
        ok = np.isfinite(share)
        share = np.where(ok, share, 0.0)
        way[item] += share[:, None] * along[go]
        with np.errstate(invalid="ignore"):
            room[item] = np.maximum(room[item] - share[:, None] * speed, 0.0)
        held[item, free] = first
        done[go[~ok]] = True
        left = left[~done]
    return way


def _along(goal: Floats, normal: Floats) -> Floats:
    """(n, d) what of `goal` lies in the planes with these normals (n, d, d)."""
    base: list[Floats] = []
    for slot in range(goal.shape[1]):
        q = normal[:, slot]
        length = np.linalg.norm(q, axis=1)
        for other in base:
            q = q - (q * other).sum(axis=1)[:, None] * other
        size = np.linalg.norm(q, axis=1)
        base.append(q * np.where(size > FLAT * length, 1.0 / np.maximum(size, 1e-300), 0.0)[:, None])
    along = goal
    for _ in range(2):
        for q in base:
            along = along - (along * q).sum(axis=1)[:, None] * q
    return along


def _pushes(goal: Floats, normal: Floats) -> Floats:
    """(n, d) shares of the normals (n, d, d) that make up `goal`; 0 for those that are none."""
    gram = np.einsum("nix,njx->nij", normal, normal)
    gram += np.eye(goal.shape[1]) * np.where(np.einsum("nii->ni", gram) > 0, 1e-12, 1.0)[:, :, None]
    return np.linalg.solve(gram, np.einsum("nix,nx->ni", normal, goal)[:, :, None])[:, :, 0]
