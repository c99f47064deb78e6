#include "spherical_actuator_calibration/base/input_file.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

std::string refusal(const std::string& path) {
  return errorMessage<ConfigError>([&] { readInputFile(path); });
}

TEST(InputFile, GivesEveryByte) {
  const TemporaryFolder folder;
  const std::string content("a\0b\n\xff", 5);
  EXPECT_EQ(readInputFile(folder.write("f", content)), content);
  const std::string large(300'000, 'x');
  EXPECT_EQ(readInputFile(folder.write("large", large)), large);
  EXPECT_EQ(readInputFile(folder.write("empty", "")), "");
}

// Each of them would never end, or wait for ever.
TEST(InputFile, NamesWhatIsNoFile) {
  const TemporaryFolder folder;
  const std::string fifo = folder.path("fifo");
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(refusal(fifo), fifo + ": is a FIFO, not a file.");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is a device, not a file.");
  EXPECT_EQ(refusal(folder.path("")), folder.path("") + ": is a folder, not a file.");
  const std::string link = folder.path("link");
  std::filesystem::create_symlink("/dev/zero", link);
  EXPECT_EQ(refusal(link), link + ": is a device, not a file.");
  EXPECT_EQ(unreadableKind(fifo), "a FIFO");
  EXPECT_EQ(unreadableKind(folder.write("f", "")), "");
}

TEST(InputFile, ReadsNoMoreThanTheLimit) {
  const TemporaryFolder folder;
  const std::string path = folder.write("f", "12345");
  EXPECT_EQ(readInputFile(path, 5), "12345");
  EXPECT_EQ(errorMessage<ConfigError>([&] { readInputFile(path, 4); }),
            path + ": is larger than 4 bytes, the most that is read of such a file.");
}

TEST(InputFile, ReadsNoMoreThanADescriptionMayHave) {
  const TemporaryFolder folder;
  const std::string comment(kLargestDescription, '#');
  EXPECT_EQ(YamlMap::load(folder.write("f", "a: 1\n" + comment.substr(10))).number("a", {}), 1.0);
  const std::string path = folder.write("g", "a: 1\n" + comment);
  EXPECT_NE(errorMessage<ConfigError>([&] { YamlMap::load(path); }).find("larger than 8388608"),
            std::string::npos);
}

std::string yamlRefusal(const std::string& text) {
  return errorMessage<ConfigError>([&] { YamlMap::parse(text, "f.yaml"); });
}

TEST(InputFile, AYamlTextOfManyKeysIsRefused) {
  const auto maps = [](int count) {
    std::string text = "a:\n";
    for (int n = 0; n < count; ++n) {
      text += "- {k: v, l: [1, 2, 3], m: {n: 1}}\n";
    }
    return text;
  };
  EXPECT_EQ(YamlMap::parse(maps(24'999), "f.yaml").maps("a").size(), 24'999U);
  const std::string message = yamlRefusal(maps(25'001));
  EXPECT_NE(message.find("f.yaml:25001: more than 100000 keys"), std::string::npos) << message;
}

// What a message quotes of a text is short, and in one line.
TEST(InputFile, AMessageQuotesNoMoreThanALine) {
  const std::string large(1'000'000, 'x');
  const auto message = [](const std::string& text) {
    return errorMessage<ConfigError>([&] {
      const YamlMap map = YamlMap::parse(text, "f.yaml");
      map.number("n", ValueRange::finite());
      map.finish();
    });
  };
  for (const std::string& text :
       {"n: " + large, "n: 1\n? " + large + "\n: 1", large + ": 1", "n: *" + large}) {
    EXPECT_LT(message(text).size(), 400U);
  }
  const std::string forged = message("n: \"a\\nFATAL: forged line\\n\"");
  EXPECT_EQ(forged.find('\n'), std::string::npos) << forged;
  EXPECT_NE(forged.find("\\x0aFATAL"), std::string::npos) << forged;
  EXPECT_EQ(message("n: 1\n\u202eabc: 1").find("\u202e"), std::string::npos);
}

// Of "," yaml-cpp makes documents for ever.
TEST(InputFile, AYamlTextThatNeverEndsIsRefused) {
  for (const char* text : {",", ",\n", "}", "]", "a: 1\n...\n,", "[a]]", "? ,", ": ,", "- ,\n,"}) {
    const std::string message = yamlRefusal(text);
    EXPECT_EQ(message.compare(0, 6, "f.yaml"), 0) << text << ": " << message;
  }
}

TEST(InputFile, AYamlTextIsOnlySoDeep) {
  const std::string deep = std::string(40, '[') + std::string(40, ']');
  EXPECT_EQ(yamlRefusal("a: " + deep), "no exception");
  EXPECT_EQ(yamlRefusal("a: " + std::string(1000, '[')),
            "f.yaml:1: maps and lists stand more than 64 deep within each other.");
}

// Of what stands in brackets yaml-cpp tells nothing before it has all of it in memory.
TEST(InputFile, AYamlTextHasOnlySoManyBracketsAndSigns) {
  for (const char bracket : {'[', '{'}) {
    EXPECT_EQ(yamlRefusal("a:\n  " + std::string(100'000, bracket)),
              "f.yaml:2: more than 1000 brackets are open here.");
  }
  const auto repeated = [](const std::string& text, std::size_t count) {
    std::string result;
    for (std::size_t n = 0; n < count; ++n) {
      result += text;
    }
    return result;
  };
  for (const char* const text : {"a,", "\"]\"[", "[#]\n", "{a: 1},", "&a ", "? ", "a: ", "!x "}) {
    const std::string message = yamlRefusal("[" + repeated(text, 2'500'000));
    EXPECT_NE(message.find(" are not read."), std::string::npos) << text << message;
  }
  EXPECT_EQ(yamlRefusal("# within [0, inf)\na: [" + repeated("{b: [1, 2]}, ", 20'000) + "]\n"),
            "no exception");
  EXPECT_EQ(yamlRefusal(repeated("# within [0, inf)\n", 900) + "a: 1\n"), "no exception");
}

TEST(InputFile, AYamlTextCountsWhatItsAliasesStandFor) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int n = 1; n < 9; ++n) {
    const std::string before = "*a" + std::to_string(n - 1);
    bomb += "a" + std::to_string(n) + ": &a" + std::to_string(n) + " [" + before;
    for (int k = 1; k < 10; ++k) {
      bomb += ", " + before;
    }
    bomb += "]\n";
  }
  EXPECT_EQ(yamlRefusal(bomb),
            "f.yaml:6: more than 1000000 values, those of aliases included, are not read.");
  EXPECT_EQ(yamlRefusal("a: &a {b: 1}\nc: *a\n"), "no exception");
  EXPECT_EQ(yamlRefusal("a: &a {b: *a}\n"),
            "f.yaml:1: an alias stands within what it is an alias of.");
}

}  // namespace
}  // namespace sac
