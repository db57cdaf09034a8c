"""Turning cycles as pure functions from a start point and the words of a block to single strokes."""
