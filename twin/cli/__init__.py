"""The command `hobtwin`."""

from twin.cli.main import main

__all__ = ["main"]
