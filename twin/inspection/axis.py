"""The part's own axis where it is not the mesh's Z: found by its bore, else by its tips, and taken out.

Both are cylinders, fitted by least squares to the mesh's corners that lie on them (inspection.md, section 3).
"""

import math

import numpy as np

from twin.errors import PartError
from twin.inspection.recognise import Form, Outline
from twin.inspection.result import Axis
from twin.inspection.sections import points_between
from twin.inspection.solid import Floats, Solid, solid_of

FACING = 0.9
"""a face of a bore looks towards the axis: cosine of the angle between the two"""
ROUND = 0.6
"""part of the faces looking inward that must lie on one cylinder to be a bore"""
WIDE = math.radians(60.0)
"""a bore may be broken by a keyway of no more than this"""
STEP = 0.25
"""radii of a bore farther apart than this [mm] are steps of it"""
SLABS = 20
"""heights at which the tip of every tooth is looked for"""
SPREAD = 4.0
"""points farther off than this many times the usual residual are left out"""
EXACT = 1e-4
"""and no point nearer than this [mm]"""
ROUNDS = 30


def find_axis(solid: Solid, outline: Outline) -> Axis:
    """Find the axis of the bore, else of the tip circle.

    Raises:
        PartError: neither is there.

    """
    points = _bore(solid, outline)
    if points is not None:
        step = _longest_step(points)
        axis, kept = _cylinder(step, "bore")
        if np.count_nonzero(kept) >= ROUND * len(step) and _surrounded(step[kept]):
            return axis
    if outline.form is Form.NEITHER:
        raise PartError(f"no bore and no tips to find an axis by: {outline.reason}")
    axis, _ = _cylinder(_tips(solid, outline), "tip circle" if outline.form is Form.GEAR else "corners")
    return axis


def straightened(solid: Solid, axis: Axis) -> Solid:
    """Return the solid moved and turned so that the axis found is Z; the axis keeps its heights."""
    pivot = np.array([axis.x_mm, axis.y_mm, axis.at_z_mm])
    turned = (solid.vertices - pivot) @ _upright(axis).T
    turned[:, 2] += axis.at_z_mm
    return solid_of(turned, solid.faces, solid.neighbours, solid.mended)


def _upright(axis: Axis) -> Floats:
    """Return the rotation (3, 3) that turns the axis into Z by the shortest way."""
    lean = [math.tan(math.radians(tilt)) for tilt in (axis.tilt_x_deg, axis.tilt_y_deg)]
    x, y, z = np.array([*lean, 1.0]) / math.sqrt(1 + lean[0] ** 2 + lean[1] ** 2)
    # Rodrigues' formula with u = (x, y, z) and e_z
    return np.array(
        [
            [1 - x * x / (1 + z), -x * y / (1 + z), -x],
            [-x * y / (1 + z), 1 - y * y / (1 + z), -y],
            [x, y, z],
        ]
    )


def _bore(solid: Solid, outline: Outline) -> Floats | None:
    """Return the corners (n, 3) of the faces that look at the axis from all round, if there are such."""
    near = solid.face_far < outline.tip_radius**2 if outline.tip_radius else np.ones(len(solid.faces), bool)
    faces = solid.faces[near]
    a, b, c = (solid.vertices[faces[:, i]] for i in range(3))
    normal, middle = np.cross(b - a, c - a), (a + b + c) / 3
    length = np.linalg.norm(normal, axis=1) * np.hypot(middle[:, 0], middle[:, 1])
    inward = np.einsum("ij,ij->i", normal[:, :2], middle[:, :2]) < -FACING * length
    if np.count_nonzero(inward) < 6:
        return None
    points = solid.vertices[np.unique(faces[inward])]
    return points if _surrounded(points) else None


def _longest_step(points: Floats) -> Floats:
    """Return those points (n, 3) that lie on the longest cylinder of a bore in steps: all, if it has none."""
    radius = np.hypot(points[:, 0], points[:, 1])
    order = np.argsort(radius)
    # the axis may stand off and lean a little: steps are higher than that
    starts = np.flatnonzero(np.diff(radius[order], prepend=-np.inf) > STEP)
    steps = np.split(order, starts[1:])
    return points[max(steps, key=lambda rows: (float(np.ptp(points[rows, 2])), len(rows)))]


def _surrounded(points: Floats) -> bool:
    """Whether points (n, 3) stand all round the axis."""
    angle = np.sort(np.arctan2(points[:, 1], points[:, 0]))
    return len(angle) > 2 and bool(np.diff(angle, append=angle[0] + 2 * math.pi).max() < WIDE)


def _tips(solid: Solid, outline: Outline) -> Floats:
    """Return the outermost corner (n, 3) of every tooth, or polygon's corner, at several heights."""
    points = points_between(solid, outline.low, outline.high)
    x, y, z = points.T
    angle = np.arctan2(y, x) - outline.phase - outline.twist * (z - outline.middle)
    sector = np.round(angle * outline.count / (2 * math.pi)).astype(np.int64) % outline.count
    part = (z - outline.low) / (outline.high - outline.low)
    slab = np.clip((part * SLABS).astype(np.int64), 0, SLABS - 1)
    cell = sector * SLABS + slab
    order = np.lexsort((np.hypot(x, y), cell))
    last = np.flatnonzero(np.diff(cell[order], append=-1))
    return points[order[last]]


def _cylinder(points: Floats, datum: str) -> tuple[Axis, np.ndarray]:
    """Fit a cylinder about Z or nearly so; return its axis and which of the points (n, 3) lie on it."""
    middle = float(points[:, 2].min() + np.ptp(points[:, 2]) / 2)
    x = y = lean_x = lean_y = 0.0
    radius = float(np.median(np.hypot(points[:, 0], points[:, 1])))
    kept = np.ones(len(points), dtype=bool)
    residual = np.zeros(len(points))
    for _ in range(ROUNDS):
        along = np.array([lean_x, lean_y, 1.0]) / math.sqrt(1 + lean_x**2 + lean_y**2)
        from_axis = points - np.array([x, y, middle])
        across = from_axis - (from_axis @ along)[:, None] * along
        distance = np.linalg.norm(across, axis=1)
        residual = distance - radius
        off = np.abs(residual - np.median(residual))
        kept = off <= max(SPREAD * float(np.median(off)), EXACT)
        cos, sin = across[kept, 0] / distance[kept], across[kept, 1] / distance[kept]
        height = from_axis[kept, 2]
        design = np.column_stack([cos, sin, height * cos, height * sin, np.ones(len(cos))])
        step, _, rank, _ = np.linalg.lstsq(design, residual[kept], rcond=1e-9)
        if rank < design.shape[1]:
            raise PartError(f"the {datum} has too few corners to find an axis by")
        x, y, lean_x, lean_y, radius = np.array([x, y, lean_x, lean_y, radius]) + step
        if np.abs(step).max() < 1e-12:
            break
    axis = Axis(
        datum=datum,
        diameter_mm=2 * float(radius),
        at_z_mm=middle,
        x_mm=float(x),
        y_mm=float(y),
        tilt_x_deg=math.degrees(math.atan(lean_x)),
        tilt_y_deg=math.degrees(math.atan(lean_y)),
        roundness_um=1000 * float(np.ptp(residual[kept])),
    )
    return axis, kept
