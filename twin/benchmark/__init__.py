"""Benchmarks that a user can run: ratios are taken within one run, so a slow machine does not matter."""
