"""Progress for whoever waits: a bar on a terminal, plain lines elsewhere, nothing when asked to be quiet."""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol, Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn


@contextmanager
def shown(*, quiet: bool = False) -> Iterator["Reporter"]:
    """Progress on the standard error."""
    if quiet:
        yield Silent()
    elif sys.stderr.isatty():
        with Bar() as bar:
            yield bar
    else:
        yield Lines()


class Reporter(Protocol):
    """Told of stages and of the share done of each."""

    def stage(self, name: str) -> None:
        """A new stage begins."""
        ...

    def share(self, done: float) -> None:
        """How much of the stage is done, 0 to 1."""
        ...


class Silent:
    """Says nothing."""

    def stage(self, name: str) -> None:
        """Nothing."""

    def share(self, done: float) -> None:
        """Nothing."""


class Lines:
    """One line a stage, with the time since the start."""

    def __init__(self) -> None:
        self._start = time.perf_counter()

    def stage(self, name: str) -> None:
        """Say it."""
        print(f"[{time.perf_counter() - self._start:6.1f} s] {name}", file=sys.stderr, flush=True)

    def share(self, done: float) -> None:
        """Lines do not count shares."""


class Bar:
    """A progress bar with one row a stage."""

    def __init__(self) -> None:
        self._progress = Progress(
            TextColumn("{task.description:<28}"),
            BarColumn(bar_width=36),
            TextColumn("{task.percentage:>3.0f} %"),
            TimeElapsedColumn(),
            console=Console(stderr=True),
        )
        self._task = None

    def __enter__(self) -> Self:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self._finish()
        self._progress.stop()

    def stage(self, name: str) -> None:
        """Finish the last row and begin a new one."""
        self._finish()
        self._task = self._progress.add_task(name, total=1.0)

    def share(self, done: float) -> None:
        """Move the bar."""
        if self._task is not None:
            self._progress.update(self._task, completed=min(max(done, 0.0), 1.0))

    def _finish(self) -> None:
        if self._task is not None:
            self._progress.update(self._task, completed=1.0)
            self._progress.stop_task(self._task)
