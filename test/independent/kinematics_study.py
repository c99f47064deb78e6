#!/usr/bin/python3
"""Random kinematics, also with parallel and nearly parallel axes: is what can be told at its bound, and the rest named?

    kinematics_study.py [--cases N] [--first-seed S]

Each case has axes of its own and 20 orientations. Of the nine coordinates of its joints some combinations are told, and
others are not, or hardly: the model of this folder knows which. Where the cycle succeeds,

- the error of what is told shows as error of the predicted orientations at the measured poses. Its mean square over the
  noise's is the number of combinations that are told (Gauss-Markov), so its root over that of this number is at the
  bound where it is 1;
- so is each such combination by itself: its error over its bound, over all cases, by its place from the best told one
  to the worst;
- a combination that no sample tells must not be claimed: a parameter that takes a large part in it and counts as
  identified is a claim;
- a parameter that counts as identified and lies six of its standard deviations or more from the truth is a wrong
  success, and so is a combination whose error is as many times its stated uncertainty.

Exit status 1 where anything is claimed or wrong, or an error is beyond 1.05 of the bound: of single combinations by
more than two standard errors.
"""

import argparse
import collections
import os
import sys
import tempfile

import cases
import laboratory
import numpy as np

POSES, RANGE, ERRORS = 20, 1.0, 0.02
OPEN = 0.05  # [rad] estimation.unobservable_stddev
CLEARLY_OPEN = 0.2  # [rad] beyond any argument about where open begins
LARGE_PART = 0.1  # of a unit vector's square
MOST = 6.0  # standard deviations
MOST_ERROR = 1.05  # over the bound
KINDS = ("general", "orthogonal", "parallel neighbours", "parallel ends", "nearly parallel", "all parallel")


def turned(axis, angle, rng):
    """The axis turned by an angle in a random direction."""
    across = np.cross(axis, rng.normal(size=3))
    return laboratory.rotation(angle * across / np.linalg.norm(across)) @ axis


def axes_of(kind, rng):
    def random_axis():
        v = rng.normal(size=3)
        return v / np.linalg.norm(v)

    first, other = random_axis(), random_axis()
    while not 0.4 < np.arccos(abs(first @ other)) < np.pi / 2:
        other = random_axis()
    if kind == "orthogonal":
        second = np.cross(first, other) / np.linalg.norm(np.cross(first, other))
        return np.stack([first, second, np.cross(first, second)])
    if kind == "parallel neighbours":
        return np.stack([first, first, other])
    if kind == "parallel ends":
        return np.stack([first, other, first])
    if kind == "nearly parallel":
        near = turned(first, 10.0 ** rng.uniform(-3.0, -0.5), rng)
        return np.stack([first, near, other] if rng.random() < 0.5 else [other, first, near])
    if kind == "all parallel":
        return np.stack([first, first, first])
    return np.stack([first, other, random_axis()])


def description(bases):
    rows = [
        f"    - {{name: joint_{k + 1}, axis: [{', '.join(repr(float(v)) for v in axis)}], offset: 0.0}}"
        for k, axis in enumerate(bases)
    ]
    return "actuator:\n  name: kinematics\n  joints:\n" + "\n".join(rows) + "\n  workspace: {tilt_limit: 1.0}\n"


def jacobian(unit, errors, poses):
    """Of the orientations at the poses by the nine errors, left rotation vectors."""
    rows = []
    for q in poses:
        R = unit.orientation(errors, q)
        columns = []
        for p in range(9):
            step = np.zeros(9)
            step[p] = 1e-6
            ahead, behind = unit.orientation(errors + step, q), unit.orientation(errors - step, q)
            columns.append((laboratory.rotation_vector(ahead @ R.T) - laboratory.rotation_vector(behind @ R.T)) / 2e-6)
        rows.append(np.stack(columns, axis=1))
    return np.concatenate(rows)


class Case:
    def __init__(self, seed):
        rng = np.random.default_rng([seed, 77])
        self.kind = KINDS[seed % len(KINDS)]
        self.unit = laboratory.Unit(axes_of(self.kind, rng), np.zeros((0, 2)), np.zeros(0), np.zeros((0, 2)))
        self.sensors = laboratory.Laboratory()
        self.errors = rng.uniform(-ERRORS, ERRORS, 9)
        self.poses = rng.uniform(-RANGE, RANGE, (POSES, 3))
        self.dwells = [
            laboratory.Dwell(
                q, laboratory.rotation(rng.normal(0.0, self.sensors.orientation, 3)) @ self.unit.orientation(self.errors, q)
            )
            for q in self.poses
        ]
        J = jacobian(self.unit, self.errors, self.poses)
        values, self.directions = np.linalg.eigh(J.T @ J / self.sensors.orientation**2)
        self.stddevs = 1.0 / np.sqrt(np.maximum(values, 1e-30))

    def outcome(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "actuator.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(description(self.unit.bases))
            exact = cases.registration_config((0.0, 0.0, 0.0))
            return cases.calibrate(self.unit, [(self.sensors, self.dwells, 0)], exact, actuator=path)[0]

    def told(self):
        return int((self.stddevs < OPEN).sum())

    def squared_error(self, outcome):
        """Of the predicted orientations, over the variance of the noise."""
        return sum(
            np.sum(laboratory.rotation_vector(self.unit.orientation(outcome.values, q) @ self.unit.orientation(self.errors, q).T) ** 2)
            for q in self.poses
        ) / self.sensors.orientation**2

    def squared_combinations(self, outcome):
        """Error of each combination that is told over its bound, squared; from the best told one on."""
        apart = (self.directions.T @ (outcome.values - self.errors)) / self.stddevs
        return np.square(apart[np.argsort(self.stddevs)][: self.told()])

    def findings(self, outcome):
        """What is claimed or wrong, in words."""
        names, apart = self.unit.names(), outcome.values - self.errors
        words = []
        for p in np.flatnonzero(outcome.identified & (np.abs(apart) > MOST * outcome.stddevs)):
            words.append(f"{names[p]} is {abs(apart[p]) / outcome.stddevs[p]:.0f} standard deviations off")
        for stddev, direction in zip(self.stddevs, self.directions.T):
            stated = np.sqrt(max(0.0, direction @ outcome.joint_covariance @ direction))
            if abs(direction @ apart) > MOST * stated + 1e-9 and stddev > OPEN:
                words.append(f"an open combination is {abs(direction @ apart) / stated:.0f} times its uncertainty off")
            if stddev > CLEARLY_OPEN:
                for p in np.flatnonzero(outcome.identified & (direction**2 > LARGE_PART)):
                    words.append(f"{names[p]} is claimed")
        return words


class Tally:
    def __init__(self):
        self.counts = collections.Counter()
        self.squares = self.freedom = 0.0
        self.combinations = [[] for _ in range(9)]  # squared error over the bound's square, from the best told on

    def add(self, case, outcome):
        if not outcome.cycles or not outcome.cycles[0][1]:
            self.counts["refused"] += 1
            return []
        self.counts["done"] += 1
        self.squares += case.squared_error(outcome)
        self.freedom += case.told()
        for place, square in enumerate(case.squared_combinations(outcome)):
            self.combinations[place].append(square)
        words = case.findings(outcome)
        self.counts["wrong"] += bool(words)
        return words

    def error_over_bound(self):
        return np.sqrt(self.squares / max(1.0, self.freedom))


def study(count, first_seed=0):
    """A tally for each kind, and a line for each finding and refusal."""
    tallies, lines = {kind: Tally() for kind in KINDS}, []
    for seed in range(first_seed, first_seed + count):
        case = Case(seed)
        outcome = case.outcome()
        words = tallies[case.kind].add(case, outcome)
        if words:
            lines.append(f"seed {seed}, {case.kind}: " + "; ".join(words))
        elif not outcome.cycles or not outcome.cycles[0][1]:
            lines.append(f"seed {seed}, {case.kind}: refused: {outcome.cycles[0][2] if outcome.cycles else outcome.reason}")
    return tallies, lines


def pooled_error(tallies):
    """rms error over the bound of all cases, and its standard error."""
    squares, freedom = (sum(getattr(tally, what) for tally in tallies.values()) for what in ("squares", "freedom"))
    pooled = np.sqrt(squares / freedom)
    return pooled, pooled / np.sqrt(2.0 * freedom)


def errors_of_combinations(tallies):
    """rms error over the bound, with its standard error, of each place among the told combinations."""
    result = []
    for place in range(9):
        squares = np.concatenate([tally.combinations[place] for tally in tallies.values()])
        if len(squares) > 1:
            rms = np.sqrt(np.mean(squares))
            result.append((rms, np.std(squares) / np.sqrt(len(squares)) / (2.0 * rms), len(squares)))
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=0)
    options = parser.parse_args()
    tallies, lines = study(options.cases, options.first_seed)
    print("\n".join(lines))
    for kind, tally in tallies.items():
        print(f"{kind:20} error/bound {tally.error_over_bound():.3f}, {tally.counts['done']} done, "
              f"{tally.counts['refused']} refused, {tally.counts['wrong']} wrong")
    pooled, uncertainty = pooled_error(tallies)
    print(f"{'all':20} error/bound {pooled:.3f} +- {uncertainty:.3f}")
    beyond = pooled > MOST_ERROR
    for place, (error, uncertainty, count) in enumerate(errors_of_combinations(tallies)):
        print(f"combination {place + 1:8} error/bound {error:.3f} +- {uncertainty:.3f}, {count} cases")
        beyond = beyond or error - 2.0 * uncertainty > MOST_ERROR
    return 1 if beyond or any(tally.counts["wrong"] for tally in tallies.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
