"""Machine models as data: one folder a machine, each with its MJCF, drive parameters and derivation."""
