"""A polygon's section against the true polygon, its deviation magnified, and every face unrolled."""

import numpy as np
from markupsafe import Markup

from twin.inspection.result import Floats, PolygonResult
from twin.report.drawing import Drawing, Plot
from twin.report.scale import largest, nice_ceiling, nice_floor

WIDTH, HEIGHT = 180.0, 92.0
"""[mm]"""
TOP = 8.0
SECTION = 80.0
"""side of the square that holds the section [mm]"""
FACES_LEFT = 98.0
"""where the plot of the faces begins [mm]"""


def section_chart(polygon: PolygonResult) -> Markup | None:
    """SVG of the section; None where no outline or no face was found."""
    if not (len(polygon.section) and len(polygon.faces)):
        return None
    across = polygon.reference.across_flats_mm if polygon.reference else polygon.across_flats_mm
    face, along, deviation_um = deviations(polygon, across)
    magnification = nice_floor(0.07 * across * 1e3 / max(largest(deviation_um), 0.1))
    drawing = Drawing("section", WIDTH, HEIGHT)
    _draw_outline(
        drawing,
        polygon,
        across=across,
        face=face,
        along=along,
        deviation_um=deviation_um,
        magnification=magnification,
    )
    _draw_faces(drawing, polygon, face, along, deviation_um)
    return drawing.svg("Section of the polygon against the true polygon, deviation magnified")


def deviations(polygon: PolygonResult, across_flats_mm: float) -> tuple[np.ndarray, Floats, Floats]:
    """Of every point of the section (m,): its face, its place along the face [mm], its deviation [µm].

    Measured along the normal of a face of the true polygon, which has the faces' own mean orientation.
    """
    normals = true_normals(polygon)
    point = polygon.section[:, 0] + 1j * polygon.section[:, 1]
    turned = point[:, None] * np.conj(normals)
    face = np.abs(np.angle(turned)).argmin(axis=1)
    local = turned[np.arange(len(point)), face]
    return face, local.imag, (local.real - across_flats_mm / 2) * 1e3


def true_normals(polygon: PolygonResult) -> np.ndarray:
    """(sides,) outward unit normals of the true polygon as complex numbers, in the order of `faces`."""
    angle = np.radians([face.direction_deg for face in polygon.faces])
    sides = len(polygon.faces)
    start = np.angle(np.exp(1j * sides * angle).mean()) / sides
    step = 2 * np.pi / sides
    return np.exp(1j * (start + step * np.round((angle - start) / step)))


def _draw_outline(
    drawing: Drawing,
    polygon: PolygonResult,
    *,
    across: float,
    face: np.ndarray,
    along: Floats,
    deviation_um: Floats,
    magnification: float,
) -> None:
    normals = true_normals(polygon)
    order = np.argsort(np.angle(normals))
    corner = across / 2 / np.cos(np.pi / len(normals)) * np.exp(1j * np.pi / len(normals)) * normals[order]
    foot = (across / 2 + 1j * along) * normals[face]
    drawn = foot + deviation_um * 1e-3 * magnification * normals[face]
    reach = 1.06 * max(float(np.abs(np.concatenate([drawn, corner])).max()), 1e-9)
    box = (-reach, reach)
    plot = Plot(drawing, left=2.0, top=TOP, width=SECTION, height=SECTION, x=box, y=box)
    around = np.concatenate([drawn, drawn[:1], foot[:1], foot[::-1]])
    plot.curve(around.real, around.imag, "shade left", closed=True)
    plot.curve(corner.real, corner.imag, "true", id="true", closed=True)
    plot.curve(drawn.real, drawn.imag, "trace left", id="outline", closed=True)
    for k, normal in enumerate(normals):
        at = normal * across * 0.36
        x, y = float(plot.across(at.real)), float(plot.down(at.imag)) + 1.0
        drawing.text(x, y, str(k + 1), "strong", anchor="middle")
    plot.curve((-0.02 * reach, 0.02 * reach), (0, 0), "axis")
    plot.curve((0, 0), (-0.02 * reach, 0.02 * reach), "axis")
    drawing.text(2.0, 3.2, f"Section at mid-length, deviation {magnification:g}:1", "title")


def _draw_faces(
    drawing: Drawing, polygon: PolygonResult, face: np.ndarray, along: Floats, deviation_um: Floats
) -> None:
    """Deviation along each face, one below the other."""
    spacing = nice_ceiling(1.3 * max(float(np.ptp(deviation_um)), 0.5))
    zeros = -spacing * np.arange(len(polygon.faces))
    low = min(float(deviation_um.min()), 0.0)
    top = max(float(deviation_um.max()), 0.0) + 0.15 * spacing
    reach = float(np.abs(along).max())
    plot = Plot(
        drawing,
        left=FACES_LEFT,
        top=TOP,
        width=WIDTH - FACES_LEFT - 2.0,
        height=SECTION - 8.0,
        x=(-1.04 * reach, 1.04 * reach),
        y=(zeros[-1] + low - 0.3 * spacing, top + 0.6 * spacing),
    )
    for k, zero in enumerate(zeros.tolist()):
        here = np.flatnonzero(face == k)
        here = here[np.argsort(along[here])]
        plot.level(zero, "zero")
        plot.curve(along[here], zero + deviation_um[here], "trace right", id=f"face-{k + 1}")
        drawing.text(plot.left - 2.0, float(plot.down(zero)) + 0.8, str(k + 1), "strong", anchor="end")
    plot.x_axis("along the face [mm]")
    drawing.text(plot.left, 3.2, "Faces against the true flat, + = material left", "title")
    um = nice_floor(0.5 * spacing)
    right = reach
    plot.curve((right, right), (top, top + um), "scale", id="scale")
    x, y = float(plot.across(right)) - 1.2, float(plot.down(top + um / 2)) + 0.8
    drawing.text(x, y, f"{um:g} µm", "small", anchor="end")
