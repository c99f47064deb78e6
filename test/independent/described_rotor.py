"""What a calibrated description says of the rotor's orientation: a NumPy model, written from doc/method.md."""

import numpy as np
from laboratory import rotation, rotation_vector, skew


def matrix_of(quaternion):
    x, y, z, w = quaternion
    v = skew([x, y, z])
    return np.eye(3) + 2.0 * w * v + 2.0 * v @ v


def tangents(axis):
    """e_u, e_v: e_u along the coordinate axis after the one that the axis is nearest to."""
    u = np.eye(3)[(np.argmax(np.abs(axis)) + 1) % 3]
    u = u - axis * (axis @ u)
    u /= np.linalg.norm(u)
    return u, np.cross(axis, u)


class DescribedRotor:
    """The orientation by a description, as loaded from YAML."""

    def __init__(self, description):
        actuator = description["actuator"]
        self.axes = [np.array(joint["axis"]) for joint in actuator["joints"]]
        self.offsets = np.array([joint["offset"] for joint in actuator["joints"]])
        self.linear = np.array([joint.get("linear", [0.0] * 3) for joint in actuator["joints"]])
        self.harmonics = np.array([joint.get("harmonics", [0.0] * 4) for joint in actuator["joints"]])
        self.map = actuator.get("orientation_map")
        if self.map:
            self.points = np.array([point["reading"] for point in self.map["points"]])
            self.rotations = np.array([point["rotation"] for point in self.map["points"]])
            self.gram = np.array([self.kernel(q) for q in self.points])

    def kernel(self, q):
        chords = 2.0 * np.sin(0.5 * (self.points - q)) / np.array(self.map["length"])
        root = np.sqrt(5.0 * np.sum(chords**2, axis=1))
        return (1.0 + root + root**2 / 3.0) * np.exp(-root)

    def share(self, q):
        """Of the map: each joint within a sixth of the points' range of one of them, or falling over 0.3 rad."""
        beyond = 0.0
        for k in range(3):
            reach = max(0.05, min(2.0, np.ptp(self.points[:, k])) / 6.0)
            nearest = np.min(np.abs(2.0 * np.sin(0.5 * (self.points[:, k] - q[k]))))
            beyond += max(0.0, (nearest - reach) / 0.3) ** 2
        return max(0.0, 1.0 - beyond) ** 2

    def unexplained(self, q):
        """Mean, variance of the smooth part and the rotor's own noise of the map's rotation vector."""
        if not self.map:
            return np.zeros((3, 3))
        k, share = self.kernel(q), self.share(q)
        rows, tracker = [], self.map.get("tracker_noise", 0.0)
        for c, (amplitude, noise) in enumerate(zip(self.map["amplitude"], self.map["noise"])):
            inverse = np.linalg.inv(amplitude**2 * self.gram + noise**2 * np.eye(len(k)))
            mean = amplitude**2 * k @ inverse @ self.rotations[:, c]
            explained = amplitude**4 * k @ inverse @ k
            rows.append([share * mean, amplitude**2 - share * (2.0 - share) * explained, max(0.0, noise**2 - tracker**2)])
        return np.array(rows).T

    def orientation(self, q, change=None):
        """With changes of parameters by their names, as in the covariance of a description."""
        change = change or {}
        corrected = np.array(q, dtype=float)
        R = np.eye(3)
        for k in range(3):
            name = f"joint_{k + 1}/"
            linear, harmonics = self.linear[k].copy(), self.harmonics[k].copy()
            if k < 2:
                linear[:2] += [change.get(f"tilt_matrix/{k + 1}{n}", 0.0) for n in (1, 2)]
            harmonics += [change.get(name + h, 0.0) for h in ("cos_1", "sin_1", "cos_2", "sin_2")]
            waves = [np.cos(q[k]), np.sin(q[k]), np.cos(2.0 * q[k]), np.sin(2.0 * q[k])]
            corrected[k] += linear @ q + harmonics @ waves
            u, v = tangents(self.axes[k])
            axis = self.axes[k] + change.get(name + "axis_u", 0.0) * u + change.get(name + "axis_v", 0.0) * v
            axis /= np.linalg.norm(axis)
            R = R @ rotation(axis * (corrected[k] + self.offsets[k] + change.get(name + "offset", 0.0)))
        return rotation(self.unexplained(q)[0]) @ R

    def stddev(self, q, covariance):
        """Of a component, root mean square, with the covariance of a description."""
        names = covariance["names"]
        P = np.zeros((len(names), len(names)))
        P[np.tril_indices(len(names))] = covariance["lower"]
        P += np.tril(P, -1).T
        R, step = self.orientation(q), 1e-6
        J = np.array([rotation_vector(self.orientation(q, {name: step}) @ R.T) / step for name in names]).T
        _, smooth, noise = self.unexplained(q)
        return np.sqrt((np.trace(J @ P @ J.T) + smooth.sum() + noise.sum()) / 3.0)
