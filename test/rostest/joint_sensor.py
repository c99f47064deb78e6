#!/usr/bin/python3
"""The joint sensor node against an independent Modbus device, over TCP and over a serial line."""

import math
import sys
import unittest

import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from driver_node import ERROR, OK, RESPONSE_TIMEOUT, DriverNode
from links import free_port
from modbus_device import ModbusDevice, RudeServer, SerialPair
from sensor_msgs.msg import JointState

UNIT = 1
COUNT_FOR_A_RATE = 100
COUNTS_PER_TURN = 131072
TURN = 2.0 * math.pi


def signed_words(value):
    value &= 0xFFFFFFFF
    return [value >> 16, value & 0xFFFF]


def set_pose(device, q):
    """What the sensors of config/joint_sensor.yaml hold at joint angles q."""
    x = q[0]
    y = math.asin(math.cos(q[0]) * math.sin(q[1]))
    counts = round(q[2] / TURN * COUNTS_PER_TURN) % COUNTS_PER_TURN
    words = signed_words(round(x * 1e6)) + signed_words(round(y * 1e6)) + signed_words(counts)
    device.input.setValues(0, words)


class JointSensor(unittest.TestCase):
    def setUp(self):
        self.received = []
        self.device = ModbusDevice(UNIT)
        self.port = free_port()
        self.subscriber = rospy.Subscriber(
            NAMESPACE + "/joint_states", JointState, self.received.append, queue_size=10000
        )
        self.addCleanup(self.subscriber.unregister)
        self.addCleanup(self.device.stop)

    def start(self, response_timeout=RESPONSE_TIMEOUT, **changes):
        parameters = rospy.get_param("/shipped/joint_sensor")
        parameters["diagnostic_period"] = 0.1
        parameters["link"].update(port=self.port, response_timeout=response_timeout)
        parameters.update(changes)
        node = DriverNode("joint_sensor", parameters)
        self.addCleanup(node.close)
        return node

    def wait_for_pose(self, q):
        def is_there():
            return self.received and all(
                abs(a - b) < 1e-4 for a, b in zip(self.received[-1].position, q)
            )

        wait_for(is_there, f"joint states {q}")

    def check_stamps(self):
        stamps = [message.header.stamp for message in self.received]
        self.assertEqual(stamps, sorted(set(stamps)), "stamps increase")
        wait_for(lambda: abs((rospy.Time.now() - self.received[-1].header.stamp).to_sec()) < 1.0, "a fresh stamp")

    def attained_rate(self):
        """What device, node and computer give just now [Hz], by the stamps of further joint states."""
        begin = len(self.received)
        wait_for(lambda: len(self.received) > begin + COUNT_FOR_A_RATE, "further joint states")
        stamps = [message.header.stamp.to_sec() for message in self.received[begin:]]
        return (len(stamps) - 1) / (stamps[-1] - stamps[0])

    def test_reads_angles_over_tcp(self):
        self.device.start_tcp(self.port)
        node = self.start()
        for q in ([0.0, 0.0, 0.0], [0.3, -0.2, 1.0], [-0.5, 0.4, -1.5]):
            set_pose(self.device, q)
            self.wait_for_pose(q)
        self.assertEqual(self.received[-1].name, ["joint_1", "joint_2", "joint_3"])
        self.check_stamps()
        node.wait_for_level("link", OK)

    def test_a_rate_that_is_kept_is_good(self):
        self.device.start_tcp(self.port)
        node = self.start()
        rate = self.attained_rate()
        node.close()
        node = self.start(rate=0.5 * rate)
        node.wait_for_level("joint_states", OK)

    def test_reads_angles_over_a_serial_line(self):
        pair = SerialPair()
        self.addCleanup(pair.close)
        self.device.start_serial(pair.device_end)
        link = {"type": "rtu", "device": pair.driver_end, "baud": 115200, "parity": "none"}
        link["response_timeout"] = RESPONSE_TIMEOUT
        self.start(link=link, rate=50.0)
        for q in ([0.3, -0.2, 1.0], [-0.5, 0.4, -2.0]):
            set_pose(self.device, q)
            self.wait_for_pose(q)
        self.check_stamps()

    def test_encoder_goes_on_through_its_end(self):
        self.device.start_tcp(self.port)
        self.start()
        angle = 0.0
        while angle < 8.0:
            set_pose(self.device, [0.0, 0.0, angle])
            self.wait_for_pose([0.0, 0.0, angle])
            angle += 1.0

    def test_a_device_may_vanish_and_return(self):
        self.device.start_tcp(self.port)
        node = self.start()
        set_pose(self.device, [0.1, 0.2, 0.3])
        self.wait_for_pose([0.1, 0.2, 0.3])
        self.device.stop()
        gone = rospy.Time.now()
        node.wait_for_level("link", ERROR)
        wait_for(lambda: int(node.value("link", "failures")) >= 4, "further attempts")
        set_pose(self.device, [0.4, 0.2, 0.3])
        back = rospy.Time.now()
        self.device.start_tcp(self.port)
        node.wait_for_level("link", OK)
        self.wait_for_pose([0.4, 0.2, 0.3])
        # By their stamps: what was read before may be received later than the diagnostics that tell the loss. One
        # reading may have been on its way.
        without = [message for message in self.received if gone < message.header.stamp < back]
        self.assertLessEqual(len(without), 1, "nothing is published without a device")
        self.assertEqual(node.value("link", "reconnects"), "1")
        self.check_stamps()

    def test_starts_before_its_device(self):
        node = self.start()
        node.wait_for_level("link", ERROR)
        set_pose(self.device, [0.1, 0.2, 0.3])
        self.device.start_tcp(self.port)
        self.wait_for_pose([0.1, 0.2, 0.3])

    def test_an_exception_of_the_device_is_told(self):
        self.device.start_tcp(self.port)
        encoder = {"joint": 3, "unit": UNIT, "table": "input", "address": 5000, "type": "uint32"}
        node = self.start(encoders=[{**encoder, "scale": 1.0}])
        node.wait_for_level("link", ERROR)
        wait_for(lambda: "Illegal data address" in node.message("link"), "the reason")
        self.assertEqual(self.received, [])

    def test_a_silent_device_is_told(self):
        server = RudeServer(self.port, b"")
        self.addCleanup(server.close)
        node = self.start(response_timeout=0.1)
        node.wait_for_level("link", ERROR)
        wait_for(lambda: "timed out" in node.message("link"), "the timeout in words")
        self.assertEqual(self.received, [])

    def test_garbage_is_never_taken_for_an_answer(self):
        server = RudeServer(self.port, bytes(range(1, 40)))
        self.addCleanup(server.close)
        node = self.start(response_timeout=0.1)
        node.wait_for_level("link", ERROR)
        wait_for(lambda: server.requests >= 3, "further attempts")
        self.assertEqual(self.received, [])

    def test_readings_that_no_pose_has_are_refused(self):
        self.device.start_tcp(self.port)
        self.device.input.setValues(0, signed_words(1400000) + signed_words(1400000) + [0, 0])
        node = self.start()
        wait_for(lambda: node.level("joint_states") is not None, "diagnostics")
        wait_for(lambda: int(node.value("joint_states", "refused")) > 0, "a refusal")
        self.assertIn("which no pose has", node.value("joint_states", "last refusal"))
        self.assertEqual(self.received, [])

    def test_a_wrong_key_ends_the_node_with_its_name(self):
        node = self.start(rat=100.0)
        error = node.wait_for_end()
        self.assertEqual(node.process.returncode, 1)
        self.assertIn("rat: the key is unknown", error)

    def test_a_rotor_without_joints_has_none_to_read(self):
        described = rospy.get_param(NAMESPACE + "/actuator")
        self.addCleanup(rospy.set_param, NAMESPACE + "/actuator", described)
        rospy.set_param(NAMESPACE + "/actuator", rospy.get_param("/levitated/actuator"))
        node = self.start()
        error = node.wait_for_end()
        self.assertEqual(node.process.returncode, 1)
        self.assertIn("has no joints", error)
        self.assertIn("joint_sensor:=false", error)


if __name__ == "__main__":
    rospy.init_node("joint_sensor_test")
    rostest.rosrun(PACKAGE, "joint_sensor", JointSensor, sys.argv)
