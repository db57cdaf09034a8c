"""Columns of numbers as an .npz file."""

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def save_arrays(path: Path, columns: Mapping[str, NDArray]) -> None:
    """Write arrays by name, compressed.

    numpy's own writer stamps the hour into the file: the same run would not give the same bytes.
    """
    with zipfile.ZipFile(path, "w") as package:
        for name, column in columns.items():
            data = io.BytesIO()
            np.lib.format.write_array(data, np.ascontiguousarray(column), allow_pickle=False)
            entry = zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0))
            package.writestr(entry, data.getbuffer(), zipfile.ZIP_DEFLATED, compresslevel=1)
