"""Files that are written while other work goes on: compressing leaves the interpreter free."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import ParamSpec, Self

P = ParamSpec("P")


class Background:
    """Work handed over within a `with` block, which does not end before it is done."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(2)
        self._begun: list[Future[None]] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pool.shutdown(cancel_futures=kind is not None)

    def start(self, work: Callable[P, None], *args: P.args, **kwargs: P.kwargs) -> None:
        """Begin some work."""
        self._begun.append(self._pool.submit(work, *args, **kwargs))

    def finish(self) -> None:
        """Wait for all of it; raises what it raised."""
        for one in self._begun:
            one.result()
