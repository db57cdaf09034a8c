"""How well the electronic gear box keeps: its error over time, and the orders of turning in it."""

from twin.sync.error import sync_error
from twin.sync.spectrum import Spectrum, spectrum

__all__ = ["Spectrum", "spectrum", "sync_error"]
