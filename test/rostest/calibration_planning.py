#!/usr/bin/python3
"""The services plan_poses, load_plan and missing_patterns of the calibration node."""

import contextlib
import math
import pathlib
import shutil
import sqlite3
import sys
import tempfile
import unittest

import rospy
import rostest
from calibration_client import NODE, PACKAGE, CalibrationClient, CalibrationNode, run_tool, wait_for
from spherical_actuator_calibration.msg import CoilPattern, PosePatterns
from spherical_actuator_calibration.srv import PlanPoses

TILT_LIMIT = 0.6


class Planning(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.client = CalibrationClient()
        self.node = CalibrationNode(folder.name + "/calibration")
        self.addCleanup(self.node.stop)
        self.client.start(self.node)
        rospy.wait_for_service(NODE + "/plan_poses")
        self.plan = rospy.ServiceProxy(NODE + "/plan_poses", PlanPoses)

    def test_plans_a_session_inside_the_workspace(self):
        answer = self.plan(cycle="refine", max_poses=8)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(len(answer.poses), 8)
        for pose in answer.poses:
            self.assertLessEqual(max(abs(angle) for angle in pose.joint_position[:2]), TILT_LIMIT)
            self.assertTrue(all(1 <= coil <= 24 for coil in pose.coils))
        self.assertEqual(len(answer.expected), 9 + 2 * 8 + 2 * 24)
        self.assertLess(max(estimate.stddev for estimate in answer.expected), 2e-3)

    def test_plans_several_coils_at_once_on_request(self):
        request = {"cycle": "refine", "max_poses": 8, "current": 1.5, "total_current": 4.5, "time_budget": 20.0}
        single = self.plan(**request)
        self.assertTrue(all(not pose.patterns for pose in single.poses))
        answer = self.plan(patterns="weighing", **request)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("of as many poses and torques could reach", answer.message)
        worst = max(estimate.stddev for estimate in answer.expected)
        self.assertLess(worst, max(estimate.stddev for estimate in single.expected))
        self.assertGreater(answer.stddev_bound, 0.0)
        self.assertLessEqual(answer.stddev_bound, worst)
        for pose in answer.poses:
            self.assertEqual(len(pose.patterns), 6)
            for pattern in pose.patterns:
                self.assertEqual(len(pattern.current), 24)
                excited = [n + 1 for n, current in enumerate(pattern.current) if current]
                self.assertEqual(len(excited), 3)
                self.assertTrue(set(excited) <= set(pose.coils))
                self.assertEqual({abs(current) for current in pattern.current}, {0.0, 1.5})

    def test_plans_single_cycles(self):
        joint = self.plan(cycle="joint", max_poses=6)
        self.assertTrue(joint.success, joint.message)
        self.assertTrue(all(not pose.coils for pose in joint.poses))
        self.assertEqual(len(joint.expected), 9)
        poles = self.plan(cycle="poles", coil=3, max_poses=12)
        self.assertTrue(poles.success, poles.message)
        self.assertTrue(all(list(pose.coils) == [3] for pose in poles.poses))

    def missing(self, *patterns):
        pose = PosePatterns(patterns=[CoilPattern(coils=coils) for coils in patterns])
        return self.client.call("missing_patterns", poses=[pose])

    def test_tells_what_any_pose_lacks(self):
        (there,) = self.missing([3], [1, -24], [-3]).poses
        self.assertEqual([tuple(pattern.coils) for pattern in there.missing], [(3,), (1, -24)])
        self.assertFalse(there.has_sample or there.is_measured)
        for coils in ([], [0], [25], [-2, 1], [-(2**31)]):
            answer = self.missing([3], coils)
            self.assertFalse(answer.success)
            self.assertRegex(answer.message, "coil")
            self.assertEqual(answer.poses, [])

    def test_the_plan_in_force_is_told_with_its_patterns(self):
        wait_for(lambda: self.client.latest("plan_progress"), "that there is no plan")
        self.assertEqual(self.client.latest("plan_progress").poses, [])
        answer = self.plan(cycle="refine", max_poses=4, patterns="weighing", time_budget=10.0)
        self.assertTrue(answer.success, answer.message)

        def is_told():
            return len(self.client.latest("plan_progress").poses) == len(answer.poses)

        wait_for(is_told, "the plan")
        for there, planned in zip(self.client.latest("plan_progress").poses, answer.poses):
            self.assertEqual(there.pose.joint_position, planned.joint_position)
            wanted = [[n if i > 0.0 else -n for n, i in enumerate(each.current, 1) if i] for each in planned.patterns]
            self.assertEqual([list(pattern.coils) for pattern in there.pose.patterns], wanted)
            self.assertEqual(there.missing, there.pose.patterns)

    def test_poses_that_were_begun_stay_in_the_plan(self):
        begun = PosePatterns(joint_position=(0.1, -0.2, 0.3), patterns=[CoilPattern(coils=[3, -7])])
        answer = self.plan(cycle="refine", max_poses=2, first=[begun], time_budget=10.0)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(len(answer.poses), 2)
        wait_for(lambda: len(self.client.latest("plan_progress").poses) == 3, "the plan")
        self.assertEqual(self.client.latest("plan_progress").poses[0].pose, begun)
        begun.patterns[0].coils = [3, 99]
        answer = self.plan(cycle="refine", max_poses=2, first=[begun], time_budget=10.0)
        self.assertFalse(answer.success)
        self.assertRegex(answer.message, "coil")
        nowhere = PosePatterns(joint_position=(math.inf, 0.0, 0.0))
        self.assertIn("joint_position", self.plan(cycle="refine", max_poses=2, first=[nowhere]).message)
        beyond = PosePatterns(joint_position=(TILT_LIMIT + 0.01, 0.0, 0.0))
        self.assertIn("tilt_limit", self.plan(cycle="refine", max_poses=2, first=[beyond]).message)
        # The actions ask so before they turn anything.
        answer = self.client.call("missing_patterns", poses=[beyond])
        self.assertFalse(answer.success)
        self.assertIn("tilt_limit", answer.message)
        self.assertEqual(len(self.client.latest("plan_progress").poses), 3)

    def test_draws_poses_to_judge_by(self):
        answer = self.client.call("draw_validation_poses", poses=3, coils_per_pose=2, seed=4)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([(len(pose.patterns), pose.validation) for pose in answer.poses], [(2, True)] * 3)
        self.assertTrue(self.client.call("missing_patterns", poses=answer.poses).success)
        answer = self.client.call("draw_validation_poses", poses=2**32 - 1)
        self.assertFalse(answer.success)
        self.assertIn("validation poses", answer.message)

    def test_follows_a_plan_of_a_file(self):
        path = pathlib.Path(self.folder) / "plan.yaml"
        description = pathlib.Path(rospy.get_param("~config")) / "pm_spherical_8x24.yaml"
        run_tool("plan_session", actuator=description, output=path, poses=4, candidates=60, patterns="weighing")
        answer = self.client.call("load_plan", path=str(path))
        self.assertTrue(answer.success, answer.message)
        self.assertEqual((len(answer.poses), answer.current), (4, 2.0))
        wait_for(lambda: len(self.client.latest("plan_progress").poses) == 4, "the plan")
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace("joint_position", "position", 1), encoding="utf-8")
        weak = pathlib.Path(self.folder) / "weak.yaml"  # coils that would not count as excited
        weak.write_text(text.replace("current: 2", "current: 0.01", 1), encoding="utf-8")
        for unusable in (path, weak, self.folder + "/none.yaml", description, "/dev/zero", ""):
            answer = self.client.call("load_plan", path=str(unusable))
            self.assertFalse(answer.success)
            self.assertIn(str(unusable), answer.message)
            self.assertEqual(answer.poses, [])
        self.assertEqual(len(self.client.latest("plan_progress").poses), 4)

    def test_follows_an_earlier_session(self):
        path = self.earlier_session([((0.1, 0.2, 0.3), 3, 0), ((0.1, 0.2, 0.3), 7, 0), ((-0.2, 0.0, 1.0), 3, 1)])
        answer = self.client.call("load_plan", path=str(path))
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.current, 1.5)
        patterns = [[tuple(pattern.coils) for pattern in pose.patterns] for pose in answer.poses]
        self.assertEqual(patterns, [[(3,), (7,)], [(3,)]])
        self.assertEqual([pose.validation for pose in answer.poses], [0, 1])
        wait_for(lambda: [there.pose for there in self.client.latest("plan_progress").poses] == answer.poses, "the plan")
        own = next(pathlib.Path(self.folder).rglob("calibration/**/session.db"))
        answer = self.client.call("load_plan", path=str(own))
        self.assertIn("not an earlier one", answer.message)
        self.assertEqual(len(self.client.latest("plan_progress").poses), 2)

    def earlier_session(self, samples):
        """A copy of this node's session, as yet without samples, that has these: joint angles, coil, held out."""
        path = pathlib.Path(self.folder) / "earlier.db"
        shutil.copy(next(pathlib.Path(self.folder).rglob("calibration/**/session.db")), path)
        with contextlib.closing(sqlite3.connect(path)) as file:
            for number, (joints, excited, held_out) in enumerate(samples, 1):
                file.execute(
                    "INSERT INTO samples (id, date, stamp, validation, joint_1, joint_2, joint_3, joint_1_stddev, "
                    "joint_2_stddev, joint_3_stddev, has_orientation, has_torque, duration, measurements) "
                    "VALUES (?, '', 0, ?, ?, ?, ?, 1e-6, 1e-6, 1e-6, 0, 0, 1.0, 1)",
                    (number, held_out, *joints),
                )
                currents = [(number, coil, 1.5 if coil == excited else 0.0) for coil in range(1, 25)]
                file.executemany("INSERT INTO sample_currents VALUES (?, ?, ?)", currents)
            file.commit()
        return path

    def test_refuses_what_it_cannot_plan(self):
        for request, word in (
            ({"cycle": "everything", "max_poses": 5}, "everything"),
            ({"cycle": "coil", "coil": 99, "max_poses": 5}, "99"),
            ({"cycle": "refine", "max_poses": 0}, "max_poses"),
            ({"cycle": "refine", "max_poses": 5, "patterns": "all"}, "all"),
            ({"cycle": "refine", "max_poses": 5, "patterns": "weighing", "total_current": 1.0}, "total_current"),
            ({"cycle": "refine", "max_poses": 5, "time_budget": -1.0}, "time_budget"),
        ):
            answer = self.plan(**request)
            self.assertFalse(answer.success)
            self.assertIn(word, answer.message)
            self.assertTrue(self.node.alive())


if __name__ == "__main__":
    rospy.init_node("calibration_planning")
    rostest.rosrun(PACKAGE, "calibration_planning", Planning, sys.argv)
