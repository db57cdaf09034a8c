"""What a result was made from: enough to make it again."""

import hashlib
import platform
from importlib.metadata import version
from pathlib import Path

LIBRARIES = ("hobtwin", "mujoco", "numpy", "scipy", "manifold3d", "trimesh")


def provenance(inputs: dict[str, Path], settings: dict[str, object]) -> dict[str, object]:
    """Hashes of the inputs by role, versions, settings. No clock and no machine name: the same job gives
    the same file."""
    return {
        "inputs": {
            role: {"file": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
            for role, path in inputs.items()
        },
        "versions": {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}},
        "settings": settings,
    }
