// doc/diagnosis.md lists what the code names, and nothing else.
#include <fstream>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

/// First words of the rows of the page's tables.
std::set<std::string> listedCauses() {
  std::ifstream page(std::string(SOURCE_DIR) + "/doc/diagnosis.md");
  EXPECT_TRUE(page.is_open());
  const std::regex row(R"(^\| `([a-z_]+)(:[A-Z])*` \|.*)");
  std::set<std::string> causes;
  std::smatch match;
  for (std::string line; std::getline(page, line);) {
    if (std::regex_match(line, match, row)) {
      causes.insert(match[1]);
    }
  }
  return causes;
}

TEST(DiagnosisPage, ListsEveryCauseOfTheCode) {
  std::set<std::string> named(wiringCauses().begin(), wiringCauses().end());
  named.insert(effectNames().begin(), effectNames().end());
  EXPECT_EQ(listedCauses(), named);
}

}  // namespace
}  // namespace sac
