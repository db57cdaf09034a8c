"""Start-up of `hobtwin run`."""

import subprocess
import sys


def test_a_run_loads_no_scipy_before_it_is_asked_for_loads():
    code = "import sys, twin.cli.run\nprint(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    modules = set(done.stdout.split())
    assert "twin.load.loaded" in modules
    assert not {name for name in modules if name.partition(".")[0] == "scipy"}
