#!/usr/bin/python3
"""Are small effects named that no mistake of wiring is? effect_trials.py [options]

Sessions of laboratory.py, with an orientation and nine torques at each of 24 poses, on units of several drawings, have one
effect each, such as a weak magnet or a marker that is turned a little. The program diagnose_samples --effects
(DIAGNOSE_SAMPLES, or --program) names what explains them. An effect is named when its cause is among those named; it is
first when no other stands before it that does not explain the samples exactly as well. Prints what was not as it should be,
and the counts. Exit status: 0 at least --named of the effects were named, and at most --false-alarms healthy sessions had
one named.
"""

import argparse
import collections
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

import laboratory
import numpy as np
from wired_laboratory import actuator_yaml, drawing

DRAWINGS = {
    "8 poles, 24 coils": drawing(),
    "6 poles, 16 coils": drawing(6, (8, 8), coil_elevation=0.25),
    "10 poles, 18 coils": drawing(10, (9, 9), coil_elevation=0.2),
    "12 poles, 9 coils": drawing(12, (9,), pole_elevation=0.15, coil_elevation=0.0),
    "askew axes": drawing(axes=[[1, 0, 0], [0.3, 0.9, 0.1], [0.1, -0.2, 1]]),
}
BATCH = 20  # sessions given to the program at once
DEGREE = laboratory.DEGREE


@dataclasses.dataclass
class Case:
    unit: laboratory.Unit
    sensors: laboratory.Laboratory
    dwells: list
    rng: np.random.Generator

    def each_torque(self, change):
        """change(dwell, current, torque) gives both anew."""
        for dwell in self.dwells:
            dwell.torques = [change(dwell, current, torque) for current, torque in dwell.torques]


def turned(rng, angle):
    return laboratory.rotation(angle * _direction(rng))


def _direction(rng):
    v = rng.standard_normal(3)
    return v / np.linalg.norm(v)


def marker(angle):
    def apply(case):
        C = turned(case.rng, angle)
        for dwell in case.dwells:
            dwell.orientation = dwell.orientation @ C

    return apply


def torque_frame(angle):
    def apply(case):
        C = turned(case.rng, angle)
        case.each_torque(lambda _dwell, current, torque: (current, C @ torque))

    return apply


def coil_gain(coil, gain):
    """More flows than is recorded."""

    def apply(case):
        def change(_dwell, current, torque):
            return {j: ampere / (gain if j == coil else 1.0) for j, ampere in current.items()}, torque

        case.each_torque(change)

    return apply


def strength(gain):
    return lambda case: case.each_torque(
        lambda _dwell, current, torque: ({j: ampere / gain for j, ampere in current.items()}, torque)
    )


def joint_scale(joint, scale):
    def apply(case):
        for dwell in case.dwells:
            dwell.reading = dwell.reading.copy()
            dwell.reading[joint] /= scale

    return apply


def bias(size):
    def apply(case):
        offset = size * _direction(case.rng)
        case.each_torque(lambda _dwell, current, torque: (current, torque + offset))

    return apply


def harmonic(joint, size):
    def apply(case):
        for dwell in case.dwells:
            dwell.reading = dwell.reading.copy()
            dwell.reading[joint] += size * np.sin(dwell.reading[joint] + 0.4)

    return apply


def rows(count):
    """The torques of all samples stand so many rows later (negative: earlier) than the rest."""

    def apply(case):
        torques = [torque for dwell in case.dwells for _, torque in dwell.torques]
        places = iter(range(len(torques)))
        case.each_torque(lambda _dwell, current, _torque: (current, torques[(next(places) - count) % len(torques)]))

    return apply


def outliers(share):
    """Single torques that are wrong explain nothing."""

    def apply(case):
        case.each_torque(
            lambda _dwell, current, torque: (
                current,
                torque + (case.rng.normal(0.0, 0.1, 3) if case.rng.random() < share else 0.0),
            )
        )

    return apply


NOTHING = ("none",)
# Name: strengths of poles that are not as drawn, what is done to the session, and what must be named: one of these causes.
EFFECTS = {
    "marker 2 deg": ({}, marker(2 * DEGREE), ("marker_registration",)),
    "marker 0.3 deg": ({}, marker(0.3 * DEGREE), ("marker_registration",)),
    "torque frame 2 deg": ({}, torque_frame(2 * DEGREE), ("torque_frame",)),
    "torque frame 0.3 deg": ({}, torque_frame(0.3 * DEGREE), ("torque_frame",)),
    "coil 3 5 % more": ({}, coil_gain(2, 1.05), ("coil_gain:3",)),
    "coil 1 8 % more": ({}, coil_gain(0, 1.08), ("coil_gain:1",)),
    "coil 5 6 % less": ({}, coil_gain(4, 0.94), ("coil_gain:5",)),
    "pole 2 5 % weak": ({1: 0.95}, None, ("pole_gain:2",)),
    "pole 1 10 % weak": ({0: 0.90}, None, ("pole_gain:1",)),
    "pole 3 20 % weak": ({2: 0.80}, None, ("pole_gain:3",)),
    "pole 4 30 % weak": ({3: 0.70}, None, ("pole_gain:4",)),
    "magnets 2 % weak": ({}, strength(0.98), ("strength_scale",)),
    "joint 1 scale 1.002": ({}, joint_scale(0, 1.002), ("joint_scale:1",)),
    "joint 2 scale 1.005": ({}, joint_scale(1, 1.005), ("joint_scale:2",)),
    "joint 3 scale 1.002": ({}, joint_scale(2, 1.002), ("joint_scale:3",)),
    "bias 3 mN m": ({}, bias(3e-3), ("torque_bias",)),
    "harmonic 1 mrad": ({}, harmonic(2, 1e-3), ("encoder_harmonics",)),
    "torques 4 rows late": ({}, rows(4), ("rows_shifted",)),
    "torques 6 rows early": ({}, rows(-6), ("rows_shifted",)),
    "two outliers in 100": ({}, outliers(0.02), NOTHING),
}
# Causes of which no sample can tell one from the other.
ALIKE = [{"marker_registration", "torque_frame"}]
ROWS = {"torques 4 rows late": "4 rows later", "torques 6 rows early": "6 rows earlier"}


def make(folder, name, drawing_name, effect, seed):
    machine = DRAWINGS[drawing_name]
    rng = np.random.default_rng([seed, zlib.crc32(f"{drawing_name}/{effect}".encode())])
    unit = laboratory.Unit(machine.axes, machine.pole_angles, machine.polarity.astype(float), machine.coil_angles)
    errors = rng.uniform(-0.03, 0.03, unit.size())
    sensors = laboratory.Laboratory(orientation=rng.choice([2e-4, 5e-4]), torque=rng.choice([2e-4, 5e-4]), joint=2e-5)
    strengths, change, _ = EFFECTS[effect] if effect else ({}, None, None)
    polarity = unit.polarity.copy()
    for pole, gain in strengths.items():
        polarity[pole] *= gain
    made = dataclasses.replace(unit, polarity=polarity)
    poses = laboratory.random_poses(24, rng.uniform(0.35, 0.6), rng)
    dwells, _ = laboratory.measured_session(made, errors, sensors, poses, 9, rng)
    if change:
        change(Case(unit, sensors, dwells, rng))
    paths = (folder / f"{name}_actuator.yaml", folder / f"{name}_samples.yaml")
    paths[0].write_text(actuator_yaml(machine))
    laboratory.write_samples(paths[1], unit, sensors, dwells)
    return paths


def judge(program, cases):
    """Seconds, causes and messages of each of (drawing, effect, seed)."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = []
        for n, case in enumerate(cases):
            arguments += make(pathlib.Path(folder), n, *case)
        run = subprocess.run([program, "--effects", *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    judged = []
    for line in run.stdout.decode().splitlines():
        if line.startswith("    "):
            judged[-1][2].append(line.strip())
        else:
            seconds, *causes = line.split()
            judged.append((float(seconds), causes, []))
    return judged


def verdict(effect, causes, messages):
    """right; second: beside a wrong one before it; missed: not named; silent: nothing named."""
    expected = set(EFFECTS[effect][2]) if effect else set(NOTHING)
    if not expected & set(causes):
        return "silent" if causes == ["none"] else "wrong"
    if effect in ROWS and not any(ROWS[effect] in message for message in messages):
        return "wrong"
    alike = set().union(expected, *(group for group in ALIKE if group & expected))
    return "right" if causes[0] in alike else "second"


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--program", default=os.environ.get("DIAGNOSE_SAMPLES"))
    options.add_argument("--seeds", type=int, default=5, help="units of each drawing with each effect")
    options.add_argument("--healthy", type=int, default=60, help="healthy sessions of each drawing")
    options.add_argument("--drawings", nargs="*", default=list(DRAWINGS))
    options.add_argument("--effects", nargs="*", default=list(EFFECTS))
    options.add_argument("--named", type=float, default=0.97, help="least share of effects that are named")
    options.add_argument("--false-alarms", type=int, default=0, help="most healthy sessions with one named")
    options.add_argument("--verbose", action="store_true", help="also the messages of what was not right")
    chosen = options.parse_args()
    cases = [(name, effect, seed) for effect in chosen.effects for name in chosen.drawings for seed in range(chosen.seeds)]
    cases += [(name, None, seed) for name in chosen.drawings for seed in range(chosen.healthy)]
    counts, beside, seconds = collections.defaultdict(collections.Counter), collections.Counter(), {False: [], True: []}
    for first in range(0, len(cases), BATCH):
        batch = cases[first : first + BATCH]
        for (name, effect, seed), (taken, causes, messages) in zip(batch, judge(chosen.program, batch)):
            kind = verdict(effect, causes, messages)
            counts[effect or "healthy"][kind] += 1
            beside[effect or "healthy"] += len(causes) - 1
            seconds[effect is None].append(taken)
            if kind != "right":
                print(f"{name}, {effect or 'healthy'}, seed {seed}: {kind}: {' '.join(causes)}", flush=True)
                if chosen.verbose:
                    print("\n".join("    " + re.sub(r"\s+", " ", message) for message in messages), flush=True)
    for effect, of_effect in counts.items():
        told = ", ".join(f"{count} {kind}" for kind, count in sorted(of_effect.items()))
        print(f"{effect}: {told}; {beside[effect]} others beside")
    healthy = counts.pop("healthy", collections.Counter())
    every = sum(counts.values(), collections.Counter())
    total = max(1, sum(every.values()))
    print(f"{every['right']} of {sum(every.values())} right, {every['second']} second; "
          f"{sum(healthy.values()) - healthy['right']} false alarms in {sum(healthy.values())} healthy sessions")
    for is_healthy, words in ((False, "with effects"), (True, "healthy")):
        if seconds[is_healthy]:
            print(f"{words}: {np.median(seconds[is_healthy]):.3f} s (median), {max(seconds[is_healthy]):.3f} s at most")
    is_named = every["right"] + every["second"] >= chosen.named * total or not counts
    return 0 if is_named and sum(healthy.values()) - healthy["right"] <= chosen.false_alarms else 1


if __name__ == "__main__":
    sys.exit(main())
