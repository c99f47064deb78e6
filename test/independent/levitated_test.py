#!/usr/bin/python3
"""A rotor without joints, 8 poles and 20 coils, and one of 4 poles and 6 coils with joints: both by their descriptions
alone, judged by an independent laboratory."""

import os
import unittest

import cases
import laboratory
import levitated
import levitated_study
import numpy as np

UNITS = 100
X, Y, Z = np.eye(3)
# What is done to the measured orientation, and the cause that must be named. Torques alone contradict it.
TRACKER_MISTAKES = {
    "inverse": (lambda R: R.T, "orientation_inverted"),
    "tracker by 90 degrees": (lambda R: laboratory.rotation(X * np.pi / 2) @ R, "tracker_frame"),
    "tracker by 180 degrees": (lambda R: laboratory.rotation(Z * np.pi) @ R, "tracker_frame"),
    "tracker askew": (lambda R: laboratory.rotation(np.array([0.2, 0.3, -0.25])) @ R, "tracker_frame"),
    "marker by 90 degrees": (lambda R: R @ laboratory.rotation(Z * np.pi / 2), "marker_frame"),
    "marker askew": (lambda R: R @ laboratory.rotation(np.array([0.2, 0.2, 0.2])), "marker_frame"),
}
SMALL = """actuator:
  name: small
  joints:
    - {{name: joint_1, axis: [1, 0, 0], offset: 0.0}}
    - {{name: joint_2, axis: [0, 1, 0], offset: 0.0}}
    - {{name: joint_3, axis: [0, 0, 1], offset: 0.0}}
  poles:
{poles}
  coils:
{coils}
  torque_curve: {{angle_unit: deg, coefficients: {coefficients}, blend_start: 2.0, support: [28.0, 32.0]}}
  workspace: {{tilt_limit: 0.6}}
"""


class Levitated(unittest.TestCase):
    def check(self, name):
        result = levitated_study.study(name, UNITS)
        print(name, result, flush=True)
        self.assertEqual(result.refined, UNITS)
        self.assertLess(result.error_over_bound, 1.05)
        self.assertGreater(result.coverage, 0.94)
        self.assertLess(result.coverage, 0.96)
        self.assertAlmostEqual(result.stated_over_bound, 1.0, delta=0.03)

    def test_errors_are_at_the_bound_of_tracker_and_torques(self):
        self.check("exact")

    def test_a_tracker_whose_errors_prevail(self):
        self.check("coarse_tracker")


class TrackerOfALevitatedRotor(unittest.TestCase):
    def test_mistakes_are_named(self):
        unit, sensors, sessions = levitated.reaction_sphere(), levitated.Laboratory(), []
        for seed, (change, _) in enumerate(TRACKER_MISTAKES.values()):
            rng = np.random.default_rng([seed, 77])
            errors = rng.uniform(-0.03, 0.03, unit.size())
            orientations = levitated.random_orientations(24, 0.6, rng)
            coils = levitated.chosen_coils(unit, orientations, 8, rng)
            session = levitated.measured_session(unit, errors, sensors, orientations, coils, rng)
            session.orientations = np.array([change(R) for R in session.orientations])
            sessions.append(session)
        outcomes = cases.calibrate_written(
            unit.names(),
            sessions,
            lambda path, session: levitated.write_samples(path, unit, sensors, session),
            cases.registration_config((0.0, 0.0, 0.0)),
            levitated_study.SPHERE,
        )
        for (name, (_, cause)), outcome in zip(TRACKER_MISTAKES.items(), outcomes):
            with self.subTest(mistake=name):
                self.assertEqual([named for named, _ in outcome.diagnoses], [cause])


class SmallActuator(unittest.TestCase):
    def test_four_poles_and_six_coils_with_joints(self):
        poles = np.array([[0.0, i * np.pi / 2.0] for i in range(4)])
        coils = np.array([[0.15 * (-1.0) ** j, j * np.pi / 3.0] for j in range(6)])
        unit = laboratory.Unit(np.eye(3), poles, np.array([1.0, -1.0] * 2), coils)
        sensors = laboratory.Laboratory()
        rows = [f"    - {{polar: {p!r}, azimuth: {a!r}, polarity: {int(s)}}}" for (p, a), s in zip(poles.tolist(), unit.polarity)]
        text = SMALL.format(
            poles="\n".join(rows),
            coils="\n".join(f"    - {{polar: {p!r}, azimuth: {a!r}}}" for p, a in coils.tolist()),
            coefficients=list(laboratory.COEFFICIENTS),
        )
        poses = laboratory.random_poses(60, 0.5, np.random.default_rng(5))
        errors, sessions = [], []
        for seed in range(40):
            rng = np.random.default_rng(seed)
            errors.append(rng.uniform(-0.02, 0.02, unit.size()))
            dwells, _ = laboratory.measured_session(unit, errors[-1], sensors, poses, 3, rng)
            sessions.append((sensors, dwells, 0))
        path = os.path.join(os.environ.get("TMPDIR", "/tmp"), f"small_{os.getpid()}.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        try:
            outcomes = cases.calibrate(unit, sessions, cases.registration_config((0.0, 0.0, 0.0)), path)
        finally:
            os.remove(path)
        self.assertTrue(all(outcome.refined() for outcome in outcomes))
        apart = np.array([outcome.values - unit.values(e) for outcome, e in zip(outcomes, errors)])
        held = np.abs(apart) <= 1.96 * np.array([outcome.stddevs for outcome in outcomes])
        self.assertEqual(apart.shape[1], 9 + 8 + 12)
        self.assertGreater(held.mean(), 0.92)
        self.assertLess(held.mean(), 0.98)


if __name__ == "__main__":
    unittest.main()
