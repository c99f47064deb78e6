#!/usr/bin/python3
"""Are the intervals of linear propagation those of a Monte Carlo propagation (JCGM 101, clause 8)?

    linearity_study.py [--trials N] [--digits D]

One unit, one set of poses; noise, registrations and shared errors are drawn N times and calibrated. For each parameter the
ends of the shortest-tailed 95 % interval of the N results (2.5 and 97.5 %) are held against value -+ 1.96 u, with u as
stated. JCGM 101, 8.1.3: the difference of the ends, d_low and d_high, is at most the tolerance delta, half a unit of the
last of D significant digits of u. The quantiles of N trials have an uncertainty of their own, about 2.7 u/sqrt(N); a
parameter fails where a difference exceeds delta by four of these. Exit status 1 where one does.
"""

import argparse
import sys

import cases
import laboratory
import numpy as np

POSES, COILS_PER_POSE, TILT, ERRORS = 14, 12, 0.5, 0.02
FACTOR = 1.96
MOST = 4.0  # uncertainties of a quantile: there are some hundred of them
SENSORS = laboratory.Laboratory(joint=3e-4, zero_current=6e-4, registration=(1e-3, 1e-3, 1e-3))
QUANTILE_UNCERTAINTY = np.sqrt(0.025 * 0.975) / 0.05845  # of one end, times u / sqrt(N): normal density at 1.96
BATCH = 50


def tolerance(stddevs, digits):
    """JCGM 101, 7.9.2: half a unit of the last of so many digits."""
    exponent = np.floor(np.log10(stddevs) + 1e-12) - (digits - 1)
    return 0.5 * 10.0**exponent


def trials(count, seed=11):
    """Values and stated standard deviations of the parameters that all trials identify; and their names."""
    unit = laboratory.paper_unit()
    rng = np.random.default_rng(seed)
    errors = rng.uniform(-ERRORS, ERRORS, unit.size())
    poses = laboratory.random_poses(POSES, TILT, rng)
    config = cases.registration_config(SENSORS.registration)
    outcomes = []
    for first in range(0, count, BATCH):
        sessions = [
            (SENSORS, laboratory.measured_session(unit, errors, SENSORS, poses, COILS_PER_POSE, rng)[0], 0)
            for _ in range(min(BATCH, count - first))
        ]
        outcomes += cases.calibrate(unit, sessions, config)
    outcomes = [outcome for outcome in outcomes if outcome.refined()]
    told = np.all([outcome.identified for outcome in outcomes], axis=0)
    values = np.stack([outcome.values for outcome in outcomes])[:, told]
    stddevs = np.median([outcome.stddevs for outcome in outcomes], axis=0)[told]
    return values - unit.values(errors)[told], stddevs, [name for name, one in zip(unit.names(), told) if one]


def judge(values, stddevs, digits):
    """Differences of the ends in u, the tolerance in u, and how far beyond it any is in uncertainties of the quantile."""
    low, high = np.quantile(values, [0.025, 0.975], axis=0)
    apart = np.maximum(np.abs(low + FACTOR * stddevs), np.abs(high - FACTOR * stddevs)) / stddevs
    delta = tolerance(stddevs, digits) / stddevs
    return apart, delta, (apart - delta) / (QUANTILE_UNCERTAINTY / np.sqrt(len(values)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=2000)
    parser.add_argument("--digits", type=int, default=1)
    options = parser.parse_args()
    values, stddevs, names = trials(options.trials)
    apart, delta, beyond = judge(values, stddevs, options.digits)
    worst = int(np.argmax(beyond))
    print(f"{len(values)} trials, {len(names)} parameters: ends differ by {np.sqrt(np.mean(apart**2)):.3f} u rms, "
          f"{np.max(apart):.3f} u at most (chance alone: {QUANTILE_UNCERTAINTY / np.sqrt(len(values)):.3f} u each); within delta "
          f"{np.mean(apart <= delta) * 100:.0f} %, or beyond it by no more than chance {100 * np.mean(beyond <= MOST):.0f} %; worst "
          f"{names[worst]}: {apart[worst]:.3f} u, delta {delta[worst]:.3f} u")
    return 1 if np.any(beyond > MOST) else 0


if __name__ == "__main__":
    sys.exit(main())
