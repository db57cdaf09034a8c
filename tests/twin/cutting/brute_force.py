"""An evaluator of the cut that shares nothing with the kernel: slow, plain, one point at a time.

Every gash is followed through every sample interval; the instant at which its half-plane passes the point
is bisected; the depth is the distance to the tooth's outline drawn as a fine polygon.
"""

import math

import numpy as np


def hob_outline(module, outside_diameter, starts, hand, pressure_angle, addendum, tip_radius, dedendum):
    """One tooth and half a land on both sides as a polygon (n, 2) of (s, rho), open downwards."""
    pitch_diameter = outside_diameter - 2 * addendum * module
    lead = math.asin(starts * module / pitch_diameter)
    pitch = math.pi * module / math.cos(lead)
    alpha = math.atan(math.tan(math.radians(pressure_angle)) / math.cos(lead))
    top = outside_diameter / 2
    root = top - (addendum + dedendum) * module
    radius = tip_radius * module
    # flank line through (pitch/4, pitch radius)
    def flank(rho):
        return pitch / 4 - (rho - pitch_diameter / 2) * math.tan(alpha)

    # centre of the tip arc: `radius` below the top and `radius` inside the flank
    cy = top - radius
    cx = flank(cy) - radius / math.cos(alpha)
    turn = np.linspace(math.pi / 2, alpha, 3000)
    arc = np.column_stack([cx + radius * np.cos(turn), cy + radius * np.sin(turn)])
    right = np.vstack([arc, [[flank(root), root], [pitch / 2, root]]])
    left = right[::-1] * [-1, 1]
    return np.vstack([left, right]), pitch


def insert_outline(tip_radius, width):
    """A square insert as a polygon reaching down to the axis."""
    return np.array([[-width / 2, 0.0], [-width / 2, tip_radius], [width / 2, tip_radius], [width / 2, 0.0]])


def depth_in_outline(outline, pitch, s, rho):
    """Signed distance, positive inside, to a row of teeth (three of them are enough)."""
    if pitch:
        s = s - pitch * round(s / pitch)
        line = np.vstack([outline + [k * pitch, 0] for k in (-1, 0, 1)])
    else:
        line = outline
    a, b = line[:-1], line[1:]
    edge = b - a
    length2 = (edge**2).sum(axis=1)
    t = np.clip((([s, rho] - a) * edge).sum(axis=1) / np.where(length2 > 0, length2, 1), 0, 1)
    distance = np.hypot(*(a + t[:, None] * edge - [s, rho]).T).min()
    # inside = below the line, which runs from left to right
    crosses = (np.minimum(a[:, 0], b[:, 0]) <= s) & (np.maximum(a[:, 0], b[:, 0]) > s)
    if not crosses.any():
        return -distance
    k = np.flatnonzero(crosses)
    height = a[k, 1] + (s - a[k, 0]) / edge[k, 0] * edge[k, 1]
    return distance if rho < height.max() else -distance


def field(point, motion, gash_angle, gash_shift, outline, pitch):
    """Largest depth of `point` over every crossing of every gash; motion as in CutterMotion."""
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
    best = -math.inf
    for phase, shift in zip(gash_angle, gash_shift, strict=True):
        phase_lag = (tool + phase - turned) / (2 * math.pi)
        for i in np.flatnonzero(np.floor(phase_lag[:-1]) != np.floor(phase_lag[1:])):
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
            depth = depth_in_outline(outline, pitch, q[2] - shift, math.hypot(q[0], q[1]))
            best = max(best, depth)
    return best
