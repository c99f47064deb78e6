"""Rotations as 3×3 matrices, and as the quaternions of messages. No ROS."""

import numpy


def skew(v):
    return numpy.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rotation_exp(v):
    """Rotation by |v| [rad] about v."""
    angle = float(numpy.linalg.norm(v))
    if angle < 1e-12:
        return numpy.eye(3) + skew(v)
    k = skew(numpy.asarray(v) / angle)
    return numpy.eye(3) + numpy.sin(angle) * k + (1.0 - numpy.cos(angle)) * k @ k


def angle_between(one, other):
    """Angle [rad] of the rotation from one orientation to another; exact for small ones, too."""
    difference = one.T @ other
    sine = 0.5 * numpy.linalg.norm(
        [
            difference[2, 1] - difference[1, 2],
            difference[0, 2] - difference[2, 0],
            difference[1, 0] - difference[0, 1],
        ]
    )
    return float(numpy.arctan2(sine, 0.5 * (numpy.trace(difference) - 1.0)))


def quaternion_of(rotation):
    """(x, y, z, w) of a rotation by less than half a turn."""
    w = 0.5 * numpy.sqrt(max(0.0, 1.0 + numpy.trace(rotation)))
    if w < 1e-3:
        raise ValueError("rotations by half a turn have no place here")
    x = (rotation[2, 1] - rotation[1, 2]) / (4.0 * w)
    y = (rotation[0, 2] - rotation[2, 0]) / (4.0 * w)
    z = (rotation[1, 0] - rotation[0, 1]) / (4.0 * w)
    return x, y, z, w


def rotation_of(quaternion):
    """Of a message's unit quaternion."""
    v = numpy.array([quaternion.x, quaternion.y, quaternion.z])
    w = quaternion.w
    return (w * w - v @ v) * numpy.eye(3) + 2.0 * numpy.outer(v, v) + 2.0 * w * skew(v)
