"""Cutter and stock that meet as they must not: at rapid, or with a spindle at rest."""
