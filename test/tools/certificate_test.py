#!/usr/bin/python3
"""calibrate_bag --certificate: a certificate of the right structure, with the numbers of the covariance file."""

import os
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import yaml
from report_page_case import SOURCE, program, run

SI = "{https://ptb.de/si}"
POSITIONER = os.path.join(SOURCE, "config", "examples", "two_axis_positioner", "actuator.yaml")
RECORDING = os.path.join(os.environ["EXAMPLES"], "two_axis_positioner.bag")
VALIDATE = os.path.join(SOURCE, "dev", "validate_certificate")


def judged(path):
    return subprocess.run([VALIDATE, path], capture_output=True, text=True, check=False)


class Certificate(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = os.path.join(cls.folder.name, "certificate.xml")
        cls.covariance = os.path.join(cls.folder.name, "covariance.yaml")
        cls.outcome = run(
            program("calibrate_bag"), "--actuator", POSITIONER, "--output", os.path.join(cls.folder.name, "out.yaml"),
            "--certificate", cls.path, "--covariance", cls.covariance, RECORDING,
        )

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def text(self):
        with open(self.path, encoding="utf-8") as file:
            return file.read()

    def test_has_all_that_the_schema_requires(self):
        self.assertIn("Certificate: ", self.outcome.stdout, self.outcome.stderr)
        answer = judged(self.path)
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)

    def test_tells_the_numbers_of_the_covariance_file(self):
        root = ElementTree.parse(self.path).getroot()
        names = next(root.iter(SI + "labelXMLList")).text.split()
        columns = [[float(word) for word in column.find(SI + "valueXMLList").text.split()] for column in root.iter(SI + "covarianceXMLList")]
        with open(self.covariance, encoding="utf-8") as file:
            told = yaml.safe_load(file)["covariance"]
        places = [told["names"].index(name) for name in names]
        self.assertGreater(len(places), 3)
        for a, p in enumerate(places):
            for b, q in enumerate(places):
                self.assertEqual(columns[b][a], told["matrix"][p][q])
        shares = told["budget"]["shares"]
        for p in places:
            self.assertAlmostEqual(sum(shares[p]), 1.0, places=9)

    def test_is_judged_by_more_than_its_presence(self):
        """What the judge is for: a certificate that lost something is found out."""
        spoilt = os.path.join(self.folder.name, "spoilt.xml")
        first = ElementTree.parse(self.path).getroot().find(f".//{SI}valueExpandedMUXMLList").text
        for old, new in (
            ("<dcc:issuer>manufacturer</dcc:issuer>", ""),
            ("<dcc:mainSigner>true</dcc:mainSigner>", ""),
            ('schemaVersion="3.3.0"', 'schemaVersion="2.0.0"'),
            (first, first.split(" ", 1)[1]),
            (first, " ".join(["1.0"] + first.split()[1:])),
        ):
            self.assertIn(old, self.text())
            with open(spoilt, "w", encoding="utf-8") as file:
                file.write(self.text().replace(old, new, 1))
            self.assertEqual(judged(spoilt).returncode, 1, old)


if __name__ == "__main__":
    unittest.main()
