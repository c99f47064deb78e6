// Mistakes made on the real measurements of config/examples/two_axis_positioner.
#include <algorithm>
#include <functional>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr char kActuator[] = SOURCE_DIR "/config/examples/two_axis_positioner/actuator.yaml";
constexpr char kSamples[] = SOURCE_DIR "/config/examples/two_axis_positioner/samples.yaml";

struct PositionerMistake {
  const char* cause;
  std::function<void(Sample&)> make;
};

Eigen::Matrix3d turn(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

std::vector<PositionerMistake> nineMistakes() {
  return {
      {"joint_sign:1", [](Sample& sample) { sample.joint_position[0] *= -1.0; }},
      {"joint_sign:2", [](Sample& sample) { sample.joint_position[1] *= -1.0; }},
      {"joint_swap:1:2",
       [](Sample& sample) { std::swap(sample.joint_position[0], sample.joint_position[1]); }},
      {"joint_degrees", [](Sample& sample) { sample.joint_position /= kOneDegree; }},
      {"joint_scale:2", [](Sample& sample) { sample.joint_position[1] *= 2.0; }},
      {"orientation_inverted", [](Sample& sample) { sample.R_stator_rotor.transposeInPlace(); }},
      {"quaternion_order",
       [](Sample& sample) {
         const Eigen::Quaterniond q(sample.R_stator_rotor);
         sample.R_stator_rotor = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
       }},
      {"tracker_frame",
       [](Sample& sample) {
         sample.R_stator_rotor = turn(Eigen::Vector3d::UnitX(), kPi / 2.0) * sample.R_stator_rotor;
       }},
      {"marker_frame",
       [](Sample& sample) { sample.R_stator_rotor *= turn(Eigen::Vector3d::UnitY(), kPi / 2.0); }},
  };
}

std::vector<std::string> causesNamed(const std::vector<Sample>& samples) {
  const Actuator actuator = loadActuator(kActuator);
  std::vector<std::string> causes;
  for (const Diagnosis& mistake : diagnoseWiring(actuator, samples, {}).mistakes) {
    causes.push_back(mistake.cause);
  }
  return causes;
}

TEST(PositionerDiagnosis, NamesNothingInTheSoundRecording) {
  EXPECT_EQ(causesNamed(loadSamples(kSamples, 0)), std::vector<std::string>{});
}

TEST(PositionerDiagnosis, NamesNineMistakes) {
  for (const PositionerMistake& mistake : nineMistakes()) {
    std::vector<Sample> samples = loadSamples(kSamples, 0);
    for (Sample& sample : samples) {
      mistake.make(sample);
    }
    const std::vector<std::string> causes = causesNamed(samples);
    ASSERT_FALSE(causes.empty()) << mistake.cause;
    EXPECT_NE(std::find(causes.begin(), causes.end(), mistake.cause), causes.end())
        << mistake.cause << " was taken for " << causes.front();
  }
}

}  // namespace
}  // namespace sac
