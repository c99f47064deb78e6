#!/usr/bin/python3
"""dev/check_guide accepts a small guide that is true, and names each thing in it that is not."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
INCLUDE = "include/spherical_actuator_calibration"

QUESTIONS = "".join(f"| question {n}? | [rooms](#rooms) |\n" for n in range(10))
GUIDE = f"""# Architecture

## Questions of a new maintainer

| question | answer |
|---|---|
{QUESTIONS}
## Rooms

`base` and `actuator`, see `Coil::current()` in `actuator/coil.hpp`.

<!-- drawn by dev/draw_rooms -->
```text
sac_core *
    base
    actuator                ← base
```
<!-- end of the drawing -->

### Add a coil

- `actuator/coil.hpp`: `Coil`, `current` – what it carries.
"""


class CheckGuide(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("README.md", "[guide](doc/architecture.md), [more](CONTRIBUTING.md#build)\n")
        self.write("CONTRIBUTING.md", "## Build\n\nRun `dev/build`.\n")
        self.write("doc/architecture.md", GUIDE)
        self.write("dev/build", "#!/bin/sh\n")
        self.write("src/CMakeLists.txt", "add_library_of_rooms(sac_core EXPORTED USES Eigen3::Eigen)\n"
                   "add_subdirectory(base)\nadd_subdirectory(actuator)\n")  # fmt: skip
        self.write("src/base/CMakeLists.txt", "add_room(base LIBRARY sac_core\n  SOURCES\n    angle.cpp)\n")
        self.write("src/actuator/CMakeLists.txt", "add_room(actuator LIBRARY sac_core\n  SOURCES\n    coil.cpp)\n")
        self.write(f"{INCLUDE}/base/angle.hpp", "double angle();\n")
        self.write(
            f"{INCLUDE}/actuator/coil.hpp",
            '#include "spherical_actuator_calibration/base/angle.hpp"\nstruct Coil { double current(); };\n',
        )

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def replace(self, name, old, new):
        text = (self.root / name).read_text(encoding="utf-8")
        self.assertIn(old, text)
        self.write(name, text.replace(old, new))

    def complaints(self):
        command = [sys.executable, ROOT / "dev" / "check_guide", self.root]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1 if result.stderr else 0, result.stderr)
        return result.stderr.splitlines()

    def test_accepts_what_is_true(self):
        self.assertEqual(self.complaints(), [])

    def test_names_a_missing_file(self):
        (self.root / "dev" / "build").unlink()
        self.assertEqual(self.complaints(), ["CONTRIBUTING.md: there is no dev/build."])

    def test_names_a_symbol_that_is_called_otherwise(self):
        self.replace(f"{INCLUDE}/actuator/coil.hpp", "current", "ampere")
        self.assertEqual(
            self.complaints(),
            [
                "doc/architecture.md: Coil::current() stands in no source.",
                f"doc/architecture.md: {INCLUDE}/actuator/coil.hpp does not hold current.",
            ],
        )

    def test_names_a_symbol_that_moved_out_of_the_place_of_a_recipe(self):
        self.replace(f"{INCLUDE}/actuator/coil.hpp", "struct Coil { double current(); };", "")
        self.write("src/actuator/winding.hpp", "struct Coil { double current(); };\n")
        self.assertEqual(
            self.complaints(),
            [
                f"doc/architecture.md: {INCLUDE}/actuator/coil.hpp does not hold Coil.",
                f"doc/architecture.md: {INCLUDE}/actuator/coil.hpp does not hold current.",
            ],
        )

    def test_names_links_that_lead_nowhere(self):
        self.replace("doc/architecture.md", "## Rooms", "## Halls")
        self.assertEqual(len(self.complaints()), 10)
        self.assertIn("the link #rooms leads to no heading", self.complaints()[0])

    def test_wants_each_page_linked_from_the_readme(self):
        self.write("README.md", "[guide](doc/architecture.md)\n")
        self.assertEqual(self.complaints(), ["README.md: no link leads to CONTRIBUTING.md."])

    def test_wants_every_question_answered_once(self):
        self.replace("doc/architecture.md", "| question 3? | [rooms](#rooms) |\n", "")
        self.replace("doc/architecture.md", "| question 4? | [rooms](#rooms) |", "| question 4? | nowhere |")
        self.assertEqual(len(self.complaints()), 2)
        self.assertIn("9 questions are answered, not 10", self.complaints()[0])

    def test_names_a_place_that_a_recipe_has_forgotten(self):
        recipe = "### Add a stream\n\n- `base/torque.hpp`: `TorqueMeasurement` – one like it.\n- `src/actuator/`\n\n"
        self.replace("doc/architecture.md", "### Add a coil", recipe + "### Add a coil")
        self.write(f"{INCLUDE}/base/torque.hpp", "struct TorqueMeasurement;\n")
        self.write("src/base/torque.cpp", "TorqueMeasurement torque();\n")
        self.write("src/actuator/pair.hpp", "TorqueMeasurement torque();\n")
        self.assertEqual(self.complaints(), [])
        self.write("config/recorded.yaml", "topics: [measured_torque]\n")
        self.assertEqual(
            self.complaints(),
            ['doc/architecture.md: "Add a stream" does not name config/recorded.yaml, which names its sample.'],
        )

    def test_names_a_forgotten_place_that_does_not_name_the_sample(self):
        self.replace("doc/architecture.md", "### Add a coil", "### Add a stream\n\n- `src/base/`\n\n### Add a coil")
        self.write("msg/CalibrationSample.msg", "float64 torque\n")
        self.assertEqual(self.complaints(), ['doc/architecture.md: "Add a stream" does not name msg/CalibrationSample.msg.'])

    def test_names_a_cycle_in_quotes_that_a_recipe_has_forgotten(self):
        self.replace("doc/architecture.md", "### Add a coil", "### Add a cycle\n\n- `src/base/`\n\n### Add a coil")
        self.write("src/actuator/coil.cpp", 'const char* kColumns[] = {"cycle", "coil"};\n')
        self.write("src/actuator/phase.cpp", 'const char* kPhase = "motion";\n')
        self.assertEqual(self.complaints(), [])
        for line in ("WHERE cycles.cycle = 'motion'", 'request.cycle = "refine";', '"--cycles", "motion"', 'run("refine")'):
            with self.subTest(line):
                self.write("scripts/run", line + "\n")
                self.assertEqual(
                    self.complaints(),
                    ['doc/architecture.md: "Add a cycle" does not name scripts/run, which names its sample.'],
                )

    def test_names_a_node_without_threads_and_a_word_without_meaning(self):
        tables = "## Threads and locks\n\n| node | threads |\n|---|---|\n| `coil` | one |\n\n"
        tables += "## Glossary\n\n| word | meaning |\n|---|---|\n| belief | what is known |\n\n"
        self.replace("doc/architecture.md", "### Add a coil", tables + "### Add a coil")
        self.write("src/nodes/CMakeLists.txt", "add_node(coil sac_core)\n")
        self.assertEqual(self.complaints(), [])
        self.replace("doc/architecture.md", "| `coil` | one |", "| `pole` | one |")
        self.replace("doc/architecture.md", "| belief |", "| prior |")
        self.assertEqual(
            self.complaints(),
            [
                'doc/architecture.md: "Threads and locks" has no row of `coil`.',
                'doc/architecture.md: "Glossary" has no row of belief.',
            ],
        )

    def test_names_a_topic_that_is_spelt_otherwise(self):
        self.write("src/base/angle.cpp", 'const char* kTopics[] = {"measured_angle", "tracker/pose", "capture"};\n')
        self.write(
            "doc/interfaces.md",
            "## Topics\n\n| topic | type |\n|---|---|\n| `measured_angle`, `tracker/pose` (latched) | `Pose` |\n\n"
            "## Services\n\n| service |\n|---|\n| `capture` |\n",
        )
        self.assertEqual(self.complaints(), [])
        self.replace("doc/interfaces.md", "measured_angle", "mesured_angle")
        self.replace("doc/interfaces.md", "`capture`", "`captur`")
        self.assertEqual(
            self.complaints(),
            [
                "doc/interfaces.md: mesured_angle stands in no source.",
                "doc/interfaces.md: captur stands in no source.",
            ],
        )

    def test_names_a_picture_of_yesterday(self):
        self.replace(f"{INCLUDE}/actuator/coil.hpp", '#include "spherical_actuator_calibration/base/angle.hpp"\n', "")
        self.assertEqual(
            self.complaints(),
            ["doc/architecture.md: the picture of rooms is not that of the sources: run dev/draw_rooms."],
        )

    def test_names_a_room_that_the_guide_does_not_know(self):
        self.replace("doc/architecture.md", "`base` and", "")
        self.assertEqual(self.complaints(), ["doc/architecture.md: tells nothing of the room base."])


if __name__ == "__main__":
    unittest.main()
