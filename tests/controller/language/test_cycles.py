"""Rulings, section 1: G70-G76, G90, G92, G94 against independent evaluators and hand-worked stations."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.commands import Arc, Move, Thread

# single cycles


@pytest.mark.parametrize(
    ("blocks", "stations"),
    [
        (
            "G90 X40. Z-10. F100\nX35.",
            [(40, 2), (40, -10), (50, -10), (50, 2), (35, 2), (35, -10), (50, -10), (50, 2)],
        ),
        ("G90 U-10. W-12. R-2. F100", [(36, 2), (40, -10), (50, -10), (50, 2)]),
        ("G94 X20. Z-1. F100", [(50, -1), (20, -1), (20, 2), (50, 2)]),
        ("G94 X20. Z-1. R-3. F100", [(50, -4), (20, -1), (20, 2), (50, 2)]),
        (
            "G90 X40. Z-10. R-1. F100\nG00 X50.\nG90 X40. Z-10.",
            [(38, 2), (40, -10), (50, -10), (50, 2), (40, 2)],
        ),
    ],
)
def test_single_cycles(read, blocks: str, stations: list[tuple[float, float]]) -> None:
    """From X50 Z2: to the cut at rapid, the cut and the way out at feed, back at rapid; R half the difference
    of the diameters; words stay in force until another code of group 01."""
    reading = read(f"G50 X50. Z2.\n{blocks}\nM30")
    assert reading.alarm is None
    assert reading.stations[: len(stations)] == stations


def test_feeds_of_the_single_cycles(read) -> None:
    moves = read("G50 X50. Z2.\nG90 X40. Z-10. F60\nG94 X30. Z0\nM30").of(Move)
    assert [move.feed and move.feed.value for move in moves] == [None, 1.0, 1.0, None] * 2


def test_threading_cycle(read) -> None:
    """G92: the thread between rapids; taper by R, start angle by Q; X alone repeats it deeper."""
    reading = read("G50 X30. Z5.\nM03 S500\nG92 X20. Z-15. R-1. F2. Q90000\nX19.\nM30")
    assert reading.stations == [
        (18, 5),
        (20, -15),
        (30, -15),
        (30, 5),
        (17, 5),
        (19, -15),
        (30, -15),
        (30, 5),
    ]
    assert [(t.lead, t.start_angle) for t in reading.of(Thread)] == [(2.0, 90.0), (2.0, 0.0)]


@pytest.mark.parametrize(
    ("blocks", "expected"),
    [
        ("G90 X40. F100", ("HT9012", 2, 1)),
        ("G90 X40. Z-5.", ("PS0011", 2, 1)),
        ("G90 X40. Z-5. C5. F100", ("PS0009", 2, 15)),
        ("G92 X40. Z-5. F2.", ("HT9007", 2, 1)),
        ("G17\nG90 X40. Z-5. F100", ("PS0021", 3, 1)),
    ],
)
def test_refused_single_cycles(alarm_in, blocks: str, expected: tuple[str, int, int]) -> None:
    assert alarm_in(f"G50 X50. Z2.\n{blocks}\nM30") == expected


# roughing


def polyline(start: tuple[float, float], command: Move | Arc | Thread) -> list[tuple[float, float]]:
    """(X in radius, Z) along a command, arcs in 200 chords."""
    end = (command.absolute.get(0, start[0]), command.absolute.get(1, start[1]))
    if not isinstance(command, Arc):
        return [start, end]
    centre = (start[0] + command.centre[1], start[1] + command.centre[0])
    first = math.atan2(start[0] - centre[0], start[1] - centre[1])
    last = math.atan2(end[0] - centre[0], end[1] - centre[1])
    sweep = (first - last if command.clockwise else last - first) % (2 * math.pi)
    radius = math.dist(start, centre)
    angles = [first + (-sweep if command.clockwise else sweep) * k / 200 for k in range(201)]
    return [(centre[0] + radius * math.sin(a), centre[1] + radius * math.cos(a)) for a in angles]


def heights(points: list[tuple[float, float]], z: np.ndarray) -> np.ndarray:
    """Smallest X of a way at each Z; inf where it does not pass."""
    found = np.full(len(z), np.inf)
    for (x0, z0), (x1, z1) in itertools.pairwise(points):
        low, high = sorted((z0, z1))
        inside = (z >= low) & (z <= high)
        if z1 != z0:
            found[inside] = np.minimum(found[inside], x0 + (z[inside] - z0) / (z1 - z0) * (x1 - x0))
    return found


STEP = st.tuples(st.integers(0, 8), st.integers(0, 8), st.sampled_from(["line", "G02", "G03"])).filter(
    lambda step: step[0] + step[1] > 0
)


@settings(max_examples=40, deadline=None)
@given(
    steps=st.lists(STEP, min_size=1, max_size=6),
    depth=st.integers(5, 40),
    escape=st.sampled_from([0.0, 0.5]),
    allowance=st.tuples(st.sampled_from([0.0, 0.4, 1.0]), st.sampled_from([0.0, 0.1])),
    facing=st.booleans(),
)
def test_roughing_keeps_to_the_profile(
    read, steps, depth: int, escape: float, allowance, facing: bool
) -> None:
    """No stroke goes below the profile with its allowance, the last pass lies on it everywhere, and no pass
    takes more than the depth of cut. G72 is G71 with the axes exchanged."""
    depth_mm = depth / 10
    top = 2.0 + sum(rise for _, rise, _ in steps)
    u, w = allowance
    n, blocks = 20, []
    along = rise_sum = 0.0
    for run, rise, kind in steps:
        along, rise_sum = along + run, rise_sum + rise
        x, z = (-along, 2 + rise_sum) if facing else (2 + rise_sum, -along)
        code = "G01" if kind == "line" or run != rise else kind
        radius = f" R{run}." if code != "G01" else ""
        blocks.append(f"{code} X{2 * x:g} Z{z:g}{radius}")
    infeed, start = ("Z2.", f"X0 Z{top + 1:g}") if facing else ("X4.", f"X{2 * (top + 1):g} Z0")
    first = f"G72 W{depth_mm} R{escape}" if facing else f"G71 U{depth_mm} R{escape}"
    code = "G72" if facing else "G71"
    profile = "\n".join([f"N10 G00 {infeed}", *blocks[:-1], f"N{n} {blocks[-1]}"])
    u_word, w_word = (2 * w, u) if facing else (2 * u, w)
    text = f"G50 {start}\n{first}\n{code} P10 Q{n} U{u_word:g} W{w_word:g} F100\n{profile}\nM30"
    reading = read(text)
    assert reading.alarm is None, text
    swap = (lambda p: (p[1], p[0])) if facing else (lambda p: p)
    at = (0.0, top + 1.0) if facing else (top + 1.0, 0.0)
    home = at
    ways = []
    for command in reading.of((Move, Arc)):
        way = polyline(at, command)
        ways.append([swap(p) for p in way])
        at = way[-1]
    assert at == home
    contour, here = [], (2.0, 0.0)
    zero = f"G50 X{0 if facing else 4} Z{2 if facing else 0}\nG01 F1"
    for command in read("\n".join([zero, *blocks, "M30"])).of((Move, Arc)):
        way = [swap(p) for p in polyline(swap(here), command)]
        contour += way
        here = way[-1]
    z = w - along * (np.arange(150) + 0.3819) / 150  # on no corner
    wall = heights([(x + u, f + w) for x, f in contour], z)
    passes = [heights(way, z) for way in ways]
    lowest = np.min(passes, axis=0)
    if along > 0:
        assert (lowest[np.isfinite(wall)] >= wall[np.isfinite(wall)] - 1e-3).all()
        assert np.abs(lowest - wall)[np.isfinite(wall)].max() < 2e-3
        material = np.full(len(z), top + 1.0 + u)
        for way, cut in zip(ways, passes, strict=True):
            removed = material - cut
            if len(way) == 2 and way[0][0] == way[1][0]:  # a pass along the axis
                assert removed[np.isfinite(cut)].max(initial=0.0) <= depth_mm + 1e-9
            material = np.minimum(material, cut)


def test_rough_passes_worked_by_hand(read) -> None:
    """From X50 Z0 in passes of 4 mm to X30 Z-10 and a cone to X50 Z-20: X42 meets it at Z-16, X34 at Z-12."""
    text = "G50 X50. Z0\nG71 U4. R1.\nG71 P1 Q2 U0 W0 F100\nN1 G00 X30.\nG01 Z-10.\nN2 X50. Z-20.\nM30"
    assert read(text).stations == [
        (50, 0),
        *[(42, 0), (42, -16), (44, -15), (44, 0)],
        *[(34, 0), (34, -12), (36, -11), (36, 0)],
        *[(30, 0), (30, -10), (50, -20)],
        *[(50, -20), (50, 0), (50, 0)],
    ]


def test_the_profile_is_not_run_a_second_time(read) -> None:
    """Behind the cycle the program goes on behind the profile that follows; G70 runs it and comes back."""
    text = "G50 X50. Z0\nG71 U9. R1.\nG71 P1 Q2 U1. W.1 F60\nN1 G00 X40. F30\nN2 G01 Z-9. S9\nG70 P1 Q2\nM30"
    reading = read(text)
    lines = [line for line, command in reading.steps if isinstance(command, Move)]
    assert lines[-3:] == [4, 5, 6]
    assert reading.stations[-1] == (50, 0)
    assert reading.of(Move)[-2].feed.value == 0.5


def test_strokes_carry_the_line_of_the_profile(read) -> None:
    text = "G50 X50. Z0\nG71 U5. R1.\nG71 P1 Q2 F60\nN1 G00 X30.\nG01 Z-9.\n\nN2 X50.\nM30"
    lines = {line for line, command in read(text).steps if isinstance(command, Move)}
    assert lines == {4, 5, 7}


@pytest.mark.parametrize(
    ("profile", "expected"),
    [
        ("N1 G00 X30.\nG01 Z-9.\nN2 Z-5.", ("PS0064", 6, 1)),
        ("N1 G00 X30.\nG01 Z-9.\nN2 X20.", ("PS0064", 6, 1)),
        ("N1 G00 X30.\nG01 Z-9.\nN2 G02 X40. Z-14. I5. K-50.", ("PS0020", 6, 23)),
        ("N1 G00 X30.\nG01 Z-2.\nN2 G03 X30. Z-12. R6.", ("PS0064", 6, 1)),
        ("N1 G00 X30. Z-1.\nN2 G01 Z-9.", ("PS0065", 4, 1)),
        ("N1 X30.\nN2 G01 Z-9.", ("PS0065", 4, 1)),
        ("N1 G00 X30.\nM08\nN2 G01 Z-9.", ("PS0066", 5, 1)),
        ("N1 G00 X30.\nX29. M08\nN2 G01 Z-9.", ("PS0066", 5, 6)),
        ("N1 G00 X30.\nG71 U2. R1.\nN2 G01 Z-9.", ("PS0066", 5, 1)),
        ("N1 G00 X30.\nT0101\nN2 G01 Z-9.", ("PS0066", 5, 1)),
        ("N1 G00 X30.\n#1=5\nN2 G01 Z-9.", ("PS0066", 5, 1)),
        ("N1 G00 X30.\nC5.\nN2 G01 Z-9.", ("PS0066", 5, 1)),
        ("N2 G00 X30.\nN1 G01 Z-9.", ("PS0063", 3, 8)),
        ("N1 G00 X30.", ("PS0063", 3, 8)),
        ("N1 G00 X30.\nG01 X20. Y\nN2 Z-9.", ("PS0005", 5, 10)),
    ],
)
def test_refused_profiles(alarm_in, profile: str, expected: tuple[str, int, int]) -> None:
    """PS0061 to PS0066: each fault at the block of the profile that has it."""
    assert alarm_in(f"G50 X50. Z0\nG71 U2. R1.\nG71 P1 Q2 F60\n{profile}\nM30") == expected


@pytest.mark.parametrize(
    ("blocks", "expected"),
    [
        ("G71", ("PS0061", 1, 1)),
        ("G71 P1 U1. F60", ("PS0061", 1, 1)),
        ("G70 P1", ("PS0061", 1, 1)),
        ("G71 U0 R1.", ("PS0062", 1, 5)),
        ("G71 U-2. R1.", ("PS0062", 1, 5)),
        ("G71 U2. R-1.", ("PS0062", 1, 9)),
        ("G73 U1. R0", ("PS0062", 1, 9)),
        ("G73 U1.", ("PS0061", 1, 1)),
        ("G73 U1. R1.5", ("PS0007", 1, 9)),
        ("G74", ("PS0062", 1, 1)),
        ("G74 Z-5. Q1000 F60", ("PS0062", 1, 1)),
        ("G74 R1.\nG74 Z-5. F60", ("PS0062", 2, 1)),
        ("G75 R1.\nG75 X-5. Z-5. P1000 F60", ("PS0062", 2, 1)),
        ("G75 R1.\nG75 X-5. P1 F60\nG75 X-5. P0 F60", ("PS0062", 3, 10)),
        ("G75 R1.\nG75 X-500. P1 F60", ("HT9016", 2, 1)),
        ("G71 U.001 R0\nG71 P1 Q2 F60\nN1 G00 X-100.\nN2 G01 Z-5.", ("HT9016", 2, 1)),
        ("G76 P010070 Q50 R0", ("PS0062", 1, 5)),
        ("M03 S9\nG76 X-9. Z-9. P1000 Q300 F1.", ("PS0062", 2, 1)),
        ("M03 S9\nG76 P010060 Q1 R0\nG50 X9. Z1.\nG76 X1. Z-9. P1000 Q2000 F1.", ("PS0062", 4, 20)),
        ("M03 S9\nG76 P010060 Q1 R0\nG50 X9. Z1.\nG76 X8. Z-9. P1000 Q200 F1.", ("PS0062", 4, 1)),
        ("M03 S9\nG76 P010060 Q0 R0\nG50 X9. Z1.\nG76 X1. Z-9. P1000 Q1 F1.", ("HT9016", 4, 20)),
        ("M03 S9\nG76 P010060 Q1 R0\nG50 X9. Z1.\nG76 X1. Z-9. P1000 F1.", ("PS0062", 4, 1)),
        ("G71 U1. X5.", ("PS0009", 1, 9)),
    ],
)
def test_refused_cycles(alarm_in, blocks: str, expected: tuple[str, int, int]) -> None:
    """PS0061, PS0062; endless ones are HT9016 before the first stroke."""
    assert alarm_in(f"{blocks}\nM30") == expected


def test_pattern(read) -> None:
    """G73 U4 W2 R3: the profile three times, first 4 mm (radius) and 2 mm away."""
    text = "G50 X60. Z5.\nG73 U4. W2. R3\nG73 P1 Q2 U1. W0 F60\nN1 G00 X40. Z2.\nN2 G01 X44. Z-9.\nM30"
    stations = read(text).stations
    for n, (x, z) in enumerate([(9.0, 2.0), (5.0, 1.0), (1.0, 0.0)]):
        assert stations[3 * n : 3 * n + 3] == [(60 + x, 5 + z), (40 + x, 2 + z), (44 + x, -9 + z)]
    assert stations[9:] == [(60, 5)]


def test_pecking(read) -> None:
    """G74: 5 mm pecks to Z-12, 1 mm back after each; G75 crosswise with a shift along Z. P in radius."""
    text = "G50 X40. Z2.\nG74 R1.\nG74 Z-12. Q5000 F60\nM30"
    assert read(text).stations == [(40, -3), (40, -2), (40, -8), (40, -7), (40, -12), (40, 2), (40, 2)]
    text = "G50 X40. Z2.\nG75 R.5\nG75 X30. Z-2. P3000 Q3. R.2 F60\nM30"
    first = [(34, 2), (35, 2), (30, 2), (30, 2.2), (40, 2.2)]
    second = [(40, -1), (34, -1), (35, -1), (30, -1), (30, -0.8), (40, -0.8)]
    third = [(40, -2), (34, -2), (35, -2), (30, -2), (30, -1.8), (40, -1.8)]
    assert read(text).stations == [*first, *second, *third, (40, 2)]


@settings(max_examples=40, deadline=None)
@given(
    height=st.integers(300, 3000),
    first=st.integers(100, 300),
    smallest=st.integers(0, 60),
    allowance=st.sampled_from([0, 20, 100]),
    spring=st.integers(1, 3),
    angle=st.sampled_from([0, 29, 30, 55, 60, 80]),
)
def test_thread_passes_cut_equal_sections(
    read, height: int, first: int, smallest: int, allowance: int, spring: int, angle: int
) -> None:
    """Depth first · √n until the smallest depth takes over, then the allowance, then spring passes; each pass
    is shifted so that one flank alone cuts: ΔZ = depth · tan(angle / 2)."""
    text = (
        f"G50 X50. Z5.\nM03 S300\nG76 P{spring:02d}00{angle:02d} Q{smallest} R{allowance / 1000}\n"
        f"G76 X30. Z-20. P{height} Q{first} F2.\nM30"
    )
    reading = read(text)
    assert reading.alarm is None
    cuts = [t.absolute[0] for t in reading.of(Thread)]
    crest, rough = 15.0 + height / 1000, (height - allowance) / 1000
    depths = [crest - x for x in cuts]
    assert depths[-spring:] == pytest.approx([height / 1000] * spring)
    assert depths[-spring - 1] == pytest.approx(rough)
    steps = np.diff([0.0, *depths[: -spring - 1]])
    for n, step in enumerate(steps):
        section = first / 1000 * math.sqrt(n + 1) - sum(steps[:n])
        assert step == pytest.approx(max(section, smallest / 1000), abs=1e-9)
    starts = [b.absolute[1] for b in reading.of(Move) if b.absolute.get(0) in cuts]
    flank = math.tan(math.radians(angle / 2))
    assert [5.0 - z for z in starts] == pytest.approx([d * flank for d in depths], abs=1e-9)
    assert reading.stations[-1] == (50, 5)


def test_taper_and_run_out_of_threads(read) -> None:
    """R: start minus end in radius; the run-out in tenths of the lead leaves at 45 degrees."""
    text = "G50 X50. Z5.\nM03 S300\nG76 P011000 Q0 R0\nG76 X30. Z-20. R-2. P1000 Q1000 F2.\nM30"
    threads = read(text).of(Thread)
    assert len(threads) == 4
    start = read(text).of(Move)[1].absolute
    assert start == pytest.approx({0: 13.0, 1: 5.0})
    turn, out = threads[0].absolute, threads[1].absolute
    assert turn[1] == pytest.approx(-18.0)
    assert turn[0] == pytest.approx(13.0 + 2.0 * 23 / 25)
    assert out == pytest.approx({0: turn[0] + 2.0, 1: -20.0})


def test_cycles_in_mdi(counting_motion) -> None:
    """PS0067: a profile needs a stored program; PS0123: so does a macro statement."""
    from controller.language.interpreter import Interpreter
    from controller.language.offsets import Offsets
    from controller.language.source import parse_program
    from controller.tables.alarms import AlarmError
    from controller.tables.machine_data import machine_data
    from controller.tables.parameters import delivered

    interpreter = Interpreter(parse_program("N1 G00 X1.\nM30"), machine_data(delivered()), Offsets(), {})
    motion = counting_motion(4)
    for block, number in (
        ("G71 P1 Q1", "PS0067"),
        ("#1=5", "PS0123"),
        ("M98 P1", "PS0076"),
        ("M30", "HT9012"),
    ):
        with pytest.raises(AlarmError, match=rf"MDI:1:.*{number}"):
            interpreter.mdi(block, motion)
    (command,) = interpreter.mdi("G00 Z5.", motion).commands
    assert isinstance(command, Move)
    assert command.absolute == {1: 5.0}
    step = interpreter.next(motion)
    assert step is not None
    assert step.index == 0


@pytest.mark.parametrize("block", ["G71 P1 Q2 U0.4 W0.1 D4000", "G76 X27. Z-20. K1.5 D0.5 F2."])
def test_the_form_of_one_block_is_answered_with_that_of_two(read, block: str) -> None:
    """D belongs to the tape format of other controls: the message says how it is written here."""
    alarm = read(f"{block}\nM30").alarm
    assert alarm.number == "PS0009"
    assert alarm.valid.startswith("the two-block form: G71 U R, then G71 P Q U W")
