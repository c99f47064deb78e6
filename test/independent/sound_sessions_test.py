#!/usr/bin/python3
"""Sound sessions of few poses have no mistake named: drawings with axes, offsets, poles and coils of their own, coils
chosen by the drawing at each pose, so that some reach a pole in hardly any sample, or in none.

The seeds are those of which a diagnosis had named a coil or a pole.
"""

import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

from wired_laboratory import Machine, Measured, Noise, actuator_yaml, direction, made, samples_yaml, small_turn

X, Y, Z = np.eye(3)
NOISES = (Noise(5e-4, 3e-4, 2e-5), Noise(5e-3, 3e-3, 1e-3), Noise(1e-5, 1e-5, 1e-6), Noise(2e-2, 2e-4, 0.0))
CURRENT = 2.0  # [A]
PROGRAM = os.environ.get("DIAGNOSE_SAMPLES", "build/test/diagnose_samples")


def ring(count, elevation, first=0.0):
    return [(elevation, 2.0 * np.pi * i / count + first) for i in range(count)]


def scattered(seed, count):
    """Directions at no smaller angle than 0.3 rad."""
    generator = np.random.default_rng(seed)
    chosen = []
    while len(chosen) < count:
        angles = (generator.uniform(-0.5, 0.5), generator.uniform(-np.pi, np.pi))
        if all(direction(angles) @ direction(other) < np.cos(0.3) for other in chosen):
            chosen.append(angles)
    return chosen


def drawing(poles, polarity, coils, axes, offsets=(0.0, 0.0, 0.0)):
    return Machine(
        axes=np.array([np.array(axis, float) / np.linalg.norm(axis) for axis in axes]),
        offsets=np.array(offsets),
        poles=np.array([direction(angles) for angles in poles]),
        polarity=np.array(polarity),
        coils=np.array([direction(angles) for angles in coils]),
        pole_strength=np.ones(len(poles)),
        coil_strength=np.ones(len(coils)),
        pole_angles=np.array(poles),
        coil_angles=np.array(coils),
    )


DRAWINGS = {
    "turned about z twice": drawing(ring(6, 0.0, 0.2), [1, -1] * 3, ring(8, 0.22) + ring(8, -0.22, 0.3), [Z, Y, Z], (0.3, 0.8, -0.5)),
    "scattered": drawing(
        scattered(1, 7), [1, -1, 1, 1, -1, -1, 1], scattered(2, 13), [[1, 0.2, 0], [0, 1, 0.3], [0.1, -0.2, 1]], (0.1, -0.2, 0.4)
    ),
    "four poles": drawing(ring(4, 0.0), [1, -1, 1, -1], ring(10, 0.15) + ring(3, -0.5), [X, Y, Z]),
    "axes the other way": drawing(ring(8, 0.0), [1, -1] * 4, ring(12, 0.2618) + ring(12, -0.2618), [-X, Y, -Z]),
}
# Drawing, streams of the random numbers, poses and coils at each, tilt, seed.
SESSIONS = (
    ("turned about z twice", 7, 1, 5, 12, 0.5, 306),
    ("turned about z twice", 7, 6, 12, 8, 0.15, 10),
    ("scattered", 9, 1, 5, 12, 0.5, 0),
    ("scattered", 9, 1, 5, 12, 0.5, 6),
    ("scattered", 9, 1, 5, 12, 0.5, 114),
    ("four poles", 8, 1, 5, 12, 0.5, 0),
    ("four poles", 8, 1, 5, 12, 0.5, 6),
    ("four poles", 8, 2, 4, 3, 0.5, 114),
    ("axes the other way", 8, 2, 4, 3, 0.5, 125),
)


def session(machine, generator, poses, coils, tilt, noise, strength):
    unit = made(machine, generator, 0.03, strength)
    unit.offsets = unit.offsets + machine.offsets
    samples = []
    for _ in range(poses):
        q = np.append(generator.uniform(-tilt, tilt, 2), generator.uniform(-np.pi, np.pi))
        R, drawn = unit.orientation(q), machine.orientation(q)
        reading = q + noise.joint * generator.standard_normal(3)
        samples.append(Measured(reading, R @ small_turn(generator, noise.orientation)))
        apart = np.degrees(np.arccos(np.clip(machine.poles @ drawn.T @ machine.coils.T, -1.0, 1.0)))
        for coil in np.argsort(np.abs(apart - 12.0).min(axis=0))[:coils]:
            current = np.zeros(len(machine.coils))
            current[coil] = CURRENT * (1.0 if generator.random() < 0.5 else -1.0)
            torque = unit.torque(R, current) + noise.torque * generator.standard_normal(3)
            samples.append(Measured(reading, None, torque, current))
    return samples


class SoundSessions(unittest.TestCase):
    def test_have_no_mistake_named(self):
        with tempfile.TemporaryDirectory() as folder:
            arguments = []
            for n, (name, stream, kind, poses, coils, tilt, seed) in enumerate(SESSIONS):
                generator = np.random.default_rng([seed, kind, stream])
                noise = NOISES[seed % 4]
                samples = session(DRAWINGS[name], generator, poses, coils, tilt, noise, 0.01 * (seed % 2))
                paths = [pathlib.Path(folder) / f"{what}_{n}.yaml" for what in ("actuator", "samples")]
                paths[0].write_text(actuator_yaml(DRAWINGS[name]))
                paths[1].write_text(samples_yaml(samples, noise))
                arguments += paths
            answer = subprocess.run([PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        for chosen, line in zip(SESSIONS, answer.stdout.decode().splitlines()):
            with self.subTest(session=chosen):
                self.assertEqual(line.split()[1:], ["none"])


if __name__ == "__main__":
    unittest.main()
