"""Reliefs, few teeth, shifted axes, several errors at once: what is put in comes back."""

import math

import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.involute import geometry

ALPHA = math.radians(20.0)


def near(value):
    return pytest.approx(value, rel=0.01, abs=0.1)


def evaluated(law, limits):
    """Slope, form, total and crowning [µm] of a law [mm] by a dense fit of its own."""
    s, u = np.linspace(*limits, 20001), np.linspace(-1, 1, 20001)
    y = 1000 * law(s)
    line, parabola = np.polyfit(u, y, 1), np.polyfit(u, y, 2)
    return 2 * line[0], np.ptp(y - np.polyval(line, u)), np.ptp(y), -parabola[0]


def figures_of(flank, name):
    return [getattr(flank, f"{name}_{item}_um") for item in ("slope", "form", "total", "crowning")]


def rolls(teeth, module, shift=0.0):
    """Roll lengths of a spur gear's flank at its foot and its tip."""
    r, r_b = teeth * module / 2, teeth * module / 2 * math.cos(ALPHA)
    straight = module * (1.25 - shift - 0.38 * (1 - math.sin(ALPHA)))
    return r * math.sin(ALPHA) - straight / math.sin(ALPHA), math.sqrt(
        (r + module * (1 + shift)) ** 2 - r_b**2
    )


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("where", ["tip", "root", "both"])
def test_relief_of_tip_and_root(parts, named, where, order):
    foot, tip = rolls(25, 2.0)
    begin, end = tip - 0.35 * (tip - foot), foot + 0.3 * (tip - foot)
    chosen = {
        "tip": [parts.relief(0.016, begin, tip, along="roll", order=order)],
        "root": [parts.relief(0.010, end, foot, along="roll", order=order)],
    }
    error = parts.all_of(*(chosen["tip"] + chosen["root"] if where == "both" else chosen[where]))
    mesh = parts.gear_mesh(
        teeth=25, module=2.0, z_step=10.0, roll_step=0.06, error=error, roll_corners=(begin, end)
    )
    gear = inspect(*mesh, named(teeth=25)).gear
    assert not gear.undercut
    assert not gear.chamfered
    assert gear.left.profile[0].evaluation[0] == pytest.approx(foot, abs=0.01)
    wanted = evaluated(lambda s: error(0, 1, s, 0.0), gear.left.profile[0].evaluation)
    for flank in (gear.left, gear.right):
        for found, value in zip(figures_of(flank, "profile"), wanted, strict=True):
            assert found == near(value)
        assert flank.helix_total_um < 0.15


@pytest.mark.parametrize("helix_deg", [0.0, -25.0])
@pytest.mark.parametrize("order", [1, 2])
def test_relief_of_the_ends(parts, named, helix_deg, order):
    """Steep where the evaluated range ends: the trace has a point right there."""
    error = parts.all_of(
        parts.relief(0.02, -5.0, 0.0, along="z", order=order),
        parts.relief(0.02, -15.0, -20.0, along="z", order=order),
    )
    mesh = parts.gear_mesh(
        teeth=24,
        module=1.5,
        helix_deg=helix_deg,
        z_step=0.25,
        roll_step=0.15,
        error=error,
        z_corners=(-5.0, -15.0),
    )
    gear = inspect(*mesh, named(teeth=24, module=1.5, helix_deg=helix_deg)).gear

    def law(z):
        return np.array([error(0, 1, np.zeros(1), height)[0] for height in z])

    wanted = evaluated(law, gear.helix_range_mm)
    for flank in (gear.left, gear.right):
        for found, value in zip(figures_of(flank, "helix"), wanted, strict=True):
            assert found == near(value)
        assert flank.profile_total_um < 0.15


@pytest.mark.parametrize(("teeth", "module", "shift"), [(61, 2.0, -0.48), (43, 4.0, 0.0), (29, 1.0, 0.26)])
def test_an_eccentric_gear_keeps_its_fillets_out_of_its_profiles(parts, named, teeth, module, shift):
    """Its fillets reach to other radii on every tooth; the flank's own form is that of a turned base circle.

    A shift e of the axis adds e sin(phi), phi the direction of the flank's normal, which turns by the roll
    angle over the profile: within a second order of its own.
    """
    e = 0.006 * module
    mesh = parts.gear_mesh(
        teeth=teeth,
        module=module,
        shift=shift,
        width=6.0,
        z_step=6.0,
        roll_step=0.07 * module,
        eccentricity=(e, 0),
    )
    gear = inspect(*mesh, named(teeth=teeth, module=module, shift=shift)).gear
    low, high = gear.left.profile[0].evaluation
    arc = (high - low) / geometry(named(teeth=teeth, module=module, shift=shift)).base_radius
    most = 1000 * e * (1 - math.cos(arc / 2))
    for flank in (gear.left, gear.right):
        assert flank.profile_form_um < most + 0.1
        assert flank.cumulative_pitch_um == pytest.approx(2000 * e / math.cos(ALPHA), rel=0.05)


@pytest.mark.parametrize(("teeth", "shift"), [(8, -0.4), (10, -0.5)])
def test_few_teeth_are_measured_where_they_have_flanks(parts, named, teeth, shift):
    """d + 2 x m_n falls inside the base circle: helix and pitch are measured at the flank all the same."""
    nominal = named(teeth=teeth, module=3.0, shift=shift)
    assert teeth * 3.0 + 6.0 * shift < geometry(nominal).base_diameter
    gear = inspect(
        *parts.gear_mesh(teeth=teeth, module=3.0, shift=shift, width=8.0, z_step=8.0, roll_step=0.03), nominal
    ).gear
    for flank in (gear.left, gear.right):
        assert max(map(abs, figures_of(flank, "helix"))) < 0.15
        assert flank.cumulative_pitch_um < 0.15


def test_several_errors_at_once(parts, named):
    """Slope, crowning, relief, end relief, one pitch: traces add up, the pitch stays what it is."""
    foot, tip = rolls(23, 2.5, 0.2)
    begin = tip - 0.3 * (tip - foot)

    def profile(s):
        u = (s - foot) / (tip - foot)
        return 0.012 * u - 0.008 * (2 * u - 1) ** 2

    def slope_and_pitch(tooth, side, roll, z):
        return profile(roll) + side * (0.0006 * (z + 8.0) + 0.015 * (tooth == 3))

    reliefs = (
        parts.relief(0.014, begin, tip, along="roll"),
        parts.relief(0.011, -3.0, 0.0, along="z", order=2),
    )
    error = parts.all_of(slope_and_pitch, *reliefs)
    mesh = parts.gear_mesh(
        teeth=23,
        module=2.5,
        shift=0.2,
        width=16.0,
        z_step=0.12,
        roll_step=0.08,
        error=error,
        roll_corners=(begin,),
        z_corners=(-3.0,),
    )
    nominal = named(teeth=23, module=2.5, shift=0.2)
    gear = inspect(*mesh, nominal).gear
    circle = geometry(nominal)
    at = circle.roll_length(circle.measuring_diameter)
    along_profile = evaluated(
        lambda s: error(0, 1, s, gear.measuring_plane_mm), gear.left.profile[0].evaluation
    )

    for flank, side in ((gear.left, 1), (gear.right, -1)):

        def helix(z, side=side):
            return np.array([error(0, side, np.array([at]), height)[0] for height in z])

        slope, *rest = evaluated(helix, gear.helix_range_mm)
        for found, value in zip(figures_of(flank, "profile"), along_profile, strict=True):
            assert found == near(value)
        for found, value in zip(figures_of(flank, "helix"), (side * slope, *rest), strict=True):
            assert found == near(value)
        outward = circle.measuring_diameter / circle.base_diameter
        assert flank.single_pitch_um == near(15.0 * outward)
        assert flank.cumulative_pitch_um == near(15.0 * outward)
