"""How long `hobtwin inspect` takes, start to end, for a gear of half a million triangles in every format."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import trimesh

from twin.benchmark.cases import CASES
from twin.cutting.cut import cut
from twin.inspection.solid import Floats, Ints
from twin.output.meshes import write_3mf, write_glb, write_stl

CASE = "spur_m2_z20_b20"
RUNS = 3
"""of which the quickest counts: others work on the machine too"""


def inspection() -> Iterator[dict[str, object]]:
    """One result a format."""
    case = CASES[CASE]()
    part = cut(case.blank, ((case.cutter, case.motion),)).remains
    with tempfile.TemporaryDirectory() as folder:
        for path in written(Path(folder), part.vertices, part.faces):
            command = [
                sys.executable,
                "-m",
                "twin.cli",
                "inspect",
                str(path),
                "--teeth",
                "20",
                "--module",
                "2",
            ]
            seconds = []
            for _ in range(RUNS):
                start = time.perf_counter()
                subprocess.run(command, check=True, capture_output=True)
                seconds.append(time.perf_counter() - start)
            yield {
                "case": "inspect",
                "format": path.suffix[1:],
                "triangles": len(part.faces),
                "seconds": min(seconds),
            }


def written(folder: Path, vertices: Floats, faces: Ints) -> Iterator[Path]:
    """Write a part [mm] in every format that is read."""
    for suffix, write in (("stl", write_stl), ("3mf", write_3mf), ("glb", write_glb)):
        write(folder / f"part.{suffix}", vertices, faces)
        yield folder / f"part.{suffix}"
    for suffix in ("ply", "obj"):
        trimesh.Trimesh(vertices, faces, process=False).export(folder / f"part.{suffix}")
        yield folder / f"part.{suffix}"
