"""The short lane of motion makes the very motion that the general way makes, to the bit."""

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from controller.clock import Feedback
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.motion.rest_to_rest import ShortLane
from controller.operator.actions import operator_event
from controller.tables.parameters import delivered

words = st.lists(
    st.tuples(
        st.sampled_from(["G00", "G01", ""]),
        st.dictionaries(
            st.sampled_from(["X", "Z", "U", "W", "C"]),
            st.integers(-260, 260).map(lambda n: n / 4),
            max_size=2,
        ).filter(lambda w: not ({"X", "U"} <= set(w) or {"Z", "W"} <= set(w))),
        st.sampled_from(["", "F60.", "F500.", "F7999.", "F9000."]),
    ),
    min_size=1,
    max_size=8,
)


def program_of(blocks) -> str:
    lines = [f"{g} {' '.join(f'{k}{v:.3f}' for k, v in axes.items())} {f}" for g, axes, f in blocks]
    return "G01 F300.\n" + "\n".join(lines) + "\nM30"


def sampled(program, events=()):
    controller = Controller(program, parameters=delivered(), events=events)
    rows = []
    while (chunk := controller.propose()).ticks:
        rows.append(chunk.setpoint)
        controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
    return b"".join(row.tobytes() for row in rows)


# an event that never comes closes the lane and changes nothing else
NEVER = [operator_event("feed override 100", time_s=1e8)]


@settings(max_examples=80, deadline=None)
@given(words)
def test_same_motion_to_the_bit(blocks) -> None:
    program = parse_program(program_of(blocks))
    by_lane, by_travel = dry_run(program, delivered()), dry_run(program, delivered(), events=NEVER)
    for name in ("absolute", "relative", "machine", "cycle_time_s", "extents", "peaks", "alarms"):
        assert getattr(by_lane, name) == getattr(by_travel, name), name
    assert by_lane.blocks.start_s.tobytes() == by_travel.blocks.start_s.tobytes()
    assert sampled(program) == sampled(program, NEVER)


def test_the_lane_is_taken(monkeypatch) -> None:
    """And it is taken where it should be: a plain program has no block that is travelled."""
    taken = []
    move = ShortLane.move
    monkeypatch.setattr(
        ShortLane, "move", lambda self, command: taken.append(move(self, command)) or taken[-1]
    )
    program = parse_program("G00 X-10. Z-5.\nG01 U-2. F300\nG01 C90. F600\nG99\nM30")
    dry_run(program, delivered())
    assert taken == [True, True, False]


def test_a_million_blocks_keep_no_knots() -> None:
    """Memory does not grow with the program: neither knots nor blocks are kept, but 16 bytes a block."""
    from controller.execution import Execution
    from controller.language.offsets import Offsets
    from controller.motion.axes import Circumstances

    lines = "\n".join(f"G01 X-{k % 7}. Z-{k % 90}.5 F7000." for k in range(20_000))
    execution = Execution(
        parse_program(f"{lines}\nM30"), delivered(), Offsets(), {}, circumstances=Circumstances()
    )
    longest = 0
    while not execution.done:
        execution.step()
        if len(execution.log.starts) % 256 == 0:
            execution.motion.timeline.forget(execution.motion.time)
        longest = max(longest, *(len(track.times) for track in execution.motion.timeline.tracks))
    assert longest <= 300
    assert len(execution.log.starts) == 20_001
    assert execution.log.starts.itemsize + execution.log.indices.itemsize == 16
    assert math.isfinite(execution.motion.time)
