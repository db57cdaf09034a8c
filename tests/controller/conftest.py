"""Fixtures: a program run without machine, and a controller driven against an ideal machine."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest

from controller.clock import Chunk, Feedback
from controller.cnc import Controller
from controller.dry_run import DryRun, dry_run
from controller.language.offsets import Offsets
from controller.language.source import parse_program
from controller.operator.actions import read_event
from controller.tables.parameters import delivered


class IdealDrives:
    """Drives that follow exactly; the only law they know is that of `Follow`, written out tick by tick."""

    def advance(self, chunk: Chunk) -> Feedback:
        reached = np.array(chunk.setpoint)
        for row in reached:
            for link in chunk.couplings:
                row[link.slave] += link.offset + link.numerator / link.denominator * row[link.master]
        return Feedback(ticks=chunk.ticks, setpoint=reached, actual=reached)


@dataclass(frozen=True)
class Driven:
    controller: Controller
    setpoint: np.ndarray
    """(n, axes)"""
    block: np.ndarray
    sync: np.ndarray
    tool: np.ndarray

    def axis(self, letter: str) -> np.ndarray:
        return self.setpoint[:, self.controller.axes.index(letter)]


@pytest.fixture
def run() -> Callable[..., DryRun]:
    def _run(
        text: str,
        setup: str = "hobbing",
        parameters: Mapping[str, str | float] | None = None,
        offsets: Offsets | None = None,
        signals: Mapping[str, bool] | None = None,
    ) -> DryRun:
        return dry_run(parse_program(text), delivered(setup, parameters), offsets, signals)

    return _run


@pytest.fixture
def drive() -> Callable[..., Driven]:
    def _drive(
        text: str,
        setup: str = "hobbing",
        *,
        parameters: Mapping[str, str | float] | None = None,
        offsets: Offsets | None = None,
        limit: int = 4096,
        drives: object | None = None,
        tick_s: float = 0.001,
    ) -> Driven:
        machine = drives or IdealDrives()
        controller = Controller(
            parse_program(text), parameters=delivered(setup, parameters), offsets=offsets, tick_s=tick_s
        )
        chunks, reached = [], []
        while (chunk := controller.propose(limit)).ticks:
            assert chunk.ticks <= limit
            assert chunk.first_tick == controller.tick
            feedback = machine.advance(chunk)
            controller.commit(feedback)
            chunks.append(chunk)
            reached.append(feedback.setpoint)
        none = np.zeros((0, len(controller.axes)))
        return Driven(
            controller=controller,
            setpoint=np.concatenate([none, *reached]),
            block=np.concatenate([[], *(chunk.block for chunk in chunks)]).astype(int),
            sync=np.concatenate([[], *(chunk.sync for chunk in chunks)]).astype(bool),
            tool=np.concatenate([[], *(chunk.tool for chunk in chunks)]).astype(int),
        )

    return _drive


@pytest.fixture(scope="session")
def act() -> Callable[..., DryRun]:
    """A program with what the operator does: events as they are typed."""

    def _act(text: str, *events: str, setup: str = "hobbing", parameters=None, signals=None) -> DryRun:
        return dry_run(
            parse_program(text),
            delivered(setup, parameters),
            signals=signals,
            events=[read_event(event) for event in events],
        )

    return _act


@pytest.fixture(scope="session")
def sampled() -> Callable[..., tuple[Controller, np.ndarray, np.ndarray]]:
    """Setpoints (n, axes) and sync (n,) of a run on ideal drives, with what the operator does."""

    def _sampled(text: str, *events: str, setup: str = "hobbing", parameters=None):
        controller = Controller(
            parse_program(text),
            parameters=delivered(setup, parameters),
            events=[read_event(event) for event in events],
        )
        rows, sync = [np.zeros((0, len(controller.axes)))], []
        while (chunk := controller.propose()).ticks:
            rows.append(chunk.setpoint)
            sync.append(chunk.sync)
            controller.commit(Feedback(ticks=chunk.ticks, setpoint=chunk.setpoint, actual=chunk.setpoint))
        return controller, np.concatenate(rows), np.concatenate(sync)

    return _sampled


@pytest.fixture(scope="session")
def warned() -> Callable[[DryRun], list[str]]:
    """The numbers of the warnings."""
    return lambda result: [warning.number for warning in result.warnings]


@pytest.fixture
def alarm_of(run: Callable[..., DryRun]) -> Callable[..., str | None]:
    """The number of the first alarm of a program, or None."""

    def _alarm_of(*args: object, **options: object) -> str | None:
        alarms = run(*args, **options).alarms
        return alarms[0].number if alarms else None

    return _alarm_of
