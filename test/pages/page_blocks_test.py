#!/usr/bin/python3
"""The test of pages fails when a page is wrong."""

import pathlib
import shutil
import tempfile
import unittest

from page_blocks import PageError, blocks_of
from page_test import Reader

FENCE = "```"


def page(how, text, language="bash"):
    comment = f"<!-- block: {how} -->\n" if how else ""
    return f"{comment}{FENCE}{language}\n{text}\n{FENCE}\n"


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder, ignore_errors=True)
        cls.reader = Reader(pathlib.Path(folder))

    def failures(self, text):
        (self.reader.package / "page.md").write_text(text)
        return self.reader.read("page.md")

    def test_a_comment_that_says_nothing_known_is_an_error(self):
        for text in (page("skip it", "true"), "<!-- block: alone -->\nwords\n", f"{FENCE}bash\ntrue\n"):
            with self.assertRaises(PageError):
                blocks_of(text)

    def test_commands_succeed_in_one_shell(self):
        self.assertEqual(self.failures(page("", "a=1\ncd config\ntest $a = 1") + page("", "test -e calibration.yaml")), [])

    def test_a_command_that_fails_is_told(self):
        for text in ("false\ntrue", "calibrate_bag --nothing", "rosrun spherical_actuator_calibration no_program", "false | true"):
            self.assertEqual(len(self.failures(page("", text))), 1, text)
        self.assertEqual(self.failures(page("status 1; it is so", "false")), [])
        self.assertEqual(len(self.failures(page("status 1; it is so", "true"))), 1)

    def test_a_service_that_refuses_is_told(self):
        self.assertEqual(len(self.failures(page("", "echo 'success: False'"))), 1)

    def test_what_runs_elsewhere_is_there(self):
        self.assertEqual(len(self.failures(page("run by TorqueCurve.NoSuchTest; long", "scripts/demo"))), 1)
        self.assertEqual(len(self.failures(page("run by tool.report_page_test; long", "dev/no_such_program"))), 1)
        self.assertEqual(self.failures(page("run by tool.report_page_test; long", "scripts/demo")), [])

    def test_tests_that_are_listed_are_there(self):
        self.assertEqual(self.failures(page("listed", "cd build\nctest -R tool.report_page_test")), [])
        self.assertEqual(len(self.failures(page("listed", "cd build; ctest -R no_such_test"))), 1)

    def test_descriptions_are_read(self):
        self.assertEqual(len(self.failures(page("", "actuator: {name: a}", "yaml"))), 1)


if __name__ == "__main__":
    unittest.main()
