#!/usr/bin/python3
"""Are mistakes named, and is none named where there is none? diagnosis_trials.py [options]

Sessions are made by wired_laboratory.py, on units of several drawings, and judged by the program diagnose_samples
(DIAGNOSE_SAMPLES, or --program). Prints what was not as it should be, the counts, and the processor time of a diagnosis. Exit
status: 0 at least --named of the mistakes were named, none of the others was taken for none, and at most --false-alarms
healthy sessions had one named.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import zlib

import numpy as np

from wired_laboratory import Noise, actuator_yaml, drawing, made, samples_yaml, session
from further_mistakes import FURTHER_LEVEL_1, FURTHER_LEVEL_2
from mistakes import EVERYTHING, LEVEL_1, is_named
from sensor_mistakes import SENSORS_LEVEL_1, SENSORS_LEVEL_2

ALL_MISTAKES = {**EVERYTHING, **FURTHER_LEVEL_1, **FURTHER_LEVEL_2, **SENSORS_LEVEL_1, **SENSORS_LEVEL_2}

# With the numbers of orientations and torques of a session.
DRAWINGS = {
    "8 poles, 24 coils": (drawing(), {}),
    "4 poles, 12 coils": (drawing(4, (6, 6), coil_elevation=0.2), {"torques": 110}),
    "6 poles, 9 coils": (drawing(6, (9,), coil_elevation=0.15), {"torques": 100}),
    "10 poles, 16 coils": (drawing(10, (8, 8), coil_elevation=0.25), {"torques": 130, "tracked": True}),
    "12 poles, 18 coils": (drawing(12, (9, 9), pole_elevation=0.08, coil_elevation=0.2), {"torques": 140}),
    "other axes": (drawing(axes=[[0, 0, 1], [0, 1, 0], [1, 0, 0]]), {"orientations": 30}),
    "askew axes": (drawing(axes=[[1, 0, 0], [0.3, 0.9, 0.1], [0.1, -0.2, 1]]), {"orientations": 30}),
    "joints only": (drawing(0, ()), {"orientations": 25, "torques": 0}),
}
BATCH = 40  # sessions given to the program at once


def sensible(mistake, machine):
    """Whether a drawing can have a mistake that the samples tell apart from none."""
    if mistake.startswith("tilt sensor") and abs(machine.axes[0] @ machine.axes[1]) > 0.1:
        return False  # such a sensor measures about axes at right angles
    if not len(machine.coils):
        return mistake in LEVEL_1 or mistake in FURTHER_LEVEL_1 or mistake in SENSORS_LEVEL_1
    return not (mistake == "layers exchanged" and len(machine.coils) % 2)


def make(folder, name, drawing_name, mistake, seed):
    """Files of one session; its two paths."""
    machine, options = DRAWINGS[drawing_name]
    generator = np.random.default_rng([seed, zlib.crc32(f"{drawing_name}/{mistake}".encode())])
    noise = Noise(orientation=generator.choice([2e-4, 5e-4, 1e-3]), torque=generator.choice([2e-4, 5e-4]))
    unit = made(machine, generator)
    samples = session(unit, generator, noise=noise, tilt=generator.uniform(0.35, 0.6), **options)
    if mistake is not None:
        ALL_MISTAKES[mistake][0](samples, unit)
    paths = (folder / f"{name}_actuator.yaml", folder / f"{name}_samples.yaml")
    paths[0].write_text(actuator_yaml(machine))
    paths[1].write_text(samples_yaml(samples, noise))
    return paths


def judge(program, cases):
    """Seconds of processor time, and causes named, of each of (drawing, mistake, seed)."""
    named = []
    with tempfile.TemporaryDirectory() as folder:
        arguments = []
        for n, case in enumerate(cases):
            arguments += make(pathlib.Path(folder), n, *case)
        run = subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    for line in run.stdout.decode().splitlines():
        seconds, *causes = line.split()
        named.append((float(seconds), causes))
    return named


def expected(mistake, machine):
    """Causes with the number of the last coil in place of the word."""

    def numbered(wanted):
        if isinstance(wanted, tuple):
            return tuple(numbered(cause) for cause in wanted)
        return wanted.replace("last", str(len(machine.coils)))

    return [numbered(wanted) for wanted in ALL_MISTAKES[mistake][1]]


class Tally:
    """What became of sessions with mistakes and of healthy ones."""

    def __init__(self):
        self.count = self.missed = self.silent = 0
        self.healthy = self.false_alarms = 0
        self.seconds = []

    def add(self, case, seconds, causes):
        """The line of a session that was not judged as it should be, or nothing."""
        name, mistake, seed = case
        self.seconds.append(seconds)
        if mistake is None:
            self.healthy += 1
            self.false_alarms += causes != ["none"]
            return f"{name}, healthy, seed {seed}: {' '.join(causes)}" if causes != ["none"] else None
        self.count += 1
        if is_named(expected(mistake, DRAWINGS[name][0]), causes):
            return None
        self.missed += 1
        self.silent += causes == ["none"]
        return f"{name}, {mistake}, seed {seed}: {' '.join(causes)}"

    def named(self):
        return 1.0 - self.missed / max(1, self.count)

    def __str__(self):
        return (
            f"{self.count - self.missed} of {self.count} mistakes named ({100 * self.named():.2f} %), {self.silent} silent; "
            f"{self.false_alarms} false alarms in {self.healthy} healthy sessions; {np.median(self.seconds):.3f} s each "
            f"(median), {np.quantile(self.seconds, 0.99):.3f} s at most in 99 % of them"
        )


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--program", default=os.environ.get("DIAGNOSE_SAMPLES"))
    options.add_argument("--seeds", type=int, default=20, help="units of each drawing with each mistake")
    options.add_argument("--healthy", type=int, default=500, help="healthy sessions of each drawing")
    options.add_argument("--drawings", nargs="*", default=list(DRAWINGS))
    options.add_argument("--mistakes", nargs="*", default=list(ALL_MISTAKES))
    options.add_argument("--named", type=float, default=0.99, help="least share of mistakes that are named")
    options.add_argument("--silent", type=int, default=0, help="most mistakes that are taken for none")
    options.add_argument("--false-alarms", type=int, default=0, help="most healthy sessions with a mistake named")
    chosen = options.parse_args()

    cases = [
        (name, mistake, seed)
        for name in chosen.drawings
        for mistake in chosen.mistakes
        if sensible(mistake, DRAWINGS[name][0])
        for seed in range(chosen.seeds)
    ]
    cases += [(name, None, seed) for name in chosen.drawings for seed in range(chosen.healthy)]
    tally = Tally()
    for first in range(0, len(cases), BATCH):
        batch = cases[first : first + BATCH]
        for case, judged in zip(batch, judge(chosen.program, batch)):
            line = tally.add(case, *judged)
            if line:
                print(line, flush=True)
    print(tally)
    is_good = tally.named() >= chosen.named and tally.silent <= chosen.silent
    return 0 if is_good and tally.false_alarms <= chosen.false_alarms else 1


if __name__ == "__main__":
    sys.exit(main())
