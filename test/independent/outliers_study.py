#!/usr/bin/python3
"""A tenth of the torques is grossly wrong: does the exit status tell what came out in the end?

    outliers_study.py [--sessions N] [--share S]

24 poses with an orientation and nine torques each; that share of the torques is off by N(0, 0.1 N m) a component. A
session is

- right, when the calibration counts as complete, as its exit status says, and every identified parameter lies within six of
  its standard deviations;
- told, when it counts as incomplete, and the last cycle was refused or left a parameter open;
- blamed, when it counts as incomplete though the refinement succeeded and identified everything: the status then told of a
  cycle that the refinement had mended;
- wrong, when it counts as complete and a parameter lies beyond.

Exit status 1 where any session is blamed or wrong.
"""

import argparse
import collections
import sys

import cases
import laboratory
import numpy as np

POSES, COILS_PER_POSE, TILT, ERRORS, SPOILT = 24, 9, 0.5, 0.02, 0.1
MOST = 6.0  # standard deviations


def session(unit, sensors, share, seed):
    rng = np.random.default_rng([seed, 10])
    errors = rng.uniform(-ERRORS, ERRORS, unit.size())
    poses = laboratory.random_poses(POSES, TILT, rng)
    dwells, _ = laboratory.measured_session(unit, errors, sensors, poses, COILS_PER_POSE, rng)
    for dwell in dwells:
        for n, (current, torque) in enumerate(dwell.torques):
            if rng.random() < share:
                dwell.torques[n] = (current, torque + rng.normal(0.0, SPOILT, 3))
    return errors, dwells


def verdict(unit, errors, outcome):
    if not outcome.complete:
        return "blamed" if outcome.refined() and outcome.identified.all() else "told"
    apart = np.abs(outcome.values - unit.values(errors)) / outcome.stddevs
    return "wrong" if np.any(outcome.identified & (apart > MOST)) else "right"


def study(share, seeds):
    """Counts of verdicts, how many sessions had a refused cycle on the way, and a line for each that was not right."""
    unit, sensors = laboratory.paper_unit(), laboratory.Laboratory(joint=2e-5)
    made = [session(unit, sensors, share, seed) for seed in seeds]
    exact = cases.registration_config((0.0, 0.0, 0.0))
    outcomes = cases.calibrate(unit, [(sensors, dwells, 0) for _, dwells in made], exact)
    counts, lines = collections.Counter(), []
    for seed, (errors, _), outcome in zip(seeds, made, outcomes):
        kind = verdict(unit, errors, outcome)
        counts[kind] += 1
        counts["mended"] += outcome.refined() and any(not success for _, success, _ in outcome.cycles)
        if kind != "right":
            lines.append(f"seed {seed}: {kind}: {outcome.reason[:150]}")
    return counts, lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sessions", type=int, default=200)
    parser.add_argument("--share", type=float, default=0.1)
    options = parser.parse_args()
    counts, lines = study(options.share, range(options.sessions))
    print("\n".join(lines))
    print(f"{counts['right']} right, {counts['told']} told, {counts['blamed']} blamed, {counts['wrong']} wrong of "
          f"{options.sessions}; in {counts['mended']} the refinement mended a refused cycle")
    return 1 if counts["blamed"] or counts["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())
