"""Cutting forces: from the metal that each tooth takes away to forces on the axes, back into the motion."""
