#!/usr/bin/python3
"""The module for Python says what predict says, and its currents make the torque that was asked for."""

import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import warnings
from unittest import mock

import yaml
from spherical_actuator_calibration.calibrated_actuator import CalibratedActuator

PROGRAMS = os.environ["PROGRAMS"]
SOURCE = os.environ["SOURCE"]
NOMINAL = os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml")
PATIENCE = 30.0  # [s]
JOINTS, TORQUE = [0.1, -0.2, 0.7], [0.05, -0.03, 0.04]


def opened(description):
    return CalibratedActuator(description, os.path.join(PROGRAMS, "actuator_model"))


class Asked(unittest.TestCase):
    def test_the_same_as_predict(self):
        with tempfile.TemporaryDirectory() as folder, opened(NOMINAL) as actuator:
            currents = [0.01 * coil for coil in range(actuator.coils)]
            paths = {name: os.path.join(folder, name) for name in ("joints", "currents", "output")}
            for name, row in (("joints", JOINTS), ("currents", currents)):
                with open(paths[name], "w", encoding="utf-8") as file:
                    file.write(",".join(map(repr, row)) + "\n")
            options = [word for name, path in paths.items() for word in (f"--{name}", path)]
            subprocess.run(
                [os.path.join(PROGRAMS, "predict"), "--actuator", NOMINAL, *options], check=True, stdout=subprocess.DEVNULL
            )
            with open(paths["output"], encoding="utf-8") as file:
                expected = [float(word) for word in next(csv.reader(file))]
            pose, made = actuator.orientation(JOINTS), actuator.torque(JOINTS, currents)
            self.assertEqual([*pose.quaternion_xyzw, pose.stddev, *made.torque, made.stddev], expected)
            self.assertFalse(actuator.has_uncertainty)

    def test_what_is_a_drawing(self):
        with open(NOMINAL, encoding="utf-8") as file:
            described = yaml.safe_load(file)
        angles = {"joints": ("offset", "axis_u", "axis_v"), "poles": ("polar", "azimuth"), "coils": ("polar", "azimuth")}
        made = {"date": "2026-11-28T12:00:00Z", "revision": 1, "software": "test", "source": [], "cycles": [], "unidentified": []}
        described["actuator"]["calibration"] = made
        for group, known in angles.items():
            for axis in described["actuator"][group]:
                axis["stddev"] = dict.fromkeys(known, 1e-4)
        self.assertFalse(self.is_as_drawn(described))
        del described["actuator"]["coils"][7]["stddev"]["azimuth"]
        self.assertTrue(self.is_as_drawn(described))
        with opened(NOMINAL) as actuator:
            self.assertTrue(actuator.is_as_drawn)

    @staticmethod
    def is_as_drawn(described):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "calibrated.yaml")
            with open(path, "w", encoding="utf-8") as file:
                yaml.safe_dump(described, file)
            with opened(path) as actuator:
                return actuator.is_as_drawn

    def test_a_description_that_was_contradicted_is_told(self):
        with open(NOMINAL, encoding="utf-8") as file:
            described = yaml.safe_load(file)
        made = {"date": "2026-11-28T12:00:00Z", "revision": 1, "software": "test", "source": [], "cycles": [], "unidentified": []}
        for is_contradicted in (True, False):
            made["validation"] = {"samples": 3, **({"contradicted": True} if is_contradicted else {})}
            described["actuator"]["calibration"] = made
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "calibrated.yaml")
                with open(path, "w", encoding="utf-8") as file:
                    yaml.safe_dump(described, file)
                with warnings.catch_warnings(record=True) as told:
                    warnings.simplefilter("always")
                    with opened(path) as actuator:
                        self.assertEqual(actuator.is_contradicted, is_contradicted)
            self.assertEqual([str(one.message) for one in told], [f"{path} was contradicted by what was held out: do not use it, calibrate anew."] * is_contradicted)

    def test_currents_make_the_torque_within_their_limit(self):
        with opened(NOMINAL) as actuator:
            found = actuator.currents(TORQUE, JOINTS)
            self.assertEqual((found.outcome, len(found.currents), len(found.stddevs)), ("reached", 24, 24))
            for wanted, made in zip(TORQUE, actuator.torque(JOINTS, found.currents).torque):
                self.assertAlmostEqual(wanted, made, 12)
            limited = actuator.currents(TORQUE, JOINTS, limit=0.01)
            self.assertEqual(limited.outcome, "limited")
            self.assertLessEqual(max(map(abs, limited.currents)), 0.01 + 1e-12)

    def test_what_is_wrong_is_told_and_the_next_question_answered(self):
        with opened(NOMINAL) as actuator:
            with self.assertRaisesRegex(ValueError, "5 numbers where 27 belong"):
                actuator.torque(JOINTS, [0.0, 0.0])
            with self.assertRaisesRegex(ValueError, "not finite|is no number"):
                actuator.orientation([float("nan"), 0.0, 0.0])
            self.assertAlmostEqual(sum(q * q for q in actuator.orientation(JOINTS).quaternion_xyzw), 1.0, 12)
        with self.assertRaisesRegex(ValueError, "no_such.yaml"):
            opened("no_such.yaml")


def children(process):
    """Numbers of the processes that it started and has not reaped."""
    return pathlib.Path(f"/proc/{process}/task/{process}/children").read_text(encoding="utf-8").split()


class Interrupted(unittest.TestCase):
    # In a session of its own, as that of a terminal, whose Ctrl-C reaches all of its foreground.
    PROGRAM = (
        "import signal, sys\n"
        "from spherical_actuator_calibration.calibrated_actuator import CalibratedActuator\n"
        "with CalibratedActuator(*sys.argv[1:]) as actuator:\n"
        "    try:\n"
        "        print('ready', flush=True)\n"
        "        signal.pause()\n"
        "    except KeyboardInterrupt:\n"
        "        print(actuator.currents([0.05, -0.03, 0.04], [0.1, -0.2, 0.7]).outcome)\n"
    )

    def started(self):
        command = [sys.executable, "-c", self.PROGRAM, NOMINAL, os.path.join(PROGRAMS, "actuator_model")]
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), "ready\n")
        return process

    def test_who_catches_the_signal_goes_on_asking(self):
        process = self.started()
        os.killpg(process.pid, signal.SIGINT)
        out, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual((out, errors, process.returncode), ("reached\n", "", 0))

    def test_the_program_does_not_outlive_who_is_killed(self):
        process = self.started()
        (child,) = children(process.pid)
        process.kill()
        until = time.monotonic() + PATIENCE
        while os.path.exists(f"/proc/{child}/exe") and time.monotonic() < until:
            time.sleep(0.01)
        self.assertFalse(os.path.exists(f"/proc/{child}/exe"))

    def test_where_the_program_is_dead_every_question_says_so(self):
        before = children(os.getpid())
        with opened(NOMINAL) as actuator:
            (child,) = set(children(os.getpid())) - set(before)
            os.kill(int(child), signal.SIGKILL)
            for _ in range(3):
                with self.assertRaisesRegex(RuntimeError, "actuator_model has ended"):
                    actuator.currents(TORQUE, JOINTS)
        with self.assertRaisesRegex(RuntimeError, "actuator_model has ended"):
            actuator.orientation(JOINTS)
        self.assertEqual(children(os.getpid()), before)

    def test_no_answer_is_taken_for_that_to_another_question(self):
        with opened(NOMINAL) as actuator:
            with mock.patch.object(actuator, "_process", wraps=actuator._process) as process:  # pylint: disable=protected-access
                process.stdin.closed = False
                process.stdout.readline.side_effect = KeyboardInterrupt
                with self.assertRaises(KeyboardInterrupt):
                    actuator.torque(JOINTS, [0.0] * actuator.coils)
            with self.assertRaisesRegex(RuntimeError, "actuator_model has ended"):
                actuator.orientation(JOINTS)


if __name__ == "__main__":
    unittest.main()
