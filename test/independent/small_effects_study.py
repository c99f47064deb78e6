#!/usr/bin/python3
"""Small single mistakes and copied measurements: is the result right, or told? And is a sound session left in peace?

    small_effects_study.py [KIND...] [--sessions N] [--first-seed S]

24 poses with an orientation and nine torques each, every fifth pose held out, registrations stated as exact; three
geometries in turn. Each kind does one thing to a sound session. One line a kind:

- found: sessions that are not called good, or say what was done to them;
- good: sessions that are called good, and coverage of their 95 % intervals, the error over the stated uncertainty (rms),
  and how many of these intervals lie beyond six standard deviations.

Exit status 1 where more than one of 3000 sound sessions is blamed, and at least one is.
"""

import argparse
import copy
import dataclasses
import os
import sys
import tempfile

import cases
import laboratory
import numpy as np

POSES, COILS_PER_POSE, TILT, ERRORS, HELD_OUT = 24, 9, 0.5, 0.02, 5
SENSORS = laboratory.Laboratory(joint=2e-5)


def ring(count, polar, start=0.0):
    return [[polar, start + j * 2.0 * np.pi / count] for j in range(count)]


def units():
    tilted = np.array([[0.9, 0.1, -0.2], [0.15, 1.0, 0.1], [-0.1, 0.2, 1.0]])
    small = laboratory.Unit(
        tilted / np.linalg.norm(tilted, axis=1)[:, None],
        np.array(ring(6, 0.0)),
        np.array([1.0, -1.0] * 3),
        np.array(ring(9, 0.25) + ring(9, -0.25, 0.35)),
    )
    turned = laboratory.Unit(
        np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
        np.array(ring(10, 0.1)),
        np.array([1.0, -1.0] * 5),
        np.array(ring(12, 0.35) + ring(8, 0.0, 0.1) + ring(12, -0.3)),
    )
    return [laboratory.paper_unit(), small, turned]


def description(unit):
    def numbers(values):
        return ", ".join(repr(float(v)) for v in values)

    lines = ["actuator:", "  name: study", "  joints:"]
    for k, axis in enumerate(unit.bases):
        lines.append(f"    - {{name: joint_{k + 1}, axis: [{numbers(axis)}], offset: 0.0}}")
    lines.append("  poles:")
    for pole, polarity in zip(unit.poles, unit.polarity):
        lines.append(f"    - {{polar: {float(pole[0])!r}, azimuth: {float(pole[1])!r}, polarity: {int(polarity)}}}")
    lines.append("  coils:")
    for coil in unit.coils:
        lines.append(f"    - {{polar: {float(coil[0])!r}, azimuth: {float(coil[1])!r}}}")
    lines.append(
        f"  torque_curve:\n    angle_unit: deg\n    coefficients: [{numbers(laboratory.COEFFICIENTS)}]\n"
        "    blend_start: 2.0\n    support: [28.0, 32.0]\n  workspace: {tilt_limit: 0.6}"
    )
    return "\n".join(lines) + "\n"


def turn_torques(dwells, size, rng):
    C = laboratory.rotation(size * direction(rng))
    for dwell in dwells:
        dwell.torques = [(current, C @ torque) for current, torque in dwell.torques]


def direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def middle(dwells, rng):
    """Somewhere in the middle half."""
    return int(rng.integers(len(dwells) // 4, 3 * len(dwells) // 4))


def bump_marker(dwells, size, rng):
    C = laboratory.rotation(size * direction(rng))
    for dwell in dwells[middle(dwells, rng) :]:
        dwell.orientation = dwell.orientation @ C


def bump_tracker(dwells, size, rng):
    C = laboratory.rotation(size * direction(rng))
    for dwell in dwells[middle(dwells, rng) :]:
        dwell.orientation = C @ dwell.orientation


def jump_joint(dwells, size, rng):
    jump = np.zeros(3)
    jump[rng.integers(3)] = size
    for dwell in dwells[middle(dwells, rng) :]:
        dwell.reading = dwell.reading + jump


def weaken_coil(dwells, size, rng):
    coils = [coil for dwell in dwells for current, _ in dwell.torques for coil in current]
    coil = rng.choice(coils)
    for dwell in dwells:
        dwell.torques = [(c, T * (1.0 - size) if coil in c else T) for c, T in dwell.torques]


def bias(dwells, size, rng):
    b = size * direction(rng)
    for dwell in dwells:
        dwell.torques = [(current, torque + b) for current, torque in dwell.torques]


def double_rows(dwells, share, rng):
    """Every dwell may come again, bit for bit: rows that were pasted twice."""
    again = [copy.deepcopy(dwell) for dwell in dwells if rng.random() < share]
    dwells.extend(again)


def replay(dwells, times, rng):
    del rng
    first = list(dwells)
    for _ in range(int(times)):
        dwells.extend(copy.deepcopy(first))


def freeze_torque(dwells, share, rng):
    """A sensor that stands still for a part of the torques of a dwell."""
    for dwell in dwells:
        if rng.random() < share:
            frozen = dwell.torques[0][1]
            dwell.torques = [(current, frozen) for current, _ in dwell.torques]


def repeat_orientation(dwells, times, rng):
    """One orientation of a pose, written beside each of its torques."""
    del rng
    for dwell in list(dwells):
        for _ in range(int(times)):
            dwells.append(laboratory.Dwell(dwell.reading, dwell.orientation, [], dwell.held_out))
    dwells.sort(key=lambda dwell: tuple(dwell.reading))


def outliers(dwells, share, rng):
    for dwell in dwells:
        for n, (current, torque) in enumerate(dwell.torques):
            if rng.random() < share:
                dwell.torques[n] = (current, torque + rng.normal(0.0, 0.1, 3))


def steps(dwells, step, rng):
    """An orientation sensor that rounds, and a torque sensor; rounding is stated."""
    del rng
    for dwell in dwells:
        v = laboratory.rotation_vector(dwell.orientation)
        dwell.orientation = laboratory.rotation(np.round(v / step) * step)


def nothing(dwells, size, rng):
    del dwells, size, rng


KINDS = {
    "sound": (nothing, 0.0),
    "torque_frame": (turn_torques, 0.87e-3),
    "marker_bumped": (bump_marker, 0.5e-3),
    "tracker_bumped": (bump_tracker, 0.5e-3),
    "joint_jumps": (jump_joint, 0.3e-3),
    "coil_weak": (weaken_coil, 5e-3),
    "bias": (bias, 3e-4),
    "rows_doubled": (double_rows, 0.5),
    "replayed": (replay, 3),
    "torque_frozen": (freeze_torque, 0.1),
    "orientation_repeated": (repeat_orientation, 8),
    "outliers_2": (outliers, 0.02),
    "outliers_5": (outliers, 0.05),
    "outliers_10": (outliers, 0.1),
}
WORDS = ("repeat an earlier sample", "not modelled")


def session(unit, kind, seed):
    rng = np.random.default_rng([seed, 31])
    errors = rng.uniform(-ERRORS, ERRORS, unit.size())
    poses = laboratory.random_poses(POSES, TILT, rng)
    dwells, _ = laboratory.measured_session(unit, errors, SENSORS, poses, COILS_PER_POSE, rng)
    change, size = KINDS[kind]
    for n, dwell in enumerate(dwells):
        dwell.held_out = n % HELD_OUT == HELD_OUT - 1
    change(dwells, size, rng)
    return errors, dwells


@dataclasses.dataclass
class Result:
    sessions: int = 0
    found: int = 0
    good: int = 0
    apart: list = dataclasses.field(default_factory=list)
    seconds: list = dataclasses.field(default_factory=list)
    grades: dict = dataclasses.field(default_factory=dict)
    blamed: list = dataclasses.field(default_factory=list)
    all_apart: list = dataclasses.field(default_factory=list)

    def coverage(self):
        return np.mean(np.abs(np.concatenate(self.apart)) < 1.96) if self.apart else np.nan

    def error(self):
        return np.sqrt(np.mean(np.concatenate(self.apart) ** 2)) if self.apart else np.nan

    def beyond(self):
        return int(np.sum(np.abs(np.concatenate(self.apart)) > 6.0)) if self.apart else 0


def study(kind, seeds):
    result = Result()
    seeds = list(seeds)
    for g, unit in enumerate(units()):
        own = [seed for seed in seeds if seed % 3 == g]
        if not own:
            continue
        made = [session(unit, kind, seed) for seed in own]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "actuator.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(description(unit))
            exact = cases.registration_config((0.0, 0.0, 0.0))
            outcomes = cases.calibrate(unit, [(SENSORS, dwells, 0) for _, dwells in made], exact, actuator=path)
        for seed, (errors, _), outcome in zip(own, made, outcomes):
            message = outcome.cycles[-1][2]
            is_told = any(word in message or word in outcome.reason for word in WORDS)
            apart = ((outcome.values - unit.values(errors)) / outcome.stddevs)[outcome.identified]
            result.sessions += 1
            result.grades[outcome.grade] = result.grades.get(outcome.grade, 0) + 1
            result.seconds.append(outcome.seconds)
            result.found += is_told or outcome.grade in ("contradicted", "failed")
            result.all_apart.append(apart)
            if outcome.grade == "good":
                result.good += 1
                result.apart.append(apart)
            if is_told or outcome.grade in ("contradicted", "failed"):
                result.blamed.append(f"{seed}: {outcome.grade}: {message} | {outcome.reason[:200]}")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--sessions", type=int, default=60)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--show", type=int, default=0, help="so many findings in words")
    options = parser.parse_args()
    status = 0
    for kind in options.kinds or KINDS:
        result = study(kind, range(options.first_seed, options.first_seed + options.sessions))
        every = np.concatenate(result.all_apart)
        print(
            f"{kind:21} found {result.found:4} of {result.sessions}  good {result.good:4}: coverage "
            f"{100.0 * result.coverage():5.1f} %, error {result.error():.2f}, beyond 6: {result.beyond()}  "
            f"all: coverage {100.0 * np.mean(np.abs(every) < 1.96):5.1f} %, error {np.sqrt(np.mean(every**2)):.2f}  "
            f"{1e3 * np.min(result.seconds):.0f} ms  {result.grades}",
            flush=True,
        )
        for line in result.blamed[: options.show]:
            print("   ", line)
        if kind == "sound" and result.found > max(1, result.sessions / 3000.0):
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
