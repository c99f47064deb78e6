"""All 73 parameters at once by SciPy's least_squares, with the analytic Jacobian written plainly in NumPy.

What a researcher would write today instead of the paper's iteration: the reference that the refinement is
measured against, in speed and in result. Angles in rad, torques in N.m, currents in A.
"""

import numpy as np
from scipy.optimize import least_squares

from paper_iteration import (
    TorqueCurve,
    axis_derivatives,
    axis_from_angles,
    left_jacobian,
    pair_torque,
    rotation_exp,
    rotation_log,
    skew,
)

ORIENTATION_STDDEV = 1e-3 / np.sqrt(3.0)
TORQUE_STDDEV = 5e-4 / np.sqrt(3.0)
TOLERANCE = 1e-15


def tangents(axis):
    """Two unit vectors across an axis, as the columns of a matrix."""
    other = np.eye(3)[np.argmin(np.abs(axis))]
    u = np.cross(axis, other)
    u /= np.linalg.norm(u)
    return np.column_stack([u, np.cross(axis, u)])


class Problem:
    """Residuals and Jacobian over [offset, u, v] of each joint, angles of poles, angles of coils."""

    def __init__(self, scenario):
        initial = scenario["initial"]
        self.curve = TorqueCurve(scenario["curve"])
        self.base = [np.array(joint["axis"], dtype=float) for joint in initial["joints"]]
        self.tangents = [tangents(axis) for axis in self.base]
        self.polarity = [pole["polarity"] for pole in initial["poles"]]
        self.poles = len(initial["poles"])
        self.coils = len(initial["coils"])
        self.samples = []
        for sample in scenario["samples"]:
            currents = np.array(sample["current"])
            excited = [(j, currents[j]) for j in np.nonzero(currents)[0]]
            self.samples.append(
                (
                    np.array(sample["q"]),
                    np.array(sample["R"]).reshape(3, 3),
                    np.array(sample["torque"]),
                    excited,
                )
            )
        self.start = np.concatenate(
            [
                np.ravel([[joint["offset"], 0.0, 0.0] for joint in initial["joints"]]),
                np.ravel([pole["angles"] for pole in initial["poles"]]),
                np.ravel([coil["angles"] for coil in initial["coils"]]),
            ]
        )

    def joint(self, x, k):
        """Unit axis of joint k and its derivative by (u, v)."""
        moved = self.base[k] + self.tangents[k] @ x[3 * k + 1 : 3 * k + 3]
        length = np.linalg.norm(moved)
        axis = moved / length
        return axis, (np.eye(3) - np.outer(axis, axis)) @ self.tangents[k] / length

    def orientation(self, x, q):
        """R(q) and the derivative of its left rotation error by the nine coordinates of the joints."""
        before = np.eye(3)
        jacobian = np.zeros((3, 9))
        for k in range(3):
            axis, d_axis = self.joint(x, k)
            angle = q[k] + x[3 * k]
            jacobian[:, 3 * k] = before @ axis
            jacobian[:, 3 * k + 1 : 3 * k + 3] = (
                angle * before @ left_jacobian(axis * angle) @ d_axis
            )
            before = before @ rotation_exp(axis * angle)
        return before, jacobian

    def linearise(self, x):
        rows = 3 * len(self.samples)
        residual = np.zeros(rows)
        jacobian = np.zeros((rows, x.size))
        pole_angles = x[9 : 9 + 2 * self.poles].reshape(-1, 2)
        coil_angles = x[9 + 2 * self.poles :].reshape(-1, 2)
        poles = [axis_from_angles(angles) for angles in pole_angles]
        d_poles = [axis_derivatives(angles) for angles in pole_angles]
        for n, (q, measured, torque, excited) in enumerate(self.samples):
            at = slice(3 * n, 3 * n + 3)
            rotation, d_rotation = self.orientation(x, q)
            if not excited:
                y = rotation_log(measured @ rotation.T)
                residual[at] = y / ORIENTATION_STDDEV
                right_inverse = np.linalg.inv(left_jacobian(-y))
                jacobian[at, :9] = -right_inverse @ d_rotation / ORIENTATION_STDDEV
                continue
            model = np.zeros(3)
            for j, current in excited:
                stator = axis_from_angles(coil_angles[j])
                s = rotation.T @ stator
                d_coil_angles = rotation.T @ axis_derivatives(coil_angles[j])
                d_joints = rotation.T @ skew(stator) @ d_rotation
                column = 9 + 2 * self.poles + 2 * j
                for i in range(self.poles):
                    pair, d_pole, d_coil = pair_torque(self.curve, poles[i], s)
                    weight = self.polarity[i] * current
                    model += weight * pair
                    jacobian[at, 9 + 2 * i : 11 + 2 * i] -= weight * d_pole @ d_poles[i]
                    jacobian[at, column : column + 2] -= weight * d_coil @ d_coil_angles
                    jacobian[at, :9] -= weight * d_coil @ d_joints
            residual[at] = (torque - model) / TORQUE_STDDEV
            jacobian[at] /= TORQUE_STDDEV
        return residual, jacobian

    def parameters(self, x):
        """Offsets, axes, angles of poles, angles of coils."""
        axes = [self.joint(x, k)[0] for k in range(3)]
        return np.concatenate([x[0:9:3], *axes, x[9:]])


def identify(scenario):
    """Identified parameters and the number of evaluations."""
    problem = Problem(scenario)
    solution = least_squares(
        lambda x: problem.linearise(x)[0],
        problem.start,
        jac=lambda x: problem.linearise(x)[1],
        method="lm",
        xtol=TOLERANCE,
        ftol=TOLERANCE,
        gtol=TOLERANCE,
    )
    return problem.parameters(solution.x), solution.nfev


def parameters(actuator):
    """The parameters of an actuator in the order that identify() returns them in."""
    return np.concatenate(
        [
            [joint["offset"] for joint in actuator["joints"]],
            *(joint["axis"] for joint in actuator["joints"]),
            np.ravel([pole["angles"] for pole in actuator["poles"]]),
            np.ravel([coil["angles"] for coil in actuator["coils"]]),
        ]
    )
