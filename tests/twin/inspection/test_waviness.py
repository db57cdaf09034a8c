"""Orders per gear turn: waves run round the gear, cut into flanks, come back with order and amplitude."""

import math

import numpy as np
import pytest

from twin.inspection.inspection import inspect
from twin.inspection.waviness import waviness

ALPHA = math.radians(20.0)


def wavy(parts, waves, *, helix_deg=0.0, **more):
    """A gear of 20 teeth, module 2, whose flanks carry waves {order: amplitude µm} of the rotation angle.

    A point of a flank meets its mate where its tangent to the base circle stands: k pitches on, and its roll
    angle back on a left flank, forth on a right one.
    """
    beta = math.radians(helix_deg)
    r_b = 20 / math.cos(beta) * math.cos(math.atan(math.tan(ALPHA) / math.cos(beta)))

    def error(tooth, side, roll, z):
        turn = 2 * math.pi * tooth / 20 + math.sin(beta) / 20 * z - side * roll / r_b
        return sum(a / 1000 * np.cos(k * turn + 0.7 * k) for k, a in waves.items())

    return parts.gear_mesh(teeth=20, module=2.0, helix_deg=helix_deg, error=error, **more)


@pytest.mark.parametrize("order", [1, 7, 20, 33, 40, 53, 60, 120])
def test_one_order(parts, named, order):
    mesh = wavy(parts, {order: 1.0}, z_step=20.0, roll_step=0.03)
    gear = inspect(*mesh, named()).gear
    for flank in (gear.left, gear.right):
        first, *others = flank.profile_waviness
        assert first.order == order
        assert first.amplitude_um == pytest.approx(1.0, rel=0.01)
        assert all(other.amplitude_um < 0.05 for other in others)
        assert flank.helix_waviness == ()


def test_several_orders_largest_first_and_no_more_than_ten(parts, named):
    waves = {3: 4.0, 21: 2.0, 60: 1.0, 77: 0.5, 130: 0.25}
    gear = inspect(*wavy(parts, waves, z_step=20.0, roll_step=0.02), named()).gear
    found = gear.right.profile_waviness
    assert len(found) <= 10
    assert [wave.order for wave in found[:5]] == list(waves)
    for wave, amplitude in zip(found, waves.values(), strict=False):
        assert wave.amplitude_um == pytest.approx(amplitude, rel=0.01, abs=0.02)


def test_helical_gears_show_orders_on_profile_and_helix(parts, named):
    mesh = wavy(parts, {60: 1.0}, helix_deg=20.0, z_step=0.25, roll_step=0.08)
    gear = inspect(*mesh, named(helix_deg=20.0)).gear
    for flank in (gear.left, gear.right):
        for waves in (flank.profile_waviness, flank.helix_waviness):
            assert waves[0].order == 60
            assert waves[0].amplitude_um == pytest.approx(1.0, abs=0.1)


def test_what_all_flanks_have_in_common_is_no_wave(parts, named):
    def error(tooth, side, roll, z):
        return (3.0 * (roll - 7) - (roll - 7) ** 2) / 1000

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=20.0, roll_step=0.02, error=error)
    gear = inspect(*mesh, named()).gear
    assert gear.left.profile_crowning_um > 5
    assert all(wave.amplitude_um < 0.1 for wave in gear.left.profile_waviness)


def test_eccentricity_is_order_one(parts, named):
    """A flank 2e/2 off along the line of action: amplitude e, once a turn."""
    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=20.0, roll_step=0.05, eccentricity=(0.01, 0.0))
    first = inspect(*mesh, named()).gear.left.profile_waviness[0]
    assert first.order == 1
    assert first.amplitude_um == pytest.approx(10.0, rel=0.01)


def test_traces_with_holes_are_left_out_and_too_few_points_give_nothing():
    turn, centres = np.linspace(0, 0.5, 200), 2 * math.pi * np.arange(12) / 12
    wave = 2.0 * np.cos(31 * (turn[:, None] + centres) + 1.0)
    wave[50:80, 4] = np.nan
    found = waviness(turn, centres, wave, highest=100)
    assert found[0].order == 31
    assert found[0].amplitude_um == pytest.approx(2.0, rel=1e-6)
    assert waviness(turn[:3], centres, wave[:3], highest=100) == ()
    assert waviness(turn, centres, np.full_like(wave, np.nan), highest=100) == ()
    assert waviness(turn, centres, wave, highest=0.5) == ()
