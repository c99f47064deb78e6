#!/usr/bin/python3
"""The bridge gives what a recording holds, and refuses, with the reason, what cannot be true."""

import os
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy
import rostest
from calibration_client import DEADLINE, NAMESPACE, PACKAGE, program, run_tool, wait_for
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import (
    PoseStamped,
    QuaternionStamped,
    TransformStamped,
    Vector3Stamped,
    WrenchStamped,
)
from tf2_msgs.msg import TFMessage

NODE = NAMESPACE + "/tracker_bridge"
TOLERANCE = 1e-12
RAW = {"tracker/pose": PoseStamped, "ft_sensor/wrench": WrenchStamped}
MEASURED = {"measured_orientation": QuaternionStamped, "measured_torque": Vector3Stamped}
SESSION = {
    "seed": 5,
    "joint-poses": 2,
    "main-coil-poses": 1,
    "coil-poses": 0,
    "validation-poses": 0,
    "tracker-rate": 240,
    "wrench-rate": 1000,
    "joint-rate": 10,
    "current-rate": 10,
}


class BridgeProcess:
    """The program, started and ended by the test."""

    def __init__(self, stderr=subprocess.DEVNULL, **private_parameters):
        rospy.set_param(NODE, private_parameters)
        self.process = subprocess.Popen(
            [program("tracker_bridge"), "__name:=tracker_bridge"],
            env={**os.environ, "ROS_NAMESPACE": NAMESPACE},
            stderr=stderr,
            text=True,
        )

    def stop(self):
        self.process.terminate()
        return self.process.wait(timeout=DEADLINE)


class Bench:
    """Publishes raw measurements, and keeps what the bridge makes of them, by stamp."""

    def __init__(self):
        self.measured = {topic: {} for topic in MEASURED}
        self.diagnostics = {}
        self.publishers = {
            topic: rospy.Publisher(f"{NAMESPACE}/{topic}", message, queue_size=100000)
            for topic, message in RAW.items()
        }
        self.transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        self.subscribers = [
            rospy.Subscriber(
                f"{NAMESPACE}/{topic}", message, self._keep, topic, queue_size=100000
            )
            for topic, message in MEASURED.items()
        ]
        self.subscribers.append(
            rospy.Subscriber("/diagnostics", DiagnosticArray, self._keep_diagnostics)
        )

    def close(self):
        for each in self.subscribers + list(self.publishers.values()) + [self.transforms]:
            each.unregister()

    def _keep(self, message, topic):
        self.measured[topic][message.header.stamp] = message

    def _keep_diagnostics(self, message):
        for status in message.status:
            self.diagnostics[status.name.split(": ")[-1]] = status

    def wait_for_bridge(self):
        def connected():
            return all(
                each.get_num_connections() == 1 for each in self.publishers.values()
            ) and all(each.get_num_connections() == 1 for each in self.subscribers[: len(MEASURED)])

        wait_for(connected, "connections of the bridge")

    def value(self, task, key):
        status = self.diagnostics.get(task)
        return {value.key: value.value for value in status.values}.get(key) if status else None


def transform(parent, child, translation=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0, 1.0)):
    message = TransformStamped()
    message.header.frame_id = parent
    message.child_frame_id = child
    offset, turn = message.transform.translation, message.transform.rotation
    offset.x, offset.y, offset.z = translation
    turn.x, turn.y, turn.z, turn.w = rotation
    return message


def numbers(message):
    """Content of a measured message, as numbers."""
    if hasattr(message, "quaternion"):
        q = message.quaternion
        return (q.x, q.y, q.z, q.w)
    return (message.vector.x, message.vector.y, message.vector.z)


class TrackerBridge(unittest.TestCase):
    def setUp(self):
        self.bench = Bench()
        self.addCleanup(self.bench.close)
        self.now = rospy.Time.now()

    def start(self, registrations=(), transform_wait=10.0, **private_parameters):
        if registrations:
            self.bench.transforms.publish(TFMessage(list(registrations)))
        bridge = BridgeProcess(diagnostic_period=0.05, transform_wait=transform_wait, **private_parameters)
        self.addCleanup(bridge.stop)
        self.bench.wait_for_bridge()
        # It waits a while for a transform, but not for ever.
        if any(each.child_frame_id == "marker" for each in registrations):
            self.wait_for_registration("rotor to marker")
        return bridge

    def wait_for_registration(self, name):
        """Until the bridge has received it, and whatever else was published with it."""
        wait_for(lambda: self.bench.value("registrations", name) == "known", name)

    def pose(self, milliseconds, frame="tracker", x=0.0, w=1.0):
        message = PoseStamped()
        message.header.stamp = self.now + rospy.Duration(nsecs=milliseconds * 1000000)
        message.header.frame_id = frame
        message.pose.orientation.x = x
        message.pose.orientation.w = w
        return message

    def wrench(self, milliseconds, frame="ft_sensor"):
        message = WrenchStamped()
        message.header.stamp = self.now + rospy.Duration(nsecs=milliseconds * 1000000)
        message.header.frame_id = frame
        message.wrench.force.x = 2.0
        message.wrench.torque.z = 0.5
        return message

    def send_pose(self, *arguments, **keys):
        self.bench.publishers["tracker/pose"].publish(self.pose(*arguments, **keys))

    def send_wrench(self, *arguments, **keys):
        self.bench.publishers["ft_sensor/wrench"].publish(self.wrench(*arguments, **keys))

    def wait_for_measured(self, topic, count):
        wait_for(lambda: len(self.bench.measured[topic]) >= count, f"{count} of {topic}")

    def wait_for_refusal(self, task, text, count):
        """Until so many messages were refused, the last one for this reason."""

        def refused():
            return (
                self.bench.value(task, "refused") == str(count)
                and text in self.bench.value(task, "last refusal")
            )

        wait_for(refused, f"refusal {count} of {task}: {text}; {self.bench.diagnostics.get(task)}")

    def assert_measured(self, topic, stamp, expected):
        found = numbers(self.bench.measured[topic][stamp])
        for value, wanted in zip(found, expected):
            self.assertAlmostEqual(value, wanted, delta=TOLERANCE, msg=topic)

    def test_gives_what_the_recording_holds(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "session.bag")
            description = os.path.join(rospy.get_param("~config"), "pm_spherical_8x24.yaml")
            run_tool("simulate_recording", actuator=description, output=path, **SESSION)
            with rosbag.Bag(path) as bag:
                recorded = list(bag.read_messages())
        # tracker/pose and so on: without the namespace.
        messages = [(topic[len(NAMESPACE) + 1 :], message) for topic, message, _ in recorded]
        registrations = [m for topic, m, _ in recorded if topic == "/tf_static"]
        self.start(registrations[0].transforms)
        for topic, message in messages:
            if topic in RAW:
                self.bench.publishers[topic].publish(message)
        for topic in MEASURED:
            expected = [message for name, message in messages if name == topic]
            self.assertGreater(len(expected), 1000)
            self.wait_for_measured(topic, len(expected))
            self.assertEqual(len(self.bench.measured[topic]), len(expected))
            for message in expected:
                found = self.bench.measured[topic][message.header.stamp]
                self.assertEqual(found.header.frame_id, message.header.frame_id)
                self.assert_measured(topic, message.header.stamp, numbers(message))

    def test_refuses_what_cannot_be_true_and_says_why(self):
        registrations = [
            transform("stator", "tracker"),
            transform("rotor", "marker"),
            transform("rotor", "ft_sensor"),
        ]
        self.start(registrations, frames={"tracker": "tracker", "ft_sensor": "ft_sensor"})
        self.send_pose(0)
        self.wait_for_measured("measured_orientation", 1)
        refused = [
            (self.pose(10, frame="camera"), 'in the frame "camera", not in "tracker"'),
            (self.pose(20, frame=""), "names no frame"),
            (self.pose(30, w=1.01), "norm"),
            (self.pose(40, w=float("nan")), "not finite"),
            (self.pose(0), "repeated"),
            (self.pose(-10), "late"),
            (self.pose(50, x=1.0, w=0.0), "jumped"),
        ]
        for count, (message, reason) in enumerate(refused, start=1):
            self.bench.publishers["tracker/pose"].publish(message)
            self.wait_for_refusal("tracker/pose", reason, count)
        self.send_pose(60)
        self.wait_for_measured("measured_orientation", 2)

        self.send_wrench(0)
        self.wait_for_measured("measured_torque", 1)
        bad = self.wrench(20)
        bad.wrench.torque.y = float("inf")
        refused = [
            (self.wrench(10, frame="tool"), 'in the frame "tool", not in "ft_sensor"'),
            (bad, "not finite"),
            (self.wrench(-10), "late"),
        ]
        for count, (message, reason) in enumerate(refused, start=1):
            self.bench.publishers["ft_sensor/wrench"].publish(message)
            self.wait_for_refusal("ft_sensor/wrench", reason, count)
        self.send_wrench(30)
        self.wait_for_measured("measured_torque", 2)

    def test_believes_a_new_place_that_is_confirmed(self):
        self.start([transform("stator", "tracker"), transform("rotor", "marker")])
        self.send_pose(0)
        self.wait_for_measured("measured_orientation", 1)
        for k in range(1, 5):
            self.send_pose(k, x=1.0, w=0.0)
            self.wait_for_refusal("tracker/pose", "jumped", k)
        self.send_pose(5, x=1.0, w=0.0)
        self.wait_for_measured("measured_orientation", 2)

    def test_names_the_transform_that_is_missing(self):
        frames = {"tracker": "tracker", "ft_sensor": "ft_sensor"}
        self.start([transform("stator", "tracker")], transform_wait=0.01, frames=frames)
        # It is the other one that is missing.
        self.wait_for_registration("stator to tracker")
        self.send_pose(0)
        self.wait_for_refusal("tracker/pose", "static_transform_publisher", 1)
        self.assertIn("rotor marker", self.bench.value("tracker/pose", "last refusal"))
        self.send_wrench(0)
        self.wait_for_refusal("ft_sensor/wrench", "rotor ft_sensor", 1)

        def tells():
            status = self.bench.diagnostics["registrations"]
            return status.level == DiagnosticStatus.ERROR and "rotor marker" in status.message

        wait_for(tells, "registrations in error")
        self.assertEqual(self.bench.value("registrations", "stator to tracker"), "known")
        # As soon as it is published, measurements go on.
        self.bench.transforms.publish(
            TFMessage([transform("rotor", "marker"), transform("rotor", "ft_sensor")])
        )
        wait_for(
            lambda: self.bench.diagnostics["registrations"].level == DiagnosticStatus.OK,
            "all registrations",
        )
        self.send_pose(10)
        self.send_wrench(10)
        self.wait_for_measured("measured_orientation", 1)
        self.wait_for_measured("measured_torque", 1)

    def test_waits_a_moment_for_a_transform(self):
        self.start()
        self.send_pose(0)
        wait_for(
            lambda: self.bench.value("registrations", "stator to tracker") == "missing",
            "the bridge to look for the transform",
        )
        registrations = [transform("stator", "tracker"), transform("rotor", "marker")]
        self.bench.transforms.publish(TFMessage(registrations))
        self.wait_for_measured("measured_orientation", 1)

    def test_turns_the_torque_of_a_sensor_under_the_stator(self):
        # 2 N along x, 0.1 m below the centre, turn the stator about -y, and the rotor, the other
        # way, about y; this is the rotor's -z when it lies a quarter about x.
        registrations = [
            transform("stator", "tracker"),
            transform("rotor", "marker"),
            transform("stator", "ft_sensor", translation=(0.0, 0.0, -0.1)),
        ]
        self.start(registrations, ft_sensor_mount="stator")
        half = 0.5**0.5
        self.send_wrench(5)
        self.send_pose(0, x=half, w=half)
        self.send_pose(10, x=half, w=half)
        self.wait_for_measured("measured_torque", 1)
        stamp = self.wrench(5).header.stamp
        self.assert_measured("measured_torque", stamp, (0.0, -0.5, -0.2))

    def test_tells_a_wrong_configuration_and_ends(self):
        bridge = BridgeProcess(stderr=subprocess.PIPE, ft_sensor_mont="rotor").process
        _, message = bridge.communicate(timeout=DEADLINE)
        self.assertEqual(bridge.returncode, 1)
        self.assertIn("ft_sensor_mont", message)

    def test_ends_in_order(self):
        bridge = self.start()
        self.assertEqual(bridge.stop(), 0)


if __name__ == "__main__":
    rospy.init_node("tracker_bridge_test")
    rostest.rosrun(PACKAGE, "tracker_bridge", TrackerBridge, sys.argv)
