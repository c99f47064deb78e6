#!/usr/bin/python3
"""Readers in Python take what comes from outside as those in C++ do: bounded, regular, and nothing obeys a terminal."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

from spherical_actuator_calibration.text_files import (
    TextFileError,
    excerpt,
    parsed_yaml,
    printable,
    read_bytes,
    read_text,
    read_yaml,
    require_separate_files,
    require_writable,
    write_text,
)

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
SOURCE = pathlib.Path(os.environ["SOURCE"])
ACTUATOR = SOURCE / "config" / "pm_spherical_8x24.yaml"
PATIENCE = 300.0  # [s] for what must end by itself, on however busy a computer
HOSTILE = {
    "deep_lists.yaml": "- " * 200000 + "1",
    "deep_flow.yaml": "[" * 100000,
    "deep_maps.yaml": "".join(f"{' ' * n}a:\n" for n in range(300)),
    "aliases.yaml": "a0: &a0 [1, 1]\n" + "".join(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 40)),
    "itself.yaml": "a: &a [*a]\n",
    "two.yaml": "a: 1\n---\na: 2\n",
    "digits.yaml": "a: " + "9" * 100000 + "\n",
    "day.yaml": "a: 2024-99-99\n",
    "escape.yaml": "a: \x1b[31m\n",
    "many.yaml": "".join(f"k{n}: {n}\n" for n in range(600000)),
}


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def refusal(self, action, *arguments):
        with self.assertRaises(TextFileError) as caught:
            action(*arguments)
        return str(caught.exception)


class TextFiles(Folder):
    def test_only_regular_files_are_read(self):
        os.mkfifo(self.folder / "fifo")
        self.assertIn("is a FIFO, not a file.", self.refusal(read_text, self.folder / "fifo"))
        self.assertIn("is a device, not a file.", self.refusal(read_text, "/dev/zero"))
        self.assertIn("is a folder, not a file.", self.refusal(read_text, self.folder))
        self.assertIn("cannot be read: No such file", self.refusal(read_text, self.folder / "none"))
        self.assertIn("cannot be read: ", self.refusal(read_text, "a\0b"))

    def test_size_and_encoding_are_told(self):
        path = self.folder / "a.yaml"
        path.write_bytes(b"12345")
        self.assertEqual(read_text(path, 5), "12345")
        self.assertIn("is larger than 4 bytes", self.refusal(read_text, path, 4))
        path.write_bytes(b"a: 1\nb: \xff\n")
        self.assertIn("a.yaml:2: a byte 0xff is no text in UTF-8.", self.refusal(read_text, path))

    def test_sparse_files_are_refused_by_their_size(self):
        path = self.folder / "sparse"
        with open(path, "wb") as file:
            file.truncate(2 << 30)
        begin = time.process_time()
        self.assertIn("is larger than 1073741824 bytes", self.refusal(read_bytes, path, 1 << 30))
        self.assertLess(time.process_time() - begin, 0.1)

    def test_reports_of_many_samples_are_read(self):
        residual = "- {id: 1, quantity: torque, residual: 1.0e-3, unit: N, standardized: 0.5, rejected: false}\n"
        self.assertEqual(len(parsed_yaml(20000 * residual, "a")), 20000)

    def test_documents_that_cost_more_than_their_text_are_refused(self):
        for name, text in HOSTILE.items():
            with self.subTest(name):
                (self.folder / name).write_text(text, encoding="utf-8")
                said = self.refusal(read_yaml, self.folder / name)
                self.assertTrue(said.startswith(str(self.folder / name)), said)
                self.assertNotIn("\x1b", said)

    def test_documents_are_read(self):
        self.assertEqual(parsed_yaml("", "a"), None)
        self.assertEqual(parsed_yaml("a: &x [1, 2.5]\nb: *x\n", "a"), {"a": [1, 2.5], "b": [1, 2.5]})
        self.assertEqual(parsed_yaml("[" * 64 + "]" * 64, "a")[0][0], parsed_yaml("[" * 62 + "]" * 62, "a"))
        self.assertIn("a:1: maps and lists stand more than 64", self.refusal(parsed_yaml, "[" * 65 + "]" * 65, "a"))

    def test_what_takes_more_time_than_its_text_is_told_at_once(self):
        prime = (1 << 61) - 1  # of its multiples Python's hashes are the same
        for text, part in (
            ("".join(f"{k * prime}: 0\n" for k in range(1, 50001)), "x:9: a whole number has more than 64 bit"),
            ('a: !!int "1' + ":1" * 100000 + '"', "x:1: a tag, tag:yaml.org,2002:int, is not read"),
            ("".join("- 1" + ":1" * 500 + "\n" for _ in range(20000)), "x:1: a whole number has more than 64 bit"),
            ("a: !!set {b, c}\n", "x:1: a tag, tag:yaml.org,2002:set, is not read"),
            ("".join(f"%TAG !e{k}! tag:x,2000:\n" for k in range(50000)) + "---\na\n", "x:9: more than 8 lines begin"),
            ("\ufeff" + "\r%TAG ! !" * 9 + "\r---\ra\r", "x:1: more than 8 lines begin"),
        ):
            with self.subTest(part):
                begin = time.process_time()
                self.assertIn(part, self.refusal(parsed_yaml, text, "x"))
                self.assertLess(time.process_time() - begin, 3.0)

    def test_numbers_of_64_bit_and_texts_are_read(self):
        largest = {"a": (1 << 64) - 1, "b": -(1 << 63), "c": "9" * 30, "d": "1", "e": "x", "f": 1e300}
        text = f"%YAML 1.1\n---\na: {hex(largest['a'])}\nb: {largest['b']}\nc: '{largest['c']}'\n"
        text += "d: !!str 1\ne: ! x\nf: 1.0e+300\n"
        self.assertEqual(parsed_yaml(text, "x"), largest)
        for number in ("18446744073709551616", "-9223372036854775809", "0b1" + "0" * 64, "0x1" + "0" * 90):
            self.assertIn("x:1: a whole number has more than 64 bit", self.refusal(parsed_yaml, f"a: {number}", "x"))

    def test_terminals_are_not_obeyed(self):
        self.assertEqual(printable("a\tb\nä €"), "a\tb\nä €")
        self.assertEqual(printable("\x1b[31m\r\x7f\x9b"), "\\x1b[31m\\x0d\\x7f\\xc2\\x9b")
        self.assertEqual(printable("\u202egnp"), "\\xe2\\x80\\xaegnp")
        for sign in "\u200e\u200f\u2028\u2029\u202a\u202e\u2066\u2069":
            self.assertTrue(printable(sign).startswith("\\xe2"), sign)
        for sign in "\u200d\u2010\u202f\u2065":
            self.assertEqual(printable(sign), sign)
        self.assertEqual(printable(os.fsdecode(b"a\xff") + "\ud800"), "a\\xff\\xed\\xa0\\x80")

    def test_excerpts_are_short_and_one_line(self):
        self.assertEqual(excerpt("a\nFATAL: forged\t"), "a\\x0aFATAL: forged\\x09")
        self.assertEqual(excerpt("ä" * 80), "ä" * 80)
        self.assertEqual(excerpt("ä" * 81), "ä" * 80 + "...")

    def test_one_file_has_one_role(self):
        path = self.folder / "in.csv"
        path.write_text("1", encoding="utf-8")
        os.link(path, self.folder / "hard.csv")
        os.symlink(path, self.folder / "soft.csv")
        for name in ("in.csv", "hard.csv", "soft.csv"):
            output = self.folder / name
            said = self.refusal(require_separate_files, [("SAMPLES.csv", path)], [("--output", output)])
            self.assertEqual(said, f"--output: {output} is the file that SAMPLES.csv reads; choose another name.")
        both = [("--a", self.folder / "new"), ("--b", f"{self.folder}/./new")]
        self.assertIn("--b: ", self.refusal(require_separate_files, [], both))
        require_separate_files([("--x", path), ("--y", None)], [("--output", self.folder / "new"), ("--b", None)])

    def test_files_are_replaced_whole(self):
        path = self.folder / "out.yaml"
        write_text(path, "a: ä\n")
        with self.assertRaises(TextFileError):
            write_text(path, "a: \ud800")
        self.assertEqual(path.read_bytes(), "a: ä\n".encode())
        self.assertEqual(os.listdir(self.folder), ["out.yaml"])
        path.unlink()
        longest = self.folder / ("ä" * 127)
        require_writable(longest)
        write_text(longest, "b: 2\n")
        self.assertEqual(os.listdir(self.folder), [longest.name])

    def test_names_that_cannot_be_written(self):
        os.mkfifo(self.folder / "fifo")
        for path, reason in (
            (self.folder / "none" / "out", "cannot be written: No such file"),
            (self.folder / "fifo", "not a regular file"),
            (self.folder, "not a regular file"),
            ("/dev/full", "not a regular file"),
            (self.folder / ("x" * 256), "cannot be written: File name too long"),
        ):
            self.assertIn(reason, self.refusal(require_writable, path))
            self.assertIn(reason, self.refusal(write_text, path, "1"))
        require_writable(self.folder / "new")
        self.assertEqual(os.listdir(self.folder), ["fifo"])


class Programs(Folder):
    """Each ends with status 2 and one sentence of printable text."""

    def expect_refusal(self, name, *arguments, part=""):
        command = [str(argument) for argument in (PROGRAMS / name, *arguments)]
        outcome = subprocess.run(
            command, capture_output=True, text=True, check=False, cwd=self.folder, timeout=PATIENCE
        )
        self.assertEqual(outcome.returncode, 2, outcome.stdout + outcome.stderr)
        self.assertTrue(outcome.stderr.startswith(f"{name}: "), outcome.stderr)
        self.assertEqual(outcome.stderr.count("\n"), 1, outcome.stderr)
        self.assertNotIn("\x1b", outcome.stdout + outcome.stderr)
        self.assertIn(part, outcome.stderr)

    def test_fifos_and_devices(self):
        os.mkfifo(self.folder / "fifo")
        for path in ("fifo", "/dev/zero"):
            self.expect_refusal("import_csv", "--actuator", path, "--output", "o.bag", "s.csv", part="not a file")
            self.expect_refusal("import_csv", "--actuator", ACTUATOR, "--output", "o.bag", path, part="not a file")
            self.expect_refusal("render_report", path, "o.html", part="not a file")
        arguments = ("--actuator", ACTUATOR, "--output", "o.bag", "--streams", "fifo")
        self.expect_refusal("import_csv", *arguments, part="not a file")
        self.expect_refusal("plot_study", "fifo", "o.png", part="not a file")
        self.expect_refusal("plot_tracking", "o.png", "fifo", part="not a file")

    def test_nested_documents(self):
        for name in ("deep_lists.yaml", "deep_flow.yaml"):
            (self.folder / name).write_text(HOSTILE[name], encoding="utf-8")
            self.expect_refusal("import_csv", "--actuator", name, "--output", "o.bag", "s.csv", part=name)
            arguments = ("--actuator", ACTUATOR, "--output", "o.bag", "--streams", name)
            self.expect_refusal("import_csv", *arguments, part="64 deep")
            self.expect_refusal("render_report", name, "o.html", part="64 deep")
        self.expect_refusal("plot_study", "deep_lists.yaml", "o.png", part="64 deep")

    def test_control_characters_of_names_and_headings(self):
        (self.folder / "s.csv").write_text("joint_1,\x1b[31mjoint_2\n", encoding="utf-8")
        self.expect_refusal("import_csv", "--actuator", ACTUATOR, "--output", "o.bag", "s.csv", part="\\x1b[31m")
        self.expect_refusal("render_report", "\x1b[31m.yaml", "o.html", part="\\x1b[31m")
        self.expect_refusal("export_session", "\x1b[31m.db", "o", part="\\x1b[31m")

    def test_forged_lines_and_large_texts_of_files(self):
        forged = 'streams: [{stream: "a\\nFATAL: forged\\n\\u2028", file: x}]\n'
        (self.folder / "i.yaml").write_text(forged, encoding="utf-8")
        arguments = ("--actuator", ACTUATOR, "--output", "o.bag", "--streams", "i.yaml")
        self.expect_refusal("import_csv", *arguments, part="\\x0aFATAL: forged\\x0a\\xe2\\x80\\xa8")
        (self.folder / "i.yaml").write_text("streams: [{stream: " + "x" * 900000 + ", file: x}]\n", encoding="utf-8")
        self.expect_refusal("import_csv", *arguments, part="...")
        (self.folder / "large").write_bytes(b"#" * (9 << 20))
        arguments_of_large = ("--actuator", "large", "--output", "o.bag", "s.csv")
        self.expect_refusal("import_csv", *arguments_of_large, part="larger than 8388608")
        self.expect_refusal("import_csv", *arguments[:-1], "large", part="larger than 1048576")

    def test_plans_are_read_before_anything_waits(self):
        os.mkfifo(self.folder / "fifo")
        (self.folder / "comma").write_text(",", encoding="utf-8")
        (self.folder / "other").write_text("session_plan: {}", encoding="utf-8")
        for plan, part in (
            ("none", "none: cannot be read: No such file"),
            ("fifo", "fifo: is a FIFO, not a file."),
            ("/dev/zero", "is a device, not a file."),
            ("comma", "comma:1: this is not valid YAML"),
            ("other", "other: this is no plan of plan_motion: the key motion_plan is missing."),
        ):
            self.expect_refusal("run_motion", plan, part=part)
            arguments = ("--actuator", ACTUATOR, "--directory", "new")
            self.expect_refusal("calibrate_by_motion", *arguments, "--plan", plan, part=part)
            self.assertFalse((self.folder / "new").exists())
        arguments = ("--actuator", "none", "--directory", "new")
        self.expect_refusal("calibrate_by_motion", *arguments, part="none: cannot be read")

    def test_sessions_that_are_none_leave_no_folder(self):
        (self.folder / "text").write_text("no database", encoding="utf-8")
        for path in ("text", "none", "/dev/zero"):
            self.expect_refusal("export_session", path, "new", part=f"{path}: ")
            self.expect_refusal("list_revisions", path, part=f"{path}: ")
            self.assertFalse((self.folder / "new").exists())

    def test_inputs_are_not_replaced(self):
        (self.folder / "s.csv").write_text("joint_1,joint_2,joint_3\n0,0,0\n", encoding="utf-8")
        arguments = ("--actuator", ACTUATOR, "--force", "--output", "s.csv", "s.csv")
        self.expect_refusal("import_csv", *arguments, part="--output: s.csv is the file that SAMPLES.csv reads")
        self.expect_refusal("plot_study", "s.csv", "s.csv", part="PLOT.png: s.csv is the file that STUDY.yaml reads")
        part = "--output: s.csv is the file that PLAN reads"
        self.expect_refusal("run_motion", "s.csv", "--output", "s.csv", part=part)
        part = "--output: s.csv is the file that --parameters reads"
        self.expect_refusal("run_motion", "p.yaml", "--parameters", "s.csv", "--output", "s.csv", part=part)

    def test_outputs_that_cannot_be_written_are_told_at_once(self):
        self.expect_refusal("run_motion", "p.yaml", "--output", "none/o.yaml", part="none/o.yaml: cannot be written")
        self.expect_refusal("track_orientation", "--output", "/dev/full", part="/dev/full: this is not a regular file")
        self.expect_refusal("render_report", "r.yaml", "none/o.html", part="none/o.html: cannot be written")


if __name__ == "__main__":
    unittest.main()
