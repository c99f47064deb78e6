#!/usr/bin/python3
"""Units of a rotor without joints, calibrated by a tracker and torques: do 95 % intervals hold 95 %, and is the error
at its Cramér-Rao bound?

    levitated_study.py [SCENARIO...] [--units N]

One line a scenario, in the manner of coverage_study.py.
"""

import argparse
import dataclasses
import os

import cases
import levitated
import numpy as np

SPHERE = os.path.join(cases.SOURCE, "config", "reaction_sphere.yaml")
POSES, COILS_PER_POSE, TILT, ERRORS = 40, 6, 0.5, 0.02
MILLI = 1e-3

SCENARIOS = {
    "exact": levitated.Laboratory(),
    "coarse_tracker": levitated.Laboratory(orientation=2.0 * MILLI),
    "fine_tracker": levitated.Laboratory(orientation=2e-5),
    "registrations": levitated.Laboratory(registration=(MILLI, MILLI, MILLI)),
}


@dataclasses.dataclass
class Result:
    coverage: float
    coverage_error: float  # standard error, units being independent
    error_over_bound: float  # rms over parameters and units
    error_over_bound_error: float
    stated_over_bound: float
    refined: int

    def __str__(self):
        return (
            f"coverage {100.0 * self.coverage:5.2f} +- {100.0 * self.coverage_error:.2f} %  error/bound "
            f"{self.error_over_bound:.3f} +- {self.error_over_bound_error:.3f}  stated/bound "
            f"{self.stated_over_bound:.3f}  refined {self.refined}"
        )


def study(name, units, first_seed=3000):
    unit, laboratory = levitated.reaction_sphere(), SCENARIOS[name]
    errors, sessions, limits = [], [], []
    for seed in range(first_seed, first_seed + units):
        rng = np.random.default_rng(seed)
        errors.append(rng.uniform(-ERRORS, ERRORS, unit.size()))
        orientations = levitated.random_orientations(POSES, TILT, rng)
        coils = levitated.chosen_coils(unit, orientations, COILS_PER_POSE, rng)
        sessions.append(levitated.measured_session(unit, errors[-1], laboratory, orientations, coils, rng))
        limits.append(np.sqrt(np.diag(levitated.bound(unit, errors[-1], laboratory, orientations, coils))))

    def write(path, session):
        levitated.write_samples(path, unit, laboratory, session)

    config = cases.registration_config(laboratory.registration)
    outcomes = cases.calibrate_written(unit.names(), sessions, write, config, SPHERE)
    done = np.array([outcome.refined() for outcome in outcomes], bool)
    apart = np.stack([outcome.values - unit.values(e) for outcome, e in zip(outcomes, errors)])[done]
    stddevs = np.stack([outcome.stddevs for outcome in outcomes])[done]
    apart = np.remainder(apart + np.pi, 2.0 * np.pi) - np.pi
    held = np.mean(np.abs(apart) <= 1.96 * stddevs, axis=1)
    squares = np.mean((apart / np.stack(limits)[done]) ** 2, axis=1)
    error, root = np.sqrt(np.mean(squares)), np.sqrt(max(1, done.sum()))
    stated = np.sqrt(np.mean((stddevs / np.stack(limits)[done]) ** 2))
    return Result(held.mean(), held.std() / root, error, squares.std() / root / (2.0 * error), stated, int(done.sum()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help=", ".join(SCENARIOS))
    parser.add_argument("--units", type=int, default=100)
    options = parser.parse_args()
    for name in options.scenarios or SCENARIOS:
        print(f"{name:15} {study(name, options.units)} of {options.units}", flush=True)


if __name__ == "__main__":
    main()
