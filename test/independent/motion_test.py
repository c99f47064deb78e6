#!/usr/bin/python3
"""Calibration in motion on a free rotor that the package did not simulate: one motion, recorded in several ways."""

import os
import re
import tempfile
import unittest

import free_motion
import laboratory
import numpy as np
from motion_bag import write_bag
from motion_cases import NOMINAL, calibrate
from recorded_motion import RecordedMotion, read_yaml, run, write_yaml

ONCE_IN_A_MILLION = {1: 23.93, 2: 27.63, 3: 30.66, 9: 44.81}  # chi-square of so many values


class Motion(RecordedMotion):
    def check(self, outcome, rms):
        self.assertTrue(outcome.converged and outcome.moves)
        apart, stddevs, identified = outcome.judged(self.unit, self.errors)
        self.assertTrue(identified.all())
        self.assertLess(np.sqrt(np.mean(apart**2)), rms)
        self.assertLess(np.sqrt(np.mean((apart / stddevs) ** 2)), 1.6)
        self.assertGreater(outcome.chi_square, 0.8)
        self.assertLess(outcome.chi_square, 1.25)
        self.assertGreaterEqual(outcome.held_out, 4)
        self.assertGreater(outcome.probability, 1e-3)

    def check_current_delay(self, outcome, expected, largest):
        """Its stated uncertainty has what sampling of steps does to it."""
        value, stddev, _ = outcome.parameters["current_delay"]
        self.assertLess(abs(value - expected), 2.0 * stddev)
        self.assertLess(stddev, largest)

    def test_finds_all_parameters_and_what_else_moves_the_rotor(self):
        outcome = calibrate(self.record(current_delay=-0.04, tracker_delay=0.05))
        self.check(outcome, 1e-4)
        inertia = self.MACHINE.inertia
        self.assertAlmostEqual(outcome.value("rotor_inertia/xx"), inertia[0, 0], delta=2e-6)
        self.assertAlmostEqual(outcome.value("rotor_inertia/xy"), inertia[0, 1], delta=1e-6)
        self.assertAlmostEqual(outcome.value("rotor_unbalance/z"), self.MACHINE.unbalance[2], delta=6e-5)
        self.assertAlmostEqual(outcome.value("viscous_friction"), self.MACHINE.viscous, delta=4e-5)
        self.assertAlmostEqual(outcome.value("coulomb_friction"), self.MACHINE.coulomb, delta=8e-5)
        self.assertAlmostEqual(outcome.value("tracker_delay"), 0.05, delta=2e-5)
        # Currents that step at the instants of the samples and lag seem to be later by h^2 / (12 lag).
        quadrature = 1e-6 / (12.0 * self.MACHINE.lag)
        self.assertAlmostEqual(outcome.value("current_delay"), -0.04 + quadrature, delta=2e-5)
        self.check_current_delay(outcome, -0.04, 6e-5)
        # A hand touched the rotor for a fifth of a second.
        touched = [count for reason, count in outcome.left_out.items() if "something else" in reason]
        self.assertEqual(len(touched), 1)
        self.assertLessEqual(touched[0], 3)

    def test_commands_tell_what_currents_do_between_samples(self):
        for rate, phase, largest in ((1000.0, 0.0, 1e-5), (1000.0, 0.5e-3, 1e-5), (500.0, 0.0, 1e-5), (200.0, 1e-3, 5e-5)):
            outcome = calibrate(
                self.record(current_delay=-0.04, current_rate=rate, joint_rate=rate, current_phase=phase, has_commands=True)
            )
            self.check(outcome, 1.6e-4)
            self.assertAlmostEqual(outcome.response[1], self.MACHINE.lag, delta=5e-5)
            value, stddev, _ = outcome.parameters["current_delay"]
            self.assertAlmostEqual(value, -0.04, delta=2.0 * largest)
            self.assertLess(abs(value + 0.04), 3.0 * stddev)
            if rate > 1.0 / self.MACHINE.step:
                self.assertLess(stddev, largest)

    def test_what_a_driver_has_set_goes_before_what_it_was_asked_for(self):
        recording = self.record(has_commands=True)
        stamps, values = recording["setpoints"] = recording["commands"]
        recording["commands"] = stamps, np.roll(values, 5, axis=0)
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "motion.bag")
            write_bag(bag, recording, len(self.unit.coils))
            report = os.path.join(folder, "report")
            result = self.calibrate_bags(folder, "motion", [bag], "--report", report)
            told = read_yaml(os.path.join(report, "report.yaml"))["calibration_report"]["cycles"][-1]["estimates"]
        (delay,) = [one for one in told if one["name"] == "current_delay"]
        self.assertLess(abs(delay["value"]), 1e-5, result.stdout)
        self.assertLess(delay["stddev"], 1e-5)

    def test_windows_as_they_come_tell_what_all_at_once_do(self):
        for streams in ({"current_delay": -0.02}, {"joint_rate": 200.0, "current_rate": 200.0}):
            outcome = calibrate(self.record(**streams), options=["--live"])
            self.check(outcome, 1.6e-4)
            self.assertGreaterEqual(outcome.live["windows"], 44)
            self.assertLessEqual(outcome.live["left_out"], 3)  # a hand touched the rotor
            self.assertLess(outcome.live["worst"], 0.2)
            self.assertLess(outcome.live["rms"], 0.05)
            self.assertGreater(outcome.live["ratios"][0], 0.95)
            self.assertLess(outcome.live["ratios"][1], 1.05)

    def test_two_hundred_hertz(self):
        outcome = calibrate(self.record(joint_rate=200.0, current_rate=200.0))
        self.check(outcome, 1.6e-4)
        self.check_current_delay(outcome, 0.0, 1.5e-3)

    def test_a_wrong_torque_curve_is_told(self):
        description = read_yaml(NOMINAL)
        curve = description["actuator"]["torque_curve"]
        curve["coefficients"] = [c / 1.01**n for n, c in enumerate(curve["coefficients"])]
        with tempfile.TemporaryDirectory() as folder:
            stretched = os.path.join(folder, "stretched.yaml")
            write_yaml(stretched, description)
            recording = self.record()
            outcome = calibrate(recording, stretched)
            self.assertGreater(outcome.chi_square, 20.0)

    def told_with_chatter(self, **machine):
        """What is said of currents that step like noise with their readings."""
        machine = free_motion.Machine(chatter=0.03, **machine)
        motion = free_motion.simulate(self.unit, self.errors, machine, self.SECONDS, self.SEED)
        streams = free_motion.Streams(joint_rate=200.0, current_rate=200.0)
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "motion.bag")
            write_bag(bag, free_motion.record(self.unit, self.errors, motion, streams, self.SEED), len(self.unit.coils))
            return self.calibrate_bags(folder, "motion", [bag]).stdout

    def test_what_passes_for_noise_of_currents_is_told(self):
        said = self.told_with_chatter(curve_stretch=3e-3)
        self.assertIn("changes too slowly for noise", said)
        self.assertNotIn("grade: good", said)
        said = self.told_with_chatter()
        self.assertIn("held-out windows agree", said)
        self.assertNotIn("too slowly", said)
        self.assertNotIn("fits better with a friction", said)

    def test_frictions_of_another_law_are_told(self):
        for law, machine in (("that grows with the square of the speed", {"drag": 3e-4}), ("about the rotor's axis z", {"spin_viscous": 2e-4})):
            motion = free_motion.simulate(self.unit, self.errors, free_motion.Machine(**machine), self.SECONDS, self.SEED)
            with tempfile.TemporaryDirectory() as folder:
                bag = os.path.join(folder, "motion.bag")
                write_bag(bag, free_motion.record(self.unit, self.errors, motion, free_motion.Streams(), self.SEED), len(self.unit.coils))
                said = self.calibrate_bags(folder, "motion", [bag]).stdout
            found = re.search(r"fits better with a friction (.*), by (\S+) \+- (\S+) N\.m\.s", said)
            self.assertTrue(found, said)
            self.assertIn(law, found[1])
            (true,) = machine.values()
            self.assertLess(abs(float(found[2]) - true), 5.0 * float(found[3]) + 0.05 * true)
            self.assertNotIn("grade: good", said)

    def test_joints_that_are_not_read_at_once_are_told(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "motion.bag")
            write_bag(bag, self.record(joint_skews=(0.0, 5e-5, 1e-4)), len(self.unit.coils))
            said = self.calibrate_bags(folder, "motion", [bag]).stdout
        found = re.search(r"joint 2 by (\S+) \+- (\S+) ms and joint 3 by (\S+) \+- (\S+) ms later", said)
        self.assertTrue(found, said)
        for value, stddev, true in ((found[1], found[2], 0.05), (found[3], found[4], 0.1)):
            self.assertLess(abs(float(value) - true), 4.0 * float(stddev) + 1e-3)
        self.assertIn("grade: usable", said)

    def test_joints_that_are_read_at_once_have_no_skew(self):
        for streams in ({}, {"joint_rate": 200.0, "current_rate": 200.0}, {"joint_skews": (1e-4, 1e-4, 1e-4)}):
            outcome = calibrate(self.record(**streams))
            for value, stddev in (outcome.skew[:2], outcome.skew[2:]):
                self.assertLess(abs(value), 3.5 * stddev)
                self.assertLess(stddev, 1e-5)

    def told(self, recording, nominal=NOMINAL):
        """The error that the model lacks which is surest, of those that chance makes once in a million times, and its
        values."""
        errors = calibrate(recording, nominal).unmodelled
        self.assertGreaterEqual(len(errors), 7)
        sure = {name: square / ONCE_IN_A_MILLION[len(values)] for name, (square, values) in errors.items()}
        surest = max(sure, key=sure.get)
        return (surest, errors[surest][1]) if sure[surest] > 1.0 else (None, None)

    def test_errors_of_sensors_and_clocks_are_told(self):
        sound = self.record()
        self.assertIsNone(self.told(sound)[0])
        stamps, joints = sound["joints"]
        current_stamps, currents = sound["currents"]
        tracker_stamps, R = sound["orientations"]
        share = tracker_stamps[:, None] / self.SECONDS
        turning = joints + 2e-4 * np.sin(joints[:, 2:] + 0.5) * [0.0, 0.0, 1.0]
        scaled = joints * [1.0 + 6e-4, 1.0, 1.0]
        late = current_stamps + 2e-4 * (current_stamps > 0.5 * self.SECONDS)
        for name, change in (
            (("turn", 3), {"joints": (stamps, turning)}),
            (("scale", 1), {"joints": (stamps, scaled)}),
            (("tracker drift", 1), {"orientations": (tracker_stamps, free_motion.rotations(share * [0.0, 3e-4, 0.0]) @ R)}),
            (("current clock", 1), {"currents": (late, currents)}),
            (("tracker clock", 1), {"orientations": (tracker_stamps + 3e-4 * share[:, 0], R)}),
        ):
            with self.subTest(name):
                told, values = self.told({**sound, **change})
                self.assertEqual(told, name)
                if told == ("turn", 3):
                    expected = 2e-4 * np.array([np.cos(0.5), np.sin(0.5)])
                    self.assertLess(np.abs((values[:, 0] - expected) / values[:, 1]).max(), 4.0)

    def test_a_torque_curve_that_is_hardly_wrong_is_told(self):
        description = read_yaml(NOMINAL)
        curve = description["actuator"]["torque_curve"]
        curve["coefficients"] = [c / 1.0006**n for n, c in enumerate(curve["coefficients"])]
        with tempfile.TemporaryDirectory() as folder:
            stretched = os.path.join(folder, "stretched.yaml")
            write_yaml(stretched, description)
            told, values = self.told(self.record(), stretched)
            self.assertEqual(told[0], "curve")
            self.assertLess(abs(values[0, 0] + 6e-4), 4.0 * values[0, 1])
            bag = os.path.join(folder, "motion.bag")
            write_bag(bag, self.record(), len(self.unit.coils))
            said = self.calibrate_bags(folder, "motion", [bag], actuator=stretched).stdout
        self.assertIn("fits better with a torque curve that is wider in angle by -0.06", said)
        self.assertIn("grade: usable", said)

    def test_a_tracker_that_is_worse_about_one_axis_is_sound(self):
        sound = self.record(tracker_stddev=3e-4)
        stamps, R = sound["orientations"]
        noise = np.random.default_rng(self.SEED).normal(size=(len(stamps), 1)) * [0.0, 0.0, 1e-3]
        outcome = calibrate({**sound, "orientations": (stamps, free_motion.rotations(noise) @ R)})
        self.check(outcome, 1.6e-4)
        self.assertEqual(outcome.tracker_colour, 1.0)

    def test_noise_of_the_tracker_that_is_not_white_counts_in_full(self):
        for fade in (0.01, 0.05):
            outcome = calibrate(self.record(tracker_fade=fade))
            self.check(outcome, 1.6e-4)
            kept = np.exp(-1.0 / (fade * 240.0))
            self.assertGreater(outcome.tracker_colour, 0.7 * (1.0 + kept) / (1.0 - kept))
        # A drift is no noise.
        drifting = calibrate(self.record(tracker_fade=2.0))
        self.assertEqual(drifting.tracker_colour, 1.0)
        self.assertLess(drifting.probability, 1e-3)
        self.assertEqual(calibrate(self.record()).tracker_colour, 1.0)

    def test_a_clock_that_jumps_by_little_is_told_and_counted(self):
        sound = self.record()
        outcome = calibrate(sound)
        self.assertLess(outcome.alignment, outcome.alignment_limit)
        stamps, currents = sound["currents"]
        jumping = {**sound, "currents": (stamps + 4e-4 * (stamps > 0.5 * self.SECONDS), currents)}
        outcome = calibrate(jumping)
        self.assertGreater(outcome.alignment, outcome.alignment_limit)
        self.assertLess(outcome.distance(self.unit, self.errors), 1.5)

    def test_one_spoilt_reading_costs_its_window_alone(self):
        recording = self.record()
        stamps, currents = recording["currents"]
        currents = np.array(currents)
        currents[len(currents) // 3, 7] = 65.535
        outcome = calibrate({**recording, "currents": (stamps, currents)})
        self.check(outcome, 1.6e-4)
        self.assertNotIn("no coil carries current", outcome.left_out)
        self.assertLessEqual(sum(outcome.left_out.values()), 4)  # a hand touched the rotor

    def test_readings_at_the_end_of_their_range_are_told(self):
        recording = self.record()
        stamps, currents = recording["currents"]
        currents = np.array(currents)
        most = 0.7 * np.abs(currents[:, 7]).max()
        currents[:, 7] = np.clip(currents[:, 7], -most, most)
        outcome = calibrate({**recording, "currents": (stamps, currents)})
        self.check(outcome, 1.6e-4)
        cut_off = {reason.split(" A,")[0] for reason in outcome.left_out if "end of its sensor" in reason}
        self.assertTrue(cut_off)
        self.assertEqual({part.split(" reads ")[0] for part in cut_off}, {"the current of coil 8"})

    def test_setpoints_at_a_limit_are_sound(self):
        machine = free_motion.Machine(coil_limit=0.4, lag=0.0, push=(6.0, 6.2, (0.0, 0.0, 4e-3)))
        motion = free_motion.simulate(self.unit, self.errors, machine, self.SECONDS, self.SEED)
        self.assertGreater(np.mean(np.abs(motion.setpoint).max(axis=1) == 0.4), 0.2)
        streams = free_motion.Streams(joint_rate=200.0, current_rate=200.0, current_stddev=0.0)
        outcome = calibrate(free_motion.record(self.unit, self.errors, motion, streams, self.SEED))
        self.assertTrue(outcome.converged)
        self.assertEqual([reason for reason in outcome.left_out if "end of its sensor" in reason], [])
        self.assertLessEqual(sum(outcome.left_out.values()), 3)

    def test_a_motion_without_excitation_is_refused(self):
        machine = free_motion.Machine(excitation=1e-6)
        motion = free_motion.simulate(self.unit, self.errors, machine, self.SECONDS, self.SEED)
        recording = free_motion.record(self.unit, self.errors, motion, free_motion.Streams(), self.SEED)
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "held.bag")
            write_bag(bag, recording, len(self.unit.coils))
            result = self.calibrate_bags(folder, "motion", [bag])
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("so that other axes may explain the motion as well: excite the coils", result.stdout)
        self.assertNotIn("diagnosis: ", result.stdout.replace("diagnosis: none", ""))

    def test_calibrate_bag_takes_motion_by_itself(self):
        with tempfile.TemporaryDirectory() as folder:
            bag, output = os.path.join(folder, "motion.bag"), os.path.join(folder, "calibrated.yaml")
            write_bag(bag, self.record(), len(self.unit.coils))
            result = run("calibrate_bag", "--actuator", NOMINAL, "--output", output, bag)
            self.assertEqual(result.returncode, 0, result.stdout)
            self.assertIn("grade: usable", result.stdout)
            self.assertIn("held-out", result.stdout)
            calibrated = read_yaml(output)["actuator"]
            both = self.calibrate_bags(folder, "motion,refine", [bag])
        self.assertEqual(both.returncode, 0, both.stdout)
        self.assertIn("no sample was recorded", both.stdout)
        poles = self.unit.poles + self.errors[9 : 9 + 2 * len(self.unit.poles)].reshape(-1, 2)
        found = np.array([pole["polar"] for pole in calibrated["poles"]])
        np.testing.assert_allclose(found, poles[:, 0], atol=2e-4)

    def dwells_and_motion(self, folder, errors):
        """Bags of both: dwells of a unit with these errors."""
        sensors, rng = laboratory.Laboratory(), np.random.default_rng(self.SEED)
        poses = laboratory.random_poses(16, 0.4, rng)
        dwells, _ = laboratory.measured_session(self.unit, errors, sensors, poses, 9, rng)
        samples, dwell_bag, motion_bag = (os.path.join(folder, name) for name in ("s.yaml", "dwells.bag", "motion.bag"))
        laboratory.write_samples(samples, self.unit, sensors, dwells)
        run("samples_to_bag", "--actuator", NOMINAL, "--samples", samples, "--output", dwell_bag)
        write_bag(motion_bag, self.record(), len(self.unit.coils))
        return dwell_bag, motion_bag

    def errors_and_stddevs(self, folder, cycles, *bags):
        report = os.path.join(folder, cycles)
        result = self.calibrate_bags(folder, cycles, bags, "--report", report, "--no-page")
        self.assertEqual(result.returncode, 0, result.stdout)
        parameters = read_yaml(os.path.join(report, "report.yaml"))["calibration_report"]["parameters"]
        rows = {row["name"]: row for row in parameters}
        rows = [rows[name] for name in self.unit.names()]
        apart = np.array([row["value"] for row in rows]) - self.unit.values(self.errors)
        apart = (apart + np.pi) % (2.0 * np.pi) - np.pi
        return apart, np.array([row["stddev"] for row in rows])

    def test_dwells_and_motion_are_one_calibration(self):
        with tempfile.TemporaryDirectory() as folder:
            dwells, motion = self.dwells_and_motion(folder, self.errors)
            _, by_dwells = self.errors_and_stddevs(folder, "joint,refine", dwells)
            _, by_motion = self.errors_and_stddevs(folder, "motion", motion)
            apart, stddevs = self.errors_and_stddevs(folder, "motion,refine", dwells, motion)
        self.assertTrue((stddevs < 1.001 * np.minimum(by_dwells, by_motion)).all())
        normalised = np.sqrt(np.mean((apart / stddevs) ** 2))
        self.assertGreater(normalised, 0.5)
        self.assertLess(normalised, 1.6)

    def test_dwells_of_another_unit_are_told(self):
        with tempfile.TemporaryDirectory() as folder:
            errors = self.errors.copy()
            errors[9:11] += 2e-3  # of one pole
            bags = self.dwells_and_motion(folder, errors)
            result = self.calibrate_bags(folder, "motion,refine", bags)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("contradict the motion", result.stdout)
        self.assertIn("grade: contradicted", result.stdout)


if __name__ == "__main__":
    unittest.main()
