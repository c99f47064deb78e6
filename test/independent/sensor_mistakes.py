"""Mistakes of sensors beside those of mistakes.py: what moved in mid-session, readings that repeat within a turn, a turned
tilt sensor, and channels of the force/torque sensor."""

import numpy as np

from mistakes import joints_changed, torques_changed
from wired_laboratory import turn


def from_row(share, change):
    """Orientations from a part of the session on."""

    def apply(samples, _machine):
        having = [sample for sample in samples if sample.orientation is not None]
        for sample in having[int(share * len(having)) :]:
            sample.orientation = change(sample.orientation)

    return apply


def slipped(k, angle, share):
    """All readings of a joint from a part of the orientations on."""

    def apply(samples, _machine):
        orientations = sum(sample.orientation is not None for sample in samples)
        for sample in samples[int(share * orientations) :]:
            sample.q = sample.q + angle * np.eye(3)[k]

    return apply


def repeating(joints, period):
    def change(q):
        q[joints] %= period
        return q

    return joints_changed(change)


def tilt_turned(angle):
    """Channels of a two-axis tilt sensor that sits turned about the vertical."""

    def change(q):
        down = turn([0, 0, 1], -angle) @ [-np.cos(q[0]) * np.sin(q[1]), np.sin(q[0]), np.cos(q[0]) * np.cos(q[1])]
        return np.array([np.arcsin(down[1]), np.arctan2(-down[0], down[2]), q[2]])

    return joints_changed(change)


def channel(axis, factor):
    return torques_changed(lambda T, _R: T * np.where(np.arange(3) == axis, factor, 1.0))


def clipped(share, bias=0.0):
    """At a share of the largest component. `bias`: standard deviation of what is taken off each torque afterwards."""

    def apply(samples, machine):
        end = share * max(np.abs(sample.torque).max() for sample in samples if sample.torque is not None)
        generator = np.random.default_rng(len(samples))
        torques_changed(lambda T, _R: np.clip(T, -end, end) + bias * generator.standard_normal(3))(samples, machine)

    return apply


def stuck(axes):
    def apply(samples, _machine):
        having = [sample for sample in samples if sample.torque is not None]
        for sample in having:
            sample.torque = sample.torque.copy()
            sample.torque[axes] = having[0].torque[axes]

    return apply


SENSORS_LEVEL_1 = {
    "marker bumped by 10 deg": (from_row(0.5, lambda R: R @ turn([1, 2, -1], np.radians(10))), ["marker_moved"]),
    "marker bumped by 3 deg": (from_row(0.7, lambda R: R @ turn([1, -1, 2], np.radians(3))), ["marker_moved"]),
    "marker bumped by 40 deg": (from_row(0.3, lambda R: R @ turn([-1, 1, 2], np.radians(40))), ["marker_moved"]),
    "tracker bumped by 8 deg": (from_row(0.4, lambda R: turn([1, 1, 2], np.radians(8)) @ R), ["tracker_moved"]),
    "joint 1 slips by 34 deg": (slipped(0, -0.6, 0.6), ["joint_slipped:1"]),
    "joint 2 slips by 11 deg": (slipped(1, 0.2, 0.4), ["joint_slipped:2"]),
    "joint 3 repeats after half a turn": (repeating([2], np.pi), ["joint_wrapped:3"]),
    "joint 3 repeats after a quarter": (repeating([2], np.pi / 2), ["joint_wrapped:3"]),
    "all joints repeat after half a turn": (repeating([0, 1, 2], np.pi), ["joint_wrapped"]),
    "tilt sensor turned by 30 deg": (tilt_turned(np.radians(30)), ["tilt_turned"]),
    "tilt sensor turned by 140 deg": (tilt_turned(np.radians(140)), ["tilt_turned"]),
}

SENSORS_LEVEL_2 = {
    "x torque of another sign": (channel(0, -1.0), ["torque_axis:1"]),
    "z torque of another sign": (channel(2, -1.0), ["torque_axis:3"]),
    "y torque 30 % more": (channel(1, 1.3), ["torque_axis:2"]),
    "x torque half": (channel(0, 0.5), ["torque_axis:1"]),
    "torques clipped at 0.8": (clipped(0.8), ["torque_clipped"]),
    "torques clipped at 0.7, bias taken off": (clipped(0.7, 2e-4), ["torque_clipped"]),
    "torques clipped at 0.7": (clipped(0.7), ["torque_clipped"]),
    "torques clipped at 0.5": (clipped(0.5), ["torque_clipped"]),
    "torques all alike": (stuck([0, 1, 2]), ["torque_stuck"]),
    "y torques all alike": (stuck([1]), ["torque_stuck"]),
}
