import math

import numpy as np
import pytest

from twin.inspection.deviation import deviation_map
from twin.inspection.inspection import inspect
from twin.inspection.result import Verdict
from twin.inspection.sheet import to_json

ALPHA = math.radians(20.0)


def near(value, floor=0.1):
    """Within 0.1 µm or 1 %, the floor asked of the measuring room."""
    return pytest.approx(value, rel=0.01, abs=floor)


def evaluated(law, limits):
    """Slope, form and total of a deviation law by a dense fit of its own."""
    s = np.linspace(*limits, 20001)
    y = law(s)
    line = np.polyfit(s, y, 1)
    return line[0] * (limits[1] - limits[0]), np.ptp(y - np.polyval(line, s)), np.ptp(y)


@pytest.fixture(scope="module")
def perfect(parts):
    meshes = {}

    def make(**words):
        key = tuple(sorted(words.items()))
        if key not in meshes:
            meshes[key] = parts.gear_mesh(z_step=words.pop("z_step", 5.0), **words)
        return meshes[key]

    return make


GEARS = [
    {"teeth": 20, "module": 2.0},
    {"teeth": 30, "module": 1.0, "bore": 12.0},
    {"teeth": 20, "module": 2.0, "helix_deg": 20.0, "z_step": 0.5, "roll_step": 0.1},
    {"teeth": 20, "module": 2.0, "helix_deg": -20.0, "z_step": 0.5, "roll_step": 0.1},
    {"teeth": 40, "module": 2.5, "helix_deg": -12.0, "shift": 0.3, "z_step": 0.5, "roll_step": 0.15},
    {"teeth": 12, "module": 3.0, "shift": 0.5},
]


@pytest.mark.parametrize("words", GEARS)
def test_a_perfect_gear_is_found_and_reads_nothing(perfect, named, words):
    vertices, faces = perfect(**words)
    shape = {k: words[k] for k in ("teeth", "module", "helix_deg", "shift") if k in words}
    helix, shift = words.get("helix_deg", 0.0), words.get("shift", 0.0)
    for nominal in (None, named(**shape, accuracy_class=1)):
        result = to_json(inspect(vertices, faces, nominal))
        assert result["kind"] == "gear"
        assert result["number_of_teeth"] == words["teeth"]
        assert result["normal_module"] == pytest.approx(words["module"], rel=1e-5)
        assert result["helix_angle_deg"] == pytest.approx(helix, abs=1e-4)
        assert result["hand"] == ("spur" if helix == 0 else "right" if helix > 0 else "left")
        assert result["profile_shift"] == pytest.approx(shift, abs=1e-3)
        d = words["teeth"] * words["module"] / math.cos(math.radians(helix))
        assert result["tip_diameter_mm"] == pytest.approx(d + 2 * words["module"] * (1 + shift), abs=1e-6)
        assert result["root_diameter_mm"] == pytest.approx(d - 2 * words["module"] * (1.25 - shift), abs=1e-6)
        for flank in result["flanks"].values():
            deviations = [v for k, v in flank.items() if k.endswith("_um") and isinstance(v, float)]
            # form, crowning and pitch always; slopes too, unless the helix angle had to be fitted
            assert len(deviations) == (10 if nominal or not helix else 8)
            assert max(map(abs, deviations)) < 0.15
    assert result["verdict"] == "in"
    assert result["accuracy_class"]["overall"] == 1


@pytest.mark.parametrize(
    ("words", "k", "span"),
    [
        ({"teeth": 30, "module": 1.0}, 4, 10.75263),
        ({"teeth": 20, "module": 2.0}, 3, 15.32088),
        ({"teeth": 40, "module": 2.5, "helix_deg": 20.0, "z_step": 0.4, "roll_step": 0.15}, 6, 42.26384),
    ],
)
def test_span_of_the_table(perfect, words, k, span):
    result = inspect(*perfect(**words)).gear
    assert result.span_teeth == k
    assert result.span_mm == pytest.approx(span, abs=1e-4)


@pytest.mark.parametrize(
    ("words", "ball", "size"),
    [
        ({"teeth": 30, "module": 1.0}, 1.75, 32.48766),
        ({"teeth": 20, "module": 2.0}, 3.5, 44.92929),
        ({"teeth": 40, "module": 2.5, "helix_deg": 20.0, "z_step": 0.4, "roll_step": 0.15}, 4.25, 112.23142),
    ],
)
def test_size_over_balls_of_the_table(perfect, words, ball, size):
    result = inspect(*perfect(**words)).gear
    assert result.pin_diameter_mm == ball
    assert result.over_pins_mm == pytest.approx(size, abs=5e-4)
    assert result.runout_um < 0.15


def test_size_over_balls_of_an_odd_gear_by_touching_it(parts, named):
    """The smallest lift at which a disc in a gap of the section no longer enters the metal, by bisection."""
    vertices, faces = parts.gear_mesh(
        teeth=21, module=2.0, width=5.0, z_step=5.0, roll_step=0.01, phase_deg=90.0
    )
    result = inspect(vertices, faces, named(teeth=21)).gear
    outline = vertices[np.isclose(vertices[:, 2], 0.0)][:, :2]
    middle = math.radians(90.0) + math.pi / 21
    low, high = 19.0, 25.0
    for _ in range(50):
        lift = (low + high) / 2
        nearest = np.hypot(*(outline - lift * np.array([math.cos(middle), math.sin(middle)])).T).min()
        low, high = (lift, high) if nearest < 1.75 else (low, lift)
    assert result.over_pins_mm == pytest.approx(2 * high * math.cos(math.pi / 42) + 3.5, abs=1e-4)


def test_span_grows_by_what_both_flanks_gain(parts, named):
    def thicker(tooth, side, roll, z):
        return np.full_like(roll, 0.01 if side > 0 else 0.02)

    result = inspect(*parts.gear_mesh(teeth=20, module=2.0, z_step=2.0, error=thicker), named()).gear
    assert result.span_mm == pytest.approx(15.32088 + 0.03, abs=1e-4)


def test_narrow_helical_gear_has_no_span_and_says_why(parts):
    mesh = parts.gear_mesh(teeth=40, module=2.5, helix_deg=20.0, width=10.0, roll_step=0.3)
    result = inspect(*mesh)
    assert result.gear.span_mm is None
    assert "face wider than 13.58 mm" in result.unmeasured["span_mm"]


def test_profile_slope_and_wave_are_returned(parts, named):
    laws = {
        1: lambda s: 1.5 * (s - 6.0) + 2.0 * np.sin(2 * np.pi * s / 1.3),
        -1: lambda s: -0.8 * (s - 6.0) + np.cos(2 * s),
    }

    def error(tooth, side, roll, z):
        return laws[side](roll) / 1000

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, roll_step=0.02, error=error)
    gear = inspect(*mesh, named()).gear
    r_b = 20 * math.cos(ALPHA)
    limits = tuple(math.sqrt((d / 2) ** 2 - r_b**2) for d in gear.profile_range_mm)
    for flank, side in ((gear.left, 1), (gear.right, -1)):
        slope, form, total = evaluated(laws[side], limits)
        assert flank.profile_slope_um == near(slope)
        assert flank.profile_form_um == near(form)
        assert flank.profile_total_um == near(total)
        assert {t.tooth for t in flank.profile} == {1, 6, 11, 16}
        assert all(len(t.position) >= 470 for t in flank.profile)


@pytest.mark.parametrize(("helix", "sense"), [(0.0, 1), (20.0, 1), (-20.0, -1)])
def test_helix_slope_has_the_sign_of_a_larger_angle(parts, named, helix, sense):
    steeper_um = 7.0  # over the whole width, as a larger |helix angle| would leave it

    def error(tooth, side, roll, z):
        return np.full_like(roll, sense * side * steeper_um / 1000 * (z + 10) / 20)

    mesh = parts.gear_mesh(teeth=20, module=2.0, helix_deg=helix, z_step=0.25, roll_step=0.1, error=error)
    gear = inspect(*mesh, named(helix_deg=helix)).gear
    # 20 mm less 5 % at each end
    expected = steeper_um * 18 / 20
    for flank in (gear.left, gear.right):
        assert flank.helix_slope_um == near(expected)
        assert flank.helix_total_um == near(expected)
        assert flank.helix_form_um == near(0.0)
    # the same as lead: a flank 7 µm further on after 20 mm has turned that much more on the base cylinder
    alpha_t = math.atan(math.tan(ALPHA) / math.cos(math.radians(helix)))
    r_b = 20 / math.cos(math.radians(helix)) * math.cos(alpha_t)
    twist = 2 * math.sin(math.radians(helix)) / 40 + sense * steeper_um / 1000 / 20 / r_b
    assert gear.helix_angle_deg == pytest.approx(math.degrees(math.asin(20 * twist)), abs=1e-4)
    if helix:
        assert gear.lead_mm == pytest.approx(2 * math.pi / abs(twist), rel=1e-5)


@pytest.mark.parametrize("helix", [0.0, 20.0, -20.0])
def test_feed_marks_do_not_hide_the_helix(parts, named, helix):
    """Ridges 5 µm high every 2 mm, shifted from tooth to tooth as a turning work leaves them."""

    def ridges(tooth, side, roll, z):
        place = np.mod(z / 2 + tooth / 20, 1.0) - 0.5
        return np.full_like(roll, 0.005 * 4 * place**2)

    mesh = parts.gear_mesh(teeth=20, module=2.0, helix_deg=helix, z_step=0.1, roll_step=0.8, error=ridges)
    for nominal in (None, named(helix_deg=helix)):
        result = inspect(*mesh, nominal).gear
        assert result.helix_angle_deg == pytest.approx(helix, abs=0.01)
        assert result.left.helix_form_um == pytest.approx(5.0, abs=0.5)


def test_one_displaced_tooth_is_named(parts, named):
    """Tooth 3 stands at -36 degrees: numbering is clockwise from C0."""

    def displaced(tooth, side, roll, z):
        return np.full_like(roll, side * 0.006 if tooth == 18 else 0.0)

    gear = inspect(*parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, error=displaced), named()).gear
    along = 6.0 / math.cos(ALPHA)  # on the pitch circle; counter-clockwise, so short of its place
    for flank in (gear.left, gear.right):
        assert flank.single_pitch_um == near(along)
        assert flank.cumulative_pitch_um == near(along)
        assert int(np.argmin(flank.cumulative_um)) == 2
        assert flank.pitch_um[1] == near(-along)
        assert flank.pitch_um[2] == near(along)
        assert flank.pitch_um.sum() == pytest.approx(0.0, abs=1e-6)


def test_left_flank_is_the_counter_clockwise_side(parts, named):
    def displaced(tooth, side, roll, z):
        return np.full_like(roll, 0.004 if side > 0 and tooth == 5 else 0.0)

    gear = inspect(*parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, error=displaced), named()).gear
    assert gear.left.cumulative_pitch_um == near(4.0 / math.cos(ALPHA))
    assert gear.right.cumulative_pitch_um == near(0.0)


@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_eccentricity_shows_as_theory_says(parts, named, helix):
    """geometry.md, section 5: F_p = 2e/cos alpha_t, f_p = 2e sin(pi/z)/cos alpha_t."""
    e, z = 0.02, 40
    mesh = parts.gear_mesh(
        teeth=z, module=2.0, helix_deg=helix, z_step=0.5 if helix else 5.0, roll_step=0.1,
        eccentricity=(e * math.cos(1.0), e * math.sin(1.0)),
    )  # fmt: skip
    gear = inspect(*mesh, named(teeth=z, helix_deg=helix)).gear
    alpha_t = math.atan(math.tan(ALPHA) / math.cos(math.radians(helix)))
    for flank in (gear.left, gear.right):
        assert flank.cumulative_pitch_um == near(2000 * e / math.cos(alpha_t))
        assert flank.single_pitch_um == near(2000 * e * math.sin(math.pi / z) / math.cos(alpha_t))
    assert gear.runout_um == near(2000 * e)
    if helix == 0.0:
        assert gear.left.cumulative_pitch_um == pytest.approx(42.57, rel=0.01)


def test_cumulative_wave_is_returned(parts, named):
    def wave(tooth, side, roll, z):
        return np.full_like(
            roll, side * 0.01 * math.cos(math.radians(20)) * math.sin(2 * math.pi * 3 * tooth / 20)
        )

    gear = inspect(*parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, error=wave), named()).gear
    places = 10 * np.sin(2 * np.pi * 3 * np.arange(20) / 20)
    for flank in (gear.left, gear.right):
        assert flank.cumulative_pitch_um == near(np.ptp(places))
        assert flank.single_pitch_um == near(np.abs(np.diff(places, append=places[0])).max())


def test_turning_the_part_changes_only_the_numbering(parts, named):
    def displaced(tooth, side, roll, z):
        return np.full_like(roll, side * 0.006 if tooth == 0 else 0.0)

    still, turned = (
        inspect(
            *parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, error=displaced, phase_deg=a), named()
        ).gear
        for a in (0.0, -4.0 * 18)
    )
    assert turned.left.cumulative_pitch_um == pytest.approx(still.left.cumulative_pitch_um, abs=1e-6)
    assert np.abs(still.left.pitch_um[[0, -1]]).min() > 5
    np.testing.assert_allclose(turned.left.pitch_um, np.roll(still.left.pitch_um, 4), atol=1e-6)


def test_undercut_flanks_are_read_above_the_undercut(parts, named):
    """The generator draws an involute down to the base circle; evaluation starts at the form diameter."""
    gear = inspect(*parts.gear_mesh(teeth=12, module=3.0, z_step=5.0), named(teeth=12, module=3.0)).gear
    d_b = 36 * math.cos(ALPHA)
    assert gear.profile_range_mm[0] == pytest.approx(33.9081, abs=1e-4)
    assert gear.profile_range_mm[0] > d_b
    assert gear.left.profile_total_um < 0.15


def test_class_and_verdict_by_what_was_put_in(parts, named):
    def steep(tooth, side, roll, z):
        return np.full_like(roll, side * 0.012 * (z + 10) / 18)

    mesh = parts.gear_mesh(teeth=20, module=2.0, z_step=5.0, roll_step=0.1, error=steep)
    # f_HbT of m2 d40 b20 is (0.05 sqrt 40 + 0.35 sqrt 20 + 4) = 5.88 µm in class 5: 8.5 in 6, 12 in 7
    good, bad = (inspect(*mesh, named(accuracy_class=a)) for a in (8, 6))
    assert good.verdict is Verdict.IN
    assert good.gear.accuracy_class["helix_slope"] in (7, 8)
    assert good.gear.accuracy_class["overall"] == good.gear.accuracy_class["helix_slope"]
    assert bad.verdict is Verdict.OUT
    assert any("helix slope deviation f_Hβ 12.0 µm exceeds the 8.5 µm of class 6" in f for f in bad.findings)
    assert inspect(*mesh, named()).verdict is Verdict.NOT_GRADED


@pytest.mark.parametrize(
    ("shift", "verdict", "words"),
    [
        (0.4, Verdict.OUT, "274 µm outside the nominal: teeth too thick by 0.582 mm, not cut to depth"),
        (0.1, Verdict.IN, "68 µm outside the nominal"),
        (-0.1, Verdict.IN, "68 µm inside the nominal: teeth too thin by 0.146 mm, cut too deep"),
        (0.0, Verdict.IN, ""),
    ],
)
def test_infeed_shows_in_the_flanks(parts, named, shift, verdict, words):
    """An infeed error x m moves each flank by x m sin alpha_n: geometry.md 5, half of the span's change."""
    mesh = parts.gear_mesh(
        teeth=20, module=2.0, shift=shift, tip_factor=1.0 - shift, z_step=5.0, roll_step=0.1
    )
    result = inspect(*mesh, named(accuracy_class=8))
    offset = 1000 * shift * 2.0 * math.sin(ALPHA)
    assert result.gear.flank_offset_um == near(offset)
    assert result.gear.span_mm == pytest.approx(15.32088 + 2 * offset / 1000, abs=1e-3)
    assert result.verdict is verdict
    assert any(words in finding for finding in result.findings)


def test_outside_the_standard_nothing_is_graded(parts, named):
    mesh = parts.gear_mesh(teeth=20, module=2.0, width=3.0, z_step=0.5, roll_step=0.2)
    result = inspect(*mesh, named(accuracy_class=8))
    assert result.verdict is Verdict.NOT_GRADED
    assert result.gear.accuracy_class == {}
    assert "face width 3 mm is outside ISO 1328-1" in result.findings[0]


def test_map_shows_the_error_normal_to_the_flank(parts, named):
    helix = 20.0

    def error(tooth, side, roll, z):
        return np.full_like(roll, 0.010 if side > 0 else -0.005)

    vertices, faces = parts.gear_mesh(
        teeth=20, module=2.0, helix_deg=helix, z_step=0.5, roll_step=0.2, error=error
    )
    result = inspect(vertices, faces, named(helix_deg=helix))
    value = deviation_map(vertices, faces, result)
    assert value.shape == (len(vertices),)
    finite = value[np.isfinite(value)]
    # turned to the mean of all flanks: 7.5 of the rotation on one side is 7.5 less on the other
    base_helix = math.asin(math.sin(math.radians(helix)) * math.cos(ALPHA))
    np.testing.assert_allclose(finite, 2.5 * math.cos(base_helix), atol=0.05)
    radius = np.hypot(vertices[:, 0], vertices[:, 1])
    assert np.isnan(value[radius < 37.6 / 2]).all()
    assert np.isfinite(value[(radius > 20.3) & (radius < 23.2)]).all()
