#!/usr/bin/python3
"""calibrate_by_motion in the emulated laboratory: it ends the motion when all is known as well as wanted, and calibrates."""

import pathlib
import subprocess
import sys
import tempfile

import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, program, wait_for
from controller_client import Controller, description
from emulated_lab import LabCase
from spherical_actuator_calibration.msg import ActuatorParameters, MotionStatus

MOST_ATTEMPTS = 3
FRICTION = 0.02  # [N.m.s] so much that the rotor waits for a computer that is busy with something else
DURATION = 300.0  # [s] of the plan: the motion is to end long before
WANTED = 1e-3  # [rad]


def plan():
    """A slow spin with some tilt, and currents in all coils that differ."""

    def sines(frequencies, amplitudes, shift=0.0):
        phases = [0.7 * n + shift for n in range(len(frequencies))]
        return {"frequencies": frequencies, "amplitudes": amplitudes, "phases": phases}

    tilts = [{"centre": 0.0, **sines([0.31 + 0.1 * k, 0.47], [0.06, 0.06], k)} for k in range(2)]
    spin = {"centre": 0.0, **sines([0.06, 0.25], [2.0, 0.2])}
    limits = {"tilt": 0.24, "rate": 3.0, "error": 0.35}
    limits.update(coil_current=2.0, total_current=10.0, square_current=10.0)
    content = {
        "actuator": description()["name"],
        "duration": DURATION,
        "ramp": 2.0,
        "limits": limits,
        "joints": [*tilts, spin],
        "coils": [sines([1.0 + 0.12 * coil, 3.9 - 0.11 * coil], [0.06, 0.06], coil) for coil in range(24)],
    }
    return yaml.safe_dump({"motion_plan": content})


class CalibrateByMotion(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(released=True, commands=False, seed=4)
        path = pathlib.Path(cls.lab.config) / "lab_emulator.yaml"
        content = yaml.safe_load(path.read_text())
        content["friction"] = {"viscous": FRICTION}
        content["load"]["unbalance"] = [0.0, 0.0, 0.0]
        path.write_text(yaml.safe_dump(content))
        cls.start_lab()
        cls.controller = Controller(largest_age=1.0)
        cls.addClassCleanup(cls.controller.close)
        rospy.wait_for_message(f"{NAMESPACE}/parameters", ActuatorParameters)
        cls.status = None
        rospy.Subscriber(f"{NAMESPACE}/orientation_controller/motion_status", MotionStatus, cls.keep)

    @classmethod
    def keep(cls, message):
        cls.status = message

    def attempt(self):
        """Exit status, text and folder of one calibration."""
        self.lab.fault("release_fixture", False)
        self.lab.move([0.0, 0.0, 0.0])
        wait_for(self.lab.is_without_current, "coils without current")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        (path / "plan.yaml").write_text(plan())
        config = path / "registration.yaml"
        names = ("stator_tracker", "rotor_marker", "rotor_ft_sensor")
        config.write_text(yaml.safe_dump({"registration": {name: {"stddev": 0.0} for name in names}}))
        done = subprocess.run(
            [
                program("calibrate_by_motion"),
                *("--actuator", str(pathlib.Path(rospy.get_param("~config")) / "pm_spherical_8x24.yaml")),
                *("--directory", str(path / "result")),
                *("--plan", str(path / "plan.yaml")),
                *("--fixture", "lab_emulator"),
                *("--config", str(config)),
                *("--wanted-stddev", str(WANTED)),
                f"--calibrate-option=--truth={self.lab.truth}",
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            check=False,
        )
        print(done.stdout)
        return done.returncode, done.stdout, path / "result"

    def test_the_motion_ends_when_it_is_enough_and_gives_the_parameters(self):
        for _ in range(MOST_ATTEMPTS):
            status, text, folder = self.attempt()
            if "That is what was wanted: the motion ends." in text and (folder / "calibrated.yaml").exists():
                break
        self.assertIn("That is what was wanted: the motion ends.", text)
        self.assertEqual(status, 0, text)
        # Windows were held out, and judge.
        self.assertTrue("grade: good" in text or "grade: usable" in text, text)
        self.assertIn("s of motion: joints", text)
        self.assertRegex(text, r"mrad(, \d+ of \d+ windows left out)?; left to 1\.000 mrad: ")
        motion = yaml.safe_load((folder / "motion.yaml").read_text())
        self.assertLess(motion["duration"], 0.5 * DURATION)
        calibrated = yaml.safe_load((folder / "calibrated.yaml").read_text())["actuator"]
        self.assertEqual(len(calibrated["coils"]), 24)
        self.assertTrue(all(coil["stddev"]["polar"] < WANTED for coil in calibrated["coils"]))
        wait_for(self.lab.is_without_current, "coils without current")


if __name__ == "__main__":
    rospy.init_node("calibrate_by_motion_test")
    rostest.rosrun(PACKAGE, "calibrate_by_motion", CalibrateByMotion, sys.argv)
