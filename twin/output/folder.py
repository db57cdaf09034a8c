"""The result folder: written beside and moved into place when complete."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from twin.errors import InputError, Place

MARK = "provenance.json"
"""What shows that a folder is one of ours and may be replaced."""


def require_replaceable(target: Path) -> None:
    """Raise InputError where `target` holds something that is not a result of ours."""
    place = Place(file=str(target))
    if target.is_symlink() or (target.exists() and not target.is_dir()):
        raise InputError("the result folder is a file", place=place, remedy="another --out")
    if target.is_dir() and any(target.iterdir()) and not (target / MARK).is_file():
        raise InputError(
            f"the folder is not empty and holds no {MARK}: it is not a result of hobtwin",
            place=place,
            remedy="an empty or new folder for --out",
        )


@contextmanager
def result_folder(target: Path) -> Iterator[Path]:
    """A new folder to write into; it takes the place of `target` when the block ends without an error."""
    require_replaceable(target)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        staging = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    except OSError as cause:
        raise InputError(
            f"cannot write there: {cause.strerror}", place=Place(file=str(target)), remedy="another --out"
        ) from cause
    try:
        staging.chmod(0o755)
        yield staging
        if target.is_dir():
            old = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
            target.replace(old / "old")
            staging.replace(target)
            shutil.rmtree(old, ignore_errors=True)
        else:
            staging.replace(target)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
