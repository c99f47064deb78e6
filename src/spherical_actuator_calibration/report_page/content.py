"""What the page tells: the figures of a report as words, rows and pictures for the template."""

import math

from ..parameter_drift import drifts_between
from ..shown_numbers import change_of, plus_minus, signed, significant, with_unit
from ..unit_identity import other_unit
from . import figures
from .motion import told_by

GRADES = {
    "good": "Good",
    "usable": "Usable",
    "not_validated": "Not validated",
    "contradicted": "Contradicted",
    "failed": "Failed",
}
# Kinds of parameters as their tables are called.
KINDS = {"joint": "Joints", "pole": "Magnet poles", "coil": "Coils", "effect": "Laboratory effects"}
QUANTITIES = ("orientation", "torque")
MOST_INFLUENTIAL = 8


def cross_and_dot(one, other):
    """Vector product and scalar product of two vectors."""
    cross = [one[i - 2] * other[i - 1] - one[i - 1] * other[i - 2] for i in range(3)]
    return cross, sum(a * b for a, b in zip(one, other))


def _identified(report):
    """Of each identified parameter of a report.yaml value, standard deviation and unit."""
    return {p["name"]: (p["value"], p["stddev"], p["unit"]) for p in report["parameters"] if p["identified"]}


class Report:
    """The report.yaml of one calibration, and an earlier one of the same unit, where there is one."""

    def __init__(self, report, previous=None):
        self._report = report
        self._previous = previous
        self._cycles = report["cycles"]
        self._parameters = report["parameters"]
        self._influences = report["influences"]

    # ---- head ----------------------------------------------------------------------------------------

    def actuator(self):
        return self._report["actuator"]

    def grade(self):
        """Key, for the style, and word."""
        key = self._report["verdict"]["grade"]
        return {"key": key, "word": GRADES[key]}

    def sentence(self):
        return self._report["verdict"]["sentence"]

    def diagnoses(self):
        """Mistakes and effects that explain the samples: cause and sentence."""
        return [(item["cause"], item["message"]) for item in self._report.get("diagnoses", [])]

    def next_steps(self):
        return self._report["next_steps"]

    def facts(self):
        """What was calibrated, from what and when: pairs of name and value."""
        facts = [
            ("Actuator", self._report["actuator"]),
            ("Serial number", self._report["serial"] or "not stated"),
            ("Date", self._report["date"].replace("T", " ").replace("Z", " UTC")),
            ("Software", f"spherical_actuator_calibration {self._report['software']}"),
        ]
        if "revision" in self._report:
            facts.append(("Revision", self._report["revision"]))
        facts.append(("Samples", self._samples_in_words()))
        return facts

    def sources(self):
        """Recordings with their checksums."""
        return self._report["source"]

    def recording(self):
        """What became of the recordings, in lines."""
        return self._report["recording"]

    def has_torque(self):
        """Whether poles and coils are part of the actuator."""
        return bool(self._report["coverage"]["coils"])

    def cards(self):
        """The few numbers that matter most."""
        identified = sum(item["identified"] for item in self._parameters)
        cards = [("Identified", f"{identified} of {len(self._parameters)}", "parameters")]
        cards += self._errors_before_and_after()
        last = self._last_success()
        if last:
            if "orientation_uncertainty" in last:
                cards.append(("Orientation error", with_unit(last["orientation_uncertainty"], "rad", 2), "expected, 1 σ"))
            if self.has_torque():
                value = f"{significant(1e3 * last['torque_uncertainty'], 2)} mN·m/A"
                cards.append(("Torque error", value, "expected, 1 σ"))
        validation = self.validation()
        if validation:
            cards.append(("Held-out χ²", validation["chi_square"], f"probability {validation['probability']}"))
        return cards

    def _errors_before_and_after(self):
        """Of orientations and torques: before the first cycle that succeeded, by the drawing, and after the last one of
        its kind, which has all samples."""
        cards = []
        succeeded = [one for one in self._cycles if one["success"] and one["error_history"]]
        for kinds, title in ((("joint", "motion"), "Orientations"), (("poles",), "Torques")):
            # After a cycle of all parameters, "before" would not be the drawing.
            first = next((one for one in succeeded if one["cycle"] in (*kinds, "refine", "motion")), None)
            if first and first["cycle"] in kinds and first["error_unit"] != "1":
                last = [one for one in succeeded if (one["cycle"], one["coil"]) == (first["cycle"], first["coil"])][-1]
                change = change_of(first["error_history"][0], last["error_history"][-1], first["error_unit"])
                cards.append((f"{title}, before → after", change, f"error, cycle {first['title'].lower()}"))
        return cards

    def joint_axes(self):
        """Rows of the joints' unit vectors: nominal, identified, and the angle between."""
        rows = []
        for axis in self._report.get("joint_axes", []):
            cross, cosine = cross_and_dot(axis["nominal"], axis["identified"])
            angle = math.atan2(math.sqrt(sum(value * value for value in cross)), cosine)
            vectors = [", ".join(f"{value:.5f}".replace("-", "−") for value in axis[key]) for key in ("nominal", "identified")]
            rows.append({"name": axis["name"], "nominal": vectors[0], "identified": vectors[1], "angle": with_unit(angle, "rad")})
        return rows

    # ---- since the last calibration ------------------------------------------------------------------

    def since_last(self):
        """What changed since an earlier report of this unit: date, count, rows; None without one."""
        old, own = self._previous, self._report
        if old is None or other_unit(old["actuator"], old["serial"], own["actuator"], own["serial"]):
            return None
        drifts = drifts_between(_identified(self._previous), _identified(self._report))
        return {
            "date": self._previous["date"].replace("T", " ").replace("Z", " UTC"),
            "revision": self._previous.get("revision"),
            "compared": len(drifts),
            "beyond": sum(drift.deviations > 3.0 for drift in drifts),
            "rows": [
                {"name": drift.name, "change": signed(drift.change, drift.unit), "ratio": significant(drift.deviations)}
                for drift in drifts[:MOST_INFLUENTIAL]
                if drift.deviations > 0.0
            ],
        }

    # ---- parameters ----------------------------------------------------------------------------------

    def parameter_groups(self):
        """Tables of parameters: joints, poles, coils, laboratory effects."""
        groups = {kind: [] for kind in KINDS}
        for item in self._parameters:
            groups[item["kind"]].append(self._parameter_row(item))
        return [(KINDS[kind], rows) for kind, rows in groups.items() if rows]

    @staticmethod
    def _parameter_row(item):
        unit = "" if item["unit"] == "1" else item["unit"]
        # One that takes part in an open direction moves with the others, though it is not identified.
        has_moved = item["value"] != item["nominal"]
        return {
            "name": item["name"],
            "nominal": f"{item['nominal']:.6g}".replace("-", "−"),
            "value": f"{plus_minus(item['value'], item['stddev'])} {unit}".strip(),
            "change": signed(item["value"] - item["nominal"], item["unit"]) if item["identified"] or has_moved else "–",
            "identified": item["identified"],
            "tag": "" if item["identified"] else "not identified" + (", relative only" if has_moved else ""),
        }

    def unidentified(self):
        return [item["name"] for item in self._parameters if not item["identified"]]

    # ---- cycles --------------------------------------------------------------------------------------

    def cycle_rows(self):
        rows = []
        for cycle in self._cycles:
            history = cycle["error_history"]
            rows.append(
                {
                    "name": cycle["title"],
                    "success": cycle["success"],
                    "message": cycle["message"],
                    "samples": self._samples_of(cycle),
                    "iterations": cycle["iterations"],
                    "error": change_of(history[0], history[-1], cycle["error_unit"]) if history else "–",
                    "chi_square": significant(cycle["reduced_chi_square"]) if history else "–",
                    "condition": significant(cycle["condition_number"]) if history else "–",
                    "time": f"{1e3 * cycle['solve_time']:.0f} ms",
                }
            )
        return rows

    @staticmethod
    def _samples_of(cycle):
        rejected = cycle["samples_rejected"]
        return f"{cycle['samples_used']} ({rejected} rejected)" if rejected else f"{cycle['samples_used']}"

    def convergence(self):
        groups = {}
        for cycle in self._cycles:
            if cycle["error_history"]:
                groups.setdefault((cycle["cycle"], cycle["error_unit"]), []).append(cycle)
        return [figures.convergence(kind, unit, cycles) for (kind, unit), cycles in groups.items()]

    # ---- residuals -----------------------------------------------------------------------------------

    def residual_figures(self):
        pictures = []
        for quantity in QUANTITIES:
            kind, residuals = self._residuals(quantity)
            if residuals:
                influential = [item["id"] for item in self._most_influential() if item["quantity"] == quantity]
                pictures.append(figures.residuals_of(quantity, kind, residuals, influential))
                pictures.append(figures.standardized_of(quantity, kind, residuals, influential))
        positions = {sample["id"]: figures.position_of(sample) for sample in self._report["samples"]}
        for quantity in QUANTITIES:
            kind, residuals = self._residuals(quantity)
            residuals = [item for item in residuals if kind == "sample" and item["id"] in positions]
            if residuals:
                pictures.append(figures.residuals_by_joint(quantity, residuals, positions, self._joints()))
        return pictures

    def residual_cycle(self):
        """Name of the cycle whose residuals are shown."""
        return (self._last_success() or {}).get("title")

    def rejected(self):
        """Rows of measurements that were taken for outliers by the last successful cycles."""
        shown = [(quantity, *self._residuals(quantity)) for quantity in QUANTITIES]
        return [
            {
                "of": f"{kind} {item['id']}",
                "quantity": quantity,
                "residual": with_unit(item["residual"], item["unit"]),
                "reason": item["reason"],
            }
            for quantity, kind, residuals in shown
            for item in residuals
            if item["rejected"]
        ]

    def influential(self):
        """Rows of the measurements without which the result would change most."""
        return [
            {
                "id": item["id"],
                "quantity": item["quantity"],
                "parameter": item["parameter"],
                "shift": "could not be told" if item["irreplaceable"] else f"{item['largest_shift']:.2g} σ",
                "leverage": f"{item['leverage']:.2f}",
            }
            for item in self._most_influential()
        ]

    def _most_influential(self):
        ordered = sorted(self._influences, key=lambda item: (not item["irreplaceable"], -item["largest_shift"]))
        return ordered[:MOST_INFLUENTIAL]

    def _residuals(self, quantity):
        """What they are of, samples or windows of a motion, and those of the last successful cycle that has any."""
        for cycle in reversed(self._cycles):
            chosen = [item for item in cycle["residuals"] if item["quantity"] == quantity]
            if cycle["success"] and chosen:
                return "window" if cycle["cycle"] == "motion" else "sample", chosen
        return "sample", []

    def _last_success(self):
        return next((cycle for cycle in reversed(self._cycles) if cycle["success"]), None)

    def _samples_in_words(self):
        samples = self._report["samples"]
        held_out = sum(sample["validation"] for sample in samples)
        return f"{len(samples) - held_out} in use, {held_out} held out"

    # ---- validation ----------------------------------------------------------------------------------

    def validation(self):
        """Numbers of what is held out; None where nothing is."""
        validation = self._report.get("validation")
        if not validation or not validation["residuals"]:
            return None
        rows = [(f"{validation.get('of', 'samples').capitalize()} held out", validation["samples"])]
        if validation["orientations"]:
            text = f"{with_unit(validation['orientation_rms'], 'rad')} rms of {validation['orientations']}"
            rows.append(("Orientation error", text))
        if validation["torques"]:
            text = f"{with_unit(validation['torque_rms'], 'N·m')} rms of {validation['torques']}"
            rows.append(("Torque error", text))
        chi_square = significant(validation["reduced_chi_square"])
        probability = significant(validation["probability"], 2)
        rows.append(("Reduced χ²", f"{chi_square} (1 on average)"))
        rows.append(("Probability of a worse χ²", probability))
        return {"rows": rows, "verdict": validation["verdict"], "chi_square": chi_square, "probability": probability}

    def validation_figures(self):
        return [figures.held_out(self._report["validation"])]

    def _joints(self):
        """Names and ranges of the joints; of the turns about the stator's axes where there are none."""
        joints = self._report["coverage"]["joints"]
        if joints:
            return joints
        turns = [figures.position_of(sample) for sample in self._report["samples"]] or [[0.0, 0.0, 0.0]]
        return [
            {"name": f"turn about {axis}", "lowest": min(angles), "highest": max(angles)}
            for axis, angles in zip("xyz", zip(*turns))
        ]

    # ---- coverage and workspace ----------------------------------------------------------------------

    def coverage_figures(self):
        coverage = self._report["coverage"]
        pictures = []
        if self._report["samples"]:
            tilt_limit = self._report["workspace"]["tilt"][-1]
            pictures.append(figures.poses(self._report["samples"], self._joints(), tilt_limit))
        for kind, counts in (("pole", coverage["poles"]), ("coil", coverage["coils"])):
            if counts:
                stddevs = [self._axis_stddev(f"{kind}_{number}") for number in range(1, len(counts) + 1)]
                pictures.append(figures.coverage(kind, counts, stddevs))
        return pictures

    def _axis_stddev(self, axis):
        """Of the worse angle of a pole or coil [rad]; None unless both are identified."""
        angles = [item for item in self._parameters if item["name"] in (f"{axis}/polar", f"{axis}/azimuth")]
        if not all(item["identified"] for item in angles):
            return None
        return max(item["stddev"] for item in angles)

    def workspace_figures(self):
        workspace = self._report["workspace"]
        joints = self._joints()
        return [
            figures.workspace_map(quantity, workspace["tilt"], workspace[quantity], joints)
            for quantity in QUANTITIES
            if workspace[quantity] and math.isfinite(workspace[quantity][0][0])
        ]

    def changes(self):
        """Picture of what calibration changed; None where nothing is identified."""
        geometry = [item for item in self._parameters if item["kind"] != "effect" and item["unit"] == "rad"]
        return figures.changes(geometry) if any(item["identified"] for item in geometry) else None

    # ---- laboratory effects --------------------------------------------------------------------------

    def model_choice(self):
        """Rows of the compared sets of laboratory effects; differences are from the smallest BIC."""
        fits = self._report.get("model_choice", [])
        least = min((fit["bic"] for fit in fits if fit["converged"]), default=None)
        return [
            {
                **{key: fit[key] for key in ("effects", "parameters", "converged")},
                "chi_square": significant(fit["reduced_chi_square"]),
                "bic": f"{fit['bic']:.1f}",
                "difference": f"{fit['bic'] - least:+.1f}" if least is not None else "–",
                "held_out": f"{1e3 * fit['held_out']:.3f} mrad" if "held_out" in fit else "–",
                "best": fit.get("best", False),
            }
            for fit in fits
        ]

    def motion(self):
        """What the last motion told; None without one."""
        cycle = next((one for one in reversed(self._cycles) if one["success"] and "motion" in one), None)
        return told_by(cycle, cycle["motion"]) if cycle else None

    def linearity(self):
        """Whether torque is proportional to current: sentence, and rows where it is told; None without torque."""
        linearity = self._report.get("torque_linearity")
        if linearity is None:
            return None
        rows = []
        for key, name in (("deviation", "At full current, from proportion"), ("asymmetry", "Positive, from the mean of both signs")):
            if key in linearity:
                share = linearity[key]
                rows.append((name, f"{plus_minus(100.0 * share['value'], 100.0 * share['stddev'])} %"))
        if linearity["told"]:
            currents = ", ".join(f"{current:.2f}" for current in linearity["currents"]).replace("-", "−")
            rows.insert(0, (f"Coil {linearity['coil']} at", f"{currents} A"))
            rows.append(("Probability if proportional", significant(linearity["probability"], 2)))
        return {"sentence": linearity["sentence"], "rows": rows}

    # ---- configuration -------------------------------------------------------------------------------

    def configuration(self):
        """Sections of the configuration with their keys and values."""
        return [
            (section, [(key, value) for key, value in keys.items()])
            for section, keys in self._report["configuration"].items()
        ]
