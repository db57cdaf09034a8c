"""An evaluator of the cut that shares nothing with the kernel: slow, plain, one point at a time.

Every gash is followed through every sample interval; the instant at which its half-plane passes the point
is bisected; the depth is the distance to outlines drawn as fine polygons.
"""

import math

import numpy as np

ARC = np.linspace(0.0, 1.0, 1500)
DEEP = -1000.0


def hob_outlines(*, module, outside_diameter, starts, pressure_angle, addendum, tip_radius, dedendum):
    """Three teeth and the land below them, each an open polygon (n, 2) of (s, rho) from left to right."""
    pitch_diameter = outside_diameter - 2 * addendum * module
    lead = math.asin(starts * module / pitch_diameter)
    pitch = math.pi * module / math.cos(lead)
    alpha = math.atan(math.tan(math.radians(pressure_angle)) / math.cos(lead))
    top = outside_diameter / 2
    radius = tip_radius * module

    def flank(rho):
        return pitch / 4 - (rho - pitch_diameter / 2) * math.tan(alpha)

    # centre of the tip arc: `radius` below the top and `radius` inside the flank
    cy = top - radius
    cx = flank(cy) - radius / math.cos(alpha)
    turn = math.pi / 2 + (alpha - math.pi / 2) * ARC
    arc = np.column_stack([cx + radius * np.cos(turn), cy + radius * np.sin(turn)])
    right = np.vstack([arc, [[flank(DEEP), DEEP]]])
    tooth = np.vstack([right[::-1] * [-1, 1], right])
    root = top - (addendum + dedendum) * module
    teeth = [tooth + np.array([k * pitch, 0.0]) for k in (-1, 0, 1)]
    return [*teeth, np.array([[-1e4, root], [1e4, root]])], pitch


def insert_outlines(*, tip_radius, width, corner_radius=0.0):
    """One insert reaching down past the axis, as an open polygon from left to right."""
    turn = math.pi / 2 * (1 - ARC)
    arc = np.column_stack(
        [
            width / 2 - corner_radius * (1 - np.cos(turn)),
            tip_radius - corner_radius * (1 - np.sin(turn)),
        ]
    )
    right = np.vstack([arc, [[width / 2, DEEP]]])
    return [np.vstack([right[::-1] * [-1, 1], right])]


def depth_in_outline(line, s, rho):
    """Signed distance, positive below the open polygon."""
    a, b = line[:-1], line[1:]
    edge = b - a
    length2 = (edge**2).sum(axis=1)
    t = np.clip((([s, rho] - a) * edge).sum(axis=1) / np.where(length2 > 0, length2, 1), 0, 1)
    distance = np.hypot(*(a + t[:, None] * edge - [s, rho]).T).min()
    # the outlines rise and fall: below means that an odd number of segments stand above
    crosses = (np.minimum(a[:, 0], b[:, 0]) <= s) & (np.maximum(a[:, 0], b[:, 0]) > s)
    k = np.flatnonzero(crosses)
    height = a[k, 1] + (s - a[k, 0]) / edge[k, 0] * edge[k, 1]
    return distance if (height > rho).sum() % 2 else -distance


def depth_in_outlines(outlines, pitch, s, rho):
    """Signed distance to a union of outlines: the deepest of them."""
    if pitch:
        s = s - pitch * round(s / pitch)
    return max(depth_in_outline(line, s, rho) for line in outlines)


def field(point, motion, cutter, outlines, pitch=0.0):
    """Largest depth of `point` over every crossing of every gash, and the instant [samples] of it."""
    x, y, z = motion.mount.rotation @ point + motion.mount.translation

    def seen(work, centre):
        lab = np.array([x * math.cos(work) - y * math.sin(work), x * math.sin(work) + y * math.cos(work), z])
        return motion.basis @ (lab - centre)

    work, tool, centre = motion.work_angle, motion.tool_angle, motion.centre
    lab = np.column_stack(
        [x * np.cos(work) - y * np.sin(work), x * np.sin(work) + y * np.cos(work), np.full(len(work), z)]
    )
    local = (lab - centre) @ motion.basis.T
    turned = np.unwrap(np.arctan2(local[:, 1], local[:, 0]))
    reach = np.hypot(local[:, 0], local[:, 1])
    best, when = -math.inf, math.nan
    for phase, shift in zip(cutter.gash_angle, cutter.gash_shift, strict=True):
        phase_lag = (tool + phase - turned) / (2 * math.pi)
        crossed = np.floor(phase_lag[:-1]) != np.floor(phase_lag[1:])
        # an edge that misses by more than the best so far needs no bisection
        crossed &= reach[:-1].clip(max=reach[1:]) - cutter.radius < 0.5 - best
        for i in np.flatnonzero(crossed):
            goal = max(math.floor(phase_lag[i]), math.floor(phase_lag[i + 1])) * 2 * math.pi

            def lag(f, i=i, phase=phase, goal=goal):
                q = seen(work[i] + f * (work[i + 1] - work[i]), centre[i] + f * (centre[i + 1] - centre[i]))
                raw = tool[i] + f * (tool[i + 1] - tool[i]) + phase - math.atan2(q[1], q[0]) - goal
                return (raw + math.pi) % (2 * math.pi) - math.pi, q

            low, high = 0.0, 1.0
            at_low = lag(low)[0]
            for _ in range(50):
                middle = (low + high) / 2
                value = lag(middle)[0]
                if (value > 0) == (at_low > 0):
                    low = middle
                else:
                    high = middle
            q = lag(low)[1]
            depth = depth_in_outlines(outlines, pitch, q[2] - shift, math.hypot(q[0], q[1]))
            if math.isfinite(cutter.half_length):
                depth = min(depth, cutter.half_length - abs(q[2] - cutter.shift))
            if depth > best:
                best, when = depth, i + low
    return best, when
