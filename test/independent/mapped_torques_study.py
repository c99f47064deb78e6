#!/usr/bin/python3
"""Poles and coils of rotors that are off their axes by a smooth rotation: errors, and coverage of 95 % intervals."""

import argparse
import collections
import dataclasses

import cases
import laboratory
import mapped_rotor
import numpy as np


@dataclasses.dataclass
class Result:
    """Of poles and coils of all refined units."""

    refined: int
    coverage: float
    ratio: float  # errors over what is stated, root mean square
    rms: float  # of the errors [rad]
    grades: collections.Counter


def study(units, bend=4e-4, use="auto", first_seed=0, **drawn):
    sensors = laboratory.Laboratory(orientation=2e-4)
    truths, sessions = [], []
    for seed in range(first_seed, first_seed + units):
        unit = mapped_rotor.BentUnit(bend, np.random.default_rng(1000 + seed))
        errors, dwells = mapped_rotor.session(unit, sensors, seed, **drawn)
        truths.append((unit, errors))
        sessions.append((sensors, dwells, 0))
    config = cases.registration_config((0.0, 0.0, 0.0), f"orientation_map: {{use: {use}}}\n")
    outcomes = cases.calibrate(truths[0][0], sessions, config)
    off, stddevs = [np.zeros(0)], [np.zeros(0)]
    for (unit, errors), outcome in zip(truths, outcomes):
        if outcome.refined():
            for column, more in zip((off, stddevs), mapped_rotor.errors_of(unit, outcome, errors)):
                column.append(more)
        else:
            print(*outcome.cycles[-1])
    off, stddevs = np.concatenate(off), np.concatenate(stddevs)
    return Result(
        sum(bool(outcome.refined()) for outcome in outcomes),
        np.mean(np.abs(off) < 1.96 * stddevs),
        np.sqrt(np.mean((off / stddevs) ** 2)),
        np.sqrt(np.mean(off**2)),
        collections.Counter(outcome.grade for outcome in outcomes),
    )


def main():
    line = argparse.ArgumentParser(description=__doc__)
    line.add_argument("--units", type=int, default=40)
    line.add_argument("--bend", type=float, default=4e-4, help="[rad], root mean square of a component")
    line.add_argument("--poses", type=int, default=60)
    line.add_argument("--coils", type=int, default=6)
    line.add_argument("--use", default="auto", help="of the map: auto, always, never")
    of = line.parse_args()
    result = study(of.units, of.bend, of.use, poses=of.poses, coils_per_pose=of.coils)
    print(
        f"{result.refined} of {of.units} refined, {100.0 * result.coverage:.1f} % inside, errors {result.ratio:.3f} of "
        f"what is stated, {1e3 * result.rms:.4f} mrad; {dict(result.grades)}"
    )


if __name__ == "__main__":
    main()
