"""The four streams of an actuator that is made exactly as drawn, under control of a test."""

import math
import random
import threading
import time

import rospy
from calibration_client import NAMESPACE, wait_for
from geometry_msgs.msg import QuaternionStamped, Vector3Stamped
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import CoilCurrents

COILS = 24
MESSAGES = {
    "joint_states": JointState,
    "measured_orientation": QuaternionStamped,
    "measured_torque": Vector3Stamped,
    "coil_currents": CoilCurrents,
}
JOINT_NOISE = 1e-5  # [rad]
ANGLE_NOISE = 1e-4  # [rad]
TORQUE_NOISE = 1e-3  # [N*m]
CURRENT_NOISE = 1e-3  # [A]


def rotation(angles):
    """Quaternion (x, y, z, w) of the turns about x, y and z, in this order from the stator."""
    (sx, sy, sz), (cx, cy, cz) = (
        [function(angle / 2.0) for angle in angles] for function in (math.sin, math.cos)
    )
    return (
        sx * cy * cz + cx * sy * sz,
        cx * sy * cz - sx * cy * sz,
        cx * cy * sz + sx * sy * cz,
        cx * cy * cz - sx * sy * sz,
    )


class EmulatedStreams:
    """Publishes from construction on; every attribute may be changed meanwhile.

    Its time goes on by one period with every measurement: on a busy computer it lags behind the clock, and its
    streams have no holes."""

    def __init__(self, rate=100.0, seed=1):
        self.joint_position = [0.0, 0.0, 0.0]
        self.tremble = 0.0  # [rad] of every joint
        self.current = [0.0] * COILS
        self.silent = set()  # streams that publish nothing
        self.spoil = {}  # stream -> function that changes its messages
        self.stamp_offset = 0.0  # [s]
        self.newest = rospy.Time()  # stamp of what was measured last
        self._period = 1.0 / rate
        self._count = 0  # measurements of each stream so far
        self._random = random.Random(seed)
        self._publishers = {
            topic: rospy.Publisher(f"{NAMESPACE}/{topic}", message, queue_size=1000)
            for topic, message in MESSAGES.items()
        }
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._thread.join()

    def move_to(self, joint_position):
        self.joint_position = list(joint_position)

    def rest(self, duration):
        """Returns after so many seconds of the streams."""
        end = self._count + duration / self._period
        wait_for(lambda: self._count > end, f"streams of {duration} s")

    def _run(self):
        begin_of_stamps, begin = rospy.Time.now(), time.monotonic()
        while not self._stop.is_set():
            elapsed = self._count * self._period
            self._publish(begin_of_stamps + rospy.Duration(elapsed + self.stamp_offset))
            self._count += 1
            self._stop.wait(max(0.0, begin + elapsed + self._period - time.monotonic()))

    def _publish(self, stamp):
        messages = self._measure()
        self.newest = stamp
        for topic, message in messages.items():
            message.header.stamp = stamp
            # Looked up once: a test may take it away meanwhile.
            spoil = self.spoil.get(topic)
            if spoil:
                spoil(message)
            if topic not in self.silent:
                self._publishers[topic].publish(message)

    def _measure(self):
        noise = self._random.gauss
        true = [q + self._random.uniform(-1.0, 1.0) * self.tremble for q in self.joint_position]
        joints = JointState(name=["joint_1", "joint_2", "joint_3"])
        joints.position = [q + noise(0.0, JOINT_NOISE) for q in true]
        orientation = QuaternionStamped()
        orientation.header.frame_id = "stator"
        q = orientation.quaternion
        q.x, q.y, q.z, q.w = rotation([angle + noise(0.0, ANGLE_NOISE) for angle in true])
        torque = Vector3Stamped()
        torque.header.frame_id = "rotor"
        t = torque.vector
        t.x, t.y, t.z = (noise(0.0, TORQUE_NOISE) for _ in range(3))
        currents = CoilCurrents(current=[i + noise(0.0, CURRENT_NOISE) for i in self.current])
        return dict(zip(MESSAGES, (joints, orientation, torque, currents)))
