#include "spherical_actuator_calibration/storage/calibration_files.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_generator.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "storage/database_examples.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

using database_examples::kDate;

class CalibrationFilesTest : public ::testing::Test {
 protected:
  CalibrationFilesTest()
      : directory_(folder_.path("unit"), scenarios::paperNominal()),
        session_({scenarios::paperNominal()}, {}, directory_.database(), "0.1.0"),
        files_(directory_) {}

  void calibrateJoint() {
    scenarios::Generator generator(3);
    std::vector<Sample> samples = scenarios::paperSession(
        scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
    samples.resize(10);
    for (Sample& sample : samples) {
      sample.id = 0;
      session_.addSample(sample, kDate);
    }
    ASSERT_TRUE(session_.run({Cycle::kJoint}, kDate).success);
  }

  static RobotDescription robot() {
    return {renderUrdf(scenarios::paperNominal(), ActuatorDimensions{}, ""), "/robot_description"};
  }

  TemporaryFolder folder_;
  CalibrationDirectory directory_;
  LiveSession session_;
  CalibrationFiles files_;
};

TEST_F(CalibrationFilesTest, NothingIsSavedBeforeAnythingIsCalibrated) {
  EXPECT_EQ(errorMessage<DataError>([&] { files_.save(session_, robot()); }),
            "Nothing is calibrated yet: run a cycle first.");
  EXPECT_FALSE(files_.isSaved(session_.revision().number, Grade::kFailed));
}

TEST_F(CalibrationFilesTest, DescriptionsAreOfTheParametersInForce) {
  calibrateJoint();
  const std::string yaml = directory_.description(1);
  const std::string urdf = directory_.urdf(1);
  EXPECT_EQ(files_.save(session_, robot()), "Saved " + yaml + " and " + urdf + ".");
  EXPECT_TRUE(files_.isSaved(1, session_.grade().grade));
  EXPECT_EQ(loadDescription(yaml).actuator.joints[0].offset, session_.actuator().joints[0].offset);
  EXPECT_TRUE(std::filesystem::exists(urdf));
  // Once more is no error: the same content is there.
  EXPECT_NO_THROW(files_.save(session_, robot()));
}

TEST_F(CalibrationFilesTest, ASavedRevisionIsNeverReplaced) {
  calibrateJoint();
  const std::string first = directory_.description(1);
  std::ofstream(first) << "by hand\n";
  const std::string second = directory_.description(1, 2);
  EXPECT_EQ(files_.save(session_, robot()), "Saved " + second + " and " + directory_.urdf(1) + ".");
  EXPECT_EQ(readInputFile(first), "by hand\n");
  EXPECT_EQ(loadDescription(second).actuator.joints[0].offset,
            session_.actuator().joints[0].offset);
}

TEST_F(CalibrationFilesTest, WhatHeldOutSamplesSayLaterIsToBeSaved) {
  calibrateJoint();
  files_.save(session_, robot());
  files_.saveReport(session_);
  EXPECT_TRUE(files_.isSaved(1, session_.grade().grade));
  scenarios::Generator generator(4);
  for (Sample& sample : scenarios::paperSession(
           scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator)) {
    if (sample.has_orientation) {
      sample.validation = true;
      session_.addSample(sample, kDate);
    }
  }
  ASSERT_EQ(session_.grade().grade, Grade::kUsable) << session_.grade().reason;
  EXPECT_FALSE(files_.isSaved(1, session_.grade().grade));
  files_.save(session_, robot());
  files_.saveReport(session_);
  EXPECT_TRUE(files_.isSaved(1, session_.grade().grade));
  EXPECT_TRUE(std::filesystem::exists(directory_.description(1, 2)));
  EXPECT_TRUE(files_.isSaved(1, Grade::kNotValidated)) << "cleared samples take nothing back";
}

TEST_F(CalibrationFilesTest, WithoutARobotDescriptionThereIsNoUrdf) {
  calibrateJoint();
  EXPECT_EQ(
      files_.save(session_, {std::nullopt, "/robot_description"}),
      "Saved " + directory_.description(1) + "; no URDF, since /robot_description is missing.");
  EXPECT_FALSE(std::filesystem::exists(directory_.urdf(1)));
}

TEST_F(CalibrationFilesTest, ARobotDescriptionOfAnotherMachineLeavesNoFile) {
  calibrateJoint();
  EXPECT_ANY_THROW(files_.save(session_, {"<robot name=\"x\"/>", "/robot_description"}));
  EXPECT_FALSE(files_.isSaved(1, session_.grade().grade));
}

TEST_F(CalibrationFilesTest, TheReportIsReplaced) {
  calibrateJoint();
  const std::string folder = files_.saveReport(session_);
  EXPECT_EQ(folder, directory_.report(1));
  EXPECT_TRUE(std::filesystem::exists(folder + "/report.yaml"));
  EXPECT_NO_THROW(files_.saveReport(session_));
}

}  // namespace
}  // namespace sac
