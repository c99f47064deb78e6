#!/usr/bin/python3
"""What calibrate_bag calls mistakes of wiring in a motion that the package did not simulate, by `--apply-diagnosis`, too."""

import os
import tempfile
import unittest
from unittest import mock

import free_motion
import numpy as np
from motion_bag import write_bag
from motion_cases import NOMINAL
from recorded_motion import RecordedMotion, read_yaml, write_yaml


class Diagnosed(RecordedMotion):
    SECONDS = 7.0
    BEGIN, END = 0.0, 5.0  # [s] of the motion that is recorded

    def diagnosed(self, change, stream="currents", status=1, description=NOMINAL, **streams):
        """What is said of a part of the motion with another stream recorded, and the coils of the description that corrects
        it, where there is one."""
        recording = {
            name: [(t, value) for t, value in zip(*one) if self.BEGIN <= t < self.END] for name, one in self.record(**streams).items()
        }
        recording = {name: tuple(zip(*stream)) for name, stream in recording.items()}
        stamps, values = recording[stream]
        recording[stream] = stamps, change(np.array(values))
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "wired.bag")
            write_bag(bag, recording, len(self.unit.coils))
            corrected = os.path.join(folder, "corrected.yaml")
            result = self.calibrate_bags(folder, "motion", [bag], "--apply-diagnosis", corrected, actuator=description)
            coils = None
            if os.path.exists(corrected):
                self.corrected = read_yaml(corrected)["actuator"]
                coils = [[coil["polar"], coil["azimuth"]] for coil in self.corrected["coils"]]
        self.assertEqual(result.returncode, status, result.stdout)
        self.said = result.stdout
        return coils, [line.split()[1].rstrip(":") for line in result.stdout.splitlines() if line.startswith("diagnosis:")]

    def turned_poles(self, folder, poles):
        """Path of the drawing with other polarities of these poles."""
        path = os.path.join(folder, "turned.yaml")
        description = read_yaml(NOMINAL)
        for pole in poles:
            description["actuator"]["poles"][pole]["polarity"] *= -1
        write_yaml(path, description)
        return path


class Wiring(Diagnosed):
    def test_names_a_coil_that_counts_the_wrong_way_round(self):
        def turned(currents):
            currents[:, 4] *= -1.0
            return currents

        coils, causes = self.diagnosed(turned)
        self.assertEqual(causes, ["coil_sign:5"])
        self.assertIsNone(coils)

    def test_names_a_circle_of_coils_beside_others_that_are_turned(self):
        def mistaken(currents):
            currents[:, [2, 8, 16]] = currents[:, [8, 16, 2]]
            currents[:, [0, 2, 20]] *= -1.0
            return currents

        _, causes = self.diagnosed(mistaken)
        # What is recorded of coil 3 flows in coil 9.
        self.assertEqual(causes, ["coil_circle:3:9:17", "coil_sign:1", "coil_sign:9", "coil_sign:21"])

    def test_names_a_pole_that_is_turned_beside_coils_that_are_exchanged(self):
        def mistaken(currents):
            currents[:, [2, 8]] = currents[:, [8, 2]]
            return currents

        with tempfile.TemporaryDirectory() as folder:
            _, causes = self.diagnosed(mistaken, description=self.turned_poles(folder, [3]))
        self.assertEqual(causes, ["coil_swap:3:9", "pole_polarity:4"])
        polarities = [pole["polarity"] for pole in self.corrected["poles"]]
        self.assertEqual(polarities, [pole["polarity"] for pole in read_yaml(NOMINAL)["actuator"]["poles"]])

    def test_names_a_sign_of_all_beside_coils_that_are_exchanged(self):
        def mistaken(currents):
            currents[:, [2, 10]] = currents[:, [10, 2]]
            return -currents

        _, causes = self.diagnosed(mistaken)
        self.assertEqual(causes, ["coil_swap:3:11", "current_sign"])

    def test_names_a_shift_beside_coils_that_are_exchanged(self):
        def mistaken(currents):
            currents[:, [2, 10]] = currents[:, [10, 2]]
            return np.roll(currents, -1, axis=1)  # what is recorded of coil 1 flows in coil 2

        coils, causes = self.diagnosed(mistaken)
        self.assertEqual(causes, ["coil_shift", "coil_swap:3:11"])
        expected = self.unit.coils.copy()
        expected[[2, 10]] = expected[[10, 2]]
        apart = (np.array(coils) - np.roll(expected, -1, axis=0) + np.pi) % (2.0 * np.pi) - np.pi
        np.testing.assert_allclose(apart, 0.0, atol=1e-9)

    def test_names_layers_that_are_exchanged(self):
        coils, causes = self.diagnosed(lambda currents: np.roll(currents, 12, axis=1))
        self.assertEqual(causes, ["coil_shift"])
        apart = (np.array(coils) - np.roll(self.unit.coils, 12, axis=0) + np.pi) % (2.0 * np.pi) - np.pi
        np.testing.assert_allclose(apart, 0.0, atol=1e-9)

    def test_names_coils_that_are_exchanged(self):
        def exchanged(currents):
            currents[:, [2, 15]] = currents[:, [15, 2]]
            return currents

        coils, causes = self.diagnosed(exchanged)
        self.assertEqual(causes, ["coil_swap:3:16"])
        expected = self.unit.coils.copy()
        expected[[2, 15]] = expected[[15, 2]]
        apart = (np.array(coils) - expected + np.pi) % (2.0 * np.pi) - np.pi
        np.testing.assert_allclose(apart, 0.0, atol=1e-9)

    def test_names_currents_in_milliamperes(self):
        self.assertEqual(self.diagnosed(lambda currents: 1e3 * currents)[1], ["current_unit"])

    def test_tells_that_currents_are_ten_times_too_large(self):
        self.assertEqual(self.diagnosed(lambda currents: 10.0 * currents, status=0)[1], [])
        self.assertIn("moments of inertia are 10.5 times those of the rotor that a motion begins with", self.said)
        self.assertIn("the torques of the recorded currents are 10.5 times the real ones", self.said)

    def test_names_a_joint_that_counts_the_wrong_way_round(self):
        def turned(joints):
            joints[:, 2] *= -1.0
            return joints

        self.assertEqual(self.diagnosed(turned, "joints")[1], ["joint_sign:3"])
        np.testing.assert_allclose(self.corrected["joints"][2]["axis"], [0.0, 0.0, -1.0], atol=1e-12)

    def test_names_an_index_and_corrects_what_a_description_can_hold(self):
        def turned(joints):
            joints[:, 0] += 0.5
            return joints

        self.assertEqual(self.diagnosed(turned, "joints")[1][0], "joint_index:1")
        self.assertAlmostEqual(self.corrected["joints"][0]["offset"], -0.5, delta=0.03)

    def test_a_late_tracker_is_no_mistake_of_wiring(self):
        def reversed_coil(currents):
            currents[:, 4] *= -1.0
            return currents

        late = self.record(tracker_delay=0.055)
        with mock.patch.object(self, "record", lambda: late):
            self.assertEqual(self.diagnosed(reversed_coil)[1], ["coil_sign:5"])


class TwoTurnedPoles(Diagnosed):
    """Of another motion, a part which the best order of the coils does not explain, at a delay of the currents that is wrong."""

    SEED = 1
    MACHINE = free_motion.Machine()
    BEGIN, END = 4.0, 7.0

    def test_are_named_beside_late_currents(self):
        with tempfile.TemporaryDirectory() as folder:
            turned = self.turned_poles(folder, [0, 6])
            _, causes = self.diagnosed(lambda currents: currents, description=turned, current_delay=0.05)
        self.assertEqual(sorted(causes), ["pole_polarity:1", "pole_polarity:7"])


if __name__ == "__main__":
    unittest.main()
