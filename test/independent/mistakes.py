"""Mistakes that laboratories make, done to sessions of wired_laboratory.py. Joints, poles and coils count from 1 in causes."""

import itertools

import numpy as np

from wired_laboratory import quaternion, rotation_of, turn


def joints_changed(change):
    def apply(samples, _machine):
        for sample in samples:
            sample.q = change(sample.q.copy())

    return apply


def orientations_changed(change):
    def apply(samples, _machine):
        for sample in samples:
            if sample.orientation is not None:
                sample.orientation = change(sample.orientation)

    return apply


def torques_changed(change):
    def apply(samples, machine):
        for sample in samples:
            if sample.torque is not None:
                sample.torque = change(sample.torque, machine.orientation(sample.q))

    return apply


def currents_changed(change):
    """The recorded currents are not those that flowed."""

    def apply(samples, _machine):
        for sample in samples:
            if sample.current is not None:
                sample.current = change(sample.current.copy())

    return apply


def _true_machine(change):
    """The machine itself is not as drawn: what was measured on it is measured again."""

    def apply(samples, machine):
        change(machine)
        for sample in samples:
            if sample.torque is not None:
                sample.torque = machine.torque(machine.orientation(sample.q), sample.current)

    return apply


def joint_sign(k):
    def change(q):
        q[k] *= -1
        return q

    return joints_changed(change)


def joint_swap(k, other):
    def change(q):
        q[[k, other]] = q[[other, k]]
        return q

    return joints_changed(change)


def joint_scale(k, factor):
    def change(q):
        q[k] *= factor
        return q

    return joints_changed(change)


def joint_index(k, angle):
    def change(q):
        q[k] += angle
        return q

    return joints_changed(change)


def quaternion_order():
    def change(rotation):
        x, y, z, w = quaternion(rotation)
        return rotation_of([w, x, y, z])

    return orientations_changed(change)


def coil_sign(j):
    def change(current):
        current[j] *= -1
        return current

    return currents_changed(change)


def coil_swap(i, j):
    def change(current):
        current[[i, j]] = current[[j, i]]
        return current

    return currents_changed(change)


def coil_strength(j, strength):
    def change(machine):
        machine.coil_strength[j] = strength

    return _true_machine(change)


def pole_strength(i, strength):
    def change(machine):
        machine.pole_strength[i] *= strength

    return _true_machine(change)


def rows_shifted(what, rows):
    def apply(samples, _machine):
        having = [sample for sample in samples if getattr(sample, what) is not None]
        values = [getattr(sample, what) for sample in having]
        for n, sample in enumerate(having):
            setattr(sample, what, values[(n + rows) % len(values)])

    return apply


def both(*mistakes):
    def apply(samples, machine):
        for mistake in mistakes:
            mistake(samples, machine)

    return apply


def tracker_frame(rotation):
    return orientations_changed(lambda R: rotation @ R)


def marker_frame(rotation):
    return orientations_changed(lambda R: R @ rotation)


def torque_frame(rotation):
    return torques_changed(lambda T, _R: rotation @ T)


X, Y, Z = np.eye(3)

# Name: what is done, and the causes of which one at least must be named (all of a tuple).
LEVEL_1 = {
    "joint_1 counts backwards": (joint_sign(0), ["joint_sign:1"]),
    "joint_2 counts backwards": (joint_sign(1), ["joint_sign:2"]),
    "joint_3 counts backwards": (joint_sign(2), ["joint_sign:3"]),
    "joints 1 and 2 exchanged": (joint_swap(0, 1), ["joint_swap:1:2"]),
    "joints 1 and 3 exchanged": (joint_swap(0, 2), ["joint_swap:1:3"]),
    "joints 2 and 3 exchanged": (joint_swap(1, 2), ["joint_swap:2:3"]),
    "degrees": (joints_changed(np.degrees), ["joint_degrees"]),
    "encoder counts twice": (joint_scale(2, 2.0), ["joint_scale:3"]),
    "encoder counts half": (joint_scale(2, 0.5), ["joint_scale:3"]),
    "tilt 1 in 20 %": (joint_scale(0, 1.2), ["joint_scale:1"]),
    "index mark 30 deg off": (joint_index(2, np.radians(30)), ["joint_index:3"]),
    "index mark of joint 1": (joint_index(0, 0.5), ["joint_index:1"]),
    "index mark of joint 2": (joint_index(1, -0.4), ["joint_index:2"]),
    "inverse orientation": (orientations_changed(lambda R: R.T), ["orientation_inverted"]),
    "w x y z": (quaternion_order(), ["quaternion_order"]),
    "tracker 90 deg about x": (tracker_frame(turn(X, np.pi / 2)), ["tracker_frame"]),
    "tracker 90 deg about z": (tracker_frame(turn(Z, np.pi / 2)), ["tracker_frame"]),
    "tracker 180 deg about y": (tracker_frame(turn(Y, np.pi)), ["tracker_frame"]),
    "tracker with other axes": (tracker_frame(turn([1, 1, 1], 2 * np.pi / 3)), ["tracker_frame"]),
    "tracker 25 deg askew": (tracker_frame(turn([1, 2, -1], np.radians(25))), ["tracker_frame"]),
    "marker 90 deg about y": (marker_frame(turn(Y, np.pi / 2)), ["marker_frame"]),
    "marker 90 deg about z": (marker_frame(turn(Z, np.pi / 2)), ["marker_frame"]),
    "marker 180 deg about x": (marker_frame(turn(X, np.pi)), ["marker_frame"]),
    "orientations one row late": (rows_shifted("orientation", -1), ["rows_shifted"]),
}

LEVEL_2 = {
    "torque frame 90 deg about z": (torque_frame(turn(Z, np.pi / 2)), ["torque_frame"]),
    "torque frame 180 deg about x": (torque_frame(turn(X, np.pi)), ["torque_frame"]),
    "torque frame 90 deg about y": (torque_frame(turn(Y, -np.pi / 2)), ["torque_frame"]),
    "torque frame 30 deg about z": (torque_frame(turn(Z, np.radians(30))), ["torque_frame"]),
    "torque in the stator": (torques_changed(lambda T, R: R @ T), ["torque_in_stator_frame"]),
    "torque of reaction": (torques_changed(lambda T, _R: -T), ["torque_sign"]),
    "reaction in the stator": (torques_changed(lambda T, R: -R @ T), [("torque_in_stator_frame", "torque_sign")]),
    "torque in N mm": (torques_changed(lambda T, _R: 1e3 * T), ["torque_unit"]),
    "torque in kgf cm": (torques_changed(lambda T, _R: T / 0.0980665), ["torque_unit"]),
    "currents in mA": (currents_changed(lambda current: 1e3 * current), ["current_unit"]),
    "currents with another sign": (currents_changed(lambda current: -current), ["current_sign"]),
    "coils numbered from the next": (currents_changed(lambda current: np.roll(current, 1)), ["coil_shift"]),
    "layers exchanged": (currents_changed(lambda current: np.roll(current, len(current) // 2)), ["coil_shift"]),
    "coil 4 backwards": (coil_sign(3), ["coil_sign:4"]),
    "coil 1 backwards": (coil_sign(0), ["coil_sign:1"]),
    "coils 2 and 5 exchanged": (coil_swap(1, 4), ["coil_swap:2:5"]),
    "coils 1 and 2 exchanged": (coil_swap(0, 1), ["coil_swap:1:2"]),
    "coil 3 dead": (coil_strength(2, 0.0), ["coil_dead:3"]),
    "coil 6 half": (coil_strength(5, 0.5), ["coil_gain:6"]),
    "pole 3 turned around": (pole_strength(2, -1.0), ["pole_polarity:3"]),
    "pole 1 turned around": (pole_strength(0, -1.0), ["pole_polarity:1"]),
    "pole 2 missing": (pole_strength(1, 0.0), ["pole_missing:2"]),
    "torques one row late": (rows_shifted("torque", -1), ["rows_shifted"]),
    "currents one row late": (rows_shifted("current", 1), ["rows_shifted"]),
}

TOGETHER = {
    "two joints backwards": (both(joint_sign(0), joint_sign(2)), [("joint_sign:1", "joint_sign:3")]),
    "joint 2 and inverse": (both(joint_sign(1), LEVEL_1["inverse orientation"][0]), [("joint_sign:2", "orientation_inverted")]),
    "exchanged and tracker": (
        both(joint_swap(0, 1), tracker_frame(turn(X, np.pi))),
        [("joint_swap:1:2", "tracker_frame")],
    ),
    "joint 1 and coil 4": (both(joint_sign(0), coil_sign(3)), [("joint_sign:1", "coil_sign:4")]),
    "two coils backwards": (both(coil_sign(1), coil_sign(4)), [("coil_sign:2", "coil_sign:5")]),
    "inverse and torque frame": (
        both(LEVEL_1["inverse orientation"][0], torque_frame(turn(Z, np.pi / 2))),
        [("orientation_inverted", "torque_frame")],
    ),
    "pole 3 and coil 2": (both(pole_strength(2, -1.0), coil_sign(1)), [("pole_polarity:3", "coil_sign:2")]),
}

EVERYTHING = dict(itertools.chain(LEVEL_1.items(), LEVEL_2.items(), TOGETHER.items()))


def is_named(expected, named):
    """Whether one of the expected causes, or all of a tuple of them, are among those named."""
    for wanted in expected:
        group = wanted if isinstance(wanted, tuple) else (wanted,)
        if all(cause in named for cause in group):
            return True
    return False
