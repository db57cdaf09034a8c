"""The planned motion at many times at once: what a run reads of the timeline, tick by tick.

A position is that of the piece that ends at its time, so that what is planned behind a time does not change a
bit of the sample at it. A dry run needs nothing of this.
"""

import bisect

import numpy as np
from numpy.typing import NDArray

from controller.clock import Geared
from controller.laws.angle_table import RAMP_S, TURN
from controller.laws.gearbox import slave_travel
from controller.laws.segments import Round, Straight, Track
from controller.motion.timeline import Epoch, Marks, Timeline

Floats = NDArray[np.float64]


def setpoints(timeline: Timeline, time: Floats) -> Floats:
    """(n, axes) setpoints at ascending times (n,); follow-type rotation is left to the machine."""
    out = np.zeros((len(time), len(timeline.tracks)))
    for k, track in enumerate(timeline.tracks):
        out[:, k] = positions(track, time)
    for epoch in timeline.epochs:
        first, last = _rows(epoch, time)
        if first < last:
            part = out[first:last]
            added = _shifts(epoch, part)
            if not epoch.gear.follow:
                added += slave_travel(epoch.gear, part[:, epoch.gear.master] - epoch.master_start)
            part[:, epoch.gear.slave] += added
    for correction in timeline.corrections:
        came, gone = (np.clip((time - t) / RAMP_S, 0.0, 1.0) for t in (correction.start, correction.end))
        angle = out[:, correction.table.work].copy()
        for column, values in correction.table.values.items():
            out[:, column] += came * (1.0 - gone) * read_at(np.array(values), angle)
    return out


def read_at(values: Floats, angle: Floats) -> Floats:
    """(n,) what a table of values at even angles of a turn says at angles (n,) [deg]."""
    place = np.mod(angle, TURN) * (len(values) / TURN)
    k = np.floor(place).astype(np.int64) % len(values)
    share = place - np.floor(place)
    return values[k] + share * (values[(k + 1) % len(values)] - values[k])


def engaged(gears: tuple[Geared, ...], ticks: int) -> NDArray[np.bool_]:
    """(ticks,) whether a gear box was engaged."""
    found = np.zeros(ticks, dtype=bool)
    for gear in gears:
        found[gear.first : gear.last] = True
    return found


def geared(timeline: Timeline, time: Floats) -> tuple[Geared, ...]:
    """Which gear boxes were engaged in which of the ascending times (n,)."""
    found = []
    for epoch in timeline.epochs:
        first, last = _rows(epoch, time)
        if first < last:
            gear = epoch.gear
            found.append(
                Geared(
                    first=first,
                    last=last,
                    slave=gear.slave,
                    master=gear.master,
                    numerator=gear.numerator,
                    denominator=gear.denominator,
                    follow=gear.follow,
                    slides=tuple(epoch.weights.items()),
                )
            )
    return tuple(found)


def _rows(epoch: Epoch, time: Floats) -> tuple[int, int]:
    """First and one-past-last of the ascending times (n,) in which the epoch was open."""
    if epoch.start < time[0] and time[-1] <= epoch.end:
        return 0, len(time)
    first, last = np.searchsorted(time, (epoch.start, epoch.end), side="right").tolist()
    return first, last


def marked(marks: Marks, time: Floats) -> NDArray[np.int64]:
    """(n,) values in force up to each of the ascending times (n,)."""
    if marks.times[-1] < time[0]:
        return np.full(len(time), marks.values[-1])
    k = np.searchsorted(np.array(marks.times), time, side="left") - 1
    return np.array(marks.values)[k]


def positions(track: Track, time: Floats) -> Floats:
    """(n,) positions of one axis at the ascending times (n,)."""
    first = max(bisect.bisect_left(track.times, time[0]) - 1, 0)
    last = max(bisect.bisect_left(track.times, time[-1]), first + 1)
    knots = track.knots[first:last]
    if len(knots) == 1:
        return _piece(knots[0], time - track.times[first])
    times = np.array(track.times[first:last])
    k = np.searchsorted(times[1:], time, side="left")
    tau = time - times[k]
    position, speed, half = np.array([knot if len(knot) == 3 else (0.0,) * 3 for knot in knots])[k].T
    out = position + tau * (speed + tau * half)
    for j, knot in enumerate(knots):
        if len(knot) == 4:
            here = k == j
            out[here] = _piece(knot, tau[here])
    return out


def _shifts(epoch: Epoch, own: Floats) -> Floats:
    """Helical shift of the slave (n,) at own positions (n, axes)."""
    total = np.zeros(len(own))
    for k, weight in epoch.weights.items():
        total += weight * (own[:, k] - epoch.slides_start[k])
    return total


def _piece(knot: Straight | Round, tau: Floats) -> Floats:
    """(n,) positions `tau` (n,) after the knot."""
    if len(knot) == 3:
        position, speed, half = knot
        if not half:
            return position + tau * speed if speed else np.full(len(tau), position)
        return position + tau * (speed + tau * half)
    wave, angle, speed, half = knot
    u = angle + tau * (speed + tau * half)
    return wave.centre + wave.cosine * np.cos(u) + wave.sine * np.sin(u) + wave.rate * u
