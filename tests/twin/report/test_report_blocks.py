"""What a block did, against recordings whose every figure is put in by formula."""

from dataclasses import replace

import numpy as np
import pytest

from twin.recording import BlockRef
from twin.report.blocks import MOST_RUNS, beside_the_work, block_facts, line_numbers, lines_at


def turning(sample, block, lines):
    """Samples of 1 ms, one a block number: X moves 2 mm/s, the work turns 90°/s, the tool moves along -Z."""
    n = len(block)
    recording = sample.recording(n)
    time = 1e-3 * np.arange(n)
    setpoint = np.stack([2.0 * time, np.zeros(n), 360.0 * time, 90.0 * time], -1)
    actual = setpoint.copy()
    actual[:, 0] -= 1e-3 * np.arange(n)  # behind by 1 µm more every sample
    angle = np.radians(90.0 * time)
    # 50 mm out along +X beside the machine, which in the part turns the other way; the tool's axis along Y
    centre = np.stack([50.0 * np.cos(angle), -50.0 * np.sin(angle), -3.0 * time], -1)
    axis = np.stack([np.sin(angle), np.cos(angle), np.zeros(n)], -1)
    refs = tuple(BlockRef(file="a.nc", line=line, text=f"N{line}") for line in lines)
    return replace(
        recording,
        time_s=time,
        setpoint=setpoint,
        actual=actual,
        work_angle_deg=90.0 * time,
        block=np.array(block, np.int32),
        blocks=refs,
        tool_centre_mm=centre,
        tool_axis=axis,
        sync=np.array(block) == 1,
    )


def test_a_block_that_ran_once(sample):
    recording = turning(sample, [0] * 100 + [1] * 300 + [2] * 100, [4, 7, 9])
    first, facts, last = block_facts(recording)
    assert (first.line, facts.line, last.line) == (4, 7, 9)
    # a block begins where the one before it ended
    assert facts.runs == ((pytest.approx(0.099), pytest.approx(0.399)),)
    assert facts.duration_s == pytest.approx(0.3)
    assert sum(f.duration_s for f in (first, facts, last)) == pytest.approx(recording.time_s[-1])
    np.testing.assert_allclose(facts.end - facts.start, [0.6, 0.0, 108.0, 27.0], atol=1e-12)
    np.testing.assert_allclose(facts.way, [0.6, 0.0, 108.0, 27.0], atol=1e-12)
    np.testing.assert_allclose(facts.error, [0.399, 0, 0, 0], atol=1e-12)
    assert (first.synced, facts.synced, last.synced) == (False, True, False)
    # beside the work the way is straight along -Z: told by its ends
    np.testing.assert_allclose(facts.path_mm, [[50, 0, -0.297], [50, 0, -1.197]], atol=1e-12)
    np.testing.assert_allclose(facts.axis, [0, 1, 0], atol=1e-12)


def test_a_line_that_ran_often_is_one_block(sample):
    recording = turning(sample, [0, 0, 1, 1, 1] * 40, [4, 7])
    four, seven = block_facts(recording)
    assert (four.count, seven.count) == (40, 40)
    assert len(seven.runs) == 40
    assert seven.duration_s == pytest.approx(0.12)
    assert four.duration_s + seven.duration_s == pytest.approx(recording.time_s[-1])
    assert np.isnan(seven.path_mm).all(axis=1).sum() == 39


def test_two_blocks_of_one_line_are_told_together(sample):
    (only,) = block_facts(turning(sample, [0] * 10 + [1] * 10, [7, 7]))
    assert only.count == 2
    assert only.runs[0][1] == only.runs[1][0]


def test_a_way_there_and_back_is_counted_twice(sample):
    recording = turning(sample, [0] * 201, [3])
    there = np.minimum(np.arange(201), 200 - np.arange(201)) * 0.01
    recording = replace(recording, setpoint=np.stack([there] * 4, -1))
    (facts,) = block_facts(recording)
    np.testing.assert_allclose(facts.way, 2.0, atol=1e-9)
    np.testing.assert_allclose(facts.end, facts.start)


def test_too_many_runs_are_joined_at_the_end(sample):
    recording = turning(sample, [0, 1] * 500, [4, 7])
    four, seven = block_facts(recording)
    for facts in (four, seven):
        assert facts.count == 500
        assert len(facts.runs) == MOST_RUNS
    assert seven.runs[-1][1] == recording.time_s[-1]


def test_nothing_recorded_tells_nothing(sample):
    assert block_facts(sample.recording(0)) == ()


def test_who_stands_beside_the_machine_sees_the_tool_stand(sample):
    recording = turning(sample, [0] * 50, [1])
    seen = beside_the_work(recording, recording.tool_centre_mm)
    np.testing.assert_allclose(seen[:, :2], [[50.0, 0.0]] * 50, atol=1e-12)


def test_lines_count_in_the_order_in_which_they_first_ran(sample):
    """Block 1 is of a line that ran before, block 3 never ran."""
    recording = turning(sample, [2] * 5 + [0] * 5 + [1] * 5 + [4] * 5, [7, 9, 9, 11, 4])
    assert line_numbers(recording).tolist() == [1, 0, 0, -1, 2]
    assert [facts.line for facts in block_facts(recording)] == [9, 7, 4]


def test_a_time_belongs_to_the_line_whose_stretch_it_lies_in(sample):
    """Samples stand at the end of what they record: block 1 runs from 0.009 to 0.019 s."""
    recording = turning(sample, [0] * 10 + [1] * 10 + [2] * 10, [4, 7, 9])
    facts = block_facts(recording)
    for number, fact in enumerate(facts):
        ((start, end),) = fact.runs
        inside = np.array([start + 1e-6, (start + end) / 2, end - 1e-6, end])
        assert lines_at(recording, inside).tolist() == [number] * 4
    assert lines_at(recording, np.array([-1.0, 0.0, 99.0, np.nan])).tolist() == [0, 0, 2, -1]
    assert lines_at(sample.recording(0), np.array([1.0, np.nan])).tolist() == [-1, -1]
