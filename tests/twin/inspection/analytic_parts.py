"""Closed meshes of gears and polygons from their closed forms, with errors put in on purpose.

Shares nothing with what it tests: flanks are points of the unwound thread, x = r_b e(phi) + s t(phi), and an
error moves a point along that thread. Teeth are counted from 0, counter-clockwise from +X, as C turns.
"""

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

Error = Callable[[int, int, np.ndarray, float], np.ndarray]
"""(tooth, side: +1 left, -1 right, roll lengths [mm], z [mm]) -> material to add, normal to the flank [mm]"""


def no_error(tooth, side, roll, z):
    return np.zeros_like(roll)


def gear_mesh(
    *,
    teeth: int,
    module: float,
    helix_deg: float = 0.0,
    shift: float = 0.0,
    width: float = 20.0,
    error: Error = no_error,
    roll_step: float = 0.05,
    z_step: float = 0.5,
    eccentricity: tuple[float, float] = (0.0, 0.0),
    phase_deg: float = 0.0,
    bore: float = 0.0,
    tip_factor: float = 1.0,
):
    """Vertices and faces of a gear with 20° pressure angle, ISO 53 profile A, between z = -width and 0."""
    beta, alpha = math.radians(helix_deg), math.radians(20.0)
    alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
    r = teeth * module / math.cos(beta) / 2
    r_b = r * math.cos(alpha_t)
    r_a, r_f = r + module * (tip_factor + shift), r - module * (1.25 - shift)
    # the straight flank of the rack ends rho (1 - sin alpha) above its tip
    straight = module * (1.25 - shift - 0.38 * (1 - math.sin(alpha)))
    first_roll = max(r * math.sin(alpha_t) - straight / math.sin(alpha_t), 0.02 * module)
    last_roll = math.sqrt(r_a**2 - r_b**2)
    roll = np.linspace(first_roll, last_roll, math.ceil((last_roll - first_roll) / roll_step) + 1)
    half_at_base = (math.pi / 2 + 2 * shift * math.tan(alpha)) / teeth + math.tan(alpha_t) - alpha_t
    twist = 2 * math.sin(beta) / (teeth * module)
    layers = np.linspace(-width, 0.0, max(math.ceil(width / z_step), 1) + 1)
    arc = np.linspace(0, 1, 8)[1:-1]
    quarter = np.linspace(0, math.pi / 2, 8)[1:]

    def side_of_tooth(k, side, z):
        """Radius and angle from the tooth's middle outward, from the form circle up to the tip."""
        along = roll + error(k, side, roll, z)
        return np.hypot(r_b, along), half_at_base - (roll / r_b - np.arctan2(along, r_b))

    def ring(z):
        radii, angles = [], []
        for k in range(teeth):
            middle = 2 * math.pi * k / teeth + twist * z + math.radians(phase_deg)
            gap_end = []
            for side in (-1, 1):
                radius, half = side_of_tooth(k, side, z)
                reach = 0.4 * (math.pi / teeth - half[0])
                fillet_r = radius[0] - (radius[0] - r_f) * np.sin(quarter)
                fillet_half = half[0] + reach * (1 - np.cos(quarter))
                radius = np.concatenate([fillet_r[::-1], radius])
                half = np.concatenate([fillet_half[::-1], half])
                gap_end.append((radius[::-side], middle + side * half[::-side]))
            (right_r, right_a), (left_r, left_a) = gap_end
            radii += [right_r, right_r[-1] + arc * (left_r[0] - right_r[-1]), left_r]
            angles += [right_a, right_a[-1] + arc * (left_a[0] - right_a[-1]), left_a]
            bottom = 2 * math.pi / teeth - 2 * (left_a[-1] - middle)
            radii.append(np.full(len(arc), r_f))
            angles.append(left_a[-1] + arc * bottom)
        return np.concatenate(radii), np.concatenate(angles)

    rings = []
    for z in layers:
        radius, angle = ring(z)
        rings.append(
            np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(len(radius), z)])
        )
    return loft(rings, bore=bore, offset=eccentricity)


def polygon_mesh(
    *,
    across_flats: float,
    cutter_radius: float,
    inserts: int,
    sides: int,
    width: float = 20.0,
    twist_deg_per_mm: float = 0.0,
    points: int = 200,
    z_step: float = 1.0,
    blank_diameter: float = math.inf,
    offset: tuple[float, float] = (0.0, 0.0),
    phase_deg: float = 0.0,
    bore: float = 0.0,
):
    """Vertices and faces of a turned polygon: the path w(theta) of an insert in the work frame."""
    face = polygon_face(across_flats, cutter_radius, inserts, sides, points)
    count = abs(sides)
    outline = np.concatenate([face[:-1] * np.exp(2j * math.pi * k / count) for k in range(count)])
    outline *= np.minimum(1.0, blank_diameter / 2 / np.abs(outline)) * np.exp(1j * math.radians(phase_deg))
    layers = np.linspace(-width, 0.0, max(math.ceil(width / z_step), 1) + 1)
    rings = []
    for z in layers:
        turned = outline * np.exp(1j * math.radians(twist_deg_per_mm) * (z + width / 2))
        rings.append(np.column_stack([turned.real, turned.imag, np.full(len(turned), z)]))
    return loft(rings, bore=bore, offset=offset)


def polygon_face(across_flats, cutter_radius, inserts, sides, points):
    """One face, from corner to corner, symmetric about the real axis."""
    distance, ratio = across_flats / 2 + cutter_radius, sides / inserts

    def path(theta):
        return distance * np.exp(-1j * theta) - cutter_radius * np.exp(1j * (ratio - 1) * theta)

    grid = np.linspace(0, math.pi / 2, 20001)[1:]
    turned = np.abs(np.angle(path(grid)))
    beyond = int(np.argmax(turned >= math.pi / abs(sides)))
    theta = brentq(
        lambda t: abs(np.angle(path(t))) - math.pi / abs(sides), grid[beyond - 1], grid[beyond], xtol=1e-15
    )
    face = path(np.linspace(-theta, theta, points))
    return face if np.angle(face[-1]) > 0 else face[::-1]


def loft(rings, *, bore: float = 0.0, offset=(0.0, 0.0)):
    """Close a stack of rings (n, 3), counter-clockwise, with ends; `bore` is the diameter of a round hole."""
    n, layers = len(rings[0]), len(rings)
    vertices = np.concatenate(rings)
    i = np.arange(n)
    j = (i + 1) % n
    quads = [
        np.concatenate(
            [np.column_stack([a + i, a + j, a + n + j]), np.column_stack([a + i, a + n + j, a + n + i])]
        )
        for a in range(0, n * (layers - 1), n)
    ]
    top = n * (layers - 1)
    low_z, high_z = rings[0][0, 2], rings[-1][0, 2]
    base = len(vertices)
    if bore:
        inner = bore / 2 * rings[0][:, :2] / np.linalg.norm(rings[0][:, :2], axis=1)[:, None]
        hole = [np.column_stack([inner, np.full(n, z)]) for z in (low_z, high_z)]
        vertices = np.concatenate([vertices, *hole])
        b, t = base, base + n
        strips = ((b, 0), (top, t), (t, b))  # lower face, upper face, wall of the hole
        quads += [
            np.concatenate([np.column_stack([p + i, p + j, q + j]), np.column_stack([p + i, q + j, q + i])])
            for p, q in strips
        ]
    else:
        vertices = np.concatenate([vertices, [[0, 0, low_z], [0, 0, high_z]]])
        quads.append(np.column_stack([j, i, np.full(n, base)]))
        quads.append(np.column_stack([top + i, top + j, np.full(n, base + 1)]))
    return vertices + np.array([*offset, 0.0]), np.concatenate(quads)
