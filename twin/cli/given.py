"""What the command line adds to a program or a job: parameters, signals, operator events."""

import argparse
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from controller.operator.actions import OperatorEvent, check_events, read_event
from controller.tables.alarms import AlarmError, ControllerError
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered
from controller.tables.signals import check_signals
from twin.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """Settings of the command line."""

    parameters: Mapping[str, str]
    signals: Mapping[str, bool]
    events: tuple[OperatorEvent, ...]


def given_by(options: argparse.Namespace, setup: str) -> Given:
    """--parameter, --signal and --event, checked against the machine of a set-up.

    Raises InputError that names the option.
    """
    parameters = dict(_pair(text, "--parameter", "201#4=1") for text in options.parameter)
    with _said_of("--parameter"):
        letters = machine_data(delivered(setup, parameters)).letters
    levels = dict(_pair(text, "--signal", "NOZAGC=1") for text in options.signal)
    for name, level in levels.items():
        if level not in ("0", "1"):
            raise InputError(f"--signal {name}={level}", remedy=f"valid: {name}=0 or {name}=1")
    signals = {name: level == "1" for name, level in levels.items()}
    with _said_of("--signal"):
        check_signals(signals, letters)
    events = events_of_options(options)
    with _said_of("--event"):
        check_events(events, letters)
    return Given(parameters=parameters, signals=signals, events=events)


def events_of_options(options: argparse.Namespace) -> tuple[OperatorEvent, ...]:
    """--event alone. Raises InputError that names the option."""
    with _said_of("--event"):
        return tuple(read_event(text) for text in options.event)


@contextmanager
def _said_of(option: str) -> Iterator[None]:
    """Give the controller's refusals the name of the option."""
    try:
        yield
    except AlarmError:
        raise
    except ControllerError as cause:
        remedy = f"valid: {cause.remedy}" if cause.remedy else ""
        raise InputError(f"{option}: {cause.text}", remedy=remedy) from cause


def _pair(text: str, option: str, example: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name.strip() or not value.strip():
        raise InputError(f"{option}: {text!r} is no name=value", remedy=f"valid: {option} {example}")
    return name.strip(), value.strip()
