"""Signals at work: inclined axis, 本功能与各轴输入输出信号之间的关系. θ = −30°, 10 tan 30° = 5.774."""

from collections.abc import Callable

import pytest

from controller.dry_run import DryRun, dry_run
from controller.language.source import parse_program
from controller.operator.actions import operator_event
from controller.tables.parameters import delivered

ON = {"8200#0": 1, "1006#3.X": 0}
HOME = "G28 Y0\nG28 X0\n"


@pytest.fixture
def signalled() -> Callable[..., DryRun]:
    """A program on the tilted set-up with its pair on; `events`: second -> words."""

    def _signalled(text: str, signals=None, events=None, parameters=None) -> DryRun:
        acts = [operator_event(do, time_s=time) for time, do in (events or {}).items()]
        levels = {name: bool(level) for name, level in (signals or {}).items()}
        values = delivered("tilted", ON | (parameters or {}))
        return dry_run(parse_program(text), values, None, levels, events=acts)

    return _signalled


def xzy(result: DryRun) -> tuple[float, ...]:
    return tuple(result.machine[letter] for letter in "XZY")


def numbers(alarms) -> list[str]:
    return [alarm.number for alarm in alarms]


# Interlock *ITx: Cartesian


def test_a_block_that_commands_an_interlocked_axis_waits(signalled) -> None:
    """All axes of the block wait; with no further event the program is left standing, and says at what."""
    result = signalled(f"{HOME}G00 Z5.\nG01 X10. Z10. F600\nM30", {"*ITX": 0})
    assert xzy(result) == (0.0, 5.0, 0.0)
    assert any("*ITX = 1" in warning.found for warning in result.warnings)


def test_it_goes_on_when_the_interlock_is_off(signalled) -> None:
    text = f"{HOME}G01 X10. F600\nM30"
    result, free = signalled(text, {"*ITX": 0}, {20.0: "signal *ITX=1"}), signalled(text)
    assert xzy(result) == (10.0, 0.0, 0.0)
    assert result.cycle_time_s == pytest.approx(20.0 + free.cycle_time_s, abs=1e-3)


def test_an_interlock_in_the_middle_of_a_block_brakes_and_holds(signalled) -> None:
    """10 mm at 10 mm/s with ramps of 5 ms take 1.005 s; standing from 0.5 s to 3 s costs just these 2.5 s,
    because both ramps together cover what one of them costs."""
    events = {0.5: "signal *ITX=0", 3.0: "signal *ITX=1"}
    result = signalled(f"{HOME}G01 X10. F600\nM30", None, events)
    assert xzy(result) == (10.0, 0.0, 0.0)
    assert result.cycle_time_s == pytest.approx(1.005 + 2.5, abs=1e-9)


def test_interlock_of_the_orthogonal_axis_does_not_stop_induced_motion(signalled) -> None:
    """并不会互锁倾斜轴的移动引起的正交轴的移动; both must be interlocked: a note says so."""
    result = signalled(f"{HOME}G00 Y10.\nM30", {"*ITX": 0})
    assert xzy(result) == pytest.approx((5.774, 0.0, 11.547), abs=1e-3)
    assert numbers(result.warnings) == ["HT9121"]
    both = signalled(f"{HOME}G00 Y10.\nM30", {"*ITX": 0, "*ITY": 0})
    assert xzy(both) == (0.0, 0.0, 0.0)
    assert "HT9121" not in numbers(both.warnings)


@pytest.mark.parametrize("arf", [0, 1])
def test_interlock_belongs_to_the_axis_that_a_return_or_g53_names(signalled, arf: int) -> None:
    """G28 and G53 of Y change what X reads, or move its slide, without commanding X."""
    parameters = {"8209#0": arf}
    away = signalled(f"{HOME}G00 Y10.\nG28 V0\nM30", {"*ITX": 0}, parameters=parameters)
    assert away.machine["Y"] == 0.0
    assert signalled(f"{HOME}G53 Y10.\nM30", {"*ITX": 0}).machine["Y"] == 10.0
    held = signalled(f"{HOME}G00 Y10.\nG28 V0\nM30", {"*ITY": 0}, parameters=parameters)
    assert held.machine["Y"] == 0.0
    assert "HT9130" in numbers(held.warnings)


# Slide signals


def test_servo_off_holds_whatever_moves_its_slide(signalled) -> None:
    """SVFx: an axis without servo cannot follow; also motion that the inclined axis induces waits."""
    result = signalled(f"{HOME}G00 Y10.\nM30", {"SVFX": 1})
    assert xzy(result) == (0.0, 0.0, 0.0)
    assert any("SVFX" in warning.found for warning in result.warnings)
    assert xzy(signalled(f"{HOME}G53 Y10.\nM30", {"SVFX": 1})) == (0.0, 0.0, 10.0)


@pytest.mark.parametrize(
    ("signal", "slides"), [("MLKX", (0.0, 0.0, 11.547)), ("MLKY", (5.774, 0.0, 0.0)), ("MLKZ", None)]
)
def test_machine_lock_of_a_slide(signalled, signal: str, slides) -> None:
    """MLKx acts on the slide: the displays count as programmed, that slide stands, the other one moves."""
    result = signalled(f"{HOME}G00 Y10.\nM30", {signal: 1})
    assert (result.absolute["X"], result.absolute["Y"]) == (0.0, 10.0)
    assert xzy(result) == pytest.approx(slides or (5.774, 0.0, 11.547), abs=1e-3)


@pytest.mark.parametrize(
    ("signal", "slides"),
    [("MIX", (-5.774, 0.0, 11.547)), ("MIY", (5.774, 0.0, -11.547)), ("MIZ", (5.774, 0.0, 11.547))],
)
def test_mirror_image_of_a_slide(signalled, signal: str, slides) -> None:
    """各轴独立地对倾斜坐标系进行镜像处理: each slide by itself; the displays count as programmed."""
    result = signalled(f"{HOME}G01 Y10. F600\nM30", {signal: 1})
    assert (result.absolute["X"], result.absolute["Y"]) == (0.0, 10.0)
    assert xzy(result) == pytest.approx(slides, abs=1e-3)


def test_mirror_image_of_an_axis_alone(signalled) -> None:
    """The way to the intermediate point of G28 is mirrored; that to the reference is not, nor is G53."""
    assert xzy(signalled(f"{HOME}G01 Z10. F600\nM30", {"MIZ": 1}))[1] == -10.0
    home = signalled(f"{HOME}G01 Z10. F600\nG28 Z20.\nM30", {"MIZ": 1})
    assert (home.machine["Z"], home.absolute["Z"]) == (0.0, 0.0)
    assert home.extents["Z"].machine == (-20.0, 0.0)
    there = signalled(f"{HOME}G53 Z10.\nM30", {"MIZ": 1})
    assert (there.machine["Z"], there.absolute["Z"]) == (10.0, -10.0)


def test_mirrored_arc(signalled) -> None:
    """Half a circle X0 Z0 to Z−20 bulges to the other side of both slides' zero."""
    text = f"{HOME}G02 Z-20. R10. F600\nM30"
    plain, mirrored = signalled(text), signalled(text, {"MIX": 1, "MIZ": 1})
    for letter in "XZ":
        low, high = plain.extents[letter].machine
        assert mirrored.extents[letter].machine == pytest.approx((-high, -low), abs=1e-6)


def test_mirror_image_has_to_be_off_in_manual(signalled) -> None:
    """请一定切断手动运行中的…镜像信号: a motion by hand is not mirrored, and warns."""
    result = signalled(f"{HOME}M00\nM30", {"MIZ": 1}, {5.0: "jog Z 3.", 20.0: "cycle start"})
    assert result.machine["Z"] == 3.0
    assert "HT9123" in numbers(result.warnings)


def test_a_detached_axis_is_as_if_it_were_not_there(signalled) -> None:
    """DTCHx: its words are no addresses, its slide stays out of the inclined axis' motion; attached again
    it needs its reference."""
    for block in ("G00 X1.", "G00 U1.", "G28 U0", "G53 X1."):
        assert numbers(signalled(f"G28 V0\n{block}\nM30", {"DTCHX": 1}).alarms) == ["PS0009"]
    result = signalled(
        f"{HOME}G00 Z1.\nM00\nG00 Y10.\nM30", None, {5.0: "signal DTCHX=1", 9.0: "cycle start"}
    )
    assert xzy(result) == pytest.approx((0.0, 1.0, 11.547), abs=1e-3)
    events = {5.0: "signal DTCHX=1", 7.0: "signal DTCHX=0", 9.0: "cycle start"}
    assert numbers(signalled(f"{HOME}M00\nG00 X1.\nM30", None, events).alarms) == ["PS0224"]


@pytest.mark.parametrize(
    ("signal", "block"),
    [("DTCHZ", "G01 Z5. F100"), ("DTCHZ", "Z5."), ("DTCHC", "M03 S100"), ("DTCHC", "G81 T20 L1")],
)
def test_every_way_to_command_a_detached_axis_is_refused(run, signal: str, block: str) -> None:
    """On the delivered hobbing set-up, plain blocks and spindles included."""
    assert numbers(run(f"{block}\nM30", signals={signal: True}).alarms) == ["PS0009"]
    assert "PS0009" not in numbers(run(f"{block}\nM30", signals={signal: False}).alarms)


@pytest.mark.parametrize("arf", [0, 1])
def test_return_to_the_reference_point_under_mirror_image(signalled, arf: int) -> None:
    """The way from the intermediate point is not reversed: both slides and both displays come home."""
    text = f"{HOME}G01 X20. Y10. F600\nG28 U0\nG28 V0\nM30"
    for signal in ("MIX", "MIY"):
        result = signalled(text, {signal: 1}, parameters={"8209#0": arf})
        assert xzy(result) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
        assert (result.absolute["X"], result.absolute["Y"]) == pytest.approx((0.0, 0.0), abs=1e-9)


# Outputs at the end


def on(result: DryRun, letters: str = "XZY") -> set[str]:
    return {
        name
        for name, level in result.signals.items()
        if level and (name[-1] in letters or name.startswith("PSW"))
    }


def test_zp_of_the_orthogonal_axis_outlives_induced_motion(signalled) -> None:
    """ZPx is Cartesian: Y moves the slide of X, and only ZPY goes."""
    home = signalled(f"{HOME}M30")
    assert {"ZPX", "ZPY"} <= on(home)
    away = signalled(f"{HOME}G00 Y10.\nM30")
    assert {"ZPX", "ZPY"} & on(away) == {"ZPX"}
    assert {"ZPX"} & on(signalled(f"{HOME}G00 X10.\nM30")) == set()


def test_zp2_after_g30(signalled) -> None:
    result = signalled(f"{HOME}G30 P2 W0\nM30", parameters={"1241.Z": -7.0})
    assert {name for name in on(result) if name.startswith("ZP")} == {"ZPX", "ZPY", "ZP2Z"}


def test_moving_and_in_position(signalled) -> None:
    """The work spindle still turns where the text ends in an alarm; everything else stands."""
    result = signalled(f"{HOME}M03 S100\nG04 X2.\nG99999\nM30")
    assert (result.signals["MVC"], result.signals["INPC"]) == (True, False)
    assert (result.signals["MVX"], result.signals["INPX"]) == (False, True)


def test_position_switch_stands_in_slide_coordinates(signalled) -> None:
    """注意 9: Y10 is slide X 5.774."""
    switch = {"6910": 1, "6930": 6.0, "6950": 5.0}
    assert "PSW01" in on(signalled(f"{HOME}G00 Y10.\nM30", parameters=switch))
    assert "PSW01" not in on(signalled(f"{HOME}G00 X10.\nM30", parameters=switch))


def test_confirmations(signalled) -> None:
    result = signalled("M30", {"MIZ": 1, "DTCHC": 1})
    assert {
        name for name in result.signals if name.startswith(("MMI", "MDTCH")) and result.signals[name]
    } == {
        "MMIZ",
        "MDTCHC",
    }
