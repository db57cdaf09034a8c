"""What every block of the program did: when, how far, how fast, how far behind, and where the tool was."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Floats
from twin.recording import Recording

Ints = NDArray[np.int64]
MOST_RUNS = 100
"""spans of time of one block that are told apart; of more, the rest is one"""
PATH_POINTS = 9
"""of the tool's way during one run of a block that is not straight"""
STRAIGHT_MM = 1e-3
"""a way that leaves its chord by less is told by its ends"""


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockFacts:
    """One line of a program, over all the times it ran."""

    file: str
    line: int
    """from 1"""
    runs: tuple[tuple[float, float], ...]
    """[s] from, to"""
    count: int
    """how often it ran"""
    duration_s: float
    """in all"""
    start: Floats
    """(axes,) setpoints where it first began, slide travel [mm] or degrees"""
    end: Floats
    """(axes,) where it last ended"""
    way: Floats
    """(axes,) setpoints' way in all, back and forth [mm, °]"""
    error: Floats
    """(axes,) largest |setpoint less actual value| [mm, °]"""
    synced: bool
    """gear box engaged at some time"""
    tool: int
    """number of the tool at its end"""
    path_mm: Floats
    """(k, 3) tool centre beside the work as it stands at C0; NaN between two runs"""
    axis: Floats
    """(3,) direction of the tool axis there, at its end"""


def block_facts(recording: Recording) -> tuple[BlockFacts, ...]:
    """Tell of every line that the recording has samples of, in the order in which they first ran."""
    n = len(recording.time_s)
    if n == 0 or not recording.blocks:
        return ()
    first = np.concatenate([[0], np.flatnonzero(np.diff(recording.block)) + 1])
    last = np.concatenate([first[1:] - 1, [n - 1]])
    before = np.maximum(first - 1, 0)
    places = [(block.file, block.line) for block in recording.blocks]
    line = line_numbers(recording)[recording.block[first]]
    error = np.maximum.reduceat(np.abs(recording.setpoint - recording.actual), first)
    steps = np.abs(np.diff(recording.setpoint, axis=0, prepend=recording.setpoint[:1]))
    way = np.add.reduceat(steps, first)
    synced = np.maximum.reduceat(recording.sync.astype(np.int8), first) > 0
    centre = beside_the_work(recording, recording.tool_centre_mm)
    samples = _samples(before, last)
    ways = centre[samples]
    straight = _straight(ways)
    found = []
    order = np.argsort(line, kind="stable")
    edges = np.flatnonzero(np.diff(line[order], prepend=-1, append=len(places)))
    for runs in np.split(order, edges[1:-1]):
        a, b = int(runs[0]), int(runs[-1])
        file, text_line = places[recording.block[first[a]]]
        spans = np.stack([recording.time_s[before[runs]], recording.time_s[last[runs]]], axis=-1)
        found.append(
            BlockFacts(
                file=file,
                line=text_line,
                runs=_few(spans),
                count=len(runs),
                duration_s=float((spans[:, 1] - spans[:, 0]).sum()),
                start=recording.setpoint[before[a]],
                end=recording.setpoint[last[b]],
                way=way[runs].sum(axis=0),
                error=error[runs].max(axis=0),
                synced=bool(synced[runs].any()),
                tool=int(recording.tool[last[b]]),
                path_mm=_path(ways[runs[:MOST_RUNS]], straight[runs[:MOST_RUNS]]),
                axis=_at(recording, recording.tool_axis, int(last[b])),
            )
        )
    return tuple(found)


def line_numbers(recording: Recording) -> Ints:
    """(blocks,) number of each block's line, in the order in which lines first ran; -1 where it never did."""
    places = [(block.file, block.line) for block in recording.blocks]
    ran, first = np.unique(recording.block, return_index=True)
    number: dict[tuple[str, int], int] = {}
    for block in ran[np.argsort(first)].tolist():
        number.setdefault(places[block], len(number))
    return np.array([number.get(place, -1) for place in places], dtype=np.int64)


def lines_at(recording: Recording, time_s: Floats) -> Ints:
    """(m,) number of the line that ran at some times, as `block_facts` counts them; -1 where the time is NaN.

    A sample ends the stretch of its block.
    """
    known = np.isfinite(time_s)
    if not len(recording.time_s) or not recording.blocks:
        return np.full(len(time_s), -1, dtype=np.int64)
    last = np.append(np.flatnonzero(np.diff(recording.block)), len(recording.block) - 1)
    stretch = np.searchsorted(recording.time_s[last[:-1]], np.where(known, time_s, 0.0))
    return np.where(known, line_numbers(recording)[recording.block[last]].take(stretch), -1)


def beside_the_work(recording: Recording, vectors: Floats) -> Floats:
    """Turn vectors (n, 3) of the turning part frame with the work: as seen by someone beside the machine."""
    return _turned(vectors, np.radians(recording.work_angle_deg))


def _at(recording: Recording, vectors: Floats, sample: int) -> Floats:
    return _turned(vectors[sample], np.radians(recording.work_angle_deg[sample]))


def _turned(vectors: Floats, angle: Floats) -> Floats:
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    return np.stack([x * cos - y * sin, x * sin + y * cos, z], axis=-1)


def _samples(start: Ints, end: Ints) -> Ints:
    """(runs, PATH_POINTS) samples evenly spread from start to end."""
    share = np.linspace(0.0, 1.0, PATH_POINTS)
    return np.rint(start[:, None] + (end - start)[:, None] * share).astype(np.int64)


def _straight(ways: Floats) -> NDArray[np.bool_]:
    """(runs,) which ways (runs, points, 3) stay near the chord from their first to their last point."""
    chord = ways[:, -1] - ways[:, 0]
    length = np.linalg.norm(chord, axis=1)
    off = ways - ways[:, :1]
    direction = np.divide(chord, length[:, None], out=np.zeros_like(chord), where=length[:, None] > 0)
    along = np.einsum("rpx,rx->rp", off, direction)
    return np.linalg.norm(off - along[..., None] * direction[:, None], axis=2).max(axis=1) < STRAIGHT_MM


def _path(ways: Floats, straight: NDArray[np.bool_]) -> Floats:
    """Join the ways of some runs, a gap between each and the next."""
    gap = np.full((1, 3), np.nan)
    pieces = [way[[0, -1]] if plain else way for way, plain in zip(ways, straight.tolist(), strict=True)]
    return np.concatenate([part for piece in pieces for part in (piece, gap)][:-1])


def _few(spans: Floats) -> tuple[tuple[float, float], ...]:
    kept = [(float(a), float(b)) for a, b in spans[:MOST_RUNS]]
    if len(spans) > MOST_RUNS:
        kept[-1] = (kept[-1][0], float(spans[-1, 1]))
    return tuple(kept)
