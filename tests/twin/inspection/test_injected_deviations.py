"""What is put into an analytic gear comes back: within 0.1 µm or 1 %, raw and behind the filter."""

import math

import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.sheet import to_json

ALPHA = math.radians(20.0)


def near(value):
    return pytest.approx(value, rel=0.01, abs=0.1)


def evaluated(law, limits):
    """Slope, form, total and crowning of a law by a dense fit of its own."""
    s = np.linspace(*limits, 20001)
    u = np.linspace(-1, 1, 20001)
    y = law(s)
    line, parabola = np.polyfit(u, y, 1), np.polyfit(u, y, 2)
    return 2 * line[0], np.ptp(y - np.polyval(line, u)), np.ptp(y), -parabola[0]


def figures_of(flank, name):
    return [getattr(flank, f"{name}_{item}_um") for item in ("slope", "form", "total", "crowning")]


def profile_law(s):
    return 1.1 * (s - 7) - 0.3 * (s - 7) ** 2


def helix_law(z):
    return 0.4 * (z + 10) - 0.06 * (z + 10) ** 2


@pytest.mark.parametrize("words", [{}, {"helix_deg": 20.0}, {"helix_deg": -20.0, "shift": 0.3}])
def test_slopes_and_crownings(parts, named, words):
    def error(tooth, side, roll, z):
        return (profile_law(roll) + helix_law(z)) / 1000

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=0.25, roll_step=0.08, error=error, **words)
    gear = inspect(*mesh, named(**words)).gear
    rolls = gear.left.profile[0].evaluation
    profile, helix = evaluated(profile_law, rolls), evaluated(helix_law, gear.helix_range_mm)
    hand = -1 if words.get("helix_deg", 0) < 0 else 1
    for flank, sense in ((gear.left, hand), (gear.right, -hand)):
        for found, wanted in zip(figures_of(flank, "profile"), profile, strict=True):
            assert found == near(wanted)
        slope, *rest = figures_of(flank, "helix")
        assert slope == near(sense * helix[0])
        for found, wanted in zip(rest, helix[1:], strict=True):
            assert found == near(wanted)
        # a line passes the filter, and a parabola all but its ends
        assert flank.filtered["profile_slope_um"] == near(profile[0])
        assert flank.filtered["profile_crowning_um"] == near(profile[3])
        assert flank.filtered["helix_crowning_um"] == near(helix[3])


def test_a_short_wave_is_filtered_as_the_gaussian_says(parts, named):
    """At twice the cut-off exp(-pi alpha²/4) = 84.1 % pass; slope and crowning of many waves are none."""

    def error(tooth, side, roll, z):
        return 0.002 * np.cos(2 * math.pi * roll / 0.653)

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=10.0, roll_step=0.01, error=error)
    result = inspect(*mesh, named(accuracy_class=8))
    trace = result.gear.left.profile[0]
    cut = (trace.evaluation[1] - trace.evaluation[0]) / 30
    passed = math.exp(-math.pi * (0.4697 * cut / 0.653) ** 2)
    whole = evaluated(lambda s: 1000 * error(0, 1, s, 0.0), trace.evaluation)[1]
    assert trace.form_um == near(whole)
    # the ends are smoothed over half as many points and pass up to the whole wave
    inner = trace.filtered.form_um
    assert whole * passed - 0.1 < inner < whole
    values = to_json(result)
    flank = values["flanks"]["left"]
    assert flank["filtered"]["profile_form_um"] == pytest.approx(inner)
    assert flank["profile"][0]["cut_off_mm"] == pytest.approx(cut)
    classes = values["accuracy_class_filtered"]
    assert classes["profile_form"] <= values["accuracy_class"]["profile_form"]


def test_chosen_teeth_are_traced(parts, named):
    """Tooth n stands at -18 (n - 1) degrees; tooth 3 alone has a slope."""

    def error(tooth, side, roll, z):
        return 0.001 * (roll - 7.0) if tooth == 18 else np.zeros_like(roll)

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=10.0, roll_step=0.05, error=error)
    usual, chosen, every = (inspect(*mesh, named(), teeth=teeth).gear.left for teeth in (None, (3, 2), "all"))
    assert [t.tooth for t in usual.profile] == [1, 6, 11, 16]
    assert [t.tooth for t in chosen.profile] == [2, 3]
    assert [t.tooth for t in every.helix] == list(range(1, 21))
    rise = every.profile[2].evaluation[1] - every.profile[2].evaluation[0]
    assert usual.profile_slope_um == near(0.0)
    assert chosen.profile_slope_um == near(rise / 2)
    assert every.profile_slope_um == near(rise / 20)
    assert every.profile_total_um == near(rise)
    assert len(every.profile[0].position) == 480


@pytest.mark.parametrize("pressure_deg", [14.5, 25.0])
def test_another_pressure_angle_without_a_nominal(parts, pressure_deg):
    mesh = parts.gear_mesh(teeth=32, module=2.0, pressure_deg=pressure_deg, z_step=10.0, roll_step=0.1)
    gear = inspect(*mesh, pressure_deg=pressure_deg).gear
    assert gear.normal_module_mm == pytest.approx(2.0, abs=1e-4)
    assert gear.profile_shift == pytest.approx(0.0, abs=1e-3)
    assert gear.left.profile_total_um < 0.15
