#!/usr/bin/python3
"""Wrong laboratories never end in success: data of an independent laboratory with one mistake each."""

import dataclasses
import os
import tempfile
import unittest

import cases
import laboratory
import numpy as np

QUARTER = laboratory.rotation(np.array([0.0, 0.0, np.pi / 2.0]))
ABOUT_X = laboratory.rotation(np.array([np.pi / 2.0, 0.0, 0.0]))
COIL = 2  # from 0
EXACT = cases.registration_config((0.0, 0.0, 0.0))


class NoWrongSuccess(unittest.TestCase):
    """20 poses with an orientation and eight torques each; nothing held out, which would tell by itself."""

    def setUp(self):
        self.unit = laboratory.paper_unit()
        self.sensors = laboratory.Laboratory(joint=2e-5)
        rng = np.random.default_rng(11)
        self.poses = laboratory.random_poses(20, 0.5, rng)
        self.errors = rng.uniform(-0.02, 0.02, self.unit.size())
        self.rng = rng

    def session(self, unit=None):
        dwells, _ = laboratory.measured_session(
            unit or self.unit, self.errors, self.sensors, self.poses, 8, self.rng
        )
        return dwells

    def outcome(self, dwells):
        (outcome,) = cases.calibrate(self.unit, [(self.sensors, dwells, 0)], EXACT)
        return outcome

    def check_refused(self, dwells):
        outcome = self.outcome(dwells)
        self.assertIn(outcome.grade, ("failed", "contradicted"), outcome.reason)
        self.assertFalse(outcome.refined(), outcome.cycles)
        return outcome

    def turn_torques(self, dwells, C):
        for dwell in dwells:
            dwell.torques = [(current, C @ torque) for current, torque in dwell.torques]
        return dwells

    def test_a_sound_session_is_taken(self):
        outcome = self.outcome(self.session())
        self.assertTrue(outcome.refined(), outcome.cycles)
        self.assertEqual(outcome.grade, "not_validated", outcome.reason)

    def test_torque_frame_turned_by_90_degrees(self):
        for C in (QUARTER, ABOUT_X):
            self.check_refused(self.turn_torques(self.session(), C))

    def test_torque_frame_turned_by_3_degrees_and_few_orientations(self):
        C = laboratory.rotation(np.array([0.0, 0.0, np.radians(3.0)]))
        for poses, torques in ((5, 12), (4, 16)):
            self.poses = laboratory.random_poses(poses, 0.5, self.rng)
            dwells, _ = laboratory.measured_session(
                self.unit, self.errors, self.sensors, self.poses, torques, self.rng
            )
            self.check_refused(self.turn_torques(dwells, C))

    def test_marker_turned_by_90_degrees(self):
        for C in (QUARTER, ABOUT_X):
            dwells = self.session()
            for dwell in dwells:
                dwell.orientation = dwell.orientation @ C
            self.check_refused(dwells)

    def test_orientation_inverted(self):
        dwells = self.session()
        for dwell in dwells:
            dwell.orientation = dwell.orientation.T
        self.check_refused(dwells)

    def test_polarity_of_a_pole(self):
        polarity = self.unit.polarity.copy()
        polarity[2] = -polarity[2]
        self.check_refused(self.session(dataclasses.replace(self.unit, polarity=polarity)))

    def test_torque_frame_half_a_degree_off_where_it_is_stated_exact(self):
        C = laboratory.rotation(np.array([0.5, 0.5, 0.5]) / np.sqrt(0.75) * 0.5 * laboratory.DEGREE)
        self.check_refused(self.turn_torques(self.session(), C))

    def test_harmonic_of_an_encoder(self):
        dwells = self.session()
        for dwell in dwells:
            dwell.reading = dwell.reading + np.array([0.0, 0.0, 1e-3 * np.sin(dwell.reading[2] + 0.4)])
        outcome = self.outcome(dwells)
        self.assertNotIn(outcome.grade, ("good", "usable"), outcome.reason)
        self.assertFalse(outcome.refined(), outcome.cycles)

    def test_coil_that_is_turned_around_for_its_last_torques_is_told(self):
        """Fewer than half of them: the result is right, and the coil is not."""
        dwells = self.session()
        places = [(n, k) for n, dwell in enumerate(dwells) for k, (current, _) in enumerate(dwell.torques) if COIL in current]
        for n, k in places[-((len(places) - 1) // 2) :]:
            current, torque = dwells[n].torques[k]
            dwells[n].torques[k] = (current, -torque)
        outcome = self.outcome(dwells)
        self.assertTrue(outcome.refined(), outcome.cycles)
        self.assertIn(f"torques of coil {COIL + 1} were left out as outliers", outcome.reason)

    def test_an_outlier_among_ten_torques_leaves_a_result_that_counts(self):
        """What a cycle on the way lost to outliers is mended by the refinement, and the last word is of that."""
        dwells = self.session()
        places = [(n, k) for n, dwell in enumerate(dwells) for k in range(len(dwell.torques))]
        coils = [next(iter(dwells[n].torques[k][0])) for n, k in places]
        # A coil that is left with one torque would be ambiguous, and told so.
        spoilt = [place for place, coil in zip(places, coils) if coils.count(coil) >= 6][::6]
        self.assertGreaterEqual(len(spoilt), len(places) // 10)
        for n, k in spoilt:
            current, torque = dwells[n].torques[k]
            dwells[n].torques[k] = (current, torque + self.rng.normal(0.0, 0.1, 3))
        outcome = self.outcome(dwells)
        self.assertTrue(outcome.refined(), outcome.cycles)
        self.assertTrue(outcome.complete, outcome.cycles)
        apart = np.abs(outcome.values - self.unit.values(self.errors)) / outcome.stddevs
        self.assertLess(apart.max(), 6.0)

    def test_offset_of_parallel_joints_is_found_as_their_sum(self):
        """The sum of both offsets is told, their difference is not, and nobody claims it."""
        unit = laboratory.Unit(np.array([[0, 0, 1.0], [0, 0, 1.0], [1.0, 0, 0]]), np.zeros((0, 2)), np.zeros(0), np.zeros((0, 2)))
        sensors = laboratory.Laboratory()
        rng = np.random.default_rng(2)
        errors = np.array([0.02, 0, 0, 0.0, 0, 0, -0.01, 0, 0])
        dwells = [
            laboratory.Dwell(q, laboratory.rotation(rng.normal(0.0, sensors.orientation, 3)) @ unit.orientation(errors, q))
            for q in rng.uniform(-1.0, 1.0, (20, 3))
        ]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "parallel.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(
                    "actuator:\n  name: parallel\n  joints:\n"
                    "    - {name: a, axis: [0, 0, 1], offset: 0.0}\n"
                    "    - {name: b, axis: [0, 0, 1], offset: 0.0}\n"
                    "    - {name: c, axis: [1, 0, 0], offset: 0.0}\n"
                    "  workspace: {tilt_limit: 1.0}\n"
                )
            (outcome,) = cases.calibrate(unit, [(sensors, dwells, 0)], EXACT, actuator=path)
        self.assertTrue(outcome.cycles[0][1], outcome.cycles)
        self.assertAlmostEqual(outcome.values[0] + outcome.values[3], 0.02, delta=5e-4)
        self.assertFalse(outcome.identified[0])
        self.assertFalse(outcome.identified[3])
        self.assertGreater(min(outcome.stddevs[0], outcome.stddevs[3]), 0.015)
        self.assertIn("joint_1/offset", outcome.cycles[0][2])
        self.assertNotEqual(outcome.grade, "good")


if __name__ == "__main__":
    unittest.main()
