#!/usr/bin/python3
"""Do the 95 % intervals of a calibration in motion hold 95 %?

    motion_coverage_study.py [SCENARIO...] [--units N] [--first SEED] [--seconds S] [--bounds N]

Every unit has errors, a motion and noise of its own; all scenarios record the same motions. One line a unit, and one a
scenario with the share of parameters inside and its standard error: the parameters of one unit share the tracker's
errors, so it is that of the mean of the units' shares, not of a binomial distribution over all parameters.

--bounds compares errors and standard deviations of so many units in the scenario 1000_hz with the Cramér-Rao bound of the
whole recording (motion_bound.py), root mean square over the unit's parameters.
"""

import argparse

import free_motion
import laboratory
import motion_bound
import numpy as np
from motion_cases import calibrate

ERRORS = 0.03  # [rad], and rad of every angle
MILLI = 1e-3

# Streams start at phases of their own: nothing makes sensors wait for the setpoints.
SCENARIOS = {
    "1000_hz": {"joint_rate": 1000.0, "current_rate": 1000.0},
    "200_hz": {"joint_rate": 200.0, "current_rate": 200.0},
    "200_hz_in_step": {"joint_rate": 200.0, "current_rate": 200.0, "in_step": True},
    "1000_hz_lossy": {"joint_rate": 1000.0, "current_rate": 1000.0, "lost": 0.05},
    "100_hz": {"joint_rate": 100.0, "current_rate": 100.0},
}


def streams_of(scenario, rng):
    options = dict(SCENARIOS[scenario])
    phases = rng.uniform(0.0, [1.0 / options["joint_rate"], 1.0 / options["current_rate"]])
    if not options.pop("in_step", False):
        options.update(joint_phase=phases[0], current_phase=phases[1])
    delays = rng.uniform([-0.01, 0.0], [0.01, 0.02])
    return free_motion.Streams(current_delay=delays[0], tracker_delay=delays[1], **options)


class Tally:
    """What the units of one scenario came to."""

    def __init__(self):
        self.inside, self.squares, self.normalised, self.worst, self.refused = [], [], [], [], 0
        self.distances = []
        self.error_over_bound, self.stated_over_bound = [], []  # squared

    def add(self, outcome, unit, errors):
        """The line of one unit."""
        apart, stddevs, identified = outcome.judged(unit, errors)
        if not outcome.converged or not identified.all():
            self.refused += 1
            return "not converged" if not outcome.converged else f"{identified.sum()} of {len(identified)} identified"
        self.inside.append(np.mean(np.abs(apart) <= 1.96 * stddevs))
        self.squares.append(np.mean(apart**2))
        self.normalised.append(np.mean((apart / stddevs) ** 2))
        self.worst.append(np.max(stddevs))
        self.distances.append(outcome.distance(unit, errors))
        return (
            f"inside {100.0 * self.inside[-1]:5.1f} %  rms {np.sqrt(self.squares[-1]) / MILLI:.4f} mrad  "
            f"normalised {np.sqrt(self.normalised[-1]):.2f}  worst std {self.worst[-1] / MILLI:.4f} mrad  "
            f"by covariance {np.sqrt(self.distances[-1]):.2f}  chi-square {outcome.chi_square:.3f}  held out {outcome.probability:.2g}"
        )

    def compare(self, outcome, unit, errors, limits):
        """With the bound of each parameter; the end of the unit's line."""
        apart, stddevs, _ = outcome.judged(unit, errors)
        scale = np.mean(limits**2)
        self.error_over_bound.append(np.mean(apart**2) / scale)
        self.stated_over_bound.append(np.mean(stddevs**2) / scale)
        return (
            f"  error/bound {np.sqrt(self.error_over_bound[-1]):.2f}  stated/bound {np.sqrt(self.stated_over_bound[-1]):.3f}  "
            f"worst stated/bound of a parameter {np.max(stddevs / limits):.3f}"
        )

    def bounds(self):
        """What the comparisons came to."""
        if not self.error_over_bound:
            return ""
        squares = np.array(self.error_over_bound)
        rms = np.sqrt(np.mean(squares))
        uncertainty = np.std(squares) / np.sqrt(len(squares)) / (2.0 * rms)
        return (
            f"  of {len(squares)}: error/bound {rms:.3f} +- {uncertainty:.3f}, stated/bound "
            f"{np.sqrt(np.mean(self.stated_over_bound)):.3f}"
        )

    def __str__(self):
        if not self.inside:
            return f"no unit calibrated, {self.refused} refused"
        root = np.sqrt(len(self.inside))
        return (
            f"{len(self.inside)} units, {self.refused} refused: inside {100.0 * np.mean(self.inside):.1f} +- "
            f"{100.0 * np.std(self.inside) / root:.1f} %  rms {np.sqrt(np.mean(self.squares)) / MILLI:.4f} mrad  "
            f"normalised {np.sqrt(np.mean(self.normalised)):.2f}  by covariance {np.sqrt(np.mean(self.distances)):.3f} +- "
            f"{np.std(self.distances) / root / (2.0 * np.sqrt(np.mean(self.distances))):.3f}  worst std {np.median(self.worst) / MILLI:.4f} mrad (median)"
        ) + self.bounds()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help=", ".join(SCENARIOS))
    parser.add_argument("--units", type=int, default=100)
    parser.add_argument("--first", type=int, default=1, help="seed of the first unit")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--bounds", type=int, default=0, metavar="N", help="a minute each")
    options = parser.parse_args()
    unit, machine = laboratory.paper_unit(), free_motion.Machine()
    tallies = {scenario: Tally() for scenario in options.scenarios or SCENARIOS}
    for seed in range(options.first, options.first + options.units):
        errors = np.random.default_rng(seed).uniform(-ERRORS, ERRORS, unit.size())
        motion = free_motion.simulate(unit, errors, machine, options.seconds, seed)
        for scenario, tally in tallies.items():
            streams = streams_of(scenario, np.random.default_rng(1000 + seed))
            outcome = calibrate(free_motion.record(unit, errors, motion, streams, seed))
            line = tally.add(outcome, unit, errors)
            if scenario == "1000_hz" and seed < options.first + options.bounds:
                limits = np.sqrt(np.diag(motion_bound.bound(unit, errors, machine, motion, streams)))
                line += tally.compare(outcome, unit, errors, limits)
            print(f"unit {seed} {scenario:15} {line}", flush=True)
    for scenario, tally in tallies.items():
        print(f"{scenario:15} {tally}")


if __name__ == "__main__":
    main()
