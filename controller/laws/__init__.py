"""The laws of the lathe as pure functions."""
