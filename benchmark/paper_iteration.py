"""The paper's Gauss-Newton iterations, written plainly with NumPy.

What a researcher would type from the paper: loops over samples and poles, 3-vectors, one identification
matrix, one linear least-squares solution per iteration. The reference that the package is measured
against, in speed and in result. Angles in rad, torques in N.m, currents in A.
"""

import numpy as np

STEP_TOLERANCE = 1e-12
MAX_ITERATIONS = 50


def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rotation_exp(v):
    theta = np.linalg.norm(v)
    if theta < 1e-9:
        return np.eye(3) + skew(v)
    k = skew(v / theta)
    return np.eye(3) + np.sin(theta) * k + (1.0 - np.cos(theta)) * (k @ k)


def rotation_log(rotation):
    axis = 0.5 * np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    sine = np.linalg.norm(axis)
    if sine < 1e-9:
        return axis
    return np.arctan2(sine, 0.5 * (np.trace(rotation) - 1.0)) / sine * axis


def left_jacobian(v):
    theta = np.linalg.norm(v)
    k = skew(v)
    if theta < 1e-6:
        return np.eye(3) + 0.5 * k
    return (
        np.eye(3)
        + (1.0 - np.cos(theta)) / theta**2 * k
        + (theta - np.sin(theta)) / theta**3 * (k @ k)
    )


def rotor_orientation(axes, offsets, q):
    rotation = np.eye(3)
    for k in range(3):
        rotation = rotation @ rotation_exp(axes[k] * (q[k] + offsets[k]))
    return rotation


def identify_joint(scenario):
    """Level 1: three axis vectors and three offsets, 12 unknowns (paper (12-15))."""
    axes = [np.array(joint["axis"], dtype=float) for joint in scenario["initial"]["joints"]]
    offsets = np.array([joint["offset"] for joint in scenario["initial"]["joints"]], dtype=float)
    samples = [
        (np.array(sample["q"]), np.array(sample["R"]).reshape(3, 3)) for sample in scenario["samples"]
    ]
    for iteration in range(1, MAX_ITERATIONS + 1):
        matrix = np.zeros((3 * len(samples), 12))
        misfit = np.zeros(3 * len(samples))
        for n, (q, measured) in enumerate(samples):
            before = np.eye(3)
            for k in range(3):
                angle = q[k] + offsets[k]
                matrix[3 * n : 3 * n + 3, 4 * k] = before @ axes[k]
                matrix[3 * n : 3 * n + 3, 4 * k + 1 : 4 * k + 4] = (
                    angle * before @ left_jacobian(axes[k] * angle)
                )
                before = before @ rotation_exp(axes[k] * angle)
            misfit[3 * n : 3 * n + 3] = rotation_log(measured @ before.T)
        step = np.linalg.lstsq(matrix, misfit, rcond=None)[0]
        for k in range(3):
            offsets[k] += step[4 * k]
            axes[k] = axes[k] + step[4 * k + 1 : 4 * k + 4]
        if np.linalg.norm(step) < STEP_TOLERANCE:
            break
    return np.concatenate([offsets, *axes]), iteration


class TorqueCurve:
    """f(psi) and its derivative: cubic near zero, polynomial, cubic to zero."""

    def __init__(self, description):
        self.polynomial = np.polynomial.Polynomial(description["coefficients"])
        self.slope = self.polynomial.deriv()
        self.blend = description["blend_start"]
        self.begin = description["support_begin"]
        self.end = description["support_end"]
        self.k1 = description["k1"]
        self.k3 = description["k3"]

    def __call__(self, psi):
        if psi < self.blend:
            return self.k1 * psi + self.k3 * psi**3, self.k1 + 3.0 * self.k3 * psi**2
        if psi <= self.begin:
            return self.polynomial(psi), self.slope(psi)
        width = self.end - self.begin
        t = (psi - self.begin) / width
        value = self.polynomial(self.begin)
        slope = self.slope(self.begin)
        return (
            (1.0 - t) ** 2 * (value * (1.0 + 2.0 * t) + slope * width * t),
            (1.0 - t) * (slope * (1.0 - 3.0 * t) - 6.0 * value * t / width),
        )


def axis_from_angles(angles):
    theta, phi = angles
    return np.array([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), np.sin(theta)])


def axis_derivatives(angles):
    theta, phi = angles
    return np.array(
        [
            [-np.sin(theta) * np.cos(phi), -np.cos(theta) * np.sin(phi)],
            [-np.sin(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)],
            [np.cos(theta), 0.0],
        ]
    )


def pair_torque(curve, r, s):
    """Torque per ampere of one pole and one coil, and its derivatives by r and s."""
    kappa = r @ s
    psi = np.arccos(np.clip(kappa, -1.0, 1.0))
    if psi >= curve.end:
        return np.zeros(3), np.zeros((3, 3)), np.zeros((3, 3))
    sine = np.sin(psi)
    f, df = curve(psi)
    h = f / sine
    dh = -(df * sine - f * kappa) / sine**3
    cross = np.cross(r, s)
    return (
        h * cross,
        -h * skew(s) + dh * np.outer(cross, s),
        h * skew(r) + dh * np.outer(cross, r),
    )


def identify_torque(scenario, identify_poles):
    """Level 2: the angles of the excited coil, and in situation 1 those of all poles (paper (24-28))."""
    initial = scenario["initial"]
    curve = TorqueCurve(scenario["curve"])
    axes = [np.array(joint["axis"], dtype=float) for joint in initial["joints"]]
    offsets = np.array([joint["offset"] for joint in initial["joints"]], dtype=float)
    coil = scenario["coil"] - 1
    poles = np.array([pole["angles"] for pole in initial["poles"]], dtype=float)
    polarity = [pole["polarity"] for pole in initial["poles"]]
    coil_angles = np.array(initial["coils"][coil]["angles"], dtype=float)
    samples = [
        (
            rotor_orientation(axes, offsets, np.array(sample["q"])),
            sample["current"][coil],
            np.array(sample["torque"]),
        )
        for sample in scenario["samples"]
    ]
    unknown_poles = 2 * len(poles) if identify_poles else 0
    for iteration in range(1, MAX_ITERATIONS + 1):
        matrix = np.zeros((3 * len(samples), unknown_poles + 2))
        misfit = np.zeros(3 * len(samples))
        for n, (rotation, current, measured) in enumerate(samples):
            rows = slice(3 * n, 3 * n + 3)
            s = rotation.T @ axis_from_angles(coil_angles)
            s_derivatives = rotation.T @ axis_derivatives(coil_angles)
            misfit[rows] = measured
            for i in range(len(poles)):
                torque, d_pole, d_coil = pair_torque(curve, axis_from_angles(poles[i]), s)
                weight = polarity[i] * current
                misfit[rows] -= weight * torque
                matrix[rows, -2:] += weight * d_coil @ s_derivatives
                if identify_poles:
                    matrix[rows, 2 * i : 2 * i + 2] = weight * d_pole @ axis_derivatives(poles[i])
        step = np.linalg.lstsq(matrix, misfit, rcond=None)[0]
        if identify_poles:
            poles = poles + step[:-2].reshape(-1, 2)
        coil_angles = coil_angles + step[-2:]
        if np.linalg.norm(step) < STEP_TOLERANCE:
            break
    identified = [poles.ravel()] if identify_poles else []
    return np.concatenate([*identified, coil_angles]), iteration


def identify(cycle, scenario):
    """Identified parameters of one cycle (joint, poles, coil) and the number of iterations."""
    if cycle == "joint":
        return identify_joint(scenario)
    return identify_torque(scenario, identify_poles=cycle == "poles")


def parameters(cycle, scenario, actuator):
    """The parameters of an actuator in the order that identify() returns them in."""
    if cycle == "joint":
        offsets = [joint["offset"] for joint in actuator["joints"]]
        return np.concatenate([offsets, *(joint["axis"] for joint in actuator["joints"])])
    poles = [pole["angles"] for pole in actuator["poles"]] if cycle == "poles" else []
    return np.concatenate([*poles, actuator["coils"][scenario["coil"] - 1]["angles"]])
