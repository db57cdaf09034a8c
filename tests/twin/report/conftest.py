"""Parts, inspections and recordings made by hand: every deviation in them is put in by formula."""

from types import SimpleNamespace

import numpy as np
import pytest

from twin.inspection.nominal import GearNominal, PolygonNominal
from twin.inspection.result import Face, Flank, GearResult, Inspection, PolygonResult, Trace, Verdict
from twin.recording import BlockRef, Recording
from twin.report import Message, Part, Program, ReportData, Row, Severity

PROGRAM = """%
O0001 (SPUR GEAR M2 Z20)
G28 U0 W0 ;
G97 S300 M03
G81 T20 L1 ;
G00 X35. Z20. M08
G01 Z-35. F2.
G80 ;
M30
%"""


def torus_grid(sections):
    """Close (k, n, 3) sections, joined one to the next and the last to the first, into a mesh."""
    k, n, _ = sections.shape
    index = np.arange(k * n).reshape(k, n)
    right, below = np.roll(index, -1, axis=1), np.roll(index, -1, axis=0)
    diagonal = np.roll(right, -1, axis=0)
    faces = np.stack([np.stack([index, below, right], -1), np.stack([right, below, diagonal], -1)], 2)
    return sections.reshape(-1, 3), faces.reshape(-1, 3)


def gear_part(*, teeth=20, module=2.0, width=20.0, bore=6.0, around=75, along=166, helix_deg=0.0, feed=2.0):
    """Involute gear with feed marks of 4.89 µm and a helix slope of 6 µm; NaN off the flanks."""
    radius, alpha = teeth * module / 2, np.radians(20.0)
    base, tip, root = radius * np.cos(alpha), radius + module, radius - 1.25 * module
    flank = around // 3
    roll = np.linspace(0.12, np.sqrt((tip / base) ** 2 - 1), flank)
    half = np.pi / (2 * teeth) + np.tan(alpha) - alpha
    flank_angle = half - (roll - np.arctan(roll))
    flank_radius = base * np.hypot(1.0, roll)
    rest = around - 2 * flank
    tips = np.linspace(-flank_angle[-1], flank_angle[-1], rest // 2 + 2)[1:-1]
    roots = np.linspace(half, 2 * np.pi / teeth - half, rest - rest // 2)
    angle = np.concatenate([-flank_angle, tips, flank_angle[::-1], roots])
    radii = np.concatenate(
        [flank_radius, np.full(len(tips), tip), flank_radius[::-1], np.full(len(roots), root)]
    )
    side = np.concatenate([-np.ones(flank), np.zeros(len(tips)), np.ones(flank), np.zeros(len(roots))])
    angle = (np.arange(teeth)[:, None] * 2 * np.pi / teeth + angle).ravel()
    radii, side = np.tile(radii, teeth), np.tile(side, teeth)
    z = np.linspace(0.0, -width, along)
    mark_um = 4.89 * (2 * ((z / feed) % 1.0) - 1.0) ** 2
    slope_um = 6.0 * (z / width + 0.5)
    deviation = np.where(side != 0, mark_um[:, None] + side * slope_um[:, None], np.nan)
    twist = z[:, None] * np.tan(np.radians(helix_deg)) / radius
    turned = angle + twist + np.nan_to_num(side * deviation) * 1e-3 / base
    outer = np.stack(
        [radii * np.cos(turned), radii * np.sin(turned), np.broadcast_to(z[:, None], turned.shape)], -1
    )
    ring = np.stack([bore * np.cos(angle), bore * np.sin(angle), np.zeros_like(angle)], -1)
    rear = ring + np.array([0, 0, -width])
    vertices, faces = torus_grid(np.concatenate([outer, rear[None], ring[None]]))
    values = np.concatenate([deviation, np.full((2, len(angle)), np.nan)])
    return Part(vertices=vertices, faces=faces, deviation_um=values.ravel())


def hexagon_section(points=1200, across=17.0, tip_radius=40.0, ratio=2.0):
    """Outline a three-insert head leaves: w(θ) = A e^{-jθ} - R e^{j(i-1)θ}, one face turned round."""
    distance = across / 2 + tip_radius
    theta = np.linspace(-np.pi / 7, np.pi / 7, points // 6 * 3)
    face = distance * np.exp(-1j * theta) - tip_radius * np.exp(1j * (ratio - 1) * theta)
    direction = np.angle(face)
    inside = face[np.abs(direction) <= np.pi / 6]
    inside = inside[np.argsort(np.angle(inside))]
    outline = np.concatenate([inside * np.exp(1j * np.pi / 3 * k) for k in range(6)])
    return np.stack([outline.real, outline.imag], -1)


def hexagon_part(width=12.0, along=24):
    outline = hexagon_section()
    z = np.linspace(0.0, -width, along)
    outer = np.concatenate(
        [
            np.broadcast_to(outline, (along, *outline.shape)),
            np.broadcast_to(z[:, None, None], (along, len(outline), 1)),
        ],
        -1,
    )
    scale = 3.0 / np.linalg.norm(outline, axis=1, keepdims=True)
    ring = np.concatenate([outline * scale, np.zeros((len(outline), 1))], -1)
    vertices, faces = torus_grid(np.concatenate([outer, (ring + np.array([0, 0, -width]))[None], ring[None]]))
    angle = np.arctan2(vertices[:, 1], vertices[:, 0])
    centre = np.round(angle / (np.pi / 3)) * np.pi / 3
    deviation = (vertices[:, 0] * np.cos(centre) + vertices[:, 1] * np.sin(centre) - 8.5) * 1e3
    return Part(
        vertices=vertices,
        faces=faces,
        deviation_um=np.where(np.hypot(*vertices[:, :2].T) > 8, deviation, np.nan),
    )


def trace(tooth, low, high, *, slope, wave, points=480, seed=0):
    position = np.linspace(low, high, points)
    start, end = low + 0.1 * (high - low), high - 0.1 * (high - low)
    rng = np.random.default_rng(seed)
    ripple = wave * np.cos(2 * np.pi * 9 * (position - low) / (high - low)) + 0.1 * rng.standard_normal(
        points
    )
    deviation = slope * (position - (start + end) / 2) / (end - start) + ripple
    deviation = deviation - 12.0 * np.clip((position - end) / (high - end), 0, None) ** 2
    used = (position >= start) & (position <= end)
    rise = np.polyfit(position[used], deviation[used], 1)
    residual = deviation[used] - np.polyval(rise, position[used])
    return Trace(
        tooth=tooth,
        position=position,
        deviation_um=deviation,
        evaluation=(start, end),
        slope_um=float(rise[0] * (end - start)),
        form_um=float(np.ptp(residual)),
        total_um=float(np.ptp(deviation[used])),
    )


def flank(sign, teeth=20):
    chosen = (1, 6, 11, 16)
    profile = tuple(trace(t, 5.0, 11.6, slope=sign * 2.5 + 0.2 * t, wave=0.6, seed=t) for t in chosen)
    helix = tuple(trace(t, -20.0, 0.0, slope=sign * 3.0 - 0.3 * t, wave=2.2, seed=50 + t) for t in chosen)
    k = np.arange(teeth)
    cumulative = 9.0 * np.sin(2 * np.pi * k / teeth + sign) + 0.5 * np.cos(2 * np.pi * 5 * k / teeth)
    pitch = cumulative - np.roll(cumulative, 1)
    return Flank(
        profile=profile,
        helix=helix,
        pitch_um=pitch,
        cumulative_um=cumulative,
        profile_slope_um=float(np.mean([t.slope_um for t in profile])),
        profile_form_um=max(t.form_um for t in profile),
        profile_total_um=max(t.total_um for t in profile),
        helix_slope_um=float(np.mean([t.slope_um for t in helix])),
        helix_form_um=max(t.form_um for t in helix),
        helix_total_um=max(t.total_um for t in helix),
        single_pitch_um=float(np.abs(pitch).max()),
        cumulative_pitch_um=float(np.ptp(cumulative)),
    )


def gear_inspection():
    nominal = GearNominal(number_of_teeth=20, normal_module_mm=2.0, accuracy_class=8)
    gear = GearResult(
        number_of_teeth=20,
        normal_module_mm=2.0003,
        helix_angle_deg=0.002,
        hand="spur",
        lead_mm=None,
        profile_shift=0.0,
        tip_diameter_mm=44.0,
        root_diameter_mm=35.0002,
        span_teeth=3,
        span_mm=15.3209,
        pin_diameter_mm=3.5,
        over_pins_mm=44.9293,
        runout_um=18.3,
        flank_offset_um=1.2,
        left=flank(1.0),
        right=flank(-1.0),
        reference=nominal,
        profile_range_mm=(37.85, 43.8),
        teeth_range_mm=(-20.0, 0.0),
        measuring_plane_mm=-10.0,
        phase_deg=0.0,
        accuracy_class={"profile_slope": 5, "profile_total": 6, "helix_total": 7, "overall": 7},
        tolerances_um={
            "profile_slope": 14.0,
            "profile_total": 22.0,
            "helix_total": 24.0,
            "single_pitch": 17.0,
        },
    )
    return Inspection(gear=gear, nominal=nominal, verdict=Verdict.IN)


def polygon_inspection():
    faces = tuple(
        Face(
            direction_deg=60.0 * k,
            distance_mm=8.4956,
            width_mm=9.815,
            mid_distance_mm=8.5,
            bow_um=13.0,
            flatness_um=13.2,
            twist_deg_per_mm=0.0,
        )
        for k in range(6)
    )
    nominal = PolygonNominal(number_of_sides=6, across_flats_mm=17.0)
    polygon = PolygonResult(
        number_of_sides=6,
        across_flats_mm=17.0,
        across_flats_planes_mm=16.9912,
        across_flats_caliper_mm=17.0001,
        across_flats_caliper_least_mm=16.9999,
        across_corners_mm=19.6,
        across_corners_least_mm=19.598,
        bow_um=13.04,
        flatness_um=13.2,
        twist_deg_per_mm=0.0,
        hand="none",
        concentricity_um=0.3,
        angles_deg=np.full(6, 60.0),
        faces=faces,
        range_mm=(-12.0, 0.0),
        section=hexagon_section(),
        reference=nominal,
    )
    return Inspection(polygon=polygon, nominal=nominal, verdict=Verdict.IN)


def recording(samples=150_000):
    """X, Z slides, tool spindle Y, work spindle C; a single-sample spike of 80 µm in the Z error."""
    t = np.arange(samples) * 1e-3
    end = max(t[-1] if samples else 0.0, 1e-3)
    ramp = np.clip(t / (0.05 * end), 0, 1)
    hob = np.cumsum(ramp) * 300 * 6 * 1e-3
    work = hob / 20
    z = 300 - np.clip((t / end - 0.1) / 0.8, 0, 1) * 55 if samples else t
    x = 200 - 182.5 * np.clip(t / (0.08 * end), 0, 1)
    setpoint = np.stack([x, z, hob, work], -1)
    lag = np.stack([0.002 * np.sin(3 * t), 0.0005 * np.cos(40 * t), 0.02 * ramp, 0.001 * ramp], -1)
    actual = setpoint - lag
    if samples:
        actual[samples // 3, 1] -= 0.08
    engaged = (t > 0.06 * end) & (t < 0.95 * end)
    lines = [4, 5, 6, 7, 8]
    texts = PROGRAM.splitlines()
    return Recording(
        time_s=t,
        axes=("X", "Z", "Y", "C"),
        setpoint=setpoint,
        actual=actual,
        block=np.minimum((t / end * 5).astype(np.int32), 4),
        blocks=tuple(BlockRef(file="program.nc", line=n, text=texts[n - 1]) for n in lines),
        tool=np.zeros(samples, np.int16),
        sync=engaged,
        sync_error_arcsec=np.where(engaged, -3600.0 * (0.001 - 0.02 / 20) * ramp, np.nan),
        sync_spectrum=None,
        work_angle_deg=work,
        tool_angle_deg=hob,
        tool_centre_mm=np.zeros((samples, 3)),
        tool_axis=np.tile([0.0, -1.0, 0.0], (samples, 1)),
        tool_zero=np.tile([1.0, 0.0, 0.0], (samples, 1)),
    )


def report(**changes):
    fields = {
        "title": "spur_m2_z20",
        "job": (Row(label="Material", value="16MnCr5"), Row(label="Hob", value="m 2 mm, Ø 70 mm, 12 gashes")),
        "provenance": (Row(label="hobtwin", value="0.1.0"), Row(label="job.toml", value="sha256 4f1c…09")),
        "timing": (Row(label="Controller and machine", value="1.9 s"), Row(label="Cutting", value="1.1 s")),
        "recording": recording(4000),
        "rotary_axes": frozenset("YC"),
        "messages": (
            Message(
                severity=Severity.WARNING,
                number="HT9101",
                text="FEED MARKS 14.3 µm",
                file="program.nc",
                line=7,
                column=12,
                found="F2. leaves marks of 14.3 µm in the root",
                remedy="F below 1.2 leaves less than 5 µm",
            ),
        ),
        "part": gear_part(around=30, along=20),
        "inspection": gear_inspection(),
        "programs": (Program(name="program.nc", text=PROGRAM),),
    }
    return ReportData(**(fields | changes))


@pytest.fixture(scope="session")
def sample():
    """The builders of this module, by name."""
    return SimpleNamespace(
        gear_part=gear_part,
        hexagon_part=hexagon_part,
        hexagon_section=hexagon_section,
        gear_inspection=gear_inspection,
        polygon_inspection=polygon_inspection,
        flank=flank,
        trace=trace,
        recording=recording,
        report=report,
        program=PROGRAM,
    )
