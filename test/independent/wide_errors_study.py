#!/usr/bin/python3
"""Units far off their drawing: is what comes out right, or is it told?

    wide_errors_study.py [--range RAD...] [--sessions N]

All offsets and angles are off by a uniform error of that range, so an axis by up to 1.4 times as much. Sessions are of
four kinds in turn: many and few samples, the tracker on at every pose or at ten of them only. A session is

- right, when the refinement succeeds and each identified parameter lies within six of its standard deviations;
- told, when a cycle that counts is refused, or the grade says that the calibration is not to be used;
- silent else. One such session is a failure: exit status 1.
"""

import argparse
import collections
import dataclasses
import sys

import cases
import laboratory
import numpy as np

MOST = 6.0  # standard deviations: once in a million sessions by chance


@dataclasses.dataclass
class Design:
    poses: int
    coils_per_pose: int
    tilt: float
    tracked: int  # first so many poses have an orientation


DESIGNS = (Design(24, 9, 0.5, 24), Design(14, 7, 0.4, 14), Design(30, 6, 0.6, 10), Design(10, 6, 0.5, 10))


def session(unit, sensors, half_width, seed):
    design = DESIGNS[seed % len(DESIGNS)]
    rng = np.random.default_rng([seed, round(1e3 * half_width)])
    errors = rng.uniform(-half_width, half_width, unit.size())
    poses = laboratory.random_poses(design.poses, design.tilt, rng)
    dwells, _ = laboratory.measured_session(unit, errors, sensors, poses, design.coils_per_pose, rng)
    for dwell in dwells[design.tracked :]:
        dwell.orientation = None
    return errors, dwells


def verdict(unit, errors, outcome):
    """right, told or silent; and what is wrong."""
    if not outcome.refined() or outcome.grade in ("failed", "contradicted"):
        return "told", ""
    apart = np.abs(outcome.values - unit.values(errors)) / outcome.stddevs
    wrong = np.flatnonzero(outcome.identified & (apart > MOST))
    if not len(wrong):
        return "right", ""
    names = unit.names()
    return "silent", ", ".join(f"{names[p]} off by {apart[p]:.0f} standard deviations" for p in wrong[:4])


def study(half_width, seeds):
    """Counts of verdicts, and a line for each silent or told session."""
    unit, sensors = laboratory.paper_unit(), laboratory.Laboratory(joint=2e-5)
    made = [session(unit, sensors, half_width, seed) for seed in seeds]
    exact = cases.registration_config((0.0, 0.0, 0.0))
    outcomes = cases.calibrate(unit, [(sensors, dwells, 0) for _, dwells in made], exact)
    counts, lines = collections.Counter(), []
    for seed, (errors, _), outcome in zip(seeds, made, outcomes):
        kind, words = verdict(unit, errors, outcome)
        counts[kind] += 1
        if kind == "right" and not outcome.identified.all():
            counts["right, with open parameters"] += 1
        if kind == "silent":
            lines.append(f"seed {seed}: {words}")
        elif kind == "told":
            lines.append(f"seed {seed}: told: {outcome.reason[:150]}")
    return counts, lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--range", type=float, nargs="*", default=[0.05, 0.1, 0.15, 0.2], metavar="RAD")
    parser.add_argument("--sessions", type=int, default=200)
    parser.add_argument("--first-seed", type=int, default=0)
    options = parser.parse_args()
    silent = 0
    for half_width in options.range:
        seeds = range(options.first_seed, options.first_seed + options.sessions)
        counts, lines = study(half_width, seeds)
        silent += counts["silent"]
        print("\n".join(lines))
        print(f"+-{half_width:.2f} rad: {counts['right']} right ({counts['right, with open parameters']} with open "
              f"parameters), {counts['told']} told, {counts['silent']} silent of {options.sessions}", flush=True)
    return 1 if silent else 0


if __name__ == "__main__":
    sys.exit(main())
