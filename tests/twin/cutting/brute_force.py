"""An evaluator of the cut that shares nothing with the kernel: slow, plain, one point at a time.

Every gash is followed through every sample interval; the instant at which its half-plane passes the point
is bisected; the depth is the distance to outlines drawn as fine polygons.
"""

import itertools
import math

import numpy as np

ARC = np.linspace(0.0, 1.0, 1500)
DEEP = -1000.0


def hob_outlines(
    *,
    module,
    outside_diameter,
    starts,
    pressure_angle,
    addendum,
    tip_radius,
    dedendum,
    helical=False,
    protuberance=0.0,
    chamfer=0.0,
):
    """Three teeth and the land below them, each an open polygon (n, 2) of (s, rho) from left to right.

    Beside them the pitch of the teeth and the lead of gashes at right angles to a left-hand thread. On such
    a gash axial lengths are those of the normal section times cos gamma_0. Protuberance of 10°, chamfer of
    45°, both in the normal section.
    """
    pitch_diameter = outside_diameter - 2 * addendum * module
    lead = math.asin(starts * module / pitch_diameter)
    axial = math.cos(lead) if helical else 1.0 / math.cos(lead)
    pitch = math.pi * module * axial
    alpha, beta, gamma = (
        math.atan(math.tan(math.radians(angle)) * axial) for angle in (pressure_angle, 10.0, 45.0)
    )
    top = outside_diameter / 2
    root = top - (addendum + dedendum) * module
    radius = tip_radius * module

    def flank(rho):
        return pitch / 4 - (rho - pitch_diameter / 2) * math.tan(alpha)

    # centre of the tip arc: `radius` below the top and `radius` inside the flank, moved out by protuberance
    cy = top - radius
    cx = flank(cy) - (radius - protuberance) / math.cos(alpha)
    leaves = beta if protuberance else alpha
    turn = math.pi / 2 + (leaves - math.pi / 2) * ARC
    right = [np.column_stack([cx + radius * np.cos(turn), cy + radius * np.sin(turn)])]
    if protuberance:
        # down along the protuberance's own flank until it is no longer outside the tooth's
        x, y = right[0][-1]
        low, high = 0.0, 5 * module
        for _ in range(60):
            middle = (low + high) / 2
            outside = x + middle * math.tan(beta) > flank(y - middle)
            low, high = (middle, high) if outside else (low, middle)
        right.append([[x + low * math.tan(beta), y - low]])
    if chamfer:
        begin = root + chamfer
        right += [[[flank(begin), begin]], [[flank(begin) + (begin - DEEP) * math.tan(gamma), DEEP]]]
    else:
        right.append([[flank(DEEP), DEEP]])
    right = np.vstack(right)
    tooth = np.vstack([right[::-1] * [-1, 1], right])
    teeth = [tooth + np.array([k * pitch, 0.0]) for k in (-1, 0, 1)]
    gash_lead = math.pi * pitch_diameter / math.tan(lead) if helical else math.inf
    return [*teeth, np.array([[-1e4, root], [1e4, root]])], pitch, gash_lead


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


def chain_outlines(points, *, tip, land=False, pitch=0.0):
    """Outlines of a chain of (half-width, depth[, radius of the arc to the next]), as for the hob.

    Without land the tooth goes straight on; with it, below the land everything cuts.
    """
    right = [np.array([[points[0][0], tip]])]
    for here, there in itertools.pairwise(points):
        a, b = complex(here[0], tip - here[1]), complex(there[0], tip - there[1])
        radius = here[2] if len(here) > 2 else 0.0
        if radius == 0:
            right.append(np.array([[b.real, b.imag]]))
            continue
        # the centre stands on the side away from the bulge
        side = -1j if radius > 0 else 1j
        back = math.sqrt(max(radius**2 - abs(b - a) ** 2 / 4, 0.0))
        centre = (a + b) / 2 + side * (b - a) / abs(b - a) * back
        turn = np.angle((b - centre) / (a - centre))
        arc = centre + (a - centre) * np.exp(1j * turn * ARC)
        right.append(np.column_stack([arc.real, arc.imag])[1:])
    right = np.vstack([*right, [[points[-1][0], DEEP]]])
    tooth = np.vstack([right[::-1] * [-1, 1], right])
    if not land:
        return [tooth]
    teeth = [tooth + np.array([k * pitch, 0.0]) for k in (-1, 0, 1)]
    return [*teeth, np.array([[-1e4, tip - points[-1][1]], [1e4, tip - points[-1][1]]])]


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


def field(point, motion, cutter, outlines, pitch=0.0, gash_lead=math.inf):
    """Largest depth of `point` over every crossing of every gash, and the instant [samples] of it.

    An edge at axial position s stands 2 pi s / `gash_lead` further about the axis.
    """
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
    ahead = 2 * math.pi * (local[:, 2] - cutter.shift) / gash_lead
    best, when = -math.inf, math.nan
    for phase, shift in zip(cutter.gash_angle, cutter.gash_shift, strict=True):
        phase_lag = (tool + phase + ahead - turned) / (2 * math.pi)
        crossed = np.floor(phase_lag[:-1]) != np.floor(phase_lag[1:])
        # an edge that misses by more than the best so far needs no bisection
        crossed &= reach[:-1].clip(max=reach[1:]) - cutter.radius < 0.5 - best
        for i in np.flatnonzero(crossed):
            goal = max(math.floor(phase_lag[i]), math.floor(phase_lag[i + 1])) * 2 * math.pi

            def lag(f, i=i, phase=phase, goal=goal):
                q = seen(work[i] + f * (work[i + 1] - work[i]), centre[i] + f * (centre[i + 1] - centre[i]))
                edge = tool[i] + f * (tool[i + 1] - tool[i]) + phase
                edge += 2 * math.pi * (q[2] - cutter.shift) / gash_lead
                raw = edge - math.atan2(q[1], q[0]) - goal
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


def wheel_field(point, motion, outlines):
    """Largest depth of `point` in a body of revolution that turns, over all time, and the instant of it."""
    x, y, z = motion.mount.rotation @ point + motion.mount.translation
    samples = np.arange(len(motion.time_s))

    def seen(at):
        work = np.interp(at, samples, motion.work_angle)
        lab = np.array(
            [x * np.cos(work) - y * np.sin(work), x * np.sin(work) + y * np.cos(work), z + 0 * work]
        )
        centre = np.array([np.interp(at, samples, column) for column in motion.centre.T])
        a, b, s = motion.basis @ (lab - centre)
        return s, np.hypot(a, b)

    def depth(at):
        s, rho = seen(at)
        return max(depth_in_outline(line, float(s), float(rho)) for line in outlines)

    tip = max(line[:, 1].max() for line in outlines)
    fine = np.linspace(0.0, samples[-1], 4 * len(samples) - 3)
    _, rho = seen(fine)
    # a wheel that stands still does not cut
    turning = np.interp(fine, samples[:-1] + 0.5, np.abs(np.diff(motion.tool_angle))) > 1e-9
    near = np.flatnonzero(turning & (rho < rho[turning].min(initial=math.inf) + 2.0) & (rho < tip + 3.0))
    value = np.full(len(fine), -math.inf)
    value[near] = [depth(at) for at in fine[near]]
    best, when = -math.inf, math.nan
    for k in np.flatnonzero(value > value.max() - 0.05):
        if k and value[k - 1] > value[k]:
            continue
        low, high = fine[max(k - 1, 0)], fine[min(k + 1, len(fine) - 1)]
        for _ in range(60):
            one, other = low + 0.382 * (high - low), low + 0.618 * (high - low)
            if depth(one) < depth(other):
                low = one
            else:
                high = other
        if depth(low) > best:
            best, when = depth(low), low
    return best, when
