"""A badly clamped gear walked through: probed, fitted, its program compensated, both gears compared."""
