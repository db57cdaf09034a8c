"""Clamping eccentricity, measured by touch and compensated (CN102814557B as mended in the rulings)."""
