"""The machine and the metal: jobs, kinematics, cutters, cutting, inspection, report."""
