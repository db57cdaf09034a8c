"""A polygon's section against the true polygon, its deviation magnified, and every face unrolled."""

import numpy as np
from matplotlib.axes import Axes

from twin.inspection.result import Floats, PolygonResult
from twin.report.scale import largest, nice_ceiling, nice_floor
from twin.report.style import FAINT, GREY, INK, LEFT, RIGHT, figure, quiet, styled, to_svg


def section_chart(polygon: PolygonResult) -> str | None:
    """SVG of the section; None where no outline or no face was found."""
    if not (len(polygon.section) and len(polygon.faces)):
        return None
    across = polygon.reference.across_flats_mm if polygon.reference else polygon.across_flats_mm
    face, along, deviation_um = deviations(polygon, across)
    magnification = nice_floor(0.07 * across * 1e3 / max(largest(deviation_um), 0.1))
    with styled():
        sheet = figure(3.6)
        outline, unrolled = sheet.subplots(
            1,
            2,
            width_ratios=(1, 1.15),
            gridspec_kw={"left": 0.01, "right": 0.985, "wspace": 0.16, "top": 0.90, "bottom": 0.12},
        )
        _draw_outline(
            outline,
            polygon,
            across=across,
            face=face,
            along=along,
            deviation_um=deviation_um,
            magnification=magnification,
        )
        _draw_faces(unrolled, polygon, face, along, deviation_um)
        return to_svg(
            sheet, "section", "Section of the polygon against the true polygon, deviation magnified"
        )


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
    axes: Axes,
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
    corner = np.concatenate([corner, corner[:1]])
    foot = (across / 2 + 1j * along) * normals[face]
    drawn = foot + deviation_um * 1e-3 * magnification * normals[face]
    drawn, foot = (np.concatenate([points, points[:1]]) for points in (drawn, foot))
    around = np.concatenate([drawn, foot[::-1]])
    axes.fill(around.real, around.imag, color=LEFT, alpha=0.15, linewidth=0)
    axes.plot(np.real(corner), np.imag(corner), color=GREY, linewidth=0.6, gid="true")
    axes.plot(drawn.real, drawn.imag, color=LEFT, gid="outline")
    for k, normal in enumerate(normals):
        at = normal * across * 0.36
        axes.text(at.real, at.imag, str(k + 1), ha="center", va="center", fontweight="bold")
    axes.plot([0], [0], marker="+", color=GREY, markersize=6, markeredgewidth=0.5)
    axes.set_aspect("equal")
    quiet(axes, "left", "bottom")
    axes.set_title(f"Section, deviation × {magnification:g}")


def _draw_faces(
    axes: Axes, polygon: PolygonResult, face: np.ndarray, along: Floats, deviation_um: Floats
) -> None:
    """Deviation along each face, one below the other."""
    spacing = nice_ceiling(1.3 * max(np.ptp(deviation_um), 0.5))
    zeros = -spacing * np.arange(len(polygon.faces))
    for k, zero in enumerate(zeros):
        here = np.flatnonzero(face == k)
        here = here[np.argsort(along[here])]
        axes.axhline(zero, color=FAINT, linewidth=0.6, zorder=0)
        axes.plot(along[here], zero + deviation_um[here], color=RIGHT, gid=f"face-{k + 1}")
    low = min(float(deviation_um.min()), 0.0)
    top = max(float(deviation_um.max()), 0.0) + 0.15 * spacing
    axes.set_ylim(zeros[-1] + low - 0.3 * spacing, top + 0.6 * spacing)
    axes.set_yticks(zeros, [str(k + 1) for k in range(len(zeros))])
    axes.set_ylabel("face")
    axes.set_xlabel("along the face [mm]")
    axes.set_title("Faces against the true flat, + = material left")
    um = nice_floor(0.5 * spacing)
    right = float(along.max())
    axes.plot([right, right], [top, top + um], color=INK, linewidth=1.2)
    axes.annotate(
        f"{um:g} µm",
        (right, top + um / 2),
        (-3, 0),
        textcoords="offset points",
        ha="right",
        va="center",
    )
