"""All 73 parameters at once by SciPy's least_squares, with the analytic Jacobian in NumPy.

What a researcher who cares for speed would write today: arrays over all samples and poles instead of loops, and one
evaluation for residual and Jacobian of a point. The reference that the refinement is measured against, in speed and in
result. Angles in rad, torques in N.m, currents in A. Shapes: n samples, p pairs of a sample and an excited coil, m
poles.
"""

import numpy as np
from scipy.optimize import least_squares

from paper_iteration import TorqueCurve

ORIENTATION_STDDEV = 1e-3 / np.sqrt(3.0)
TORQUE_STDDEV = 5e-4 / np.sqrt(3.0)
TOLERANCE = 1e-12  # of a step against the coordinates, as of the other solvers
NONE = 1e-15  # of what else would end the iteration
MOST_STEPS = 50
SMALL_ANGLE = 1e-6


def tangents(axis):
    """Two unit vectors across an axis, as the columns of a matrix."""
    other = np.eye(3)[np.argmin(np.abs(axis))]
    u = np.cross(axis, other)
    u /= np.linalg.norm(u)
    return np.column_stack([u, np.cross(axis, u)])


def skews(v):
    """Cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    result = np.zeros((*v.shape, 3))
    result[..., 0, 1], result[..., 0, 2], result[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return result - np.swapaxes(result, -1, -2)


def rotations(axis, angles):
    """Rotations (n, 3, 3) about one unit axis."""
    k = skews(axis)
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + sine * k + (1.0 - cosine) * (k @ k)


def left_jacobians(axis, angles):
    """Left Jacobians (n, 3, 3) of rotations about one unit axis, multiplied by their angle."""
    k = skews(axis)
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return angles[:, None, None] * np.eye(3) + (1.0 - cosine) * k + (angles[:, None, None] - sine) * (k @ k)


def rotation_logs(rotation):
    """Rotation vectors (n, 3)."""
    twice = rotation - np.swapaxes(rotation, 1, 2)
    axis = 0.5 * np.stack([twice[:, 2, 1], twice[:, 0, 2], twice[:, 1, 0]], axis=1)
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(rotation, axis1=1, axis2=2) - 1.0))
    return np.where(sine > SMALL_ANGLE, angle / np.maximum(sine, SMALL_ANGLE), 1.0)[:, None] * axis


def inverse_left_jacobians(v):
    """Inverses (n, 3, 3) of the left Jacobians of rotation vectors (n, 3)."""
    theta = np.linalg.norm(v, axis=1)
    safe = np.maximum(theta, SMALL_ANGLE)
    factor = np.where(
        theta > SMALL_ANGLE, 1.0 / safe**2 - (1.0 + np.cos(safe)) / (2.0 * safe * np.sin(safe)), 1.0 / 12.0
    )
    k = skews(v)
    return np.eye(3) - 0.5 * k + factor[:, None, None] * (k @ k)


def axes_from_angles(angles):
    """Unit vectors (m, 3) and their derivatives (m, 3, 2) by polar and azimuth angle."""
    theta, phi = angles[:, 0], angles[:, 1]
    zero = np.zeros_like(theta)
    axes = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), np.sin(theta)], axis=1)
    by_theta = np.stack([-np.sin(theta) * np.cos(phi), -np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    by_phi = np.stack([-np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi), zero], axis=1)
    return axes, np.stack([by_theta, by_phi], axis=2)


def curve_values(curve, psi):
    """f(psi) and its derivative, zero beyond the support."""
    width = curve.end - curve.begin
    t = (psi - curve.begin) / width
    value, slope = curve.polynomial(curve.begin), curve.slope(curve.begin)
    pieces = [psi < curve.blend, psi <= curve.begin, psi < curve.end]
    f = np.select(
        pieces,
        [
            curve.k1 * psi + curve.k3 * psi**3,
            curve.polynomial(psi),
            (1.0 - t) ** 2 * (value * (1.0 + 2.0 * t) + slope * width * t),
        ],
    )
    df = np.select(
        pieces,
        [
            curve.k1 + 3.0 * curve.k3 * psi**2,
            curve.slope(psi),
            (1.0 - t) * (slope * (1.0 - 3.0 * t) - 6.0 * value * t / width),
        ],
    )
    return f, df


class Problem:
    """Residuals and Jacobian over [offset, u, v] of each joint, angles of poles, angles of coils."""

    def __init__(self, scenario):
        initial = scenario["initial"]
        samples = scenario["samples"]
        self.curve = TorqueCurve(scenario["curve"])
        self.base = [np.array(joint["axis"], dtype=float) for joint in initial["joints"]]
        self.tangents = [tangents(axis) for axis in self.base]
        self.polarity = np.array([pole["polarity"] for pole in initial["poles"]], dtype=float)
        self.poles = len(initial["poles"])
        self.q = np.array([sample["q"] for sample in samples])
        self.measured = np.array([sample["R"] for sample in samples]).reshape(-1, 3, 3)
        self.torques = np.array([sample["torque"] for sample in samples])
        currents = np.zeros((len(samples), len(initial["coils"])))
        for row, sample in zip(currents, samples):
            row[: len(sample["current"])] = sample["current"]
        self.pair_sample, self.pair_coil = np.nonzero(currents)
        self.pair_current = currents[self.pair_sample, self.pair_coil]
        excited = np.any(currents != 0.0, axis=1)
        self.oriented, self.excited = np.nonzero(~excited)[0], np.nonzero(excited)[0]
        self.start = np.concatenate(
            [
                np.ravel([[joint["offset"], 0.0, 0.0] for joint in initial["joints"]]),
                np.ravel([pole["angles"] for pole in initial["poles"]]),
                np.ravel([coil["angles"] for coil in initial["coils"]]),
            ]
        )
        self._at = None
        self._values = None

    def joint(self, x, k):
        """Unit axis of joint k and its derivative by (u, v)."""
        moved = self.base[k] + self.tangents[k] @ x[3 * k + 1 : 3 * k + 3]
        length = np.linalg.norm(moved)
        axis = moved / length
        return axis, (np.eye(3) - np.outer(axis, axis)) @ self.tangents[k] / length

    def orientations(self, x):
        """R (n, 3, 3), and the derivatives (n, 3, 9) of its left rotation error by the coordinates of the joints."""
        before = np.broadcast_to(np.eye(3), (len(self.q), 3, 3))
        jacobian = np.empty((len(self.q), 3, 9))
        for k in range(3):
            axis, d_axis = self.joint(x, k)
            angles = self.q[:, k] + x[3 * k]
            jacobian[:, :, 3 * k] = before @ axis
            jacobian[:, :, 3 * k + 1 : 3 * k + 3] = before @ left_jacobians(axis, angles) @ d_axis
            before = before @ rotations(axis, angles)
        return before, jacobian

    def _orientation_rows(self, rotation, d_rotation, residual, jacobian):
        n = self.oriented
        y = rotation_logs(self.measured[n] @ np.swapaxes(rotation[n], 1, 2))
        residual[n] = y / ORIENTATION_STDDEV
        jacobian[n, :, :9] = -inverse_left_jacobians(-y) @ d_rotation[n] / ORIENTATION_STDDEV

    def _torque_rows(self, x, rotation, d_rotation, residual, jacobian):
        first_coil = 9 + 2 * self.poles
        poles, d_poles = axes_from_angles(x[9:first_coil].reshape(-1, 2))
        coils, d_coils = axes_from_angles(x[first_coil:].reshape(-1, 2))
        to_rotor = np.swapaxes(rotation[self.pair_sample], 1, 2)
        stator = coils[self.pair_coil]
        s = (to_rotor @ stator[:, :, None])[:, :, 0]
        kappa = np.clip(s @ poles.T, -1.0, 1.0)
        psi = np.arccos(kappa)
        sine = np.sin(psi)
        f, df = curve_values(self.curve, psi)
        weight = self.pair_current[:, None] * self.polarity
        h = weight * f / sine
        dh = -weight * (df * sine - f * kappa) / sine**3
        cross = np.cross(poles[None, :, :], s[:, None, :])
        torque = np.einsum("pm,pmi->pi", h, cross)
        d_pole = -h[:, :, None, None] * skews(s)[:, None] + dh[:, :, None, None] * (
            cross[:, :, :, None] * s[:, None, None, :]
        )
        d_coil = np.einsum("pm,mij->pij", h, skews(poles)) + np.einsum("pm,pmi,mj->pij", dh, cross, poles)
        by_poles = (d_pole @ d_poles).transpose(0, 2, 1, 3).reshape(len(s), 3, 2 * self.poles)
        by_coil = d_coil @ to_rotor @ d_coils[self.pair_coil]
        by_joints = d_coil @ to_rotor @ skews(stator) @ d_rotation[self.pair_sample]
        np.add.at(residual, self.pair_sample, -torque)
        np.add.at(jacobian[:, :, :9], self.pair_sample, -by_joints)
        np.add.at(jacobian[:, :, 9:first_coil], self.pair_sample, -by_poles)
        for column in range(2):
            place = first_coil + 2 * self.pair_coil + column
            jacobian[self.pair_sample, :, place] -= by_coil[:, :, column]
        residual[self.excited] += self.torques[self.excited]
        residual[self.excited] /= TORQUE_STDDEV
        jacobian[self.excited] /= TORQUE_STDDEV

    def linearise(self, x):
        """Whitened residuals and Jacobian; those of the last point are kept."""
        if self._at is None or not np.array_equal(x, self._at):
            rotation, d_rotation = self.orientations(x)
            residual = np.zeros((len(self.q), 3))
            jacobian = np.zeros((len(self.q), 3, x.size))
            self._orientation_rows(rotation, d_rotation, residual, jacobian)
            self._torque_rows(x, rotation, d_rotation, residual, jacobian)
            self._at, self._values = x.copy(), (residual.ravel(), jacobian.reshape(-1, x.size))
        return self._values

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
        ftol=NONE,
        gtol=NONE,
    )
    return problem.parameters(solution.x), solution.nfev


def identify_by_normal_equations(scenario):
    """The same without SciPy: Gauss-Newton from a start that is near, the least that a script can do."""
    problem = Problem(scenario)
    x = problem.start.copy()
    for evaluations in range(1, MOST_STEPS + 1):
        residual, jacobian = problem.linearise(x)
        step = -np.linalg.solve(jacobian.T @ jacobian, jacobian.T @ residual)
        x += step
        if np.linalg.norm(step) <= TOLERANCE * np.linalg.norm(x):
            break
    return problem.parameters(x), evaluations


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
