#include "command_line.hpp"

#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/error_message.hpp"

namespace sac {
namespace {

struct Options {
  std::string actuator;
  std::optional<std::string> output;
  std::optional<double> tilt;
  std::size_t poses = 10;
  bool merge = false;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
  std::vector<std::string> bags;
};

class CommandLineTest : public ::testing::Test {
 protected:
  CommandLineTest() {
    line_.addRequiredInput("actuator", options_.actuator, "YAML", "actuator description");
    line_.add("tilt", options_.tilt, "RAD", "of the joints");
    line_.beginGroup("Plan");
    line_.add("poses", options_.poses, "N", "at most");
    line_.addSwitch("merge", options_.merge, "join the shards");
    line_.addForce(options_.overwrite);
    line_.addOutput("output", options_.output, "YAML", "to write");
    line_.addInputs(options_.bags, "BAG");
  }

  bool parse(std::vector<const char*> words) {
    words.insert(words.begin(), "tool");
    return line_.parse(static_cast<int>(words.size()), words.data(), printed_);
  }

  std::string refusal(const std::vector<const char*>& words) {
    return errorMessage<ConfigError>([&] { parse(words); });
  }

  Options options_;
  CommandLine line_{"Usage: tool\n"};
  std::ostringstream printed_;
};

TEST_F(CommandLineTest, WhatIsWrittenIsNoFileThatIsRead) {
  EXPECT_EQ(refusal({"--actuator", "a.yaml", "--output", "./a.yaml"}),
            "--output: ./a.yaml is the file that --actuator reads; choose another name.");
  EXPECT_EQ(refusal({"--actuator", "a.yaml", "one.bag", "--output", "one.bag"}),
            "--output: one.bag is the file that BAG reads; choose another name.");
  ASSERT_TRUE(parse({"--actuator", "a.yaml", "--output", "b.yaml"}));
  EXPECT_NO_THROW(line_.requireSeparate("report", "report.yaml"));
  EXPECT_EQ(errorMessage<ConfigError>([&] { line_.requireSeparate("report", "a.yaml"); }),
            "--report: a.yaml is the file that --actuator reads; choose another name.");
}

TEST_F(CommandLineTest, FillsInWhatIsGiven) {
  ASSERT_TRUE(parse({"--actuator",
                     "a.yaml",
                     "one.bag",
                     "--tilt=0.2",
                     "--poses",
                     "10",
                     "--merge",
                     "--force",
                     "two.bag"}));
  EXPECT_EQ(options_.actuator, "a.yaml");
  EXPECT_EQ(options_.tilt, 0.2);
  EXPECT_EQ(options_.poses, 10U);
  EXPECT_TRUE(options_.merge);
  EXPECT_EQ(options_.overwrite, OverwritePolicy::kReplace);
  EXPECT_EQ(options_.bags, (std::vector<std::string>{"one.bag", "two.bag"}));
  EXPECT_TRUE(line_.wasGiven("poses"));
}

TEST_F(CommandLineTest, LeavesTheRestAsItWas) {
  ASSERT_TRUE(parse({"--actuator", "a.yaml"}));
  EXPECT_EQ(options_.tilt, std::nullopt);
  EXPECT_EQ(options_.poses, 10U);
  EXPECT_FALSE(options_.merge);
  EXPECT_EQ(options_.overwrite, OverwritePolicy::kRefuse);
  EXPECT_TRUE(options_.bags.empty());
  EXPECT_FALSE(line_.wasGiven("poses"));
}

TEST_F(CommandLineTest, HelpNeedsNothingElse) {
  EXPECT_FALSE(parse({"--help"}));
  const std::string text = printed_.str();
  EXPECT_EQ(text.rfind("Usage: tool\n", 0), 0U);
  EXPECT_NE(text.find("--actuator YAML"), std::string::npos);
  EXPECT_NE(text.find("actuator description; needed"), std::string::npos);
  EXPECT_NE(text.find("Plan:"), std::string::npos);
  EXPECT_NE(text.find("--poses N (=10)"), std::string::npos);
  EXPECT_EQ(text.find("operands"), std::string::npos);
}

TEST_F(CommandLineTest, RefusalsNameTheOption) {
  EXPECT_EQ(refusal({}), "--actuator is needed; --help tells what it is.");
  EXPECT_EQ(refusal({"--actuator", ""}), "--actuator needs a value.");
  // Not --actuator by guessing.
  EXPECT_NE(refusal({"--act", "a.yaml"}).find("'--act'"), std::string::npos);
  EXPECT_NE(refusal({"--actuator", "a.yaml", "--poses", "many"}).find("--poses"),
            std::string::npos);
}

TEST_F(CommandLineTest, ChoicesNameTheirWords) {
  const std::vector<std::pair<std::string, bool>> choices = {{"on", true}, {"off", false}};
  EXPECT_TRUE(choose<bool>("tracker", "on", choices));
  EXPECT_FALSE(choose<bool>("tracker", "off", choices));
  EXPECT_EQ(errorMessage<ConfigError>([&] { choose<bool>("tracker", "maybe", choices); }),
            "--tracker: \"maybe\" is none of: on, off.");
}

}  // namespace
}  // namespace sac
