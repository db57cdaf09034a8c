"""The machine without its shapes: what the drives step.

Bodies that are joined rigidly are one body, inertias are the numbers that their shapes came to, and what only
touches, shows or measures is gone. The joints move as before, at half the cost.
"""

# pyright: reportAttributeAccessIssue=false

import mujoco  # its bindings are compiled and carry no types
import numpy as np

NOT_GIVEN = np.full(6, np.nan)


def bare(mjcf: mujoco.MjSpec, whole: mujoco.MjModel) -> mujoco.MjModel:
    """The joints, actuators and inertias of `whole`, which `mjcf` was just compiled to; shapes of explicit
    contact pairs stay."""
    spec = mjcf.copy()
    for body in spec.bodies[1:]:  # the first one is the world
        body.explicitinertial = True
        body.mass = whole.body_mass[body.id]
        body.ipos = whole.body_ipos[body.id]
        body.iquat = whole.body_iquat[body.id]
        body.inertia = whole.body_inertia[body.id]
        body.fullinertia = NOT_GIVEN
    touching = {name for pair in spec.pairs for name in (pair.geomname1, pair.geomname2)}
    for geom in [g for g in spec.geoms if g.name not in touching]:
        spec.delete(geom)
    for elements in (spec.sites, spec.cameras, spec.lights, spec.sensors, spec.meshes):
        for element in list(elements):
            spec.delete(element)
    spec.compiler.fusestatic = True
    return spec.compile()


def stop_the_clock() -> None:
    """Take away the clock by which MuJoCo times its own stages, for the whole process.

    Reading it costs a third of a step of so few joints, and nobody here looks at those times.
    """
    mujoco.set_mjcb_time(None)
