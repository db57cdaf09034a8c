"""pytest collects every job.toml that has an `[expect]`: `pytest scenes/` is a regression suite.

Loaded by every pytest in an environment that has hobtwin: nothing heavy is imported before a job runs.
"""

import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """How the jobs are run."""
    group = parser.getgroup("hobtwin", "jobs with [expect]")
    group.addoption("--hobtwin-ideal", action="store_true", help="axes follow their setpoints exactly")
    group.addoption("--hobtwin-cell-mm", type=float, metavar="MM", help="cell of the cutting grid")
    group.addoption(
        "--hobtwin-out", type=Path, metavar="DIR", help="keep the results as DIR/<job> (default: thrown away)"
    )


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "JobFile | None":
    """A job.toml with `[expect]`, or one that cannot be read but names it."""
    if file_path.name != "job.toml":
        return None
    try:
        expects = "expect" in tomllib.loads(file_path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError:
        expects = "expect" in file_path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return None
    return JobFile.from_parent(parent, path=file_path) if expects else None


class JobFile(pytest.File):
    """One job.toml."""

    def collect(self) -> Iterator["JobItem"]:
        """Its one test, named as the job's folder."""
        yield JobItem.from_parent(self, name=self.path.parent.name)


class NotAsExpected(Exception):
    """What missed, in lines."""


class JobItem(pytest.Item):
    """Run the job and hold it against its `[expect]`; what the expectation allows is no failure."""

    def runtest(self) -> None:
        """Raise NotAsExpected, or the error of a job that cannot run."""
        out = self.config.getoption("hobtwin_out")
        if out is not None:
            self._run(out / self.name)
            return
        with tempfile.TemporaryDirectory(prefix="hobtwin-") as folder:
            self._run(Path(folder) / self.name)

    def _run(self, out: Path) -> None:
        from twin.job import read_job  # noqa: PLC0415 - see above
        from twin.outcome import Options  # noqa: PLC0415
        from twin.regression.judge import table  # noqa: PLC0415
        from twin.run import run_job  # noqa: PLC0415

        options = Options(
            ideal=bool(self.config.getoption("hobtwin_ideal")),
            cell_mm=self.config.getoption("hobtwin_cell_mm"),
        )
        outcome = run_job(read_job(self.path), out, options)
        for name, numbers in (
            ("alarms", outcome.session.alarms),
            ("warnings", (*outcome.session.warnings, *outcome.advice)),
        ):
            self.add_report_section("call", name, "\n".join(str(one) for one in numbers))
        if outcome.missed:
            head = f"{len(outcome.missed)} of {len(outcome.job.expect)} in [expect] of {self.path}:"
            raise NotAsExpected("\n".join([head, *table(outcome.missed)]))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The table alone, and a user's error as its one line; our own faults with their trace."""
        from controller.tables.alarms import ControllerError  # noqa: PLC0415
        from twin.errors import HobtwinError  # noqa: PLC0415

        if isinstance(excinfo.value, NotAsExpected | HobtwinError | ControllerError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where it stands, and its headline."""
        return self.path, None, f"job {self.name}"
