#!/usr/bin/python3
"""lab.launch starts what is there, puts the parameters where the nodes look for them, and records."""

import glob
import os
import pathlib
import sys
import tempfile
import unittest
from xml.etree import ElementTree

import rosbag
import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, CalibrationClient, wait_for
from geometry_msgs.msg import PoseStamped, QuaternionStamped
from launch_client import Launch, configuration_of, launch_file, missing_programs, nodes_of
from recorder_links import received

NODES = ["calibration", "coil_driver", "joint_sensor", "session_engine", "tracker_bridge"]
RECORDED = {"measured_orientation", "parameters", "status", "tracker/pose"}
REGISTRATION = "0 0 0.1 0 0 0 1"


def names(nodes):
    return sorted(node.name for node in nodes)


class LaunchLab(unittest.TestCase):
    def test_every_program_is_there(self):
        nodes = nodes_of(
            launch_file("lab.launch"),
            record=True,
            stator_tracker=REGISTRATION,
            rotor_marker=REGISTRATION,
            rotor_ft_sensor=REGISTRATION,
        )
        expected = NODES + ["record", "rotor_ft_sensor", "rotor_marker", "stator_tracker"]
        self.assertEqual(names(nodes), sorted(expected))
        self.assertEqual(missing_programs(nodes), [])

    def test_views_of_others_name_what_is_there(self):
        config = pathlib.Path(launch_file("lab.launch")).parent.parent / "config"
        content = yaml.safe_load((config / "diagnostic_aggregator.yaml").read_text())
        branches = content["analyzers"]["spherical_actuator"]["analyzers"].values()
        told = [branch["find_and_remove_prefix"] for branch in branches]
        nodes = names(nodes_of(launch_file("lab.launch"), controller=True))
        self.assertEqual(sorted(told), [f"actuator/{name}: " for name in nodes if name != "session_engine"])
        layout = ElementTree.parse(config / "plotjuggler_layout.xml")
        shown = [curve.get("name") for curve in layout.iter("curve")]
        measured = [f"joint_states/joint_{k}/position" for k in (1, 2, 3)]
        measured += [f"measured_orientation/quaternion/{part}" for part in "xyzw"]
        measured += [f"measured_torque/vector/{part}" for part in "xyz"]
        for topic in ("coil_command", "coil_currents"):
            measured += [f"{topic}/current[{coil}]" for coil in range(24)]
        self.assertEqual(shown, [f"{NAMESPACE}/{name}" for name in measured])

    def test_arguments_choose_what_is_started(self):
        path = launch_file("lab.launch")
        self.assertEqual(names(nodes_of(path)), NODES)
        self.assertEqual(names(nodes_of(path, drivers=False)), ["calibration", "session_engine", "tracker_bridge"])
        self.assertNotIn("session_engine", names(nodes_of(path, engine=False)))
        without = [name for name in NODES if name != "joint_sensor"]
        self.assertEqual(names(nodes_of(path, joint_sensor=False)), without)
        self.assertIn("rviz", names(nodes_of(path, rviz=True)))
        self.assertEqual({node.namespace for node in nodes_of(path, ns="second")}, {"/second/"})

    def test_emulated_laboratories_run_side_by_side_and_end_with_their_emulators(self):
        config = configuration_of(
            launch_file("emulated_lab.launch"), joint_sensor_port=4711, coil_driver_port=4712
        )
        required = {node.name for node in config.nodes if node.required}
        self.assertEqual(required, {"lab_emulator"})
        ports = {name: value.value for name, value in config.params.items() if name.endswith("link/port")}
        expected = {
            "joint_sensor/link/port": 4711,
            "lab_emulator/joint_sensor/link/port": 4711,
            "coil_driver/link/port": 4712,
            "lab_emulator/coil_driver/link/port": 4712,
        }
        self.assertEqual(ports, {f"{NAMESPACE}/{name}": port for name, port in expected.items()})

    def test_runs_and_records(self):
        with tempfile.TemporaryDirectory() as folder:
            launch = Launch(
                launch_file("lab.launch"),
                environment={"ROS_HOME": folder},
                drivers=False,
                record=True,
                frame_prefix="unit_1/",
                stator_tracker=REGISTRATION,
                rotor_marker=REGISTRATION,
            )
            self.addCleanup(launch.stop)
            self.check_session()
            launch.stop()
            self.check_recording(os.path.join(folder, PACKAGE, "unit-001"))

    def check_session(self):
        client = CalibrationClient()
        wait_for(lambda: client.latest("status") and client.latest("parameters"), "status, parameters")
        self.assertEqual(client.latest("parameters").header.frame_id, "unit_1/stator")
        measured = []
        rospy.Subscriber(f"{NAMESPACE}/measured_orientation", QuaternionStamped, measured.append)
        poses = rospy.Publisher(f"{NAMESPACE}/tracker/pose", PoseStamped, queue_size=10)
        # The bridge, and the recorder.
        wait_for(lambda: poses.get_num_connections() == 2, "subscribers of the tracker")
        message = PoseStamped()
        message.header.frame_id = "unit_1/tracker"
        message.pose.orientation.w = 1.0

        def is_measured():
            message.header.stamp = rospy.Time.now()
            poses.publish(message)
            return measured

        wait_for(is_measured, "measured orientation")
        self.assertEqual(measured[0].header.frame_id, "unit_1/stator")
        for topic in self.recorded_topics():
            wait_for(lambda: is_measured() and received(topic), f"a recorded message of {topic}")  # noqa: B023

    @staticmethod
    def recorded_topics():
        return {f"{NAMESPACE}/{stream}" for stream in RECORDED} | {"/tf_static"}

    def check_recording(self, directory):
        self.assertTrue(os.path.exists(os.path.join(directory, "session.db")))
        bags = glob.glob(os.path.join(directory, "recordings", "session_*.bag"))
        self.assertEqual(len(bags), 1, os.listdir(directory))
        with rosbag.Bag(bags[0]) as bag:
            recorded = set(bag.get_type_and_topic_info().topics)
        self.assertLessEqual(self.recorded_topics(), recorded)


if __name__ == "__main__":
    rospy.init_node("launch_lab_test")
    rostest.rosrun(PACKAGE, "launch_lab", LaunchLab, sys.argv)
