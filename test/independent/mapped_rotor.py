"""A rotor that is off its axes by a smooth rotation over the joint angles, as bearings and bending make it."""

import laboratory
import numpy as np
from laboratory import rotation


class BentUnit(laboratory.Unit):
    """The paper's unit, turned by a bend of so many radians (root mean square of a component)."""

    def __init__(self, size, rng):
        drawn = laboratory.paper_unit()
        super().__init__(drawn.bases, drawn.poles, drawn.polarity, drawn.coils)
        self.bend = size
        self.phases = rng.uniform(-np.pi, np.pi, (3, 4))
        self.rates = np.array([2.5, 2.0, 1.0, 2.0])  # waves a turn: of tilt, tilt, spin, spin

    def orientation(self, errors, q):
        # As drawn a unit has no bend: poses are chosen by it.
        R = super().orientation(errors, q)
        if not np.any(errors):
            return R
        angles = self.rates * np.array([q[0], q[1], q[2], q[2]])
        return rotation(self.bend * np.sqrt(0.5) * np.sin(angles + self.phases).sum(axis=1)) @ R


def session(unit, sensors, seed, poses=60, coils_per_pose=6, tilt=0.4):
    """Errors of the unit and dwells."""
    rng = np.random.default_rng(seed)
    errors = rng.uniform(-0.02, 0.02, unit.size())
    dwells, _ = laboratory.measured_session(
        unit, errors, sensors, laboratory.random_poses(poses, tilt, rng), coils_per_pose, rng
    )
    return errors, dwells


def errors_of(unit, outcome, errors):
    """Of poles and coils that were identified, with their stated standard deviations."""
    seen = outcome.identified.copy()
    seen[:9] = False  # how a rotation divides among joints and bend is no matter of fact
    return (outcome.values - unit.values(errors))[seen], outcome.stddevs[seen]
