#include "spherical_actuator_calibration/base/version.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "support/source_dir.hpp"

namespace sac {
namespace {

TEST(PackageVersion, IsThatOfPackageXml) {
  std::ostringstream package;
  package << std::ifstream(SOURCE_DIR "/package.xml").rdbuf();
  EXPECT_NE(package.str().find("<version>" + std::string(packageVersion()) + "</version>"),
            std::string::npos)
      << packageVersion();
}

}  // namespace
}  // namespace sac
