#!/usr/bin/python3
"""The page of a report: complete, self-contained, and harmless whatever names it is given."""

import base64
import copy
import html.parser
import os
import re
import shutil
import tempfile
import unittest
import unittest.mock

import yaml
from matplotlib.backends.backend_svg import FigureCanvasSVG
from program_module import loaded
from report_page_case import HOSTILE, SOURCE, actuator_file, calibrated, program, read, run


# Style, place, turn and content of a text in an SVG of matplotlib.
TEXT = re.compile(r'<text style="([^"]*)" x="([0-9.-]+)" y="([0-9.-]+)" transform="rotate\((-?\d+)[^"]*"[^>]*>([^<]*)')
RENDER_REPORT = loaded("render_report")
CHARACTER = 0.55  # of its size is what a character is wide on average


class Page(html.parser.HTMLParser):
    """Elements and table rows of a page."""

    def __init__(self, text):
        super().__init__()
        self.elements = []
        self.rows = []
        self.text = ""
        self._is_text = True
        self._is_cell = False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self._is_text = tag not in ("style", "script")
        if tag == "tr":
            self.rows.append([])
        if tag in ("th", "td"):
            self.rows[-1].append("")
            self._is_cell = True

    def handle_endtag(self, tag):
        if tag in ("th", "td"):
            self._is_cell = False

    def handle_data(self, data):
        if self._is_text:
            self.text += data
            if self._is_cell:
                self.rows[-1][-1] += data

    def of(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]

    def row(self, name):
        """Cells of the only row whose first word is this."""
        found = [row for row in self.rows if row and row[0].split()[:1] == [name]]
        assert len(found) == 1, f"{name}: {found}"
        return found[0]


class ReportPage(unittest.TestCase):
    """One short session: all 24 angles of poles and one coil, two coils that no sample excites."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        actuator = actuator_file(cls.folder.name, 3, HOSTILE)
        session = ("--joint-poses", "8", "--coil-poses", "0", "--validation-poses", "0", "--bad-dwells", "1")
        cls.outcome, cls.report = calibrated(cls.folder.name, actuator, session)
        cls.html = read(os.path.join(cls.report, "report.html"))
        cls.figures = yaml.safe_load(read(os.path.join(cls.report, "report.yaml")))["calibration_report"]
        cls.page = Page(cls.html)

    def render(self, figures, name, are_drawn=False):
        """Page of other figures. Unless they are drawn, pictures are empty: most tests ask for their titles at most."""
        path = os.path.join(self.folder.name, name)
        with open(path + ".yaml", "w", encoding="utf-8") as file:
            yaml.dump({"calibration_report": figures}, file, yaml.CSafeDumper, allow_unicode=True)
        previous = RENDER_REPORT.previous_report(path + ".yaml")
        reports = [RENDER_REPORT.read_report(file) if file else None for file in (path + ".yaml", previous)]
        if are_drawn:
            return Page(RENDER_REPORT.render(*reports))
        with unittest.mock.patch.object(FigureCanvasSVG, "print_svg", lambda _, content, **__: content.write(b"<svg/>")):
            return Page(RENDER_REPORT.render(*reports))

    def test_calibrate_bag_names_it(self):
        self.assertIn(self.outcome.returncode, (0, 1), self.outcome.stderr)
        self.assertIn(f"Report: {self.report}/report.html\n", self.outcome.stdout)
        self.assertEqual(sorted(os.listdir(self.report)), ["report.html", "report.yaml"])

    def test_needs_no_other_file(self):
        for attributes in self.page.of("img"):
            self.assertTrue(attributes["src"].startswith("data:image/"), attributes["src"][:40])
        for attributes in self.page.of("a"):
            self.assertTrue(attributes["href"].startswith("#"), attributes)
        for tag in ("link", "script", "iframe", "object", "base", "form"):
            self.assertEqual(self.page.of(tag), [], tag)
        for word in ("http:", "https:", "file:", "url(", "@import"):
            self.assertNotIn(word, self.html)

    def test_links_lead_to_sections(self):
        targets = {attributes["id"] for _, attributes in self.page.elements if "id" in attributes}
        for attributes in self.page.of("a"):
            self.assertIn(attributes["href"][1:], targets)

    def test_pictures_are_described(self):
        pictures = self.page.of("img")
        self.assertGreaterEqual(len(pictures), 11)
        descriptions = [attributes["alt"] for attributes in pictures]
        self.assertEqual(len(set(descriptions)), len(descriptions))
        for description in descriptions:
            self.assertGreater(len(description), 40)

    def test_every_axis_has_numbers(self):
        for attributes in self.page.of("img"):
            picture = base64.b64decode(attributes["src"].split(",", 1)[1]).decode("utf-8")
            parts = re.split(r'<g id="matplotlib\.axis_(\d+)"', picture)
            counts = {number: len(re.findall("<text", part.split('<g id="axes')[0])) for number, part in zip(parts[1::2], parts[2::2])}
            self.assertTrue(counts, attributes["alt"])
            for number, texts in counts.items():
                # Two numbers and the name of the axis; of a column for colours and of shared axes, less.
                if number == "2":
                    self.assertGreaterEqual(texts, 3, attributes["alt"])

    def test_no_text_of_a_picture_is_cut_off_or_beside_its_axis(self):
        for attributes in self.page.of("img"):
            svg = base64.b64decode(attributes["src"].split(",", 1)[1]).decode("utf-8")
            width, height = map(float, re.search(r'viewBox="0 0 ([0-9.]+) ([0-9.]+)"', svg).groups())
            for style, x, y, turn, text in TEXT.findall(svg):
                height_of_text = float(re.search(r"([0-9.]+)px", style)[1])
                length = CHARACTER * height_of_text * len(text)
                anchor = re.search(r"text-anchor: (\w+)", style)
                before = {"middle": 0.5, "end": 1.0}.get(anchor and anchor[1], 0.0) * length
                # Along the text, then across it.
                along, across = (height - float(y), float(x)) if turn == "-90" else (float(x), float(y))
                limits = (height, width) if turn == "-90" else (width, height)
                self.assertGreaterEqual(along, before, (attributes["alt"], text))
                self.assertLessEqual(along - before + length, limits[0], (attributes["alt"], text))
                self.assertGreaterEqual(across, 0.8 * height_of_text, (attributes["alt"], text))
                self.assertLessEqual(across, limits[1], (attributes["alt"], text))

    def test_a_short_logarithmic_axis_has_numbers(self):
        figures = dict(self.figures)
        cycle = dict(self.figures["cycles"][0], cycle="refine", error_unit="1", error_history=[0.97, 0.91])
        figures["cycles"] = [cycle]
        picture = next(item for item in self.render(figures, "short", are_drawn=True).of("img") if item["alt"].startswith("Joint: "))
        svg = base64.b64decode(picture["src"].split(",", 1)[1]).decode("utf-8")
        axis = svg.split('<g id="matplotlib.axis_2"')[1]
        numbers = [float(text) for text in re.findall(r">([0-9.]+)</text>", axis)]
        self.assertGreaterEqual(len(numbers), 2, numbers)

    def test_the_error_after_is_that_of_the_last_cycle_of_its_kind(self):
        figures = copy.deepcopy(self.figures)
        first = next(cycle for cycle in figures["cycles"] if cycle["cycle"] == "joint")
        first["error_history"] = [0.0331, 0.000011]
        figures["cycles"].append({**first, "error_history": [0.000011, 0.000099]})
        self.assertIn("33.1 → 0.099 mrad", self.render(figures, "again").text)

    def test_an_error_before_is_that_of_the_drawing(self):
        figures = copy.deepcopy(self.figures)
        cycle = next(cycle for cycle in figures["cycles"] if cycle["cycle"] == "joint")
        figures["cycles"] = [{**cycle, "cycle": "refine", "error_unit": "1"}, cycle]
        self.assertNotIn("Orientations, before → after", self.render(figures, "refined_first").text)

    def test_tells_errors_before_and_after_and_axes_as_vectors(self):
        self.assertIn("Orientations, before → after", self.page.text)
        for axis in self.figures["joint_axes"]:
            cells = self.page.row(axis["name"])
            shown = [float(value.replace("−", "-")) for value in cells[2].split(", ")]
            self.assertAlmostEqual(sum(value * value for value in shown), 1.0, delta=1e-4)
            for value, exact in zip(shown, axis["identified"]):
                self.assertAlmostEqual(value, exact, delta=1e-5)

    def test_tells_what_changed_since_the_last_calibration(self):
        moved = self.figures["parameters"][0]
        earlier = [dict(item) for item in self.figures["parameters"]]
        earlier[0]["value"] += 10.0 * moved["stddev"]
        for revision, parameters in ((3, earlier), (7, self.figures["parameters"])):
            folder = os.path.join(self.folder.name, f"report_revision_{revision}")
            os.makedirs(folder)
            figures = dict(self.figures, revision=revision, parameters=parameters)
            page = self.render(figures, os.path.join(folder, "report"))
        self.assertIn("revision 3: 1 of", " ".join(page.text.split()))
        rows = [row for row in page.rows if row[0] == moved["name"] and len(row) == 3]
        self.assertAlmostEqual(float(rows[0][2]), 10.0 / 2.0**0.5, delta=0.01)
        self.assertNotIn("Since the last calibration", self.page.text)

    def test_no_parameter_is_without_uncertainty(self):
        for parameter in self.figures["parameters"]:
            cells = self.page.row(parameter["name"])
            value, stddev = re.fullmatch(r"(\S+) ± (\S+) rad", cells[1]).groups()
            self.assertAlmostEqual(float(value.replace("−", "-")), parameter["value"], delta=0.1 * parameter["stddev"])
            self.assertAlmostEqual(float(stddev), parameter["stddev"], delta=0.06 * parameter["stddev"])

    def test_a_change_has_the_unit_of_its_parameter(self):
        example = dict(self.figures["parameters"][0], nominal=1.0, value=1.00125, stddev=1e-5, identified=True, kind="effect")
        expected = {"rad": "+1.25 mrad", "N·m": "+1.25 mN·m", "1": "+0.00125", "kg·m²": "+0.00125 kg·m²", "s²": "+0.00125 s²"}
        examples = [dict(example, name=f"example_{number}", unit=unit) for number, unit in enumerate(expected)]
        page = self.render(dict(self.figures, parameters=[*self.figures["parameters"], *examples]), "units")
        self.assertEqual([page.row(one["name"])[-1] for one in examples], list(expected.values()))
        self.assertTrue(page.row("example_3")[1].endswith(" kg·m²"))

    def test_names_what_is_not_identified(self):
        unidentified = [item["name"] for item in self.figures["parameters"] if not item["identified"]]
        self.assertIn("coil_3/azimuth", unidentified)
        self.assertIn(", ".join(unidentified), self.page.text)
        for parameter in self.figures["parameters"]:
            said = "not identified" in self.page.row(parameter["name"])[0]
            self.assertEqual(said, not parameter["identified"], parameter["name"])

    def test_tells_verdict_steps_origin_and_validation(self):
        self.assertIn(self.figures["verdict"]["sentence"], self.page.text)
        for step in self.figures["next_steps"]:
            self.assertIn(step, self.page.text)
        self.assertIn(self.figures["source"][0]["checksum"], self.page.text)
        self.assertIn(self.figures["validation"]["verdict"], self.page.text)
        self.assertIn(self.figures["configuration"]["currents"]["bias_removal"], self.page.text)

    def test_lists_cycles_and_rejected_measurements(self):
        self.assertIn(self.figures["cycles"][0]["message"], self.page.row("Joint")[-1])
        rejected = [item for item in self.figures["cycles"][-1]["residuals"] if item["rejected"]]
        self.assertTrue(rejected)
        for item in rejected:
            self.assertIn(
                (f"sample {item['id']}", item["quantity"], item["reason"]),
                [(row[0], row[1], row[-1]) for row in self.page.rows if len(row) == 4],
            )

    def test_calls_cycles_as_the_report_does(self):
        cycle = dict(self.figures["cycles"][-1], cycle="swing", title="Swinging", title_of_kind="Swings")
        page = self.render(dict(self.figures, cycles=[*self.figures["cycles"][:-1], cycle]), "titles")
        self.assertIn(cycle["message"], page.row("Swinging")[-1])
        self.assertTrue([item for item in page.of("img") if item["alt"].startswith("Swings: ")])

    def test_sorts_parameters_by_their_kind_and_draws_angles_alone(self):
        angle = dict(self.figures["parameters"][0], name="wear", kind="coil", identified=True)
        strength = dict(angle, name="strength", unit="1", nominal=0.0, value=700.0)
        page = self.render(dict(self.figures, parameters=[*self.figures["parameters"], angle, strength]), "kinds")
        names = [row[0].split()[0] for row in page.rows if row]
        self.assertEqual(names.index("strength"), names.index("wear") + 1)
        drawn = sum(item["identified"] for item in self.figures["parameters"]) + 1
        change = next(item["alt"] for item in page.of("img") if item["alt"].startswith("Difference between"))
        self.assertIn(f" of {drawn} parameters", change)

    def test_names_are_no_markup(self):
        self.assertIn(HOSTILE, self.page.text)
        self.assertNotIn("<script", self.html)
        self.assertNotIn("<img src=x", self.html)

    def test_the_same_figures_give_the_same_bytes(self):
        again = os.path.join(self.folder.name, "again.html")
        run(program("render_report"), os.path.join(self.report, "report.yaml"), again)
        self.assertEqual(read(again), self.html)

    def test_a_session_without_success_has_a_page(self):
        figures = dict(self.figures, influences=[], validation=None)
        nothing = {"error_history": [], "residuals": [], "reduced_chi_square": 0.0, "condition_number": 0.0}
        figures["cycles"] = [dict(self.figures["cycles"][0], success=False, **nothing)]
        figures["parameters"] = [dict(item, identified=False) for item in self.figures["parameters"]]
        figures["verdict"] = {"grade": "failed", "sentence": "Nothing is calibrated."}
        page = self.render(figures, "failed")
        self.assertIn("Failed", page.text)
        self.assertIn("Nothing was held out", page.text)
        row = page.row("Joint")
        self.assertIn("failed", row[0])
        self.assertEqual(row.count("–"), 3, row)

    def test_what_rounds_to_zero_has_no_sign(self):
        figures = copy.deepcopy(self.figures)
        figures["parameters"][0].update(value=-1e-9, stddev=0.012)
        text = self.render(figures, "zero").text
        self.assertIn("0.000 ± 0.012", text)
        self.assertNotIn("−0.000 ± 0.012", text)

    def test_a_joint_alone_has_a_page(self):
        figures = dict(self.figures)
        figures["coverage"] = dict(self.figures["coverage"], poles=[], coils=[])
        figures["workspace"] = dict(self.figures["workspace"], torque=[])
        figures["parameters"] = self.figures["parameters"][:9]
        figures["cycles"] = self.figures["cycles"][:1]
        page = self.render(figures, "joint")
        self.assertNotIn("Magnet poles", page.text)
        self.assertFalse([item for item in page.of("img") if "torque" in item["alt"]])

    def test_laboratory_effects_are_compared(self):
        figures = dict(self.figures)
        effect = {"name": "torque_bias/x", "nominal": 0.0, "value": 2.7e-3, "stddev": 4e-5, "identified": True}
        figures["parameters"] = self.figures["parameters"] + [dict(effect, unit="N·m", kind="effect")]
        fit = {"effects": "none", "converged": True, "parameters": 31, "chi_square": 900.0, "reduced_chi_square": 3.0}
        # By the regions that it predicts, which the smaller criterion does not tell.
        figures["model_choice"] = [
            dict(fit, bic=1076.5, best=True, held_out=1e-4), dict(fit, effects="all", bic=400.25, best=False, held_out=2e-4)
        ]  # fmt: skip
        page = self.render(figures, "effects")
        self.assertEqual(page.row("torque_bias/x")[1], "0.002700 ± 0.000040 N·m")
        self.assertIn("best", page.row("none")[0])
        self.assertNotIn("best", page.row("all")[0])
        self.assertEqual(page.row("none")[-2:], ["+676.2", "0.100 mrad"])

    def test_tells_whether_torque_is_proportional_to_current(self):
        self.assertIn("proportional to current is not told", self.page.text)
        told = {"sentence": "Torque is not proportional to current.", "told": True, "coil": 3, "currents": [2.0, 1.0, -2.0]}
        told.update(deviation={"value": -0.0203, "stddev": 0.0011}, asymmetry={"value": 0.0, "stddev": 0.0004}, probability=1e-90)
        page = self.render(dict(self.figures, torque_linearity=told), "linearity")
        for part in ("Torque is not proportional to current.", "2.00, 1.00, −2.00 A", "−2.03 ± 0.11 %", "0.000 ± 0.040 %", "1e-90"):
            self.assertIn(part, page.text)

    def test_tells_of_a_motion_what_served_and_what_else_moved_the_rotor(self):
        self.assertNotIn("Residual torque over the motion", self.html)
        motion = {"duration": 2.5, "windows": 12, "windows_used": 10, "orientations": 600, "orientations_rejected": 3}
        motion["windows_left_out"] = [{"count": 2, "reason": "something else moved the rotor"}]
        motion.update(joint_stddev=[2e-5, 3e-5, 4e-5], current_stddev=1e-3, orientation_stddev=5e-4)
        motion.update(commands={"delay": 1.5e-3, "time_constant": 2e-3, "stddev": 12e-6})
        motion.update(window_chi_square=1.02, orientation_chi_square=0.97)
        cycle = dict(next(one for one in self.figures["cycles"] if one["success"]), cycle="motion", title="Motion", motion=motion)
        estimate = {"initial": 0.0, "observable": True}
        cycle["estimates"] = [
            dict(estimate, name="rotor_inertia/zz", nominal=1.3e-3, value=1.43e-3, stddev=1e-6, unit="kg·m²"),
            dict(estimate, name="coulomb_friction", nominal=0.0, value=4.2e-4, stddev=2.5e-5, unit="N·m"),
            dict(estimate, name="tracker_delay", nominal=0.0, value=4e-3, stddev=5e-6, unit="s", observable=False),
        ]
        residual = {"quantity": "torque", "unit": "N·m", "standardized": 1.0}
        cycle["residuals"] = [dict(residual, id=n, residual=1e-4 * n, rejected=n > 10, reason="") for n in range(1, 13)]
        page = self.render(dict(self.figures, cycles=[*self.figures["cycles"], cycle]), "motion")
        for part in ("10 of 12", "something else moved the rotor", "600 (3 rejected)", "0.02 mrad, 0.03 mrad, 0.04 mrad", "1.02", "3.500 ± 0.012 ms later", "some 2 ms"):
            self.assertIn(part, page.text)
        self.assertIn(["window 12", "torque"], [row[:2] for row in page.rows])
        self.assertEqual(page.row("rotor_inertia/zz")[1:], ["0.0014300 ± 0.0000010 kg·m²", "0.0013", "+10.00 %"])
        self.assertIn("0.000420 ± 0.000025 N·m", page.row("coulomb_friction"))
        self.assertIn("not identified", page.row("tracker_delay")[0])
        pictures = [attrs["alt"] for attrs in page.of("img")]
        told = "Mean residual torque of each of 12 windows over time: at most 1 mN·m among those used, 2 left out."
        self.assertIn(told, pictures)

    def test_tells_windows_that_were_held_out_from_samples(self):
        self.assertIn("Samples held out", self.page.text)
        validation = dict(self.figures["validation"], of="windows")
        page = self.render(dict(self.figures, validation=validation), "windows")
        self.assertIn("Windows held out", page.text)
        self.assertNotIn("Samples held out", page.text)

    def test_refuses_what_is_no_report(self):
        page = os.path.join(self.folder.name, "none.html")
        for content, part in (
            ("calibration_report: [", "this is not valid YAML"),
            ("{a: 1}", "not the report of a calibration"),
            ("calibration_report: {actuator: a}", "of another version of this package, or damaged"),
        ):
            path = os.path.join(self.folder.name, "none.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(content)
            outcome = run(program("render_report"), path, page)
            self.assertEqual(outcome.returncode, 2)
            self.assertIn(part, outcome.stderr)
            self.assertNotIn("Traceback", outcome.stderr)
            self.assertFalse(os.path.exists(page))

    def test_leaves_no_part_of_a_page(self):
        folder = os.path.join(self.folder.name, "occupied")
        os.makedirs(os.path.join(folder, "page.html"))
        outcome = run(program("render_report"), os.path.join(self.report, "report.yaml"), folder + "/page.html")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("not a regular file", outcome.stderr)
        self.assertEqual(os.listdir(folder), ["page.html"])

    def calibrate_positioner(self, calibrate_bag, name):
        """Output of a calibration of the example, which leaves an axis open; the folder of its report."""
        actuator = os.path.join(SOURCE, "config", "examples", "two_axis_positioner", "actuator.yaml")
        bag = os.path.join(os.environ["EXAMPLES"], "two_axis_positioner.bag")
        report = os.path.join(self.folder.name, name)
        outcome = run(calibrate_bag, "--actuator", actuator, "--output", report + ".yaml", "--report", report, bag)
        self.assertEqual(outcome.returncode, 1)
        return outcome, report

    def test_needs_no_sourced_environment(self):
        with unittest.mock.patch.dict(os.environ):
            os.environ.pop("PYTHONPATH", None)
            _, report = self.calibrate_positioner(program("calibrate_bag"), "unsourced")
        self.assertEqual(sorted(os.listdir(report)), ["report.html", "report.yaml"])

    def test_the_figures_stand_without_the_page(self):
        alone = os.path.join(self.folder.name, "calibrate_bag")
        shutil.copy(program("calibrate_bag"), alone)
        outcome, report = self.calibrate_positioner(alone, "alone")
        self.assertIn("warning: There is no page of the report: ", outcome.stderr)
        self.assertEqual(os.listdir(report), ["report.yaml"])
        self.assertTrue(os.path.exists(report + ".yaml"))


if __name__ == "__main__":
    unittest.main()
