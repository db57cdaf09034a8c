"""Recorded motion and cutting edges in, part mesh out."""
