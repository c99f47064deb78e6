#!/usr/bin/python3
"""The package as others get it: installed into a folder of its own, and examples/ built against that."""

import os
import pathlib
import re
import shutil
import unittest

from example_case import check_calibrate_samples, check_use_calibration, run

PACKAGE = "spherical_actuator_calibration"
BUILD = pathlib.Path(os.environ["BUILD"])
SOURCE = pathlib.Path(os.environ["SOURCE"])
CMAKE = os.environ["CMAKE"]
STAGING = BUILD / "test" / ".staging"
PREFIX = STAGING / os.environ["PREFIX"].lstrip("/")
CONSUMER = BUILD / "test" / "consumer"  # where examples/ are built

OUR_INCLUDE = re.compile(rf'#\s*include\s*[<"]({PACKAGE}/[^>"]+)[>"]')
ROS = re.compile(rf"/(ros|roscpp|rosbag|\w+_msgs|tf2\w*)/|/{PACKAGE}/[A-Z]\w*\.h$")


def setUpModule():
    for folder in (STAGING, CONSUMER):
        shutil.rmtree(folder, ignore_errors=True)
    installed = run(CMAKE, "--install", BUILD, env={**os.environ, "DESTDIR": str(STAGING)})
    assert installed.returncode == 0, installed.stderr + "Was everything built, not the tests alone?"


def build_examples(folder, target, *options):
    """Builds one program of examples/ as a user does; returns its path."""
    configured = run(CMAKE, "-S", SOURCE / "examples", "-B", folder, f"-DCMAKE_PREFIX_PATH={PREFIX}", *options)
    assert configured.returncode == 0, configured.stdout + configured.stderr
    built = run(CMAKE, "--build", folder, "--target", target)
    assert built.returncode == 0, built.stdout + built.stderr
    return folder / target


class OtherPrefix(unittest.TestCase):
    def test_is_refused_before_anything_is_installed(self):
        other = BUILD / "test" / ".other_prefix"
        refused = run(CMAKE, "--install", BUILD, "--prefix", other)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn(f"-DCMAKE_INSTALL_PREFIX={other}", " ".join(refused.stderr.split()))
        self.assertFalse(other.exists())


class Headers(unittest.TestCase):
    def setUp(self):
        self.folder = PREFIX / "include" / PACKAGE
        self.headers = sorted(self.folder.rglob("*.hpp"))

    def test_every_header_finds_those_that_it_includes(self):
        self.assertGreater(len(self.headers), 50)
        for header in self.headers:
            for name in OUR_INCLUDE.findall(header.read_text()):
                self.assertTrue((PREFIX / "include" / name).exists(), f"{header}: {name} is not installed")

    def test_what_is_internal_stays_at_home(self):
        public = SOURCE / "include" / PACKAGE
        rooms = {path.relative_to(self.folder).parts[0] for path in self.headers}
        for header in self.headers:
            self.assertTrue((public / header.relative_to(self.folder)).exists(), header)
        self.assertIn("actuator", rooms)
        self.assertFalse(rooms & {"study", "rviz"}, "no other package is to link these")


class WithoutRos(unittest.TestCase):
    """Who calibrates samples needs the core, and neither a header nor a library of ROS."""

    def test_example_calibrates(self):
        program = build_examples(
            CONSUMER / "core", "calibrate_samples", "-DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON"
        )
        check_calibrate_samples(self, program, SOURCE)
        needed = run("ldd", program).stdout
        self.assertIn(f"libsac_core.so => {PREFIX}/lib/libsac_core.so", needed)
        self.assertNotRegex(needed, r"lib(ros|modbus|sqlite3|SQLiteCpp|Qt)")

    def test_example_uses_a_calibration(self):
        program = build_examples(CONSUMER / "core", "use_calibration", "-DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON")
        check_use_calibration(self, [program], SOURCE)
        self.assertNotRegex(run("ldd", program).stdout, r"lib(ros|modbus|sqlite3|SQLiteCpp|Qt)|not found")

    def test_example_reads_no_header_of_ros(self):
        read = run(
            "c++", "-std=c++17", "-M", f"-I{PREFIX}/include", "-isystem", "/usr/include/eigen3",
            SOURCE / "examples" / "calibrate_samples.cpp",
        )  # fmt: skip
        self.assertEqual(read.returncode, 0, read.stderr)
        self.assertIn("calibration_session.hpp", read.stdout)
        self.assertEqual([header for header in read.stdout.split() if ROS.search(header)], [])

    def test_wrong_components_are_told(self):
        project = CONSUMER / "wrong"
        project.mkdir(parents=True)
        (project / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.16)\n"
            "project(wrong LANGUAGES CXX)\n"
            "find_package(sac REQUIRED COMPONENTS core study)\n"
        )
        result = run(CMAKE, "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={PREFIX}")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("sac::study is no library of this installation", result.stderr)


class WithCatkin(unittest.TestCase):
    """The node is left where the test of running nodes finds it."""

    def test_example_is_built_with_messages_and_core(self):
        program = build_examples(CONSUMER / "catkin", "follow_parameters")
        needed = run("ldd", program).stdout
        self.assertIn(f"{PREFIX}/lib/libsac_core.so", needed)
        self.assertIn("libroscpp", needed)
        self.assertNotRegex(needed, r"lib(modbus|sqlite3|SQLiteCpp|Qt)|not found")


if __name__ == "__main__":
    unittest.main()
