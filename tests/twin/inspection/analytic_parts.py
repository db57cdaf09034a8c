"""Closed meshes of gears and polygons from their closed forms, with errors put in on purpose.

Shares nothing with what it tests: flanks are points of the unwound thread, x = r_b e(phi) + s t(phi), and an
error is how much farther a point of roll length s stands along it. Teeth are counted from 0,
counter-clockwise from +X, as C turns.
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
    chamfer: float = 0.0,
    trochoid: bool = False,
    pressure_deg: float = 20.0,
    roll_corners: tuple[float, ...] = (),
    z_corners: tuple[float, ...] = (),
):
    """Vertices and faces of a gear of ISO 53 profile A between z = -width and 0.

    Where an error has a corner, at a roll length or a height, the mesh has one too: `roll_corners`,
    `z_corners` [mm]. `chamfer` [mm] takes off the tips' edges at 45°. The root is a quarter of an ellipse, or
    with `trochoid` (spur gears) the path of the rounded rack corner, which undercuts few teeth.
    """
    beta, alpha = math.radians(helix_deg), math.radians(pressure_deg)
    alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
    r = teeth * module / math.cos(beta) / 2
    r_b = r * math.cos(alpha_t)
    r_a, r_f = r + module * (tip_factor + shift), r - module * (1.25 - shift)
    # the straight flank of the rack ends rho (1 - sin alpha) above its tip
    straight = module * (1.25 - shift - 0.38 * (1 - math.sin(alpha)))
    first_roll = max(r * math.sin(alpha_t) - straight / math.sin(alpha_t), 0.02 * module)
    if trochoid:
        root_r, root_gap = rack_corner(teeth, module, shift, alpha)
        first_roll = math.sqrt(root_r[-1] ** 2 - r_b**2)
    last_roll = math.sqrt((r_a - chamfer) ** 2 - r_b**2)
    roll = np.linspace(first_roll, last_roll, math.ceil((last_roll - first_roll) / roll_step) + 1)
    roll = with_corners(roll, roll_corners)
    half_at_base = (math.pi / 2 + 2 * shift * math.tan(alpha)) / teeth + math.tan(alpha_t) - alpha_t
    twist = 2 * math.sin(beta) / (teeth * module)
    layers = np.linspace(-width, 0.0, max(math.ceil(width / z_step), 1) + 1)
    layers = with_corners(layers, z_corners)
    arc = np.linspace(0, 1, 8)[1:-1]
    quarter = np.linspace(0, math.pi / 2, 8)[1:]

    def side_of_tooth(k, side, z):
        """Radius and angle from the tooth's middle outward, from the form circle up to the tip."""
        unwound = roll - error(k, side, roll, z)
        return np.hypot(r_b, roll), half_at_base - (unwound / r_b - np.arctan2(roll, r_b))

    def ring(z):
        radii, angles = [], []
        for k in range(teeth):
            middle = 2 * math.pi * k / teeth + twist * z + math.radians(phase_deg)
            gap_end = []
            for side in (-1, 1):
                radius, half = side_of_tooth(k, side, z)
                if trochoid:
                    fillet_r, fillet_half = root_r[:-1], math.pi / teeth - root_gap[:-1]
                else:
                    reach = 0.4 * (math.pi / teeth - half[0])
                    fillet_r = (radius[0] - (radius[0] - r_f) * np.sin(quarter))[::-1]
                    fillet_half = (half[0] + reach * (1 - np.cos(quarter)))[::-1]
                edge = np.linspace(0, chamfer, 5)[1:] if chamfer else np.zeros(0)
                radius = np.concatenate([fillet_r, radius, radius[-1] + edge])
                half = np.concatenate([fillet_half, half, half[-1] - edge / r_a])
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


def with_corners(places, corners):
    """Ascending places, and the corners between the first and the last of them."""
    inner = [corner for corner in corners if places[0] < corner < places[-1]]
    return np.unique(np.concatenate([places, inner]))


def all_of(*errors: Error) -> Error:
    """The sum of errors."""
    return lambda tooth, side, roll, z: sum(error(tooth, side, roll, z) for error in errors)


def relief(amount: float, begin: float, end: float, *, along: str, order: int = 1) -> Error:
    """Material taken off [mm] from `begin` on, `amount` of it at `end`, in a line (1) or parabola (2).

    `along` is "roll" (tip relief where end > begin, root relief where it is less) or "z" (end relief).
    """

    def error(tooth, side, roll, z):
        at = roll if along == "roll" else np.full_like(roll, z)
        return -amount * np.maximum((at - begin) / (end - begin), 0.0) ** order

    return error


def rack_corner(teeth, module, shift, alpha, points=120):
    """Radii and angles from the gap's middle of the trochoid, from root to involute (geometry.md, 1)."""
    r, rho = teeth * module / 2, 0.38 * module
    depth = 1.25 * module
    b_c = math.pi * module / 4 - depth * math.tan(alpha) - rho * (1 - math.sin(alpha)) / math.cos(alpha)
    down = depth - rho - shift * module
    r_b = r * math.cos(alpha)
    half_at_base = (math.pi / 2 + 2 * shift * math.tan(alpha)) / teeth + math.tan(alpha) - alpha

    def path(u):
        centre = (u + b_c) + 1j * (r - down)
        away = centre - 1j * r
        point = (centre + rho * away / abs(away)) * np.exp(1j * u / r)
        return abs(point), math.pi / 2 - np.angle(point)

    def too_wide(u):
        """How much wider the path leaves the gap than the involute does."""
        radius, gap = path(u)
        angle = math.acos(min(r_b / radius, 1.0))
        return gap - (math.pi / teeth - half_at_base + math.tan(angle) - angle)

    last = down / math.tan(alpha) - b_c
    grid = np.linspace(-b_c, last, 4001)
    radius = path(grid)[0]
    # below the tangent point the path lies inside the involute's gap, unless it has cut it away
    wide = np.array([r_k > r_b and too_wide(u) > 1e-9 for u, r_k in zip(grid, radius, strict=True)])
    if wide.any():
        beyond = int(np.flatnonzero(wide)[radius[wide].argmax()])
        other = beyond + (1 if radius[min(beyond + 1, 4000)] > radius[beyond] else -1)
        last = brentq(too_wide, grid[beyond], grid[other], xtol=1e-15)
    return path(np.linspace(-b_c, last, points))


def moved(mesh, *, offset=(0.0, 0.0), tilt_deg=0.0, towards_deg=0.0, about_z=0.0):
    """The mesh tilted about a point of its axis towards a direction, then pushed aside."""
    vertices, faces = mesh
    lean, to = math.radians(tilt_deg), math.radians(towards_deg)
    out, z = np.array([math.cos(to), math.sin(to), 0.0]), np.array([0.0, 0.0, 1.0])
    across = np.cross(z, out)
    turn = (
        np.outer(out * math.cos(lean) - z * math.sin(lean), out)
        + np.outer(across, across)
        + np.outer(z * math.cos(lean) + out * math.sin(lean), z)
    )
    pivot = about_z * z
    return (vertices - pivot) @ turn.T + pivot + np.array([*offset, 0.0]), faces


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
