"""A hob that sits badly on its spindle, as the rigid body it is: brute force, one point at a time.

Shares nothing with the kernel: the point is taken into the frame of the hob, that of the turning spindle
moved by the arbor, and every gash's half-plane is bisected for there.
"""

import math

import numpy as np
from brute_force import depth_in_outlines


def deepest(point, motion, gashes, arbor, outlines, pitch):
    """Largest depth of a point of the part in any pass of any gash.

    `motion` is that of the spindle, without its hob's errors; `gashes` are (angle, axial shift) [rad, mm];
    `arbor` (rotation, translation) takes the hob's own frame to the spindle's.
    """
    rotation, shift = arbor
    samples = np.arange(len(motion.time_s), dtype=float)

    def seen(at):
        """The point in the hob's own frame, (3, n)."""
        work, tool = np.interp(at, samples, motion.work_angle), np.interp(at, samples, motion.tool_angle)
        x, y, z = motion.mount.rotation @ point + motion.mount.translation
        lab = np.stack(
            [x * np.cos(work) - y * np.sin(work), x * np.sin(work) + y * np.cos(work), z + 0 * work]
        )
        centre = np.stack([np.interp(at, samples, column) for column in motion.centre.T])
        a, b, s = motion.basis @ (lab - centre)
        turning = np.stack([a * np.cos(tool) + b * np.sin(tool), b * np.cos(tool) - a * np.sin(tool), s])
        return rotation.T @ (turning - shift[:, None])

    x, y, _ = seen(samples)
    reach, angle = np.hypot(x, y), np.unwrap(np.arctan2(y, x))
    top = max(line[:, 1].max() for line in outlines)
    best = -math.inf
    for gash, axial in gashes:
        turns = np.floor((angle - gash) / (2 * math.pi))
        for k in np.flatnonzero((np.diff(turns) != 0) & (np.minimum(reach[:-1], reach[1:]) < top + 0.3)):
            low, high = float(k), float(k + 1)

            def ahead(at, gash=gash):
                q = seen(np.array([at]))[:, 0]
                return math.remainder(math.atan2(q[1], q[0]) - gash, 2 * math.pi)

            first = ahead(low)
            for _ in range(45):
                middle = (low + high) / 2
                if (ahead(middle) > 0) == (first > 0):
                    low = middle
                else:
                    high = middle
            q = seen(np.array([low]))[:, 0]
            best = max(best, depth_in_outlines(outlines, pitch, q[2] - axial, math.hypot(q[0], q[1])))
    return best
