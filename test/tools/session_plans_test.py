#!/usr/bin/python3
"""Poses that a guided session takes from sessions of long ago, and goes on with."""

import contextlib
import pathlib
import sqlite3
import tempfile
import unittest

from spherical_actuator_calibration.msg import CoilPattern, PoseProgress
from spherical_actuator_calibration.session_guide.account import Account
from spherical_actuator_calibration.session_guide.options import Options
from spherical_actuator_calibration.session_guide.plans import PlanError, read_session
from spherical_actuator_calibration.session_guide.progress import Measured, Pose
from spherical_actuator_calibration.session_guide.session import Session
from spherical_actuator_calibration.session_guide.task import Task

ACTUATOR = {
    "name": "sphere",
    "serial": "A7",
    "workspace": {"tilt_limit": 0.5},
    "joints": [{"name": f"joint_{n}"} for n in (1, 2, 3)],
    "coils": [{}] * 4,
}


class Sessions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def stored(self, samples, name="sphere"):
        """A database of (joint angles, currents, held out, removed)."""
        path = str(self.folder / "session.db")
        with contextlib.closing(sqlite3.connect(path)) as file:
            file.executescript(
                "PRAGMA application_id = 1396786003; PRAGMA user_version = 4;"
                "CREATE TABLE unit (name TEXT, serial TEXT);"
                "CREATE TABLE samples (id INTEGER, joint_1, joint_2, joint_3, validation INTEGER, removal TEXT);"
                "CREATE TABLE sample_currents (sample INTEGER, coil INTEGER, current);"
            )
            file.execute("INSERT INTO unit VALUES (?, 'A7')", (name,))
            for number, (joints, currents, held_out, removal) in enumerate(samples, 1):
                file.execute("INSERT INTO samples VALUES (?, ?, ?, ?, ?, ?)", (number, *joints, held_out, removal))
                rows = [(number, coil, current) for coil, current in enumerate(currents)]
                file.executemany("INSERT INTO sample_currents VALUES (?, ?, ?)", rows)
            file.commit()
        return path

    def test_is_measured_again_as_it_was(self):
        here, nearby, there = (0.1, 0.2, 0.3), (0.11, 0.2, 0.3), (0.4, 0.0, 0.0)
        path = self.stored(
            [
                (here, (0, 0, 0, 0), 0, None),
                (nearby, (2.001, 0, 0, 0.001), 0, None),
                (nearby, (-2.001, 0, 0, 0), 0, None),
                (here, (0, 1.999, -2.0, 0), 0, None),
                (here, (0, 0, 0, 2.0), 0, "removed"),
                (there, (0, 0, 2.0, 0), 1, None),
            ]
        )
        plan = read_session(path, ACTUATOR, 0.05, 0.05)
        self.assertEqual(plan.current, 2.0)
        self.assertEqual([pose.joints for pose in plan.poses], [here, there])
        self.assertEqual([pose.validation for pose in plan.poses], [False, True])
        self.assertEqual(plan.poses[0].excitations, ((1,), (-1,), (2, -3)))
        self.assertEqual(plan.poses[1].excitations, ((3,),))

    def test_names_what_is_wrong(self):
        with self.assertRaisesRegex(PlanError, "no samples in use"):
            read_session(self.stored([]), ACTUATOR, 0.05, 0.05)
        (self.folder / "session.db").write_text("no database")
        with self.assertRaisesRegex(PlanError, "session.db"):
            read_session(str(self.folder / "session.db"), ACTUATOR, 0.05, 0.05)
        with self.assertRaisesRegex(PlanError, "there is no such file"):
            read_session(str(self.folder / "none.db"), ACTUATOR, 0.05, 0.05)

    def test_of_another_actuator(self):
        with self.assertRaisesRegex(PlanError, "for the actuator cube, not for sphere"):
            read_session(self.stored([], name="cube"), ACTUATOR, 0.05, 0.05)


class Bench:
    """A calibration node that plans poses of two coils, holds samples and never estimates; at 2 A."""

    def __init__(self):
        self.held = []
        self.asked = []  # for how many poses
        self.in_force = []  # poses of the plan

    def measured(self):
        return self.held

    @staticmethod
    def pose_tolerance():
        return 0.05

    def progress_of(self, poses):
        return [self._progress_of(pose) for pose in poses]

    def _progress_of(self, pose):
        there = {sample.pattern for sample in self.held if sample.joints == pose.joints}
        missing = [CoilPattern(coils=list(pattern)) for pattern in pose.excitations if pattern not in there]
        return PoseProgress(has_sample=bool(there), is_measured=bool(there) and not missing, missing=missing)

    def begun(self):
        there = zip(self.in_force, self.progress_of(self.in_force))
        return [pose for pose, progress in there if progress.has_sample and not progress.is_measured]

    def plan(self, poses, wanted_stddev, first, **_):
        self.asked.append(poses)
        begin = sum(self.asked[:-1])
        chosen = [Pose((0.1 * n, 0.0, 0.0), ((1,), (2,))) for n in range(begin, begin + poses)]
        self.in_force = [*first, *chosen]
        return chosen, "Planned."

    def capture(self, pose, *patterns):
        self.held += [Measured(pose.joints, pattern, pose.validation) for pattern in patterns]


class InterruptedSessions(unittest.TestCase):
    def setUp(self):
        self.bench, self.account = Bench(), Account()

    def wanted(self, **options):
        options = Options(poses=4, validation_poses=0, **options)
        return Session(self.bench, None, ACTUATOR, options, Task(), self.account)._wanted_poses()

    def test_complete_the_pose_that_was_begun(self):
        first, second, *_ = self.wanted()
        self.bench.capture(first, (), (1,), (2,))
        self.bench.capture(second, ())
        poses = self.wanted()
        self.assertEqual((poses[0], len(poses)), (second, 3))
        self.assertIn("The session goes on: 2 poses are measured already, 1 of them in part.", self.account.message().sentences)
        # Interrupted there once more, in the middle of the coils.
        self.bench.capture(second, (), (1,))
        self.assertEqual(self.wanted()[0], second)
        self.bench.capture(second, (2,))
        self.assertNotIn(second, self.wanted())

    def test_go_on_when_all_poses_were_begun(self):
        for pose in self.wanted():
            self.bench.capture(pose, ())
        self.assertEqual(self.wanted(), self.bench.in_force)
        self.assertEqual(self.bench.asked, [4])

    def test_forget_what_does_not_fit_any_more(self):
        for pose in self.wanted():
            self.bench.capture(pose, ())
        self.bench.in_force = [Pose(pose.joints, ((1, -2),)) for pose in self.bench.in_force]
        self.assertEqual(self.wanted(total_current=3.0), [])
        self.assertEqual(len(self.wanted(total_current=4.0)), 4)
        self.bench.held.clear()
        self.assertEqual(len(self.wanted()), 4)
        self.assertEqual(self.bench.asked, [4, 4])


if __name__ == "__main__":
    unittest.main()
