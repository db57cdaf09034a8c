"""Stock removed from every flank, on points of flanks that are known."""

import math

import numpy as np
import pytest

from twin.compensation.removal import removal
from twin.grinding.gap import gap_of
from twin.grinding.precut import PrecutGear
from twin.inspection.involute import geometry

STOCK = 0.12


def precut(helix):
    return PrecutGear(
        stock_per_flank_mm=STOCK,
        gap_phase_deg=11.0,
        number_of_teeth=24,
        normal_module_mm=2.5,
        helix_angle_deg=helix,
        normal_pressure_angle_deg=20.0,
        profile_shift=0.1,
        dedendum_factor=1.25,
    )


def flanks(gear, left_stock, shift=0.0):
    """Points of all flanks that keep `left_stock`, moved by `shift` [mm] as a complex number."""
    gap = gap_of(gear, stock=left_stock)
    rolls = np.linspace(
        gap.roll_at(gear.form_diameter / 2 + 0.05), gap.roll_at(gear.tip_diameter / 2 - 0.05), 20
    )
    one = gap.flank(rolls)[0] @ [1.0, 1j]
    rows = []
    for z in np.linspace(-19.0, -1.0, 7):
        for k in range(gear.teeth):
            turn = np.exp(1j * (math.radians(11.0) + 2 * math.pi * k / gear.teeth + gear.twist * z))
            for side in (one, one.conj()):
                place = side * turn + shift
                rows.append(np.column_stack([place.real, place.imag, np.full(len(place), z)]))
    return np.vstack(rows)


@pytest.mark.parametrize("helix", [0.0, 15.0, -25.0])
@pytest.mark.parametrize("kept", [STOCK, 0.05, 0.0, -0.01])
def test_flanks_that_lost_the_same_everywhere(helix, kept):
    one = precut(helix)
    found = removal(flanks(geometry(one.nominal()), kept), one, low=-20.0, high=0.0)
    for side in (found.left, found.right):
        for values in side:
            assert values == pytest.approx(STOCK - kept, abs=1e-9)


def test_a_gear_ground_off_centre():
    """Moved by s in the direction of gap 1: its flanks move across by s sin α, both into the gap 1 … by the
    flanks' own normals, so least and most lie s apart to both sides of the stock."""
    one, s = precut(0.0), 0.02
    gear = geometry(one.nominal())
    along = s * np.exp(1j * math.radians(11.0))
    found = removal(flanks(gear, 0.0, along), one, low=-20.0, high=0.0)
    for side in ("left", "right"):
        least, most = found.extremes(side)
        assert least == pytest.approx(STOCK - s, abs=0.03 * s)
        assert most == pytest.approx(STOCK + s, abs=0.03 * s)
    # gap 1 opens towards the move: its flanks lose less by s sin of the angle of their normals
    middle = float(np.mean([found.left[0][0], found.left[1][0]]))
    assert middle < STOCK


def test_a_flank_without_points_is_not_a_number():
    one = precut(0.0)
    points = flanks(geometry(one.nominal()), 0.0)
    first = np.abs(np.arctan2(points[:, 1], points[:, 0]) - math.radians(11.0)) < math.pi / 24
    found = removal(points[~first], one, low=-20.0, high=0.0)
    assert np.isnan(found.left[0][0])
    assert np.isfinite(found.left[0][1:]).all()
