"""Cramér-Rao bound of a whole recording of motion, without windows and without test functions.

The state of the rotor is a turn xi of its orientation (R -> exp(xi) R) and an error of its angular momentum L. The currents
that flowed are those recorded less their noise, which drives the state; joint readings and tracker observe it. A Kalman
filter over all stamps gives innovations; what these tell of the parameters is all that the recording tells (the
innovations of a Gauss-Markov process are independent), with the initial state unknown. All derivatives are taken around the
true motion. Shares no code with the package, and with it only the parameters that count as unknown: joints, poles, coils,
inertia, unbalance, viscous and Coulomb friction, delay and dispersion of the currents, delay of the tracker.
"""

import free_motion
import laboratory as lab
import numpy as np

STEP = 1e-6
FURTHER = 6 + 3 + 2 + 2 + 1  # inertia, unbalance, friction, currents, tracker
PHYSICAL = (1e-5, 1e-5, 1e-5)  # scales of inertia, unbalance and friction, so that numbers are alike
CHUNK = 2000


def _skews(v):
    K = np.zeros((len(v), 3, 3))
    K[:, 0, 1], K[:, 0, 2], K[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    return K - K.transpose(0, 2, 1)


class _Torques:
    """Torques of all pairs at many times, stator frame, and their derivatives."""

    def __init__(self, unit, errors, R, current):
        self.unit, self.R, self.current = unit, R, current
        coils = free_motion.Coils(unit, errors)
        self.poles, self.coils, self.coil_set = coils.poles, coils.coils, coils
        self.angles = unit.poles + errors[9 : 9 + 2 * len(unit.poles)].reshape(-1, 2)
        self.coil_angles = unit.coils + errors[9 + 2 * len(unit.poles) :].reshape(-1, 2)

    def _strength(self, p, s):
        """h at p (n x m x 3) and s (l x 3): n x m x l."""
        table = self.coil_set
        return np.interp(p @ s.T, table._kappa, table._h, left=0.0)

    def of(self, p, polarity, s, current):
        """Torque of poles p (n x m x 3, with polarities) on coils s, n x 3."""
        h = self._strength(p, s) * polarity[None, :, None]
        return np.cross(p, np.einsum("nml,nl,lk->nmk", h, current, s)).sum(axis=1)

    def moved(self, R):
        return np.einsum("nij,mj->nmi", R, self.poles)

    def per_ampere(self):
        p = self.moved(self.R)
        h = self._strength(p, self.coils) * self.unit.polarity[None, :, None]
        return np.cross(np.einsum("nml,nmk->nlk", h, p), self.coils[None]).transpose(0, 2, 1)

    def by_turn(self):
        columns = []
        for k in range(3):
            turn = lab.rotation(STEP * np.eye(3)[k])
            ahead, behind = (
                self.of(self.moved(T @ self.R), self.unit.polarity, self.coils, self.current) for T in (turn, turn.T)
            )
            columns.append((ahead - behind) / (2 * STEP))
        return np.stack(columns, axis=2)

    def by_angles(self):
        """Of poles, then coils: n x 3 x (2 m + 2 l)."""
        columns = []
        for i, angles in enumerate(self.angles):
            for axis in range(2):
                step = STEP * np.eye(2)[axis]
                ahead, behind = (
                    self.of((self.R @ lab.axis_of(*moved))[:, None], self.unit.polarity[i : i + 1], self.coils, self.current)
                    for moved in (angles + step, angles - step)
                )
                columns.append((ahead - behind) / (2 * STEP))
        p = self.moved(self.R)
        for j, angles in enumerate(self.coil_angles):
            for axis in range(2):
                step = STEP * np.eye(2)[axis]
                ahead, behind = (
                    self.of(p, self.unit.polarity, lab.axis_of(*moved)[None], self.current[:, j : j + 1])
                    for moved in (angles + step, angles - step)
                )
                columns.append((ahead - behind) / (2 * STEP))
        return np.stack(columns, axis=2)


def _joint_orientations(unit, errors, q):
    R = np.broadcast_to(np.eye(3), (len(q), 3, 3))
    for k in range(3):
        offset, u, v = errors[3 * k : 3 * k + 3]
        R = R @ free_motion.rotations((q[:, k] + offset)[:, None] * lab.chart_axis(unit.bases[k], u, v))
    return R


def _by_joints(unit, errors, q):
    """Turns by the nine errors (n x 3 x 9) and by the readings (n x 3 x 3)."""
    R = _joint_orientations(unit, errors, q).transpose(0, 2, 1)
    by_errors, by_readings = [], []
    for p in range(9):
        step = np.zeros(len(errors))
        step[p] = STEP
        ahead, behind = (_joint_orientations(unit, errors + s * step, q) @ R for s in (1.0, -1.0))
        by_errors.append((free_motion._logs(ahead) - free_motion._logs(behind)) / (2 * STEP))
    for k in range(3):
        step = STEP * np.eye(3)[k]
        ahead, behind = (_joint_orientations(unit, errors, q + s * step) @ R for s in (1.0, -1.0))
        by_readings.append((free_motion._logs(ahead) - free_motion._logs(behind)) / (2 * STEP))
    return np.stack(by_errors, axis=2), np.stack(by_readings, axis=2)


class _Dynamics:
    """What a chunk of the motion has of derivatives: dx/dt = A x + F theta + B (noise of the currents)."""

    def __init__(self, unit, errors, machine, R, w, current, rate, bend):
        torques = _Torques(unit, errors, R, current)
        J = R @ machine.inertia @ R.transpose(0, 2, 1)
        inverse = np.linalg.inv(J)
        L = np.einsum("nij,nj->ni", J, w)
        speed = np.sqrt(np.sum(w**2, axis=1) + machine.friction_speed**2)
        # -(b + c / speed) w, by w.
        by_rate = -(machine.viscous + machine.coulomb / speed)[:, None, None] * np.eye(3)
        by_rate = by_rate + (machine.coulomb / speed**3)[:, None, None] * w[:, :, None] * w[:, None, :]
        # w = R J^-1 R^T L: turned by xi it is xi x w - inverse (xi x L).
        rate_by_turn = -_skews(w) + inverse @ _skews(L)
        centre = R @ np.array(machine.unbalance)
        weight = np.zeros((len(R), 3, 3))
        weight[:, 0, 1], weight[:, 1, 0] = -1.0, 1.0  # a -> a x (-z)
        A = np.zeros((len(R), 6, 6))
        A[:, :3, :3] = _skews(w) + rate_by_turn
        A[:, :3, 3:] = inverse
        A[:, 3:, :3] = torques.by_turn() + weight @ -_skews(centre) + by_rate @ rate_by_turn
        A[:, 3:, 3:] = by_rate @ inverse
        self.A, self.Q = A, torques.per_ampere()
        size = unit.size()
        F = np.zeros((len(R), 6, size + FURTHER))
        F[:, 3:, 9:size] = torques.by_angles()
        for k, (a, b) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))):
            E = np.zeros((3, 3))
            E[a, b] = E[b, a] = PHYSICAL[0]
            change = -np.einsum("nij,nj->ni", inverse @ (R @ E @ R.transpose(0, 2, 1)), w)
            F[:, :3, size + k] = change
            F[:, 3:, size + k] = np.einsum("nij,nj->ni", by_rate, change)
        F[:, 3:, size + 6 : size + 9] = PHYSICAL[1] * (weight @ R)
        F[:, 3:, size + 9] = -PHYSICAL[2] * w
        F[:, 3:, size + 10] = -PHYSICAL[2] * w / speed[:, None]
        F[:, 3:, size + 11] = 1e-3 * np.einsum("nij,nj->ni", self.Q, rate)
        F[:, 3:, size + 12] = 1e-6 * np.einsum("nij,nj->ni", self.Q, bend)
        self.F = F


class _Filter:
    """State covariance, its sensitivity to the parameters, and their information."""

    def __init__(self, parameters):
        self.P = np.diag([1.0] * 3 + [1.0] * 3)
        self.S = np.zeros((6, parameters))
        self.information = np.zeros((parameters, parameters))
        self._rows = []

    def advance(self, A, F, Q, variance, h):
        step = np.eye(6) + h * A + 0.5 * h * h * A @ A
        self.P = step @ self.P @ step.T
        self.P[3:, 3:] += h * h * variance * (Q @ Q.T)
        self.S = step @ self.S + h * (F + 0.5 * h * A @ F)

    def observe(self, H, D, V):
        """Of H x + D theta with covariance V."""
        root = np.linalg.inv(np.linalg.cholesky(H @ self.P @ H.T + V))
        sensitivity = H @ self.S + D
        self._rows.append(root @ sensitivity)
        gain = self.P @ H.T @ root.T @ root
        self.S = self.S - gain @ sensitivity
        self.P = self.P - gain @ H @ self.P
        self.P = 0.5 * (self.P + self.P.T)
        if len(self._rows) > 500:
            self.gather()

    def gather(self):
        if self._rows:
            stacked = np.concatenate(self._rows)
            self.information += stacked.T @ stacked
            self._rows = []


def bound(unit, errors, machine, motion, streams):
    """Covariance of the unit's errors at least; joints and currents sampled every millisecond."""
    if streams.joint_rate != 1000.0 or streams.current_rate != 1000.0:
        raise ValueError("The bound is for joints and currents at 1000 Hz.")
    first, last = 6, len(motion.time) - 6
    h, size = 1e-3, unit.size()
    q = free_motion.joint_angles(unit, errors, motion.orientation)
    w = np.zeros((len(q), 3))
    R = motion.orientation
    w[1:-1] = free_motion._logs(R[2:] @ R[:-2].transpose(0, 2, 1)) / (2 * h)
    # Between samples the currents are a straight line, as for whoever has but their samples.
    current = motion.current
    middle = 0.5 * (current[:-1] + current[1:])
    rate = np.diff(current, axis=0) / h
    bend = np.zeros_like(rate)
    bend[1:-1] = (rate[2:] - rate[:-2]) / (2 * h)
    filtered = _Filter(size + FURTHER)
    tracker = np.zeros(len(q), int)
    stamps = np.arange(0.005, motion.time[-1] - 0.005, 1.0 / streams.tracker_rate)
    np.add.at(tracker, np.round(stamps / h).astype(int), 1)
    H = np.zeros((3, 6))
    H[:, :3] = np.eye(3)
    for begin in range(first, last, CHUNK):
        chosen = slice(begin, min(last, begin + CHUNK))
        dynamics = _Dynamics(unit, errors, machine, R[chosen], w[chosen], middle[chosen], rate[chosen], bend[chosen])
        by_errors, by_readings = _by_joints(unit, errors, q[chosen])
        for n in range(len(by_errors)):
            D = np.zeros((3, size + FURTHER))
            D[:, :9] = -by_errors[n]
            V = streams.joint_stddev**2 * by_readings[n] @ by_readings[n].T
            filtered.observe(H, D, V)
            for _ in range(tracker[begin + n]):
                D = np.zeros((3, size + FURTHER))
                D[:, -1] = 1e-3 * w[begin + n]
                filtered.observe(H, D, streams.tracker_stddev**2 * np.eye(3))
            filtered.advance(dynamics.A[n], dynamics.F[n], dynamics.Q[n], streams.current_stddev**2, h)
    filtered.gather()
    return np.linalg.inv(filtered.information)[:size, :size]
