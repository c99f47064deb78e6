#include "spherical_actuator_calibration/base/yaml_writer.hpp"

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace sac {
namespace {

TEST(YamlWriter, WritesNumbersThatYaml11TakesForNumbers) {
  EXPECT_EQ(yamlNumber(0.0), "0.0");
  EXPECT_EQ(yamlNumber(1e-5), "1.0e-05");
  EXPECT_EQ(yamlNumber(-2.5e300), "-2.5e+300");
  EXPECT_EQ(yamlNumber(1e22), "1.0e+22");
  EXPECT_EQ(yamlNumber(0.1), "0.1");
  EXPECT_EQ(yamlNumber(1.0 / 3.0), "0.3333333333333333");
}

TEST(YamlWriter, QuotesStringsThatCouldBeSomethingElse) {
  EXPECT_EQ(yamlText("unit-001"), "unit-001");
  EXPECT_EQ(yamlText("joint_3/axis_u"), "joint_3/axis_u");
  EXPECT_EQ(yamlText("007"), "\"007\"");
  EXPECT_EQ(yamlText("Yes"), "\"Yes\"");
  EXPECT_EQ(yamlText(""), "\"\"");
  EXPECT_EQ(yamlText("2024-05-31T12:00:00Z"), "\"2024-05-31T12:00:00Z\"");
  EXPECT_EQ(yamlText("a\"b\\c\n"), "\"a\\\"b\\\\c\\x0a\"");
}

TEST(YamlWriter, StringsComeBack) {
  for (const char* const text : {"a: b",
                                 "#no",
                                 "'",
                                 "\"",
                                 "- x",
                                 "nan",
                                 "INF",
                                 "null",
                                 "~",
                                 "[x]",
                                 "Prüfstand N·m",
                                 "\t\x7f"}) {
    const YamlMap map = YamlMap::parse("k: " + yamlText(text), "f.yaml");
    EXPECT_EQ(map.text("k"), text);
  }
}

TEST(YamlWriter, IndentsWhatBelongsToAKey) {
  YamlWriter writer;
  writer.map(0, "unit");
  writer.entry(1, "name", yamlText("a b"));
  writer.line(1, "# none of them");
  writer.list(1, "poles", {});
  writer.list(1, "axis", {yamlNumbers(std::array{0.5, -1.0}), yamlBoolean(true)});
  writer.optional(1, "stddev", 0.25);
  writer.optional(1, "missing", std::nullopt);
  EXPECT_EQ(writer.text(),
            "unit:\n"
            "  name: \"a b\"\n"
            "  # none of them\n"
            "  poles: []\n"
            "  axis:\n"
            "    - [0.5, -1.0]\n"
            "    - true\n"
            "  stddev: 0.25\n");
}

}  // namespace
}  // namespace sac
