#!/usr/bin/python3
"""dev/check_clang_tidy reads sources together, and finds what it would find in each alone."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DEFECT = "int {name}(int a) {{\n  int badName = a;\n  return badName;\n}}\n"
FINDING = "invalid case style for variable 'badName'"
INTERNAL = "namespace {\n\nint limit() {\n  return 1;\n}\n\n}  // namespace\n"


class CheckClangTidy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        self.cache = self.root / "cache"
        self.settle()

    def settle(self):
        """A package with one source in order, in self.root."""
        self.sources = []
        (self.root / "build").mkdir(parents=True)
        for name in (".clang-tidy", "test/.clang-tidy"):
            (self.root / name).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        self.write("src/base/angle.cpp", "int angle() {\n  return 1;\n}\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        if path.suffix == ".cpp" and path not in self.sources:
            self.sources.append(path)

    def check(self, *sources):
        """Exit status and output; of these sources only, if any."""
        flags = f"-I{self.root}/include -Wall -Wextra -Wshadow -Werror -std=c++17 -o x.o -c"
        entries = [
            {"directory": str(self.root), "file": str(file), "command": f"/usr/bin/c++ {flags} {file}"}
            for file in self.sources
        ]
        (self.root / "build" / "compile_commands.json").write_text(json.dumps(entries))
        result = subprocess.run(
            [ROOT / "dev" / "check_clang_tidy", "build", *sources],
            cwd=self.root,
            env={**os.environ, "XDG_CACHE_HOME": str(self.cache)},
            capture_output=True,
            text=True,
            check=False,
        )
        return result.returncode, result.stdout + result.stderr

    def test_remembers_what_is_clean(self):
        self.write("include/base/turn.hpp", "#pragma once\n")
        self.write("src/base/turn.cpp", '#include "base/turn.hpp"\n')
        self.assertEqual(self.check(), (0, "2 sources in 1 groups, 1 checked now, 0 with findings\n"))
        self.assertEqual(self.check(), (0, "2 sources in 1 groups, 0 checked now, 0 with findings\n"))
        self.write("include/base/turn.hpp", "#pragma once\n" + DEFECT.format(name="turn"))
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn(f"{self.root}/include/base/turn.hpp:3:7: error: {FINDING}", said)
        self.assertIn("1 checked now, 1 with findings", said)

    def test_another_clone_knows_it_too(self):
        self.assertEqual(self.check(), (0, "1 sources in 1 groups, 1 checked now, 0 with findings\n"))
        self.root = self.root / "clone"
        self.settle()
        self.assertEqual(self.check(), (0, "1 sources in 1 groups, 0 checked now, 0 with findings\n"))

    def test_finds_the_defects_of_every_source_of_a_group(self):
        for name in ("one", "two"):
            self.write(f"src/base/{name}.cpp", DEFECT.format(name=name))
        status, said = self.check()
        self.assertEqual(status, 1)
        for name in ("one", "two"):
            self.assertIn(f"{self.root}/src/base/{name}.cpp:2:7: error: {FINDING}", said)
        self.assertIn("3 sources in 1 groups, 1 checked now, 1 with findings", said)

    def test_checks_single_sources(self):
        self.write("src/base/bad.cpp", DEFECT.format(name="bad"))
        self.assertEqual(self.check("src/base/angle.cpp")[0], 0)
        self.assertIn(FINDING, self.check("src/base/bad.cpp")[1])
        status, said = self.check("src/base/angle.cpp", "src/base/missing.cpp")
        self.assertEqual(status, 1)
        self.assertIn("lacks sources", said)

    def test_keeps_apart_what_uses_a_name_for_its_own(self):
        for name in ("one", "two"):
            self.write(f"src/base/{name}.cpp", INTERNAL + f"int {name}() {{\n  return limit();\n}}\n")
        self.assertEqual(self.check(), (0, "3 sources in 2 groups, 2 checked now, 0 with findings\n"))

    def test_reads_alone_what_cannot_be_read_together(self):
        for name in ("one", "two"):
            text = "static int limit() {\n  return 1;\n}\n" + f"int {name}() {{\n  return limit();\n}}\n"
            self.write(f"src/base/{name}.cpp", text + DEFECT.format(name="bad" + name.capitalize()))
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn("3 sources in 1 groups, 1 checked now, 1 with findings", said)
        self.assertEqual(said.count(FINDING), 2)
        self.assertNotIn("redefinition", said)

    def test_reads_programs_together(self):
        for name in ("one", "two"):
            self.write(f"src/tools/{name}_main.cpp", "int main(int argc, char**) {\n  return argc;\n}\n")
        self.assertEqual(self.check(), (0, "3 sources in 1 groups, 1 checked now, 0 with findings\n"))

    def test_tells_what_the_compiler_complains_of(self):
        self.write("src/base/one.cpp", "int one() {\n  int unused;\n  return missing;\n}\n")
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn("src/base/one.cpp:3:10: error: use of undeclared identifier 'missing'", said)

    def test_each_folder_has_its_configuration(self):
        text = "#include <string>\nint size(std::string text) {\n  return static_cast<int>(text.size());\n}\n"
        self.write("test/base/text_test.cpp", text)
        self.assertEqual(self.check()[0], 0)
        self.write("src/base/text.cpp", text)
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn("[performance-unnecessary-value-param", said)

    def test_functions_have_at_most_sixty_lines(self):
        for count, status in ((57, 0), (60, 1)):
            self.write("src/base/long.cpp", "int f(int a) {\n" + count * "  ++a;\n" + "  return a;\n}\n")
            found, said = self.check()
            self.assertEqual(found, status, said)
        self.assertIn("[readability-function-size", said)

    def test_reads_each_source_of_a_batch(self):
        for name in ("one", "two"):
            self.write(f"src/base/{name}.cpp", DEFECT.format(name=name))
        batch = self.root / "build" / "Unity" / "unity_base_0_cxx.cxx"
        batch.parent.mkdir()
        batch.write_text("".join(f'#include "{source}"\n' for source in self.sources), encoding="utf-8")
        self.sources = [batch]
        status, said = self.check()
        self.assertEqual(status, 1)
        for name in ("one", "two"):
            self.assertIn(f"{self.root}/src/base/{name}.cpp:2:7: error: {FINDING}", said)
        self.assertEqual(self.check("src/base/angle.cpp")[0], 0)

    def test_says_when_there_is_nothing_to_check(self):
        self.sources = []
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn("lacks sources", said)


if __name__ == "__main__":
    unittest.main()
