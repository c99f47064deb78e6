"""Thirty-six mistakes beside those of mistakes.py, of the same form: other places, other sizes, several at once."""

import numpy as np

from mistakes import (
    X,
    Y,
    Z,
    both,
    coil_sign,
    coil_strength,
    coil_swap,
    currents_changed,
    joint_index,
    joint_scale,
    joint_sign,
    joints_changed,
    marker_frame,
    orientations_changed,
    pole_strength,
    rows_shifted,
    torque_frame,
    torques_changed,
    tracker_frame,
)
from wired_laboratory import turn

LAST_COIL = -1

FURTHER_LEVEL_1 = {
    "joints 1 and 2 backwards": (both(joint_sign(0), joint_sign(1)), [("joint_sign:1", "joint_sign:2")]),
    "radians taken for degrees": (joints_changed(np.radians), ["joint_degrees"]),
    "joint 2 alone in degrees": (joint_scale(1, np.degrees(1.0)), ["joint_scale:2"]),
    "gear of 3 at joint 3": (joint_scale(2, 3.0), ["joint_scale:3"]),
    "joint 2 reads 25 % less": (joint_scale(1, 0.75), ["joint_scale:2"]),
    "index mark half a turn off": (joint_index(2, np.pi), ["joint_index:3"]),
    "index mark of joint 2, 17 deg": (joint_index(1, 0.3), ["joint_index:2"]),
    "tracker 180 deg about z": (tracker_frame(turn(Z, np.pi)), ["tracker_frame"]),
    "tracker 120 deg about 1 -1 1": (tracker_frame(turn([1, -1, 1], 2 * np.pi / 3)), ["tracker_frame"]),
    "tracker 15 deg askew": (tracker_frame(turn([2, -1, 1], np.radians(15))), ["tracker_frame"]),
    "marker 120 deg about 1 1 1": (marker_frame(turn([1, 1, 1], 2 * np.pi / 3)), ["marker_frame"]),
    "marker 20 deg askew": (marker_frame(turn([1, -2, 2], np.radians(20))), ["marker_frame"]),
    "orientations two rows early": (rows_shifted("orientation", 2), ["rows_shifted"]),
    "joint 3 and tracker": (
        both(joint_sign(2), tracker_frame(turn(X, np.pi / 2))),
        [("joint_sign:3", "tracker_frame")],
    ),
    "joint 3 backwards, its index off": (both(joint_sign(2), joint_index(2, 0.7)), [("joint_sign:3", "joint_index:3")]),
    "index marks of joints 1 and 2": (
        both(joint_index(0, 0.5), joint_index(1, -0.4)),
        [("joint_index:1", "joint_index:2"), ("tracker_frame", "joint_index:2")],
    ),
    "joints 1 and 2 alone in degrees": (
        both(joint_scale(0, np.degrees(1.0)), joint_scale(1, np.degrees(1.0))),
        [("joint_scale:1", "joint_scale:2")],
    ),
    "tracker and marker askew": (
        both(tracker_frame(turn([1, 2, 3], 1.1)), marker_frame(turn([-2, 1, 0.5], 0.9))),
        [("tracker_frame", "marker_frame")],
    ),
    "joint 1 backwards, tracker askew": (
        both(joint_sign(0), tracker_frame(turn([1, 1, 0], 0.45))),
        [("joint_sign:1", "tracker_frame")],
    ),
    "inverse, marker askew": (
        both(marker_frame(turn([1, 0, 1], 0.7)), orientations_changed(lambda R: R.T)),
        [("orientation_inverted", "marker_frame"), ("orientation_inverted", "tracker_frame")],
    ),
}

FURTHER_LEVEL_2 = {
    "torque frame 90 deg about x": (torque_frame(turn(X, np.pi / 2)), ["torque_frame"]),
    "torque frame 120 deg about 1 1 1": (torque_frame(turn([1, 1, 1], 2 * np.pi / 3)), ["torque_frame"]),
    "torque frame 20 deg about y": (torque_frame(turn(Y, np.radians(20))), ["torque_frame"]),
    "torque in lbf in": (torques_changed(lambda T, _R: T / 0.1129848), ["torque_unit"]),
    "coils numbered from the one before": (currents_changed(lambda current: np.roll(current, -1)), ["coil_shift"]),
    "last coil backwards": (coil_sign(LAST_COIL), ["coil_sign:last"]),
    "coil 7 backwards": (coil_sign(6), ["coil_sign:7"]),
    "coils 3 and 4 exchanged": (coil_swap(2, 3), ["coil_swap:3:4"]),
    "first and last coil exchanged": (coil_swap(0, LAST_COIL), ["coil_swap:1:last"]),
    "coil 8 dead": (coil_strength(7, 0.0), ["coil_dead:8"]),
    "coil 2 half as strong again": (coil_strength(1, 1.5), ["coil_gain:2"]),
    "pole 4 turned around": (pole_strength(3, -1.0), ["pole_polarity:4"]),
    "pole 1 missing": (pole_strength(0, 0.0), ["pole_missing:1"]),
    "torques three rows early": (rows_shifted("torque", 3), ["rows_shifted"]),
    "coil 5 dead, coil 9 backwards": (both(coil_strength(4, 0.0), coil_sign(8)), [("coil_dead:5", "coil_sign:9")]),
    "poles 1 and 3 turned around": (
        both(pole_strength(0, -1.0), pole_strength(2, -1.0)),
        [("pole_polarity:1", "pole_polarity:3")],
    ),
}
