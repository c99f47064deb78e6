#!/usr/bin/python3
"""Does a check notice what it says it would?

    check_study.py [--sessions N] [--poses P]

A unit is calibrated; then a few poses (3 by default), with an orientation each, are held out and checked, of the unit as it
was calibrated, or of one of which a joint has moved. A check that finds all well says "valid to X mrad (99 %)". It is

- a false alarm, when nothing has moved and it finds a change;
- too sure, when it says so and the orientations of these poses are off by more than X, root mean square.

Exit status 1 where more than 1 % are false alarms, or of the moved units more than 1 % too sure: each by more than two
standard errors.
"""

import argparse
import collections
import re
import sys

import cases
import laboratory
import numpy as np

POSES, COILS_PER_POSE, TILT, ERRORS, LARGEST_MOVE = 24, 6, 0.5, 0.02, 1e-3
PROMISED = 0.01


def session(unit, sensors, poses, has_moved, seed):
    """Dwells of which the last are those of the check, and by how much their orientations are off."""
    rng = np.random.default_rng([seed, 42, has_moved])
    errors = rng.uniform(-ERRORS, ERRORS, unit.size())
    calibrated = laboratory.random_poses(POSES, TILT, rng)
    dwells, _ = laboratory.measured_session(unit, errors, sensors, calibrated, COILS_PER_POSE, rng)
    now = errors.copy()
    if has_moved:
        now[3 * rng.integers(3)] += rng.choice([-1.0, 1.0]) * rng.uniform(0.0, LARGEST_MOVE)
    checked = laboratory.random_poses(poses, TILT, rng)
    later, _ = laboratory.measured_session(unit, now, sensors, checked, 0, rng)
    for dwell in later:
        dwell.held_out = True
    off = [laboratory.rotation_vector(unit.orientation(now, q) @ unit.orientation(errors, q).T) for q in checked]
    return dwells + later, float(np.sqrt(np.mean(np.sum(np.square(off), axis=1))))


def study(poses, has_moved, seeds):
    """Counts of answers, and the bounds that were told [rad]."""
    unit, sensors = laboratory.paper_unit(), laboratory.Laboratory(joint=2e-5)
    made = [session(unit, sensors, poses, has_moved, seed) for seed in seeds]
    exact = cases.registration_config((0.0, 0.0, 0.0))
    outcomes = cases.calibrate(unit, [(sensors, dwells, 0) for dwells, _ in made], exact)
    counts, bounds = collections.Counter(), []
    for (_, off), outcome in zip(made, outcomes):
        is_valid, message = outcome.check
        counts["valid" if is_valid else "changed"] += 1
        if is_valid:
            bounds.append(1e-3 * float(re.search(r"Valid to ([0-9.e-]+) mrad \(99 %\)", message).group(1)))
            counts["too sure"] += off > bounds[-1]
    return counts, bounds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sessions", type=int, default=500)
    parser.add_argument("--poses", type=int, default=3)
    options = parser.parse_args()
    seeds = range(options.sessions)
    healthy, bounds = study(options.poses, False, seeds)
    moved, _ = study(options.poses, True, seeds)
    print(f"nothing moved: {healthy['changed']} false alarms of {options.sessions}; valid to {1e3 * np.median(bounds):.2f} mrad "
          f"(median)\nmoved by up to {1e3 * LARGEST_MOVE:.1f} mrad: {moved['changed']} noticed, {moved['too sure']} too sure of "
          f"{options.sessions}")
    most = options.sessions * PROMISED + 2.0 * np.sqrt(options.sessions * PROMISED)
    return 1 if healthy["changed"] > most or moved["too sure"] > most else 0


if __name__ == "__main__":
    sys.exit(main())
