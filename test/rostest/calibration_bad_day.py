#!/usr/bin/python3
"""What goes wrong in a laboratory: the node says so in a sentence, keeps what it has and lives on."""

import math
import os
import resource
import sys
import tempfile
import threading
import unittest

import rospy
import rostest
from calibration_client import (
    DEADLINE,
    NAMESPACE,
    NODE,
    PACKAGE,
    CalibrationClient,
    CalibrationNode,
    values_of,
    wait_for,
)
from emulated_streams import EmulatedStreams, rotation
from links import free_port
from second_master import SecondMaster

POSES = ((0.2, 0.0, 0.0), (0.0, 0.2, 1.0), (-0.2, 0.1, -1.0), (0.1, -0.2, 2.0), (0.0, 0.1, 0.5))
DURATION = 0.3  # [s] of a capture
REST = 1.5  # [s] of the streams, long enough for an automatic sample


def is_at(sample, pose):
    return all(abs(found - wanted) < 1e-3 for found, wanted in zip(sample.joint_position, pose))


def end_of(sample):
    """Stamp until when a sample was measured."""
    return sample.header.stamp + rospy.Duration(sample.duration / 2.0)


class BadDay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.directory = os.path.join(self.folder.name, "calibration")
        self.client = CalibrationClient()
        self.node = CalibrationNode(self.directory, diagnostic_period=0.1)
        self.addCleanup(self.node.stop)
        self.client.start(self.node)
        self.streams = EmulatedStreams()
        self.addCleanup(self.streams.stop)
        self.capture_at(POSES[0])

    # -- steps ---------------------------------------------------------------------------------------

    def capture(self):
        return self.client.call("capture", duration=DURATION)

    def captured(self):
        """Captures, and asks again while the streams have just come back, or are late on a busy computer."""
        return wait_for(self.successful_capture, "a sample").sample

    def successful_capture(self):
        answer = self.capture()
        return answer if answer.success else None

    def capture_at(self, pose):
        before = self.streams.joint_position
        self.streams.move_to(pose)
        sample = self.captured()
        # A capture that began before the move refuses; only where the streams are late it may not have begun.
        while is_at(sample, before):
            self.assertTrue(self.client.call("remove_sample", id=sample.id).success)
            sample = self.captured()
        self.assertTrue(is_at(sample, pose), sample.joint_position)
        return sample

    def capture_all(self):
        for pose in POSES[1:]:
            self.capture_at(pose)

    def refused(self, answer, *words):
        """The answer is a refusal in one sentence that holds these words."""
        self.assertFalse(answer.success, answer.message)
        self.assertTrue(answer.message.endswith("."), answer.message)
        for word in words:
            self.assertIn(word, answer.message)

    def captures_are_refused(self, since, *words):
        """Every capture is, until one for this reason: a busy computer may delay a stream, and that is told first. A
        node that is behind may still make a sample of what was measured before this stamp."""

        def told():
            answer = self.capture()
            if answer.success and end_of(answer.sample) < since:
                self.assertTrue(self.client.call("remove_sample", id=answer.sample.id).success)
                return False
            self.refused(answer)
            return all(word in answer.message for word in words)

        wait_for(told, f"a refusal that holds {words}")

    def wait_for_refusal(self, stream, word):
        def is_told():
            return word in self.client.diagnostic(stream).get("last refusal", "")

        wait_for(is_told, f"{stream}: {word}")

    def nothing_changed(self, revision, held):
        self.assertEqual(self.client.held(), held)
        self.assertEqual(self.client.revision(), revision)
        self.assertTrue(self.node.alive())
        self.assertTrue(self.client.latest("status").next_step)

    # -- streams -------------------------------------------------------------------------------------

    def test_silent_tracker_is_named_and_the_next_capture_works(self):
        self.streams.silent.add("measured_orientation")
        since = self.streams.newest
        self.wait_for_age("measured_orientation", 2.0)
        self.captures_are_refused(since, "measured_orientation", "silent")
        self.streams.silent.clear()
        self.assertTrue(self.captured().has_orientation)

    def wait_for_age(self, stream, age):
        def is_reached():
            return float(self.client.diagnostic(stream).get("age [s]", 0.0)) > age

        wait_for(is_reached, f"{stream} silent for {age} s")

    def test_automatic_capture_goes_on_after_a_silent_tracker(self):
        self.assertTrue(self.client.call("set_auto_capture", data=True).success)
        self.streams.silent.add("measured_orientation")
        self.wait_for_age("measured_orientation", 2.0)
        self.streams.silent.clear()
        self.rest_at(POSES[1])
        self.streams.move_to(POSES[2])
        self.assertTrue(self.automatic_sample_at(POSES[1]).has_orientation)

    def automatic_sample_at(self, pose):
        def samples_here():
            return [sample for sample in self.client.samples if is_at(sample, pose)]

        return wait_for(samples_here, f"an automatic sample at {pose}")[0]

    def rest_at(self, pose):
        self.streams.move_to(pose)
        self.streams.rest(REST)

    def test_stamps_may_jump_backwards_and_forwards_again(self):
        held = self.client.held()
        (first,) = held.values()
        self.streams.stamp_offset = -100.0
        wait_for(lambda: self.captured().header.stamp < first.header.stamp, "a sample of the time before")
        self.streams.stamp_offset = 0.0
        wait_for(lambda: self.captured().header.stamp > first.header.stamp, "a sample of the time after")
        self.assertEqual(self.client.held()[first.id], first)

    def test_nan_is_refused_and_the_rest_is_used(self):
        seen = {"count": 0}

        def spoil_some(message):
            seen["count"] += 1
            if seen["count"] % 5 == 0:
                message.quaternion.x = math.nan

        self.streams.spoil["measured_orientation"] = spoil_some
        self.wait_for_refusal("measured_orientation", "finite")
        sample = self.captured()
        self.assertTrue(sample.has_orientation)
        q = rotation(POSES[0])
        self.assertAlmostEqual(abs(sample.orientation.x), abs(q[0]), delta=1e-3)

    def test_a_stream_of_nan_counts_as_silent(self):
        def spoil(message):
            message.vector.z = math.nan

        self.streams.spoil["measured_torque"] = spoil
        since = self.streams.newest
        self.wait_for_refusal("measured_torque", "finite")
        self.wait_for_age("measured_torque", 0.5)
        held = self.client.held()
        self.captures_are_refused(since, "measured_torque")
        self.nothing_changed(0, held)

    def test_a_rotor_that_never_settles_gives_no_sample(self):
        captured = self.client.held()
        self.assertTrue(self.client.call("set_auto_capture", data=True).success)
        self.streams.tremble = 0.01
        since = self.streams.newest
        # The rest before it is over, and gives the last one.
        wait_for(lambda: any(sample.id not in captured for sample in self.client.samples), "the sample of the rest")
        held = self.client.held()
        self.captures_are_refused(since, "moves")
        self.assertTrue(self.client.call("set_auto_capture", data=False).success)
        self.captures_are_refused(since, "moves")
        self.nothing_changed(0, held)

    def test_wrong_number_of_coils_is_refused(self):
        def drop_last(message):
            message.current = message.current[:-1]

        self.streams.spoil["coil_currents"] = drop_last
        since = self.streams.newest
        self.wait_for_refusal("coil_currents", "size")
        self.wait_for_age("coil_currents", 0.5)
        self.captures_are_refused(since, "coil_currents")
        self.streams.spoil.clear()
        self.assertEqual(len(self.captured().current), 24)

    def test_foreign_frame_is_refused(self):
        def mislabel(message):
            message.header.frame_id = "tracker"

        self.streams.spoil["measured_orientation"] = mislabel
        since = self.streams.newest
        self.wait_for_refusal("measured_orientation", "tracker")
        self.wait_for_age("measured_orientation", 0.5)
        self.captures_are_refused(since, "measured_orientation")

    # -- requests ------------------------------------------------------------------------------------

    def test_services_in_the_wrong_order_are_refused(self):
        self.capture_all()
        before = values_of(self.client.latest("parameters"))
        held = self.client.held()
        self.refused(self.client.call("calibrate_coil", coil=2), "pole")
        self.refused(self.client.call("calibrate_poles", coil=1))
        for coil in (0, 25, 4294967295):
            self.refused(self.client.call("calibrate_coil", coil=coil), "coil")
            self.refused(self.client.call("calibrate_poles", coil=coil), "coil")
        self.refused(self.client.call("calibrate_motion"), "record")  # of a rotor at rest
        self.refused(self.client.call("remove_sample", id=4711), "4711")
        self.refused(self.client.call("restore", revision=4711), "4711")
        for duration in (-1.0, 1e9, math.nan):
            self.refused(self.client.call("capture", duration=duration))
        self.nothing_changed(0, held)
        self.assertEqual(values_of(self.client.latest("parameters")), before)

    def test_a_failed_cycle_changes_no_parameter(self):
        self.capture_all()
        self.assertTrue(self.client.call("calibrate_joint").success)
        wait_for(lambda: self.client.revision() == 1, "the identified parameters")
        before = values_of(self.client.latest("parameters"))
        # One sample tells too little.
        self.assertTrue(self.client.call("clear_samples").success)
        self.refused(self.client.call("refine"))
        self.captured()
        held = self.client.held()
        self.refused(self.client.call("calibrate_joint"))
        wait_for(self.failure_is_reported, "the report of the failure")
        self.nothing_changed(1, held)
        self.assertEqual(values_of(self.client.latest("parameters")), before)
        # The failure stays in the past when the node starts again.
        self.assertEqual(self.node.stop(), 0)
        self.client.start(self.node)
        self.nothing_changed(1, held)
        self.assertEqual(values_of(self.client.latest("parameters")), before)

    def failure_is_reported(self):
        report = self.client.latest("report")
        return report and not report.success

    def test_two_clients_at_once_are_both_answered(self):
        self.capture_all()
        first, second = self.at_once(self.captured)
        # Captures of the very same measurements are one sample.
        if first.header.stamp == second.header.stamp:
            self.assertEqual(first, second)
        else:
            self.assertNotEqual(first.id, second.id)
        answers = self.at_once(lambda: self.client.call("calibrate_joint"))
        self.assertEqual([answer.success for answer in answers], [True, True])
        wait_for(lambda: self.client.revision() == 2, "one revision per cycle")
        self.assertEqual(len(self.client.held()), len(POSES) + len({first.id, second.id}))

    @staticmethod
    def at_once(call):
        answers = []
        clients = [threading.Thread(target=lambda: answers.append(call())) for _ in range(2)]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        return answers

    # -- disk ----------------------------------------------------------------------------------------

    def test_a_full_disk_fails_the_service_and_the_node_goes_on_afterwards(self):
        self.capture_all()
        self.assertTrue(self.client.call("calibrate_joint").success)
        wait_for(lambda: self.client.revision() == 1, "the identified parameters")
        held = self.client.held()
        unlimited = resource.prlimit(self.node.process.pid, resource.RLIMIT_FSIZE)
        # Files can grow no more: what a full disk is to the node.
        resource.prlimit(self.node.process.pid, resource.RLIMIT_FSIZE, (0, unlimited[1]))
        self.refused(self.capture())
        self.refused(self.client.call("calibrate_joint"))
        self.refused(self.client.call("reset"))
        self.refused(self.client.call("save"))
        self.refused(self.client.call("clear_samples"))
        self.nothing_changed(1, held)
        self.assertEqual([name for name in os.listdir(self.directory) if "revision" in name], [])

        resource.prlimit(self.node.process.pid, resource.RLIMIT_FSIZE, unlimited)
        answer = self.client.call("save")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(self.client.call("calibrate_joint").success)
        self.captured()
        held = self.client.held()
        self.assertEqual(len(held), len(POSES) + 1)
        self.assertEqual(self.node.stop(), 0)
        self.client.start(self.node)
        self.nothing_changed(2, held)

    def test_automatic_samples_wait_for_a_full_disk(self):
        self.assertTrue(self.client.call("set_auto_capture", data=True).success)
        unlimited = resource.prlimit(self.node.process.pid, resource.RLIMIT_FSIZE)
        resource.prlimit(self.node.process.pid, resource.RLIMIT_FSIZE, (0, unlimited[1]))
        self.rest_at(POSES[1])
        self.streams.move_to(POSES[2])

        def is_told():
            error = self.client.diagnostic("session").get("last error", "none")
            return error != "none"

        wait_for(is_told, "the failure on diagnostics")
        resource.prlimit(self.node.process.pid, resource.RLIMIT_FSIZE, unlimited)
        sample = self.automatic_sample_at(POSES[1])
        self.assertEqual(self.client.held()[sample.id].joint_position, sample.joint_position)

    def test_a_directory_that_cannot_be_made_ends_the_node_with_the_reason(self):
        obstacle = os.path.join(self.folder.name, "file")
        with open(obstacle, "w", encoding="utf-8"):
            pass
        self.node.stop()
        node = CalibrationNode(os.path.join(obstacle, "calibration")).start()
        self.addCleanup(node.stop)
        self.assertEqual(node.process.wait(timeout=DEADLINE), 1)
        self.assertIn(obstacle, node.stderr())

    def test_a_second_node_on_the_same_directory_is_refused(self):
        held = self.client.held()
        node = CalibrationNode(self.directory, environment={"ROS_NAMESPACE": "/other"})
        rospy.set_param("/other/actuator", rospy.get_param("/actuator/actuator"))
        node.start()
        self.addCleanup(node.stop)
        self.assertEqual(node.process.wait(timeout=DEADLINE), 1)
        self.assertIn(self.directory, node.stderr())
        self.nothing_changed(0, held)

    # -- master --------------------------------------------------------------------------------------

    def test_everything_is_there_after_the_master_was_restarted(self):
        self.capture_all()
        self.assertTrue(self.client.call("calibrate_joint").success)
        held = self.client.held()
        self.assertEqual(self.node.stop(), 0)

        uri = f"http://localhost:{free_port()}"
        node = CalibrationNode(self.directory, environment={"ROS_MASTER_URI": uri})
        for _ in range(2):
            master = SecondMaster(uri)
            self.addCleanup(master.stop)
            master.wait_until_up((NAMESPACE, NODE))
            node.start()
            self.addCleanup(node.stop)
            self.assertEqual(master.samples_held(), sorted(held))
            # The node lives on without a master, but cannot be found by the next one.
            master.stop()
            self.assertTrue(node.alive())
            self.assertEqual(node.stop(), 0)

        self.client.start(self.node)
        self.nothing_changed(1, held)


if __name__ == "__main__":
    rospy.init_node("calibration_bad_day")
    rostest.rosrun(PACKAGE, "calibration_bad_day", BadDay, sys.argv)
