#!/usr/bin/python3
"""dev/check_rooms accepts a small house in order, and names every kind of disorder that is put into it."""

import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
INCLUDE = "include/spherical_actuator_calibration"


def include(header):
    return f'#include "spherical_actuator_calibration/{header}"\n'


class CheckRooms(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write(f"{INCLUDE}/base/angle.hpp", "#include <cmath>\nint angle();\n")
        self.write("src/base/angle.cpp", include("base/angle.hpp") + '#include "turns.hpp"\n')
        self.write("src/base/turns.hpp", "int turns();\n")
        for room in ("streams", "estimation", "planning", "control", "storage", "tools"):
            self.write(f"src/{room}/rest.cpp", 10 * "int a();\n")
        self.write(f"{INCLUDE}/actuator/coil.hpp", include("base/angle.hpp"))
        self.write("src/actuator/coil.cpp", include("actuator/coil.hpp"))
        self.write("src/ros/node/coil_node.cpp", include("actuator/coil.hpp") + "#include <ros/ros.h>\n")
        self.write("test/base/angle_test.cpp", include("base/angle.hpp"))
        self.write("scripts/turn", "#!/usr/bin/python3\ndef turn():\n    return 1\n")
        self.write("CMakeLists.txt", "project(house)\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def write_libraries(self):
        """Of base, control and storage, which links base alone; of a node and a tool that link storage."""
        rooms = {"base": "sac_core", "control": "sac_control", "storage": "sac_storage"}
        self.write("src/CMakeLists.txt", "add_library_of_rooms(sac_core EXPORTED USES Eigen3::Eigen)\n"
                   "add_library_of_rooms(sac_control USES sac_core)\nadd_library_of_rooms(sac_storage USES sac_core)\n"
                   + "".join(f"add_subdirectory({room})\n" for room in rooms))  # fmt: skip
        for room, library in rooms.items():
            self.write(f"src/{room}/CMakeLists.txt", f"add_room({room} LIBRARY {library}\n  SOURCES\n    rest.cpp\n"
                       "    angle.cpp table.cpp)\nadd_room_tests(base SOURCES angle_test.cpp)\n")
        self.write("src/nodes/CMakeLists.txt", "if(DATABASE)\n  add_node(turner sac_storage)\nendif()\n")
        self.write("src/tools/CMakeLists.txt", "add_library(tool_words STATIC words.cpp)\n"
                   "target_link_libraries(tool_words PUBLIC sac_core)\n"
                   "add_tool(rest_of\n  SOURCES rest.cpp\n  LIBRARIES sac_control)\n"
                   "add_tool(turn SOURCES turn_options.cpp LIBRARIES sac_storage)\n")  # fmt: skip

    def complaints(self):
        command = [ROOT / "dev" / "check_rooms", self.root]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1 if result.stderr else 0, result.stderr)
        return result.stderr.splitlines()

    def expect_one(self, *parts):
        """Exactly one complaint, with these parts."""
        complaints = self.complaints()
        self.assertEqual(len(complaints), 1, complaints)
        for part in parts:
            self.assertIn(part, complaints[0])

    def test_accepts_a_house_in_order(self):
        self.assertEqual(self.complaints(), [])

    def test_names_an_include_against_the_order(self):
        self.write("src/base/wire.cpp", include("actuator/coil.hpp"))
        self.expect_one(f"src/base/wire.cpp: base must not include {INCLUDE}/actuator/coil.hpp: actuator comes after it")

    def test_names_a_room_whose_library_is_not_linked(self):
        self.write_libraries()
        self.write("src/storage/table.cpp", include("base/angle.hpp"))
        self.assertEqual(self.complaints(), [])
        self.write(f"{INCLUDE}/control/motion.hpp", "enum class Motion { kUp };\n")
        self.write("src/storage/table.cpp", include("control/motion.hpp"))
        self.expect_one("src/storage/table.cpp: includes", "sac_storage does not link sac_control")

    def test_names_sources_that_nobody_compiles(self):
        self.write_libraries()
        for name in ("src/base/wire.cpp", "test/base/wire_test.cpp"):
            with self.subTest(name):
                self.write(name, include("base/angle.hpp"))
                self.expect_one(f"{name}: src/base/CMakeLists.txt does not list it")
                (self.root / name).unlink()
        listing = self.root / "src" / "base" / "CMakeLists.txt"
        listing.write_text(listing.read_text().replace("    angle.cpp", "    # angle.cpp\n   "))
        self.expect_one("src/base/angle.cpp: src/base/CMakeLists.txt does not list it")

    def test_names_a_type_of_a_later_room_that_is_declared(self):
        self.write(f"{INCLUDE}/planning/plan.hpp", "struct Plan {\n  int poses;\n};\nenum class Kind : int { kOne };\n")
        for declaration, name in (("struct Plan;\n", "Plan"), ("enum class Kind : int;\n", "Kind"), ("namespace sac { struct Plan; }\n", "Plan")):
            with self.subTest(name):
                self.write("src/streams/rest.cpp", 10 * "int a();\n" + declaration)
                self.expect_one(f"src/streams/rest.cpp: streams must not know {name}: planning comes after it")
        # As a name of one's own, or of a class within another, it is no type of that room.
        self.write("src/streams/rest.cpp", "struct Plan {\n  int a;\n};\nstruct Plan;\nclass A {\n  enum class Kind : int;\n};\n")
        self.assertEqual(self.complaints(), [])

    def test_names_a_program_that_does_not_link_what_it_includes(self):
        self.write_libraries()
        self.write(f"{INCLUDE}/control/motion.hpp", "enum class Motion { kUp };\n")
        main = include("control/motion.hpp") + "int main() {}\n"
        for source, program in (
            ("src/nodes/turner_main.cpp", "turner"),
            ("src/tools/turn_main.cpp", "turn"),
            ("src/tools/turn_options.hpp", "turn"),
            ("src/tools/words.cpp", "tool_words"),
        ):
            with self.subTest(source):
                self.write(source, main)
                self.expect_one(f"{source}: includes {INCLUDE}/control/motion.hpp: {program} does not link sac_control.")
                (self.root / source).unlink()
        self.write("src/tools/rest.cpp", main)
        self.assertEqual(self.complaints(), [])

    def test_names_a_source_that_no_program_is_made_of(self):
        self.write_libraries()
        self.write("src/tools/left_over.cpp", "int a();\n")
        self.expect_one("src/tools/left_over.cpp: no program of src/tools/CMakeLists.txt is made of it.")

    def test_names_an_include_that_the_rules_would_not_see(self):
        for line in ("#include HEADER", "/**/ #include <ros/ros.h>", "#import <ros/ros.h>", "%:include <ros/ros.h>"):
            with self.subTest(line):
                self.write("src/base/angle.cpp", f"#define HEADER <ros/ros.h>\n{line}\n")
                self.expect_one(f"src/base/angle.cpp: {line}: an include stands in a line of its own")

    def test_names_an_include_that_goes_over_two_lines(self):
        for line in ("#\\\ninclude <ros/ros.h>", "#include \\\n<ros/ros.h>"):
            with self.subTest(line):
                self.write("src/base/angle.cpp", f"{line}\n")
                self.assertIn("an include stands in a line of its own", "\n".join(self.complaints()))

    def test_names_a_library_in_a_room_that_must_not_know_it(self):
        for header, room in (("SQLiteCpp/Database.h", "storage"), ("sqlite3.h", "storage"), ("modbus/modbus.h", "drivers")):
            with self.subTest(header):
                for place in ("src/rviz/list.cpp", "src/streams/list.cpp"):
                    self.write(place, f"#include <{header}>\n")
                    self.expect_one(f"{place}: includes {header}, which is for {room}")
                    (self.root / place).unlink()
                self.write(f"src/{room}/rest.cpp", 10 * "int a();\n" + f"#include <{header}>\n")
                self.assertEqual(self.complaints(), [])

    def test_names_a_library_that_may_leave_symbols_open(self):
        option = "  target_link_options(${name} PRIVATE -Wl,--no-undefined)\n"
        function = "function(make name)\n  add_library(${name} SHARED a.cpp)\n%sendfunction()\n"
        alias = "function(name name)\n  add_library(sac::a ALIAS ${name})\nendfunction()\n"
        self.write("cmake/rooms.cmake", function % option + alias)
        self.assertEqual(self.complaints(), [])
        self.write("cmake/rooms.cmake", function % f"  #{option}" + alias + option)
        self.expect_one("cmake/rooms.cmake: make() links a library without -Wl,--no-undefined")
        self.write("cmake/rooms.cmake", function % option)
        self.write("cmake/links.cmake", "add_link_options(-Wl,-z,undefs)\n")
        self.expect_one("cmake/links.cmake: -z,undefs lets a library leave symbols open")

    def test_names_an_internal_header_of_a_later_room(self):
        self.write("src/actuator/winding.hpp", "")
        self.write("src/base/wire.cpp", '#include "../actuator/winding.hpp"\n')
        self.expect_one("src/base/wire.cpp: base must not include src/actuator/winding.hpp")

    def test_names_an_internal_header_of_an_earlier_room(self):
        self.write("src/actuator/coil.cpp", '#include "../base/turns.hpp"\n')
        self.expect_one("src/actuator/coil.cpp: includes src/base/turns.hpp, which is internal to base")

    def test_names_an_include_against_the_order_by_a_relative_path(self):
        self.write("src/base/wire.cpp", f'#include "../../{INCLUDE}/actuator/coil.hpp"\n')
        self.expect_one("src/base/wire.cpp: base must not include")

    def test_names_an_internal_header_in_one_that_is_installed(self):
        self.write(f"{INCLUDE}/base/wire.hpp", '#include "../../../src/base/turns.hpp"\n')
        self.expect_one(f"{INCLUDE}/base/wire.hpp: includes src/base/turns.hpp, which is not installed")

    def test_names_an_internal_header_in_a_test_of_another_room(self):
        self.write("test/base/turns_test.cpp", '#include "turns.hpp"\n')
        self.assertEqual(self.complaints(), [])
        self.write("test/actuator/coil_test.cpp", include("actuator/coil.hpp") + '#include "../../src/base/turns.hpp"\n')
        self.expect_one("test/actuator/coil_test.cpp: includes src/base/turns.hpp, which is internal to base")

    def test_names_a_test_in_a_room_that_it_does_not_test(self):
        self.write("test/base/wire_test.cpp", include("actuator/coil.hpp"))
        self.expect_one("test/base/wire_test.cpp: includes no header of base: a test is in the room of what it tests")
        self.write("test/base/fixture.hpp", include("base/angle.hpp"))
        self.write("test/base/wire_test.cpp", '#include "fixture.hpp"\n')
        self.assertEqual(self.complaints(), [])

    def test_names_texts_and_sources_that_are_included(self):
        self.write("src/base/table.txt", include("actuator/coil.hpp"))
        for name, complaint in (
            ("table.txt", "headers end in .hpp here"),
            ("angle.cpp", "includes src/base/angle.cpp, which is no header"),
        ):
            with self.subTest(name):
                self.write("src/base/wire.cpp", f'#include "{name}"\n')
                self.expect_one("src/base/wire.cpp: includes", complaint)

    def test_names_sources_where_no_rule_would_see_them(self):
        for name, complaint in (
            ("library/angle.cpp", "C++ belongs into include, src"),
            ("include/sac/angle.hpp", f"headers belong into {INCLUDE}"),
        ):
            with self.subTest(name):
                self.write(name, "int angle();\n")
                self.expect_one(name, complaint)
                (self.root / name).unlink()
        self.write("build-arm/angle.cpp", "int angle();\n")
        self.assertEqual(self.complaints(), [])

    def test_names_a_header_of_planning_that_many_sources_include(self):
        self.write(f"{INCLUDE}/planning/pose.hpp", "")
        for number in range(14):
            self.write(f"test/planning/pose{number}_test.cpp", include("planning/pose.hpp"))
        self.assertEqual(self.complaints(), [])
        self.write("test/tools/pose.hpp", include("planning/pose.hpp"))
        self.write("test/tools/tool_test.cpp", '#include "pose.hpp"\n')
        self.expect_one(f"{INCLUDE}/planning/pose.hpp: 15 sources include it, more than 14")

    def test_names_a_circle_of_modules(self):
        package = "src/spherical_actuator_calibration"
        self.write(f"{package}/guide/__init__.py", "")
        self.write(f"{package}/guide/one.py", "from . import two\n")
        self.write(f"{package}/guide/two.py", "from spherical_actuator_calibration.three import words\n")
        self.write(f"{package}/three.py", "import rospy\n")
        self.assertEqual(self.complaints(), [])
        self.write(f"{package}/three.py", "def words():\n    from .guide.one import more\n")
        self.expect_one("circle of modules", "guide.one -> spherical_actuator_calibration.guide.two -> ")

    def test_names_a_program_that_changes_where_modules_are_looked_for(self):
        self.write("scripts/turn", "#!/usr/bin/python3\nimport sys\nsys.path.insert(0, '..')\n")
        self.expect_one("scripts/turn: changes where modules are looked for")

    def test_names_a_module_that_is_imported_by_a_text(self):
        self.write("scripts/turn", "#!/usr/bin/python3\nimport importlib\nimportlib.import_module('angle')\n")
        self.expect_one("scripts/turn: imports a module by its name as a text, which no rule sees: write import.")

    def test_names_what_is_for_tests_in_what_is_not(self):
        self.write("test/support/example.hpp", "int example();\n")
        self.write("src/actuator/coil.cpp", '#include "support/example.hpp"\n')
        self.expect_one("src/actuator/coil.cpp: includes test/support/example.hpp, which is for tests")

    def test_names_endings_that_no_rule_would_see(self):
        for name in ("src/base/angle.cc", f"{INCLUDE}/base/angle.inl"):
            with self.subTest(name):
                self.write(name, "int angle();\n")
                self.expect_one(f"{name}: headers end in .hpp here, sources in .cpp")
                (self.root / name).unlink()

    def test_names_a_room_that_has_grown_by_folders_of_its_own(self):
        for part in ("one", "two"):
            self.write(f"src/base/{part}/rest.cpp", 15 * "int a();\n")
        self.expect_one("base: holds", "lines of C++, more than 25 %")

    def test_names_a_circle_of_files_through_their_sources(self):
        self.write(f"{INCLUDE}/base/angle.hpp", include("base/sine.hpp"))
        self.write(f"{INCLUDE}/base/sine.hpp", "")
        self.write("src/base/sine.cpp", include("base/sine.hpp") + include("base/angle.hpp"))
        self.expect_one("circle of files: base/angle -> base/sine -> base/angle")

    def test_names_a_folder_that_is_no_room(self):
        self.write("src/helpers/all.cpp", "")
        self.expect_one("src/helpers/all.cpp", '"helpers" is no room')

    def test_names_headers_of_ros_and_messages_below_ros(self):
        for place in ("src/base/wire.cpp", "test/base/wire_test.cpp"):
            for header in (
                "ros/time.h",
                "geometry_msgs/Pose.h",
                "eigen_conversions/eigen_msg.h",
                "angles/angles.h",
                "ros.h",
                "spherical_actuator_calibration/CoilCurrents.h",
            ):
                with self.subTest(place + header):
                    self.write(place, include("base/angle.hpp") + f"#include <{header}>\n")
                    self.expect_one(f"{place}: includes {header}: base must not know ROS")
            (self.root / place).unlink()

    def test_what_tests_share_may_know_ros_where_the_tests_do(self):
        self.write("test/support/bag.hpp", "#include <rosbag/bag.h>\n")
        self.write("src/ros/node/coil_node.hpp", "")
        self.write("test/ros/node/node_test.cpp", '#include "coil_node.hpp"\n#include "support/bag.hpp"\n')
        self.assertEqual(self.complaints(), [])
        self.write("test/base/wire_test.cpp", include("base/angle.hpp") + '#include "support/bag.hpp"\n')
        self.expect_one("test/base/wire_test.cpp: includes rosbag/bag.h, by test/support/bag.hpp: base must not know ROS")

    def test_names_a_folder_with_more_than_a_quarter_of_the_lines(self):
        self.write("src/ros/node/all.cpp", 40 * "int a;\n")
        self.expect_one("ros/node: holds 42 of ", "more than 25 %")

    def test_names_a_long_source(self):
        for name, line in (("test/base/long.py", "\n"), ("scripts/long", "#!/bin/sh\n"), ("src/page.html", "\n")):
            with self.subTest(name):
                self.write(name, 400 * line)
                self.assertEqual(self.complaints(), [])
                self.write(name, 401 * line)
                self.expect_one(name, "has 401 lines, more than 400")
                (self.root / name).unlink()

    def test_names_a_long_function_in_python(self):
        for length in (60, 61):
            self.write("scripts/turn", "#!/usr/bin/python3\ndef turn():\n" + (length - 1) * "    print()\n")
            if length == 60:
                self.assertEqual(self.complaints(), [])
        self.expect_one("scripts/turn:2: turn has 61 lines, more than 60")

    def test_names_a_long_test(self):
        found = {}
        for length in (60, 61):
            self.write("test/base/turn_test.cpp", "TEST_F(Turn, Turns) {\n" + (length - 2) * "  turn();\n" + "}\n")
            found[length] = [one for one in self.complaints() if "TEST" in one]
        self.assertEqual(found[60], [])
        self.assertEqual(found[61], ["test/base/turn_test.cpp:1: TEST_F(Turn, Turns) has 61 lines, more than 60."])

    def test_counts_the_head_of_a_function(self):
        body = 57 * "  turn();\n" + "}\n"
        heads = {
            "turn": "Angle turn(int a,\n           int b) {\n",
            "Coil::turn": "void Coil::turn(int a,\n                int b)\n    const {\n",
        }
        for name, head in heads.items():
            with self.subTest(name):
                self.write("src/base/long.cpp", head + body)
                length = head.count("\n") + 58
                found = [one for one in self.complaints() if "base/long.cpp" in one and "base: holds" not in one]
                expected = [f"src/base/long.cpp:1: {name} has {length} lines, more than 60."] if length > 60 else []
                self.assertEqual(found, expected)

    def test_names_a_long_lambda_outside_of_functions(self):
        for head, end in (("const auto turn = [](int a) {\n", "};\n"), ("const int turn =\n    [] {\n", "}();\n")):
            with self.subTest(head):
                self.write("src/base/long.cpp", head + 60 * "  turn();\n" + end)
                found = [one for one in self.complaints() if "base/long.cpp" in one]
                length = 61 + head.count("\n")
                self.assertEqual(found, [f"src/base/long.cpp:1: turn has {length} lines, more than 60."])

    def test_names_a_long_function_however_it_is_written(self):
        heads = (
            ("turn", "void turn() {  // all the way\n", "}\n"),
            ("turn", 'extern "C" void turn() {\n', "}\n"),
            ("turn", "struct Turns turn(int a = {}) {\n", "}\n"),
            ("turn", '[[nodiscard]] int none() { return \'}\'; }\n[[nodiscard]] auto turn() -> int {\n', "}\n"),
            ("Turns::Turns", "Turns::Turns(int a) : a_{a}, b_(a), c_{a} {\n", "}\n"),
            ("operator+", "Turns operator+(Turns a, Turns b) {\n", "}\n"),
            ("turn", 'void turn() {\nprint(R"(\n}\n)");\n', "}\n"),
            ("turn", "class Turns {\n public:\n  int a = {};\n  void turn() const {\n", "  }\n};\n"),
            ("a lambda", "const Turn kTurn = std::function<void()>([] {\n", "});\n"),
            ("a lambda", 'const Turn kTurns[] = {\n{"a", [] {}},\n{"b", [](int a) {\n', "}},\n};\n"),
        )
        for name, head, end in heads:
            with self.subTest(head):
                self.write("src/base/long.cpp", head + 60 * "  turn();\n" + end)
                found = [one for one in self.complaints() if "base/long.cpp" in one and "base: holds" not in one]
                self.assertEqual(len(found), 1, found)
                self.assertIn(f": {name} has 6", found[0])

    def test_takes_no_class_or_table_for_a_function(self):
        struct = "struct Turns {\n" + 70 * "  int a;\n" + "};\n"
        table = "constexpr int kTurns[] = {\n" + 70 * "  1,\n" + "};\n"
        self.write("test/base/table.cpp", struct + table)
        self.assertEqual([one for one in self.complaints() if "table.cpp" in one], [])

    def test_names_a_long_function_in_shell(self):
        for head, end in (("turn() {\n", "}\n"), ("turn() (\n", ")\n"), ("function turn\n{\n", "}\n")):
            for length in (60, 61):
                rest = (length - head.count("\n") - 1) * "  echo\n"
                self.write("scripts/turn", "#!/usr/bin/env bash\n" + head + rest + end)
                if length == 60:
                    self.assertEqual(self.complaints(), [])
            self.expect_one("scripts/turn:2: turn has 61 lines, more than 60")

    def test_names_a_long_cmake_file(self):
        for name in ("CMakeLists.txt", "benchmark/CMakeLists.txt", "cmake/rooms.cmake"):
            with self.subTest(name):
                self.write(name, 200 * "\n")
                self.assertEqual(self.complaints(), [])
                self.write(name, 201 * "\n")
                self.expect_one(name, "has 201 lines, more than 200")
                self.write(name, "")

    def test_says_when_there_is_nothing_to_check(self):
        with tempfile.TemporaryDirectory() as empty:
            result = subprocess.run([ROOT / "dev" / "check_rooms", empty], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("holds no C++", result.stderr)


if __name__ == "__main__":
    unittest.main()
