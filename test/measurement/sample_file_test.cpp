#include "spherical_actuator_calibration/measurement/sample_file.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/error_message.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

constexpr char kActuatorFile[] = SOURCE_DIR "/config/examples/two_axis_positioner/actuator.yaml";
constexpr char kSampleFile[] = SOURCE_DIR "/config/examples/two_axis_positioner/samples.yaml";

class SampleFile : public testing::Test {
 protected:
  std::string write(const std::string& text) const { return folder_.write("samples.yaml", text); }

  std::string errorOf(const std::string& text, std::size_t coils = 0) const {
    const std::string path = write(text);
    return errorMessage<Error>([&] { loadSamples(path, coils); });
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(SampleFile, ReadsEveryQuantity) {
  const std::vector<Sample> samples = loadSamples(write(R"(
torque_stddev: 0.002
samples:
  - joint_position: [0.1, 0.2, 0.3]
    joint_stddev: [1.0e-4, 2.0e-4, 3.0e-4]
    orientation_xyzw: [0.0, 0.0, 0.6, 0.8]
    orientation_stddev: 0.001
  - joint_position: [0.0, 0.0, 0.0]
    torque: [0.01, 0.02, 0.03]
    current: [0.0, 2.0]
    validation: true
)"),
                                                  2);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].id, 1u);
  EXPECT_EQ(samples[0].joint_position, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(samples[0].joint_stddev, Eigen::Vector3d(1e-4, 2e-4, 3e-4));
  EXPECT_TRUE(samples[0].has_orientation);
  EXPECT_FALSE(samples[0].has_torque);
  EXPECT_NEAR(samples[0].R_stator_rotor(1, 0), 2.0 * 0.6 * 0.8, 1e-15);
  EXPECT_EQ(samples[0].orientation_stddev, 0.001);
  EXPECT_FALSE(samples[0].validation);
  EXPECT_TRUE(samples[1].has_torque);
  EXPECT_EQ(samples[1].torque_stddev, 0.002);
  EXPECT_EQ(samples[1].current, Eigen::Vector2d(0.0, 2.0));
  EXPECT_TRUE(samples[1].validation);
}

TEST_F(SampleFile, ErrorsNameFileLineAndKey) {
  const std::string position = "samples:\n  - joint_position: [0.0, 0.0, 0.0]\n    ";
  const std::string unknown = errorOf(position + "orientatoin_xyzw: [0.0, 0.0, 0.0, 1.0]\n");
  EXPECT_NE(unknown.find("samples.yaml:3: samples[0].orientatoin_xyzw"), std::string::npos)
      << unknown;
  const std::string not_unit = errorOf(position + "orientation_xyzw: [0.0, 0.0, 0.5, 0.5]\n");
  EXPECT_NE(not_unit.find("samples.yaml:3: samples[0].orientation_xyzw"), std::string::npos)
      << not_unit;
  EXPECT_NE(errorOf("samples:\n  - torque: [0.0, 0.0, 0.0]\n").find("joint_position"),
            std::string::npos);
}

TEST_F(SampleFile, ATorqueNeedsOneCurrentPerCoil) {
  const std::string text =
      "samples:\n  - joint_position: [0.0, 0.0, 0.0]\n    torque: [0.0, 0.0, 0.0]\n    "
      "current: [1.0, 2.0]\n";
  EXPECT_EQ(errorOf(text, 2), "no exception");
  EXPECT_NE(errorOf(text, 3), "no exception");
}

TEST(TwoAxisPositioner, IsFittedAndItsMissingJointIsNamed) {
  const CalibrationModel model{ParameterSpace(loadActuator(kActuatorFile))};
  const std::vector<Sample> samples = loadSamples(kSampleFile, 0);
  ASSERT_EQ(samples.size(), 105u);
  const CalibrationState nominal = nominalState(model.space(), ManufacturingTolerance());
  const CycleOutcome outcome =
      runCycle(model, samples, nominal, {Cycle::kJoint}, EstimationOptions());
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_EQ(outcome.report.samples_used, 105u);
  double squares = 0.0;
  for (const SampleResidual& residual : outcome.report.residuals) {
    squares += residual.residual * residual.residual;
  }
  const double rms = std::sqrt(squares / 105.0);
  RecordProperty("rms", std::to_string(rms));
  EXPECT_LE(rms, 0.90e-3);
  EXPECT_NE(outcome.report.message.find("The axis of joint_3 is not observable"), std::string::npos)
      << outcome.report.message;
  const Actuator found = model.space().actuatorAt(outcome.state.belief.x);
  EXPECT_EQ(found.joints[2].axis, model.space().nominal().joints[2].axis);
  for (const ParameterEstimate& estimate : outcome.report.estimates) {
    EXPECT_EQ(estimate.observable, estimate.name.rfind("joint_3/axis", 0) != 0) << estimate.name;
  }
}

}  // namespace
}  // namespace sac
