#!/usr/bin/python3
"""Are mistakes named, and is none named where there is none? diagnosis_trials.py [options]

Sessions are made by wired_laboratory.py, on units of several drawings, and judged by the program diagnose_samples
(DIAGNOSE_SAMPLES, or --program). Prints what was not as it should be, and the counts. Exit status: 0 at least --named
of the mistakes were named and at most --false-alarms healthy sessions were not.
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
from mistakes import EVERYTHING, LEVEL_1, is_named

# With the numbers of orientations and torques of a session.
DRAWINGS = {
    "8 poles, 24 coils": (drawing(), {}),
    "4 poles, 12 coils": (drawing(4, (6, 6), coil_elevation=0.2), {"torques": 110}),
    "6 poles, 9 coils": (drawing(6, (9,), coil_elevation=0.15), {"torques": 100}),
    "10 poles, 16 coils": (drawing(10, (8, 8), coil_elevation=0.25), {"torques": 130, "tracked": True}),
    "other axes": (drawing(axes=[[0, 0, 1], [0, 1, 0], [1, 0, 0]]), {"orientations": 30}),
    "joints only": (drawing(0, ()), {"orientations": 25, "torques": 0}),
}
BATCH = 40  # sessions given to the program at once


def sensible(mistake, machine):
    """Whether a drawing can have a mistake that the samples tell apart from none."""
    if not len(machine.coils):
        return mistake in LEVEL_1
    return not (mistake == "layers exchanged" and len(machine.coils) % 2)


def make(folder, name, drawing_name, mistake, seed):
    """Files of one session; its two paths."""
    machine, options = DRAWINGS[drawing_name]
    generator = np.random.default_rng([seed, zlib.crc32(f"{drawing_name}/{mistake}".encode())])
    noise = Noise(orientation=generator.choice([2e-4, 5e-4, 1e-3]), torque=generator.choice([2e-4, 5e-4]))
    unit = made(machine, generator)
    samples = session(unit, generator, noise=noise, tilt=generator.uniform(0.35, 0.6), **options)
    if mistake is not None:
        EVERYTHING[mistake][0](samples, unit)
    paths = (folder / f"{name}_actuator.yaml", folder / f"{name}_samples.yaml")
    paths[0].write_text(actuator_yaml(machine))
    paths[1].write_text(samples_yaml(samples, noise))
    return paths


def judge(program, cases):
    """Causes named in each of (drawing, mistake, seed)."""
    named = []
    for first in range(0, len(cases), BATCH):
        with tempfile.TemporaryDirectory() as folder:
            arguments = []
            for n, case in enumerate(cases[first : first + BATCH]):
                arguments += make(pathlib.Path(folder), n, *case)
            run = subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        named += [line.split() for line in run.stdout.decode().splitlines()]
    return named


def expected(mistake):
    return EVERYTHING[mistake][1]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--program", default=os.environ.get("DIAGNOSE_SAMPLES"))
    options.add_argument("--seeds", type=int, default=20, help="units of each drawing with each mistake")
    options.add_argument("--healthy", type=int, default=500, help="healthy sessions of each drawing")
    options.add_argument("--drawings", nargs="*", default=list(DRAWINGS))
    options.add_argument("--mistakes", nargs="*", default=list(EVERYTHING))
    options.add_argument("--named", type=float, default=0.99, help="least share of mistakes that are named")
    options.add_argument("--false-alarms", type=int, default=0, help="most healthy sessions with a mistake named")
    chosen = options.parse_args()

    mistaken = [
        (name, mistake, seed)
        for name in chosen.drawings
        for mistake in chosen.mistakes
        if sensible(mistake, DRAWINGS[name][0])
        for seed in range(chosen.seeds)
    ]
    missed = 0
    silent = 0
    for (name, mistake, seed), causes in zip(mistaken, judge(chosen.program, mistaken)):
        if not is_named(expected(mistake), causes):
            missed += 1
            silent += causes == ["none"]
            print(f"{name}, {mistake}, seed {seed}: {' '.join(causes)}", flush=True)
    healthy = [(name, None, seed) for name in chosen.drawings for seed in range(chosen.healthy)]
    false_alarms = 0
    for (name, _, seed), causes in zip(healthy, judge(chosen.program, healthy)):
        if causes != ["none"]:
            false_alarms += 1
            print(f"{name}, healthy, seed {seed}: {' '.join(causes)}", flush=True)
    named = 1 - missed / max(1, len(mistaken))
    print(f"{len(mistaken) - missed} of {len(mistaken)} mistakes named ({100 * named:.2f} %), {silent} silent; "
          f"{false_alarms} false alarms in {len(healthy)} healthy sessions")
    return 0 if named >= chosen.named and false_alarms <= chosen.false_alarms else 1


if __name__ == "__main__":
    sys.exit(main())
