"""A whole calibration by the panel of rviz alone, on a screen that nobody sees: keys are pressed, and a hand, which this
plays, turns the rotor to the pose that the panel asks for."""

import pathlib
import time

import rospy
from calibration_client import NAMESPACE, wait_for
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import CalibrationReport, CalibrationSample, CalibrationStatus, CoilCurrents
from true_parameters import expect_truth
from viewed_lab import ViewedLabCase

PLAN, MEASURE, HOLD_OUT, REFINE, VALIDATE, SAVE = "F2", "F3", "F5", "F7", "F8", "F9"
PATIENCE = 60.0  # [s] for a plan; pressed again before, its key would stop it
LOOK = 0.6  # [s] in which rviz, at few pictures a second, sees where the rotor is
SILENCE = 10.0  # [s] without a sample, after which nothing is measured any more


class PanelHandCase(ViewedLabCase):
    @classmethod
    def start_panel(cls, **arguments):
        """A laboratory with the panel, and what it publishes."""
        cls.make_lab(commands=False, seed=5, **arguments)
        cls.latest = {}
        cls.samples = []
        cls.reports = []
        for topic, kind in (
            ("wanted_pose", JointState),
            ("coil_currents", CoilCurrents),
            ("status", CalibrationStatus),
        ):
            rospy.Subscriber(f"{NAMESPACE}/{topic}", kind, lambda message, name=topic: cls.keep(name, message))
        rospy.Subscriber(f"{NAMESPACE}/samples", CalibrationSample, cls.samples.append)
        rospy.Subscriber(f"{NAMESPACE}/report", CalibrationReport, cls.reports.append)
        cls.start_lab()
        cls.wait_for_panel()
        wait_for(lambda: "wanted_pose" in cls.latest or "coil_currents" in cls.latest, "the streams")

    @classmethod
    def keep(cls, topic, message):
        cls.latest[topic] = message

    def wanted(self):
        message = self.latest.get("wanted_pose")
        return tuple(message.position) if message else ()

    def calibrate(self, poses, held_out):
        """From the first plan to what is saved and holds the truth."""
        self.press(PLAN, self.wanted, "a plan", pause=PATIENCE)
        self.assertEqual(self.measure_poses(poses), poses)
        self.press(REFINE, lambda: self.report(CalibrationReport.REFINE), "a refinement")
        self.assertTrue(self.report(CalibrationReport.REFINE).success)
        self.key(HOLD_OUT)
        self.press(PLAN, self.wanted, "a plan to validate by", pause=PATIENCE)
        self.assertEqual(self.measure_poses(held_out), held_out)
        self.assertTrue(self.samples[-1].validation)
        self.press(VALIDATE, lambda: self.latest["status"].grade == CalibrationReport.GOOD, "a good grade")
        self.press(SAVE, self.saved, "the saved description")
        expect_truth(self, self.saved()[-1], self.lab.truth)
        wait_for(self.lab.is_without_current, "zero currents")

    def saved(self):
        """Where a key was pressed again because its service was slow, there is more than one refinement."""
        return sorted(pathlib.Path(self.lab.directory).rglob("*_revision_*.yaml"))

    def measure_poses(self, most):
        """The number of poses that the panel asked for, up to `most`."""
        for count in range(most):
            pose = self.wanted()
            if not pose:
                return count
            self.lab.move(pose)
            time.sleep(LOOK)
            self.measure(lambda wanted=pose: self.wanted() != wanted)
        return most

    def measure(self, is_done):
        """By one key; it must not be pressed while it measures, as it would stop."""
        count = [len(self.samples), time.monotonic()]
        self.key(MEASURE)

        def done():
            if is_done():
                return True
            if len(self.samples) != count[0]:
                count[:] = [len(self.samples), time.monotonic()]
            elif time.monotonic() - count[1] > SILENCE:
                count[1] = time.monotonic()
                self.key(MEASURE)
            return False

        wait_for(done, "the samples of a pose")

    def report(self, cycle):
        return next((report for report in self.reports if report.cycle == cycle), None)
