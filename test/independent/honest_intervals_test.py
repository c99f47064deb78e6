#!/usr/bin/python3
"""Intervals hold what they promise where sessions and dwells share errors: judged by an independent laboratory."""

import os
import unittest

import cases
import coverage_study
import laboratory
import numpy as np

SESSIONS = 10


class HonestIntervals(unittest.TestCase):
    def check(self, name, least=0.90):
        result = coverage_study.study(name, SESSIONS, with_bound=False)
        self.assertEqual(result.refined, SESSIONS)
        # Few sessions, and errors that many parameters share: far from 95 % only where something is wrong.
        self.assertGreater(result.coverage, least)
        self.assertLess(result.coverage, 0.995)

    def test_registrations(self):
        self.check("registrations", least=0.80)

    def test_reading_of_the_joints_shared_in_a_dwell(self):
        self.check("joint_1")

    def test_encoder_of_twelve_bits(self):
        self.check("encoder_12_bit", least=0.85)

    def test_torque_without_current_shared_in_a_dwell(self):
        self.check("bias")

    @unittest.skipUnless(os.environ.get("DENSE_BOUND"), "the dense bound takes a minute: set DENSE_BOUND")
    def test_stated_uncertainty_is_the_bound_with_all_of_them(self):
        unit = laboratory.paper_unit()
        sensors = laboratory.Laboratory(joint=3e-4, zero_current=6e-4, registration=(1e-3, 1e-3, 1e-3))
        rng = np.random.default_rng(3)
        poses = laboratory.random_poses(14, 0.5, rng)
        errors = rng.uniform(-0.02, 0.02, unit.size())
        dwells, _ = laboratory.measured_session(unit, errors, sensors, poses, 12, rng)
        (outcome,) = cases.calibrate(
            unit, [(sensors, dwells, 0)], cases.registration_config(sensors.registration)
        )
        self.assertTrue(outcome.refined(), outcome.reason)
        limits = np.sqrt(np.diag(laboratory.bound(unit, errors, sensors, dwells)))
        seen = outcome.identified & (limits < 0.01)
        self.assertGreater(seen.sum(), 60)
        np.testing.assert_allclose(outcome.stddevs[seen], limits[seen], rtol=0.05)

    def test_registrations_that_are_not_stated_count_as_exact_and_are_told(self):
        unit, sensors = laboratory.paper_unit(), laboratory.Laboratory()
        poses = laboratory.random_poses(30, 0.5, np.random.default_rng(5))
        errors, dwells = coverage_study.sessions_of(unit, sensors, poses, 1, 7)[0]
        del errors
        stated, unstated = (
            cases.calibrate(unit, [(sensors, dwells, 5)], cases.registration_config(registration))[0]
            for registration in ((0.0, 0.0, 0.0), None)
        )
        self.assertEqual(stated.grade, "good", stated.reason)
        self.assertEqual(unstated.grade, "usable", unstated.reason)
        self.assertIn("relative to the registrations", unstated.reason)
        np.testing.assert_array_equal(stated.values, unstated.values)


if __name__ == "__main__":
    unittest.main()
