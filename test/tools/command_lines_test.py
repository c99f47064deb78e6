#!/usr/bin/python3
"""Programs in Python take a command line as those in C++ do: options by their whole name, each once."""

import contextlib
import io
import os
import pathlib
import subprocess
import tempfile
import unittest

from spherical_actuator_calibration.command_line import parser

SOURCE = pathlib.Path(os.environ["SOURCE"])
PROGRAMS = (
    "calibrate_by_motion",
    "export_session",
    "guided_session",
    "import_csv",
    "level_1_by_coils",
    "list_revisions",
    "plot_study",
    "plot_tracking",
    "render_report",
    "run_motion",
    "session_engine",
    "track_orientation",
)
SHELL_PROGRAMS = [path for path in sorted((SOURCE / "scripts").iterdir()) if b"bash" in path.read_bytes().partition(b"\n")[0]]


class CommandLines(unittest.TestCase):
    def setUp(self):
        self.command_line = parser("turn", "Turns.")
        self.command_line.add_argument("--force", action="store_true")
        self.command_line.add_argument("--name", default="")
        self.command_line.add_argument("--option", action="append", default=[])
        self.command_line.add_argument("files", nargs="*")

    def expect_refusal(self, part, *arguments):
        said = io.StringIO()
        with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(said):
            self.command_line.parse_args(arguments)
        self.assertEqual(ended.exception.code, 2)
        self.assertIn(part, said.getvalue())

    def test_takes_whole_names(self):
        options = self.command_line.parse_args(["--name=a", "--force", "b", "b"])
        self.assertEqual((options.name, options.force, options.files), ("a", True, ["b", "b"]))
        self.expect_refusal("unrecognized arguments: --forc", "--forc")
        self.expect_refusal("unrecognized arguments: --nam=a", "--nam=a")

    def test_takes_an_option_once(self):
        self.expect_refusal("--force is given more than once", "--force", "--force")
        self.expect_refusal("--name is given more than once", "--name", "a", "--name=b")

    def test_gathers_where_the_option_does(self):
        options = self.command_line.parse_args(["--option=--tilt=0.3", "--option=--tilt=0.4"])
        self.assertEqual(options.option, ["--tilt=0.3", "--tilt=0.4"])

    def test_takes_files_of_any_name_behind_two_dashes(self):
        options = self.command_line.parse_args(["--force", "--", "--force", "--force"])
        self.assertEqual(options.files, ["--force", "--force"])

    def test_a_guided_session_without_a_master_says_so(self):
        nowhere = "http://127.0.0.1:9"
        result = subprocess.run(
            [SOURCE / "scripts" / "guided_session"],
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
            env={**os.environ, "ROS_MASTER_URI": nowhere},
        )
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn(f"guided_session: no ROS master answers at {nowhere}; start lab.launch.", result.stderr)

    def test_programs_refuse_what_they_do_not_know(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in PROGRAMS:
                with self.subTest(name):
                    command = [SOURCE / "scripts" / name, "--hel"]
                    result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
                    self.assertEqual(result.returncode, 2, result.stdout)
                    self.assertIn(f"{name}: error: ", result.stderr)
                    self.assertIn("; --help tells the options", result.stderr)
            self.assertEqual(os.listdir(folder), [])

    def test_programs_in_shell_start_nothing_where_they_are_asked_for_help(self):
        asked = [(path.name, argument, 0) for path in SHELL_PROGRAMS for argument in ("--help", "-h")]
        wrong = [("motion_demo", "--seed", 2), ("tracking_demo", "--seed", 2), ("record_session", "--hel", 1)]
        self.assertGreater(len(asked), len(wrong))
        for name, argument, status in asked + wrong:
            with self.subTest(name, argument=argument), tempfile.TemporaryDirectory() as folder:
                # What is built and shown stays here.
                places = {**os.environ, "BUILD_DIR": folder, "DEMO_DIR": os.path.join(folder, "demo"), "ROS_HOME": folder}
                command = [SOURCE / "scripts" / name, argument]
                result = subprocess.run(
                    command, capture_output=True, text=True, check=False, cwd=folder, env=places, timeout=20
                )
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertIn(name, result.stdout + result.stderr)
                self.assertNotIn("set -euo", result.stdout)
                self.assertEqual(os.listdir(folder), [])

    def test_programs_for_maintainers_do_nothing_where_they_are_asked_for_help(self):
        programs = [path for path in sorted((SOURCE / "dev").iterdir()) if path.is_file() and not path.suffix]
        self.assertGreater(len(programs), 20)
        for path in programs:
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                places = {**os.environ, "BUILD_DIR": folder, "KEPT": folder}
                result = subprocess.run(
                    [path, "--help"], capture_output=True, text=True, check=False, cwd=folder, env=places, timeout=20
                )
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertRegex(result.stdout, r"^\w.*\w.*")
                self.assertNotIn("set -euo", result.stdout)
                self.assertEqual(os.listdir(folder), [])

    def test_demonstrations_take_a_description_of_the_callers_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [SOURCE / "scripts" / "demo", "--actuator", "./own.yaml"]
            result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn(f"there is no {os.path.realpath(folder)}/own.yaml,", result.stderr)

    def test_no_program_parses_by_itself(self):
        for folder in ("scripts", "src"):
            for path in sorted((SOURCE / folder).rglob("*")):
                if path.is_file() and path.suffix in ("", ".py") and path.name != "command_line.py":
                    self.assertNotIn("argparse", path.read_text(encoding="utf-8"), path)


if __name__ == "__main__":
    unittest.main()
