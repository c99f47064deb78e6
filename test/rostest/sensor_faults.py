"""Faults of the joint sensor's device: no angle may be wrong, and the driver tells."""

import math
import time

import rospy
import yaml
from calibration_client import NAMESPACE, wait_for
from driver_node import ERROR, OK, DriverNode
from fault_laboratory import CONFIG, DIAGNOSTIC_PERIOD, Outcome
from faulty_device import READ_INPUT, FaultyDevice
from sensor_msgs.msg import JointState

COUNTS = 32768  # of 131072 in a turn
ANGLE = 2.0 * math.pi * COUNTS / 131072
PATIENCE = 20.0  # [s]


def sensor_fault(behaviour):
    """What a device with this behaviour leads to, as a function that gives an Outcome."""

    def run(_folder):
        device = FaultyDevice()
        device.registers[READ_INPUT][4:6] = [COUNTS >> 16, COUNTS & 0xFFFF]
        parameters = yaml.safe_load((CONFIG / "joint_sensor.yaml").read_text())
        parameters["link"]["port"] = device.port
        parameters["diagnostic_period"] = DIAGNOSTIC_PERIOD
        wrong, right = [], []
        expected = (0.0, 0.0, ANGLE)

        def judge(message):
            deviation = max(abs(a - b) for a, b in zip(message.position, expected))
            (right if deviation < 1e-4 else wrong).append(message)

        subscriber = rospy.Subscriber(f"{NAMESPACE}/joint_states", JointState, judge, queue_size=10000)
        driver = DriverNode("joint_sensor", parameters)
        try:
            wait_for(lambda: right and driver.level("link") == OK, "joint angles")
            begin = time.monotonic()
            device.behaviour = behaviour
            while driver.level("link") != ERROR and time.monotonic() < begin + PATIENCE:
                time.sleep(0.002)
            told = time.monotonic() - begin if driver.level("link") == ERROR else math.inf
            time.sleep(0.5)
            return Outcome(told=told, defect="wrong angles" if wrong else "")
        finally:
            subscriber.unregister()
            driver.process.kill()
            driver.close()
            device.close()

    return run
