#!/usr/bin/python3
"""Do 95 % intervals hold 95 %, and is the error at the bound, where a dwell or a whole session shares errors?

    coverage_study.py [SCENARIO...] [--sessions N]

One line a scenario: coverage of all parameters with its standard error, rms error over the bound, stated uncertainty
over the bound. Parameters of one session share the errors of its registrations, so the standard error is that of the
mean of the sessions' shares, not of a binomial distribution over all parameters.
"""

import argparse
import dataclasses

import cases
import laboratory
import numpy as np

POSES, COILS_PER_POSE, TILT, ERRORS = 24, 9, 0.5, 0.02
MILLI = 1e-3

SCENARIOS = {
    "exact": laboratory.Laboratory(),
    "tracker": laboratory.Laboratory(registration=(MILLI, 0.0, 0.0)),
    "marker": laboratory.Laboratory(registration=(0.0, MILLI, 0.0)),
    "ft_sensor": laboratory.Laboratory(registration=(0.0, 0.0, MILLI)),
    "registrations": laboratory.Laboratory(registration=(MILLI, MILLI, MILLI)),
    "joint_0.1": laboratory.Laboratory(joint=0.1 * MILLI),
    "joint_0.3": laboratory.Laboratory(joint=0.3 * MILLI),
    "joint_1": laboratory.Laboratory(joint=MILLI),
    "encoder_12_bit": laboratory.Laboratory(encoder_bits=12),
    "bias": laboratory.Laboratory(zero_current=6e-4),
    "bias_drift": laboratory.Laboratory(zero_current=6e-4, bias_drift=3e-4),
    "all": laboratory.Laboratory(
        joint=0.3 * MILLI, encoder_bits=12, zero_current=6e-4, registration=(MILLI, MILLI, MILLI)
    ),
}


def sessions_of(unit, sensors, poses, count, first_seed):
    """(errors, dwells) each: the same poses, other errors and noise."""
    result = []
    for seed in range(first_seed, first_seed + count):
        rng = np.random.default_rng(seed)
        errors = rng.uniform(-ERRORS, ERRORS, unit.size())
        dwells, _ = laboratory.measured_session(unit, errors, sensors, poses, COILS_PER_POSE, rng)
        result.append((errors, dwells))
    return result


@dataclasses.dataclass
class Result:
    coverage: float
    coverage_error: float  # standard error, sessions being independent
    error_over_bound: float  # rms over parameters and sessions
    error_over_bound_error: float  # standard error, sessions being independent
    stated_over_bound: float
    refined: int
    seconds: float  # a refinement, median


def study(name, count, first_seed=1000, with_bound=True):
    unit, sensors = laboratory.paper_unit(), SCENARIOS[name]
    poses = laboratory.random_poses(POSES, TILT, np.random.default_rng(5))
    sessions = sessions_of(unit, sensors, poses, count, first_seed)
    config = cases.registration_config(sensors.registration)
    outcomes = cases.calibrate(unit, [(sensors, dwells, 0) for _, dwells in sessions], config)
    truths = np.stack([unit.values(errors) for errors, _ in sessions])
    values = np.stack([outcome.values for outcome in outcomes])
    stddevs = np.stack([outcome.stddevs for outcome in outcomes])
    done = np.array([outcome.refined() for outcome in outcomes], bool)
    apart = (values - truths)[done]
    held = np.mean(np.abs(apart) <= 1.96 * stddevs[done], axis=1)
    # Angles of poles and coils are as many radians as their arcs here, to 4 %: all lie near the equator.
    limits = np.full(unit.size(), np.nan)
    if with_bound:
        limits = np.sqrt(np.diag(laboratory.bound(unit, sessions[0][0], sensors, sessions[0][1])))
    squares = np.mean((apart / limits) ** 2, axis=1)
    error_over_bound = np.sqrt(np.mean(squares))
    root = np.sqrt(max(1, len(squares)))
    return Result(
        coverage=np.mean(held),
        coverage_error=np.std(held) / root,
        error_over_bound=error_over_bound,
        error_over_bound_error=np.std(squares) / root / (2.0 * error_over_bound),
        stated_over_bound=np.sqrt(np.mean((stddevs[done] / limits) ** 2)),
        refined=int(done.sum()),
        seconds=float(np.median([outcome.seconds for outcome in outcomes])),
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help=", ".join(SCENARIOS))
    parser.add_argument("--sessions", type=int, default=300)
    parser.add_argument("--no-bound", action="store_true", help="without the dense bound, which takes a minute each")
    options = parser.parse_args()
    for name in options.scenarios or SCENARIOS:
        result = study(name, options.sessions, with_bound=not options.no_bound)
        print(
            f"{name:15} coverage {100.0 * result.coverage:5.1f} +- {100.0 * result.coverage_error:.1f} %  "
            f"error/bound {result.error_over_bound:.3f} +- {result.error_over_bound_error:.3f}  "
            f"stated/bound {result.stated_over_bound:.3f}  refined {result.refined} of {options.sessions}, "
            f"{1e3 * result.seconds:.0f} ms each",
            flush=True,
        )


if __name__ == "__main__":
    main()
