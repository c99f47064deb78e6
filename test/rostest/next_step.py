#!/usr/bin/python3
"""What the node tells the operator to do next, where it is easily wrong."""

import contextlib
import math
import sqlite3
import sys
import tempfile
import unittest

import rospy
import rostest
from calibration_client import NAMESPACE, NODE, PACKAGE, CalibrationClient, CalibrationNode, wait_for
from emulated_streams import EmulatedStreams
from spherical_actuator_calibration.msg import PosePatterns
from spherical_actuator_calibration.srv import PlanPoses

DURATION = 0.3  # [s] of a capture
POSES = ((0.2, 0.0, 0.0), (0.0, 0.2, 1.0), (-0.2, 0.1, -1.0), (0.1, -0.2, 2.0), (0.2, 0.2, -2.0), (-0.1, -0.2, 0.5))
HELD_OUT = ((0.1, 0.1, 0.4), (-0.1, 0.2, -0.6), (0.15, -0.1, 1.4), (-0.2, -0.1, 2.4))


def turned(message):
    """An orientation that is far off, by 0.1 rad about x: the marker was hit."""
    q = message.quaternion
    sine, cosine = math.sin(0.05), math.cos(0.05)
    x, y, z, w = q.x, q.y, q.z, q.w
    q.x, q.y, q.z, q.w = cosine * x + sine * w, cosine * y - sine * z, cosine * z + sine * y, cosine * w - sine * x


class NextStep(unittest.TestCase):
    """With an actuator that is a joint alone, so that one cycle is the whole calibration."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        actuator = rospy.get_param(f"{NAMESPACE}/actuator")
        for key in ("poles", "coils", "torque_curve"):
            actuator.pop(key, None)
        rospy.set_param(f"{NAMESPACE}/actuator", actuator)
        self.client = CalibrationClient()
        self.output = folder.name + "/calibration"
        self.node = CalibrationNode(self.output, report_page=False)
        self.addCleanup(self.node.stop)
        self.client.start(self.node)
        self.streams = EmulatedStreams()
        self.addCleanup(self.streams.stop)

    def says(self, part):
        wait_for(lambda: part in self.client.latest("status").next_step, part)

    def capture(self, pose, validation=False):
        """Until a sample of this pose is held: on a busy computer streams may be late."""
        self.streams.move_to(pose)

        def is_captured():
            answer = self.client.call("capture", duration=DURATION, validation=validation)
            if answer.success and max(abs(a - b) for a, b in zip(answer.sample.joint_position, pose)) > 1e-2:
                self.client.call("remove_sample", id=answer.sample.id)
                return False
            return answer.success

        wait_for(is_captured, f"a sample at {pose}")

    def calibrate(self):
        for pose in POSES:
            self.capture(pose)
        answer = self.client.call("calibrate_joint", coil=0)
        self.assertTrue(answer.success, answer.message)

    def test_many_captures_at_one_pose(self):
        for _ in range(10):
            self.capture(POSES[0])
        self.says("3 of 10 are held")
        self.assertNotIn("Call calibrate_joint", self.client.latest("status").next_step)

    def test_the_report_names_samples_in_use_only(self):
        def names(samples):
            def is_told():
                report = self.client.latest("report")  # none of a node that was started just now
                return report is not None and {one.id for one in report.residuals} == set(samples)

            wait_for(is_told, f"{samples}")

        self.calibrate()
        held = sorted(self.client.held())
        wait_for(lambda: self.client.latest("report"), "a report")
        names(held)
        self.assertTrue(self.client.call("remove_sample", id=held[0]).success)
        names(held[1:])
        self.node.kill()
        self.client.start(self.node)
        names(held[1:])
        self.assertTrue(self.client.call("clear_samples").success)
        names([])

    def test_a_plan_is_followed_also_after_the_node_was_killed(self):
        rospy.wait_for_service(NODE + "/plan_poses")
        plan = rospy.ServiceProxy(NODE + "/plan_poses", PlanPoses)(cycle="joint", max_poses=4)
        self.assertTrue(plan.success, plan.message)
        for number, pose in enumerate(plan.poses):
            self.says(f"Go on with the plan, {number} of {len(plan.poses)} poses {'is' if number == 1 else 'are'} measured")
            self.says(f"joints {pose.joint_position[0]:.2f},")
            self.capture(pose.joint_position)
            if number == 1:
                self.node.kill()
                self.client.start(self.node)
        wait_for(lambda: "plan" not in self.client.latest("status").next_step, "the end of the plan")

    def tells(self, *measured):
        """Whether poses of the plan in force are measured, in their order; the others are not even begun."""

        def is_told():
            message = self.client.latest("plan_progress")
            told = [(there.has_sample, there.is_measured) for there in message.poses] if message else None
            return told == [(each, each) for each in measured]

        wait_for(is_told, f"plan_progress of {measured}")

    def test_what_is_measured_of_a_plan_is_told_with_every_change(self):
        self.tells()
        plan = self.client.call("plan_poses", cycle="joint", max_poses=2)
        self.assertTrue(plan.success, plan.message)
        first, second = (tuple(pose.joint_position) for pose in plan.poses)
        self.tells(False, False)
        poses = [there.pose for there in self.client.latest("plan_progress").poses]
        self.assertEqual([tuple(pose.joint_position) for pose in poses], [first, second])
        self.capture(first, validation=True)
        self.capture(second)
        self.tells(False, True)
        self.capture(first)
        self.tells(True, True)
        held = self.client.call("list_samples")
        self.assertEqual([sample.id for sample in held.samples], [1, 2, 3])
        self.assertEqual(held.places, (1, 2, 3))  # held out is another place
        self.assertTrue(self.client.call("remove_sample", id=max(self.client.held())).success)
        self.tells(False, True)
        self.says(f"joints {first[0]:.2f},")
        self.node.kill()
        self.client.start(self.node)
        self.tells(False, True)
        # Of other poses, as of the first one for the samples that judge, on request.
        asked = [PosePatterns(joint_position=pose, validation=True) for pose in (first, second)]
        answer = self.client.call("missing_patterns", poses=asked)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([there.is_measured for there in answer.poses], [True, False])
        self.assertTrue(self.client.call("clear_samples").success)
        self.tells()

    def test_a_plan_to_judge_by_is_measured_by_held_out_samples(self):
        plan = self.client.call("plan_poses", cycle="joint", max_poses=1, validation=True)
        self.assertTrue(plan.success, plan.message)
        (pose,) = (tuple(planned.joint_position) for planned in plan.poses)
        self.says("and capture (held out).")
        self.capture(pose)
        self.node.kill()
        self.client.start(self.node)
        self.tells(False)
        self.assertTrue(self.client.latest("plan_progress").poses[0].pose.validation)
        self.capture(pose, validation=True)
        self.tells(True)

    def test_a_damaged_plan_keeps_nobody_from_calibrating(self):
        rospy.wait_for_service(NODE + "/plan_poses")
        plan = rospy.ServiceProxy(NODE + "/plan_poses", PlanPoses)(cycle="joint", max_poses=4)
        self.assertTrue(plan.success, plan.message)
        self.capture(POSES[0])
        self.node.kill()
        with contextlib.closing(sqlite3.connect(f"{self.output}/session.db")) as database:
            database.execute("UPDATE planned_poses SET joint_1 = 'east'")
            database.commit()
        self.client.start(self.node)
        self.assertNotIn("plan", self.client.latest("status").next_step)
        self.assertEqual(self.client.latest("status").orientation_samples, 1)
        self.calibrate()

    def test_forgotten_samples(self):
        self.calibrate()
        self.says("validation set")
        self.assertTrue(self.client.call("save").success)
        self.says("nothing judges it")
        self.assertTrue(self.client.call("clear_samples").success)
        self.says("no sample is in use")

    def test_a_failed_validation(self):
        self.calibrate()
        self.streams.spoil["measured_orientation"] = turned
        for pose in HELD_OUT:
            self.capture(pose, validation=True)
        self.assertFalse(self.client.call("validate", coil=0).success)
        self.says("Do not use the parameters")
        saved = self.client.call("save")
        self.assertTrue(saved.success, saved.message)
        self.assertIn("Grade: contradicted", saved.message)
        wait_for(lambda: self.client.diagnostic("session").get("grade") == "contradicted", "the grade on diagnostics")
        self.says("Do not use the parameters")


if __name__ == "__main__":
    rospy.init_node("next_step")
    rostest.rosrun(PACKAGE, "next_step", NextStep, sys.argv)
