"""A spur or helical gear to be hobbed in one pass."""

import math
from dataclasses import dataclass

from twin.advice.gear_law import feed_mark, reference_diameter
from twin.cutters.hob import Hob
from twin.errors import InputError
from twin.inspection.nominal import GearNominal
from twin.inspection.tolerances import GearSize, gear_tolerance, outside_standard
from twin.starter.approach import clearance
from twin.starter.gashes import enough_gashes
from twin.starter.plan import Draft, highest_speeds, program_text, spindle_speed, toml_number, up, word

HOBS: tuple[tuple[float, float, int], ...] = (
    (1.0, 50.0, 12),
    (1.5, 63.0, 12),
    (2.0, 70.0, 12),
    (2.5, 70.0, 12),
    (3.0, 80.0, 12),
    (4.0, 90.0, 10),
    (5.0, 100.0, 10),
    (6.0, 115.0, 10),
    (8.0, 140.0, 10),
    (10.0, 170.0, 10),
)
"""Up to this module [mm]: outside diameter [mm] and gashes of a usual hob (DIN 8002 A, rounded)."""
LARGEST_FEED = 2.0
"""[mm per turn of the work]"""
FEED_STEP = 0.05
MARK_SHARE = 0.5
"""Of the helix form tolerance, left to the feed marks."""
BORE = 0.3
"""Bore over root diameter."""
ADDENDUM = 1.25
"""of the hob [modules]"""
TIP_RADIUS = 0.38
"""of the hob's teeth, where the pressure angle leaves room [modules] (ISO 53, profile A)"""
BESIDE = 2.0
"""[mm] beside the blank and above it before the hob comes near"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GearOrder:
    """What is wanted; None = chosen."""

    module: float
    teeth: int
    helix_deg: float = 0.0
    """+ right-hand"""
    width: float | None = None
    """[mm]; None = ten modules"""
    profile_shift: float = 0.0
    pressure_angle_deg: float = 20.0
    bore: float | None = None
    """[mm]; 0 = solid"""
    accuracy_class: int = 8
    hob_diameter: float | None = None
    gashes: int | None = None
    starts: int = 1
    cutting_speed: float = 60.0
    """v_c [m/min]"""
    feed: float | None = None
    """f_a [mm per turn of the work]"""


def draft_gear(order: GearOrder) -> Draft:
    """Job and program. Raises InputError for what no hob can cut or the draft does not know."""
    _check(order)
    nominal = GearNominal(
        number_of_teeth=order.teeth,
        normal_module_mm=order.module,
        helix_angle_deg=order.helix_deg,
        normal_pressure_angle_deg=order.pressure_angle_deg,
        profile_shift=order.profile_shift,
        accuracy_class=order.accuracy_class,
    )
    beta = math.radians(order.helix_deg)
    pitch = reference_diameter(teeth=order.teeth, module=order.module, helix=beta)
    tip = pitch + 2.0 * order.module * (1.0 + order.profile_shift)
    root = pitch - 2.0 * order.module * (ADDENDUM - order.profile_shift)
    width = order.width if order.width is not None else 10.0 * order.module
    size = GearSize(
        number_of_teeth=order.teeth,
        reference_diameter=pitch,
        normal_module=order.module,
        face_width=width,
        helix_angle=order.helix_deg,
    )
    hob = _hob(order, size, tip)
    bore = order.bore if order.bore is not None else up(BORE * root, 1.0)
    if not 0.0 <= bore < root - order.module:
        raise InputError(
            f"a bore of {bore:g} mm leaves no rim", remedy=f"valid: 0 to {root - order.module:.3f}"
        )
    aside = clearance(
        tip_radius=hob.outside_diameter_mm / 2.0,
        outside_radius=tip / 2.0,
        root_radius=root / 2.0,
        swivel=beta - hob.lead_angle,
    )
    beside = up(aside + BESIDE, 0.5)
    work_rpm, tool_rpm = highest_speeds()
    highest = min(tool_rpm, work_rpm * order.teeth / order.starts)
    speed = spindle_speed(order.cutting_speed, hob.outside_diameter_mm, highest)
    feed = order.feed if order.feed is not None else _feed(order, hob, size)
    program = _program(order, root, up(tip + 2.0 * BESIDE, 1.0), (beside, -width - beside), (speed, feed))
    shape = f"β {abs(order.helix_deg):g}° {'right' if beta > 0 else 'left'}" if beta else "spur"
    return Draft(
        job=_job(nominal, hob, tip, width, bore) + _expect(nominal, size),
        program=program,
        summary=f"gear m{order.module:g} z{order.teeth} {shape}, {width:g} mm wide: S{speed}, F{feed:g}",
    )


def _check(order: GearOrder) -> None:
    limits = (
        ("--module", order.module, 0.5, 10.0),
        ("--teeth", order.teeth, 5, 1000),
        ("--helix", order.helix_deg, -45.0, 45.0),
        ("--pressure-angle", order.pressure_angle_deg, 14.0, 30.0),
        ("--profile-shift", order.profile_shift, -1.0, 1.0),
        ("--class", order.accuracy_class, 1, 11),
        ("--starts", order.starts, 1, 5),
        ("--cutting-speed", order.cutting_speed, 1.0, 400.0),
        ("--width", order.width if order.width is not None else 1.0, 0.5, 300.0),
        ("--feed", order.feed if order.feed is not None else 1.0, 0.05, 10.0),
    )
    for name, value, low, high in limits:
        if not low <= value <= high:
            raise InputError(f"{name} {value:g}", remedy=f"valid: {low:g} to {high:g}")


def _hob(order: GearOrder, size: GearSize, tip: float) -> Hob:
    """The catalogue's hob, with more gashes where the class needs them.

    Right-hand for spur gears, else of the gear's hand, to swivel little; tips as round as 0.38 modules, or as
    the pressure angle leaves room for.
    """
    _, diameter, gashes = next(row for row in HOBS if order.module <= row[0])
    if order.gashes is None:
        gashes = enough_gashes(
            size,
            tip_diameter=tip,
            pressure_deg=order.pressure_angle_deg,
            starts=order.starts,
            accuracy_class=order.accuracy_class,
            usual=gashes,
        )
    return Hob(
        normal_module_mm=order.module,
        outside_diameter_mm=order.hob_diameter if order.hob_diameter is not None else diameter,
        starts=order.starts,
        gashes=order.gashes if order.gashes is not None else gashes,
        hand="left" if order.helix_deg < 0 else "right",
        pressure_angle_deg=order.pressure_angle_deg,
        tip_radius_factor=_tip_radius(math.radians(order.pressure_angle_deg)),
    )


def _tip_radius(pressure: float) -> float:
    """Of the hob's teeth [modules]: at most that of one arc from flank to flank, down to hundredths."""
    half = math.pi / 4.0 - ADDENDUM * math.tan(pressure)
    whole = half * math.cos(pressure) / (1.0 - math.sin(pressure))
    return min(TIP_RADIUS, math.floor(100.0 * whole) / 100.0)


def _feed(order: GearOrder, hob: Hob, size: GearSize) -> float:
    """The largest feed whose marks, at the hob's pitch cylinder, hold their share of the tolerance."""
    allowed = MARK_SHARE * gear_tolerance("helix_form", size, order.accuracy_class) / 1000.0
    unit = feed_mark(
        feed=1.0,
        hob_radius=hob.pitch_diameter / 2.0,
        pressure=math.radians(order.pressure_angle_deg),
        helix=math.radians(order.helix_deg),
    )
    feed = math.sqrt(allowed / unit)
    return max(FEED_STEP, min(LARGEST_FEED, round(FEED_STEP * int(feed / FEED_STEP), 3)))


def _program(
    order: GearOrder, root: float, above: float, ends: tuple[float, float], rates: tuple[int, float]
) -> str:
    sign = -1 if order.helix_deg < 0 else 1
    helix = f" {word('Q', order.module)} {word('P', order.helix_deg)}" if order.helix_deg else ""
    speed, feed = rates
    start, end = ends
    rows = (
        ("G28 U0 W0", "X and Z to the reference point"),
        ("G28 H0 V0", "work and tool spindle to the reference point"),
        (f"G54 G00 {word('X', above)} {word('Z', start)}", "beside the blank"),
        (f"G81 T{order.teeth} L{sign * order.starts}{helix}", "gear box on"),
        (f"S{speed}", f"{order.cutting_speed:g} m/min at the hob's outside diameter"),
        (f"G99 G01 {word('X', root)} {word('F', feed)}", "to the root diameter, still beside the blank"),
        (f"G01 {word('Z', end)} {word('F', feed)}", f"one pass, {feed:g} mm per turn of the work"),
        (f"G01 {word('X', above)} {word('F', feed)}", "retract"),
        ("S0", "stop the hob"),
        ("G80", "gear box off"),
        ("M30", ""),
    )
    return program_text(f"GEAR M{order.module:g} Z{order.teeth} BETA {order.helix_deg:g}", rows)


def _job(nominal: GearNominal, hob: Hob, tip: float, width: float, bore: float) -> str:
    number = toml_number
    return f"""\
[machine]
model = "hobbing_lathe"
setup = "hobbing"
parameters = {{ "201#2" = 1 }}   # F per turn of the work by its theoretical speed

[work]
diameter_mm = {number(round(tip, 3))}
length_mm = {number(width)}
bore_mm = {number(bore)}

[tool]
kind = "hob"
normal_module_mm = {number(hob.normal_module_mm)}
pressure_angle_deg = {number(hob.pressure_angle_deg)}
outside_diameter_mm = {number(hob.outside_diameter_mm)}
tip_radius_factor = {number(hob.tip_radius_factor)}
starts = {hob.starts}
gashes = {hob.gashes}
hand = "{hob.hand}"

[program]
file = "program.nc"

[nominal]
kind = "gear"
number_of_teeth = {nominal.number_of_teeth}
normal_module_mm = {number(nominal.normal_module_mm)}
helix_angle_deg = {number(nominal.helix_angle_deg)}
normal_pressure_angle_deg = {number(nominal.normal_pressure_angle_deg)}
profile_shift = {number(nominal.profile_shift)}
accuracy_class = {nominal.accuracy_class}
"""


def _expect(nominal: GearNominal, size: GearSize) -> str:
    """What the order says of the part: the helix within its tolerance over the face width."""
    helix = nominal.helix_angle_deg
    slope = gear_tolerance("helix_slope", size, nominal.accuracy_class or 8) / 1000.0
    angle = math.degrees(slope / size.face_width) * math.cos(math.radians(helix)) ** 2
    hand = "spur" if helix == 0 else "right" if helix > 0 else "left"
    return f"""
[expect]
number_of_teeth = {nominal.number_of_teeth}
hand = "{hand}"
helix_angle_deg = {{value = {toml_number(helix)}, tolerance = {toml_number(round(angle, 4))}}}
verdict = "{"not_graded" if outside_standard(size) else "in"}"
alarms = []
"""
