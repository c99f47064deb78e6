#include "spherical_actuator_calibration/base/yaml_reader.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using Cases = std::vector<std::pair<std::string, std::string>>;

/// Message of reading `text` as file f.yaml with a getter.
template <typename Read>
std::string messageOf(const std::string& text, Read read) {
  return errorMessage<ConfigError>([&] {
    const YamlMap map = YamlMap::parse(text, "f.yaml");
    read(map);
    map.finish();
  });
}

TEST(YamlReader, ReadsEveryType) {
  const YamlMap map = YamlMap::parse(
      "a: {number: -1.5e-3, whole: -7, truth: true, text: unit-001, quoted: '12', word: rad}\n"
      "list: [1, 2.5, +3]\n"
      "names: [x, y]\n"
      "items:\n  - {n: 1}\n  - {n: 2}\n",
      "f.yaml");
  const YamlMap a = map.map("a");
  EXPECT_EQ(a.number("number", ValueRange::finite()), -1.5e-3);
  EXPECT_EQ(a.integer("whole", -10, 10), -7);
  EXPECT_TRUE(a.boolean("truth"));
  EXPECT_EQ(a.text("text"), "unit-001");
  EXPECT_EQ(a.text("quoted"), "12");
  EXPECT_EQ(a.choice("word", {"deg", "rad"}), "rad");
  EXPECT_EQ(map.numbers("list", ValueRange::finite(), 3), (std::vector<double>{1.0, 2.5, 3.0}));
  EXPECT_EQ(map.texts("names"), (std::vector<std::string>{"x", "y"}));
  const std::vector<YamlMap> items = map.maps("items");
  ASSERT_EQ(items.size(), 2U);
  EXPECT_EQ(items[0].integer("n", 0, 5), 1);
  EXPECT_EQ(items[1].integer("n", 0, 5), 2);
  EXPECT_NO_THROW(map.finish());
}

TEST(YamlReader, TellsNoLineOfWhatIsNoFile) {
  const YamlMap map = YamlMap::parse("{a: {n: x, l: [1, 0]}}", "/node", LineNumbers::kOmitted);
  const YamlMap a = map.map("a");
  const ValueRange range = ValueRange::positive("A");
  EXPECT_EQ(errorMessage<ConfigError>([&] { a.number("n", range); }),
            "/node: a.n: \"x\" is not a number; allowed is (0, inf) A.");
  EXPECT_EQ(errorMessage<ConfigError>([&] { a.numbers("l", range); }),
            "/node: a.l[1]: 0 is outside (0, inf) A.");
  EXPECT_EQ(errorMessage<ConfigError>([&] { a.text("absent"); }),
            "/node: a.absent: the key is missing.");
}

TEST(YamlReader, FallsBackOnlyWhereTheKeyIsAbsent) {
  const YamlMap map = YamlMap::parse("n: 2\nempty:\n", "f.yaml");
  EXPECT_EQ(map.number("n", ValueRange::finite(), 5.0), 2.0);
  EXPECT_EQ(map.number("absent", ValueRange::finite(), 5.0), 5.0);
  EXPECT_EQ(map.integer("absent", 0, 9, 4), 4);
  EXPECT_TRUE(map.boolean("absent", true));
  EXPECT_EQ(map.text("absent", "x"), "x");
  EXPECT_EQ(map.choice("absent", {"a", "b"}, "b"), "b");
  EXPECT_THROW(map.number("empty", ValueRange::finite(), 5.0), ConfigError);
}

TEST(YamlReader, NamesFileLineAndKeyOfAWrongNumber) {
  const auto read = [](const YamlMap& map) {
    map.map("a").number("n", ValueRange::closed(-2.0, 2.0, "rad"));
  };
  const Cases cases = {
      {"a:\n  n: 2.1\n", "f.yaml:2: a.n: 2.1 is outside [-2, 2] rad."},
      {"a:\n  n: .nan\n", "f.yaml:2: a.n: nan is not finite; allowed is [-2, 2] rad."},
      {"a:\n  n: -.inf\n", "f.yaml:2: a.n: -inf is not finite; allowed is [-2, 2] rad."},
      {"a:\n  n: 1e999\n", "f.yaml:2: a.n: inf is not finite; allowed is [-2, 2] rad."},
      {"a:\n  n: '1'\n", "f.yaml:2: a.n: \"1\" is not a number; allowed is [-2, 2] rad."},
      {"a:\n  n: 1x\n", "f.yaml:2: a.n: \"1x\" is not a number; allowed is [-2, 2] rad."},
      {"a:\n  n: [1]\n", "f.yaml:2: a.n: a list is not a number; allowed is [-2, 2] rad."},
      {"a:\n  n:\n", "f.yaml:2: a.n: an empty value is not a number; allowed is [-2, 2] rad."},
      {"\na:\n  m: 1\n", "f.yaml:2: a.n: the key is missing."},
      {"a:\n  n: 1\n  m: 1\n", "f.yaml:3: a.m: the key is unknown here; known are: n."},
      {"a:\n  n: 1\nb: 1\n", "f.yaml:3: b: the key is unknown here; known are: a."},
      {"a:\n  n: 1\n  n: 1\n", "f.yaml:3: a.n: the key is given twice, first in line 2."},
      {"a: 1\n", "f.yaml:1: a: \"1\" is not a map of keys and values."},
      {"a:\n  n: 1\n  [x]: 1\n", "f.yaml:3: a: a list cannot be a key."},
  };
  for (const auto& [text, message] : cases) {
    EXPECT_EQ(messageOf(text, read), message);
  }
}

TEST(YamlReader, NamesTheEntryOfAList) {
  const auto numbers = [](const YamlMap& map) { map.numbers("l", ValueRange::positive("A"), 2); };
  EXPECT_EQ(messageOf("l: [1, 2, 3]", numbers),
            "f.yaml:1: l: the list has 3 numbers; exactly 2 are needed.");
  EXPECT_EQ(messageOf("l:\n  - 1\n  - 0\n", numbers), "f.yaml:3: l[1]: 0 is outside (0, inf) A.");
  EXPECT_EQ(messageOf("l:\n  - 1\n  - x\n", numbers),
            "f.yaml:3: l[1]: \"x\" is not a number; allowed is (0, inf) A.");
  EXPECT_EQ(messageOf("l: 1", numbers), "f.yaml:1: l: \"1\" is not a list.");
  const auto maps = [](const YamlMap& map) { map.maps("l"); };
  EXPECT_EQ(messageOf("l:\n  - {}\n  - 3\n", maps),
            "f.yaml:3: l[1]: \"3\" is not a map of keys and values.");
  EXPECT_EQ(messageOf("l:\n  - {}\n  - {x: 1}\n", maps),
            "f.yaml:3: l[1].x: the key is unknown here.");
  const auto texts = [](const YamlMap& map) { map.texts("l"); };
  EXPECT_EQ(messageOf("l: [a, '']", texts),
            "f.yaml:1: l[1]: \"\" is not a string with at least one character.");
}

TEST(YamlReader, RejectsOtherWrongTypes) {
  EXPECT_EQ(messageOf("k: 1.0", [](const YamlMap& map) { map.integer("k", 0, 5); }),
            "f.yaml:1: k: \"1.0\" is not a whole number; allowed is [0, 5].");
  EXPECT_EQ(messageOf("k: 6", [](const YamlMap& map) { map.integer("k", 0, 5); }),
            "f.yaml:1: k: 6 is outside [0, 5].");
  EXPECT_EQ(
      messageOf("k: 99999999999999999999", [](const YamlMap& map) { map.integer("k", 0, 5); }),
      "f.yaml:1: k: \"99999999999999999999\" is not a whole number; allowed is [0, 5].");
  EXPECT_EQ(messageOf("k: 2", [](const YamlMap& map) { map.boolean("k"); }),
            "f.yaml:1: k: \"2\" is neither true nor false.");
  EXPECT_EQ(messageOf("k: mm",
                      [](const YamlMap& map) {
                        map.choice("k", {"deg", "rad"});
                      }),
            "f.yaml:1: k: \"mm\" is not one of: deg, rad.");
  EXPECT_EQ(messageOf("k: ''", [](const YamlMap& map) { map.nonEmptyText("k"); }),
            "f.yaml:1: k: the string is empty; at least one character is needed.");
  for (const char* const value : {"007", "1e5", "yes", "{}", ".inf"}) {
    EXPECT_NE(messageOf(std::string("k: ") + value, [](const YamlMap& map) { map.text("k"); })
                  .find("is not a string; write a string in quotes."),
              std::string::npos)
        << value;
  }
}

TEST(YamlReader, RejectsWhatIsNoFileOfOneMap) {
  const auto nothing = [](const YamlMap&) {};
  EXPECT_EQ(messageOf("", nothing), "f.yaml: the file is empty.");
  EXPECT_EQ(messageOf("# nothing\n", nothing), "f.yaml: the file is empty.");
  EXPECT_EQ(messageOf("- 1\n", nothing), "f.yaml:1: a list is not a map of keys and values.");
  EXPECT_EQ(messageOf("a: {}\n---\nb: {}\n", nothing),
            "f.yaml:3: only one YAML document is allowed in a file.");
  EXPECT_NE(messageOf("a: 1\nb: [1\n", nothing).find("f.yaml:3: this is not valid YAML: "),
            std::string::npos);
}

/// yaml-cpp 0.6 takes all memory for these.
TEST(YamlReader, RefusesAColonBeforeTheEndOfAList) {
  const auto nothing = [](const YamlMap&) {};
  for (const std::string text : {"a: {b: 1, c:]}\n", "{a:]", "[a:]", "[a::]", "[:]"}) {
    EXPECT_NE(messageOf(text, nothing), "") << text;
  }
  EXPECT_EQ(YamlMap::parse("a: 1  # in [V:]\n", "f.yaml").has("a"), true);
}

TEST(YamlReader, TellsWhyAFileCannotBeRead) {
  const TemporaryFolder folder;
  const auto message = [](const std::string& path) {
    return errorMessage<ConfigError>([&] { YamlMap::load(path); });
  };
  EXPECT_EQ(message(folder.path("missing.yaml")),
            folder.path("missing.yaml") + ": cannot be read: No such file or directory.");
  EXPECT_EQ(message(folder.path("")), folder.path("") + ": is a folder, not a file.");
  const std::string path = folder.write("a.yaml", "k: 1\n");
  EXPECT_EQ(YamlMap::load(path).number("k", ValueRange::finite()), 1.0);
}

}  // namespace
}  // namespace sac
