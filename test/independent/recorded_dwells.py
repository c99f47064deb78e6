"""Recordings of dwells as a laboratory's bridge publishes them, drawn by the laboratory of laboratory.py: streams of
single measurements with their noise, from which the package has to make samples itself."""

import dataclasses

import genpy
import laboratory
import numpy as np
import rosbag
from geometry_msgs.msg import QuaternionStamped, Vector3Stamped
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import CoilCurrents

MOVE, WITHOUT_CURRENT, EXCITED = 0.8, 0.55, 0.7  # [s] what a pose consists of


@dataclasses.dataclass
class Streams:
    """Rates [Hz] and standard deviations of single measurements."""

    joint_rate: float = 50.0
    orientation_rate: float = 50.0
    torque_rate: float = 100.0
    current_rate: float = 50.0
    joint: float = 2e-5  # [rad]
    encoder_bits: int = 0  # 0: no quantisation
    orientation: float = 1e-3  # [rad] per component
    torque: float = 3e-3  # [N m] per component
    bias: float = 0.05  # [N m] of the sensor, one for all


class Pose:
    """What rests at one place: joint angles, orientation, and the torque of each current pattern."""

    def __init__(self, unit, errors, q, coils, ampere):
        self.q = q
        self.R = unit.orientation(errors, q)
        self.patterns = [{}] + [{int(coil): ampere} for coil in coils]
        self.torques = [unit.torque(errors, self.R, current) for current in self.patterns]


class Recorder:
    def __init__(self, path, unit, streams, rng):
        self.bag = rosbag.Bag(path, "w")
        self.coils = len(unit.coils)
        self.streams = streams
        self.rng = rng
        self.time = 1000.0
        self.q = np.zeros(3)

    def close(self):
        self.bag.close()

    def write(self, topic, time, message, frame):
        stamp = genpy.Time.from_sec(time)
        message.header.stamp = stamp
        message.header.frame_id = frame
        self.bag.write("/actuator/" + topic, message, stamp)

    def times(self, rate, duration):
        return self.time + np.arange(round(duration * rate)) / rate

    def joints(self, q_of, duration):
        step = 2.0 * np.pi / 2**self.streams.encoder_bits if self.streams.encoder_bits else 0.0
        for time in self.times(self.streams.joint_rate, duration):
            reading = q_of(time) + self.rng.normal(0.0, self.streams.joint, 3)
            reading = np.round(reading / step) * step if step else reading
            names = ["joint_1", "joint_2", "joint_3"]
            self.write("joint_states", time, JointState(name=names, position=list(reading)), "")

    def orientations(self, R, duration):
        for time in self.times(self.streams.orientation_rate, duration):
            noise = laboratory.rotation(self.rng.normal(0.0, self.streams.orientation, 3))
            message = QuaternionStamped()
            quaternion = message.quaternion
            quaternion.x, quaternion.y, quaternion.z, quaternion.w = laboratory.quaternion_xyzw(noise @ R)
            self.write("measured_orientation", time, message, "stator")

    def torques(self, torque, duration):
        for time in self.times(self.streams.torque_rate, duration):
            message = Vector3Stamped()
            vector = torque + self.streams.bias + self.rng.normal(0.0, self.streams.torque, 3)
            message.vector.x, message.vector.y, message.vector.z = vector
            self.write("measured_torque", time, message, "rotor")

    def currents(self, current, duration):
        values = np.zeros(self.coils)
        for coil, ampere in current.items():
            values[coil] = ampere
        for time in self.times(self.streams.current_rate, duration):
            self.write("coil_currents", time, CoilCurrents(current=list(values)), "")

    def move_to(self, pose):
        begin, start = self.time, self.q
        self.joints(lambda time: start + (pose.q - start) * (time - begin) / MOVE, MOVE)
        self.currents({}, MOVE)
        self.time += MOVE
        self.q = pose.q

    def rest_at(self, pose):
        for current, torque in zip(pose.patterns, pose.torques):
            duration = EXCITED if current else WITHOUT_CURRENT
            self.joints(lambda _: pose.q, duration)
            self.orientations(pose.R, duration)
            self.torques(torque, duration)
            self.currents(current, duration)
            self.time += duration


def record(path, unit, errors, streams, poses, coils_per_pose, rng, ampere=2.0):
    recorder = Recorder(path, unit, streams, rng)
    for q in poses:
        pose = Pose(unit, errors, q, laboratory.coils_in_reach(unit, q, coils_per_pose), ampere)
        recorder.move_to(pose)
        recorder.rest_at(pose)
    recorder.close()
