#include "spherical_actuator_calibration/actuator/description_file.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "actuator/description_example.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/error_message.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

/// Every value a description can hold, with awkward digits.
CalibratedDescription fullDescription() {
  CalibratedDescription description = parseDescription(kDescription, "f.yaml");
  Actuator& actuator = description.actuator;
  actuator.joints[0].axis = Eigen::Vector3d(1.0, -0.0157, 0.03141).normalized();
  actuator.joints[1].axis = Eigen::Vector3d(1.0, 1.0, 1.0).normalized();
  actuator.joints[0].offset = 1e-5;
  actuator.joints[2].offset = -1.0 / 3.0;
  actuator.poles[0].polar = -kPi / 2.0;
  actuator.poles[1].azimuth = 5.5 + std::numeric_limits<double>::epsilon() * 4.0;
  actuator.poles[1].gain = 1.02;
  actuator.coils[0].gain = 0.98;
  ParameterStddevs& stddevs = description.stddevs;
  stddevs.joints[0] = {1e-4, 2e-4 / 3.0, 0.0};
  stddevs.joints[2].offset = 5e-324;
  stddevs.poles[1] = {1e-5, 2e-5};
  stddevs.coils[0].azimuth = 3e-5;
  stddevs.torque_curve = TorqueCurveStddev{{0.0, 1.0 / 3.0, 30.0}, {0.0, 1e-4 / 3.0, 0.0}};
  CalibrationRecord& record = *description.calibration;
  record.source.push_back({"/data/Prüfstand 2.bag", "sha256:1f"});
  record.cycles.push_back({"coil", 7, 30, 0, 0.004, 3.2e-6, "N·m", 0.97});
  record.unidentified.clear();
  record.validation = ValidationRecord{9, 1e-3, 2.5e-4};
  record.orientation_uncertainty = 1e-4;
  record.torque_uncertainty = 1e-10;
  return description;
}

auto values(const JointAxis& joint, const JointStddev& stddev) {
  return std::make_tuple(joint.name,
                         joint.axis.x(),
                         joint.axis.y(),
                         joint.axis.z(),
                         joint.offset,
                         stddev.offset,
                         stddev.axis_u,
                         stddev.axis_v);
}

template <typename PoleOrCoil>
auto values(const PoleOrCoil& axis, const AxisStddev& stddev) {
  return std::make_tuple(axis.polar, axis.azimuth, axis.gain, stddev.polar, stddev.azimuth);
}

auto values(const CycleRecord& cycle) {
  return std::make_tuple(cycle.cycle,
                         cycle.coil,
                         cycle.samples_used,
                         cycle.samples_rejected,
                         cycle.error_before,
                         cycle.error_after,
                         cycle.unit,
                         cycle.reduced_chi_square);
}

void expectIdentical(const CalibrationRecord& a, const CalibrationRecord& b) {
  EXPECT_EQ(std::tie(a.date, a.revision, a.software, a.unidentified),
            std::tie(b.date, b.revision, b.software, b.unidentified));
  EXPECT_EQ(a.orientation_uncertainty, b.orientation_uncertainty);
  EXPECT_EQ(a.torque_uncertainty, b.torque_uncertainty);
  ASSERT_EQ(a.source.size(), b.source.size());
  for (std::size_t i = 0; i < a.source.size(); ++i) {
    EXPECT_EQ(a.source[i].recording, b.source[i].recording);
    EXPECT_EQ(a.source[i].checksum, b.source[i].checksum);
  }
  ASSERT_EQ(a.cycles.size(), b.cycles.size());
  for (std::size_t i = 0; i < a.cycles.size(); ++i) {
    EXPECT_EQ(values(a.cycles[i]), values(b.cycles[i]));
  }
  ASSERT_EQ(a.validation.has_value(), b.validation.has_value());
  if (a.validation) {
    EXPECT_EQ(a.validation->samples, b.validation->samples);
    EXPECT_EQ(a.validation->orientation_rms, b.validation->orientation_rms);
    EXPECT_EQ(a.validation->torque_rms, b.validation->torque_rms);
  }
}

/// Equal to the last bit.
void expectIdentical(const CalibratedDescription& a, const CalibratedDescription& b) {
  EXPECT_EQ(a.actuator.name, b.actuator.name);
  EXPECT_EQ(a.actuator.serial, b.actuator.serial);
  for (std::size_t k = 0; k < kJoints; ++k) {
    EXPECT_EQ(values(a.actuator.joints[k], a.stddevs.joints[k]),
              values(b.actuator.joints[k], b.stddevs.joints[k]));
  }
  ASSERT_EQ(a.actuator.poles.size(), b.actuator.poles.size());
  ASSERT_EQ(a.stddevs.poles.size(), b.stddevs.poles.size());
  for (std::size_t i = 0; i < a.actuator.poles.size(); ++i) {
    EXPECT_EQ(values(a.actuator.poles[i], a.stddevs.poles[i]),
              values(b.actuator.poles[i], b.stddevs.poles[i]));
    EXPECT_EQ(a.actuator.poles[i].polarity, b.actuator.poles[i].polarity);
  }
  ASSERT_EQ(a.actuator.coils.size(), b.actuator.coils.size());
  ASSERT_EQ(a.stddevs.coils.size(), b.stddevs.coils.size());
  for (std::size_t j = 0; j < a.actuator.coils.size(); ++j) {
    EXPECT_EQ(values(a.actuator.coils[j], a.stddevs.coils[j]),
              values(b.actuator.coils[j], b.stddevs.coils[j]));
  }
  ASSERT_EQ(a.actuator.torque_curve.has_value(), b.actuator.torque_curve.has_value());
  if (a.actuator.torque_curve) {
    const TorqueCurveDescription& left = *a.actuator.torque_curve;
    const TorqueCurveDescription& right = *b.actuator.torque_curve;
    EXPECT_EQ(left.angle_unit, right.angle_unit);
    EXPECT_EQ(left.coefficients, right.coefficients);
    EXPECT_EQ(std::tie(left.blend_start, left.support_begin, left.support_end),
              std::tie(right.blend_start, right.support_begin, right.support_end));
  }
  ASSERT_EQ(a.stddevs.torque_curve.has_value(), b.stddevs.torque_curve.has_value());
  if (a.stddevs.torque_curve) {
    EXPECT_EQ(a.stddevs.torque_curve->angles, b.stddevs.torque_curve->angles);
    EXPECT_EQ(a.stddevs.torque_curve->torques, b.stddevs.torque_curve->torques);
  }
  EXPECT_EQ(a.actuator.workspace.tilt_limit, b.actuator.workspace.tilt_limit);
  ASSERT_EQ(a.calibration.has_value(), b.calibration.has_value());
  if (a.calibration) {
    expectIdentical(*a.calibration, *b.calibration);
  }
}

TEST(DescriptionFile, ReadsEveryValue) {
  const CalibratedDescription description = parseDescription(
      spoilt("{polar: 0.2618, azimuth: 0.0}",
             "{polar: 0.2618, azimuth: 0.5, gain: 0.9, stddev: {polar: 1.0e-4, azimuth: 2.0e-4}}"),
      "f.yaml");
  const Actuator& actuator = description.actuator;
  EXPECT_EQ(actuator.name, "test");
  EXPECT_EQ(actuator.serial, "unit-001");
  EXPECT_EQ(actuator.joints[1].name, "joint_2");
  EXPECT_EQ(actuator.joints[1].axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(actuator.joints[1].offset, 0.1);
  ASSERT_EQ(actuator.poles.size(), 2U);
  EXPECT_EQ(actuator.poles[1].polar, 0.1);
  EXPECT_EQ(actuator.poles[1].azimuth, 0.8);
  EXPECT_EQ(actuator.poles[1].polarity, -1);
  EXPECT_EQ(actuator.poles[1].gain, 1.0);
  EXPECT_FALSE(description.stddevs.poles[1].polar.has_value());
  ASSERT_EQ(actuator.coils.size(), 1U);
  EXPECT_EQ(values(actuator.coils[0], description.stddevs.coils[0]),
            std::make_tuple(0.2618, 0.5, 0.9, std::optional(1e-4), std::optional(2e-4)));
  ASSERT_TRUE(actuator.torque_curve.has_value());
  EXPECT_EQ(actuator.torque_curve->angle_unit, AngleUnit::kDegree);
  EXPECT_EQ(actuator.torque_curve->coefficients, (std::vector<double>{0.0, 0.05}));
  EXPECT_EQ(actuator.torque_curve->blend_start, 2.0);
  EXPECT_EQ(actuator.torque_curve->support_begin, 28.0);
  EXPECT_EQ(actuator.torque_curve->support_end, 32.0);
  EXPECT_EQ(actuator.workspace.tilt_limit, 0.6);
  ASSERT_TRUE(description.calibration.has_value());
  EXPECT_EQ(description.calibration->date, "2024-05-31T12:00:00Z");
  EXPECT_EQ(description.calibration->revision, 2U);
  EXPECT_EQ(description.calibration->cycles.at(0).samples_used, 5U);
  EXPECT_EQ(description.calibration->unidentified.at(0), "joint_3/axis_u");
}

TEST(DescriptionFile, TakesAJointAlone) {
  const CalibratedDescription description = parseDescription(
      "actuator:\n"
      "  name: test\n"
      "  joints:\n"
      "    - {name: a, axis: [0, -1, 0], offset: 0}\n"
      "    - {name: b, axis: [0, 0, 1], offset: 0}\n"
      "    - {name: c, axis: [1, 0, 0], offset: 0}\n"
      "  workspace: {tilt_limit: 0.6}\n",
      "f.yaml");
  EXPECT_EQ(description.actuator.serial, "");
  EXPECT_FALSE(description.actuator.hasTorqueModel());
  EXPECT_FALSE(description.calibration.has_value());
  expectIdentical(parseDescription(renderDescription(description, "x"), "x"), description);
}

TEST(DescriptionFile, NormalisesAxesThatAreNearlyUnit) {
  const std::string text = spoilt("[0, 1, 0]", "[0.01745, 0.99963, -0.02094]");
  const Eigen::Vector3d axis = parseDescription(text, "f.yaml").actuator.joints[1].axis;
  EXPECT_NEAR(axis.norm(), 1.0, 1e-15);
  EXPECT_NEAR(axis.x() / axis.z(), 0.01745 / -0.02094, 1e-14);
}

TEST(DescriptionFile, TakesARoundedRightAngle) {
  const std::string text = spoilt("polar: 0.1", "polar: 1.5708");
  EXPECT_EQ(parseDescription(text, "f.yaml").actuator.poles[1].polar, kPi / 2.0);
}

TEST(DescriptionFile, SavedAndLoadedIsIdenticalToTheLastBit) {
  const TemporaryFolder folder;
  const CalibratedDescription description = fullDescription();
  saveDescription(folder.path("a.yaml"), description, OverwritePolicy::kRefuse);
  const CalibratedDescription loaded = loadDescription(folder.path("a.yaml"));
  expectIdentical(loaded, description);
  saveDescription(folder.path("b.yaml"), loaded, OverwritePolicy::kRefuse);
  EXPECT_EQ(contentOf(folder.path("a.yaml")), contentOf(folder.path("b.yaml")));
}

TEST(DescriptionFile, NormalisedAxesStayTheSame) {
  // Rounding leaves a normalised vector a few units in the last place off unit length.
  CalibratedDescription description = fullDescription();
  for (int i = 0; i < 300; ++i) {
    description.actuator.joints[0].axis =
        Eigen::Vector3d(std::sin(i), std::cos(1.7 * i), std::sin(2.3 * i + 1.0)).normalized();
    const std::string text = renderDescription(description, "x");
    EXPECT_EQ(parseDescription(text, "x").actuator.joints[0].axis,
              description.actuator.joints[0].axis);
  }
}

TEST(DescriptionFile, RefusesToOverwriteUnlessTold) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.yaml", "something else");
  EXPECT_THROW(saveDescription(path, fullDescription(), OverwritePolicy::kRefuse), DataError);
  EXPECT_EQ(contentOf(path), "something else");
  saveDescription(path, fullDescription(), OverwritePolicy::kReplace);
  EXPECT_EQ(loadActuator(path).name, "test");
}

TEST(DescriptionFile, SavesNothingThatCouldNotBeLoaded) {
  const TemporaryFolder folder;
  CalibratedDescription description = fullDescription();
  description.calibration->cycles[1].error_after = std::numeric_limits<double>::quiet_NaN();
  const std::string message = errorMessage<ConfigError>(
      [&] { saveDescription(folder.path("a.yaml"), description, OverwritePolicy::kRefuse); });
  EXPECT_NE(message.find("actuator.calibration.cycles[1].error_after: nan is not finite"),
            std::string::npos)
      << message;
  EXPECT_EQ(folder.files(), 0);
}

TEST(DescriptionFile, RefusesStandardDeviationsOfAnotherActuator) {
  CalibratedDescription description = fullDescription();
  description.stddevs.coils.resize(3);
  EXPECT_EQ(errorMessage<ConfigError>([&] { renderDescription(description, "x"); }),
            "coils: 3 standard deviations do not belong to 1 coils.");
}

TEST(DescriptionFile, ARotorWithoutJointsIsReadAndWrittenAsSuch) {
  CalibratedDescription description = parseDescription(withoutJoints(), "f.yaml");
  EXPECT_FALSE(description.actuator.has_joints);
  EXPECT_TRUE(parseDescription(kDescription, "f.yaml").actuator.has_joints);
  description.stddevs.poles[1] = {1e-5, 2e-5};
  const std::string text = renderDescription(description, "f.yaml");
  EXPECT_NE(text.find("  joints: []\n"), std::string::npos) << text;
  const CalibratedDescription again = parseDescription(text, "f.yaml");
  EXPECT_FALSE(again.actuator.has_joints);
  EXPECT_EQ(again.actuator.poles.size(), 2U);
  EXPECT_EQ(again.stddevs.poles[1].azimuth, 2e-5);
  description.actuator.joints[1].offset = 1e-9;
  EXPECT_EQ(
      errorMessage<ConfigError>([&] { validate(description.actuator); }),
      "joints: the rotor has none, so that they have no axes, offsets or corrections either.");
}

TEST(DescriptionFile, TheShippedReactionSphereHasNoJoints) {
  const Actuator sphere = loadActuator(SOURCE_DIR "/config/reaction_sphere.yaml");
  EXPECT_FALSE(sphere.has_joints);
  EXPECT_TRUE(sphere.hasTorqueModel());
  EXPECT_EQ(sphere.poles.size(), 8U);
  EXPECT_EQ(sphere.coils.size(), 20U);
  // Its torque curve is that of the other shipped actuator, over twice the angle.
  const TorqueCurve curve(*sphere.torque_curve);
  const TorqueCurve half(*loadActuator(SOURCE_DIR "/config/pm_spherical_8x24.yaml").torque_curve);
  for (double angle = 0.01; angle < 1.2; angle += 0.01) {
    EXPECT_NEAR(curve.value(angle), half.value(0.5 * angle), 1e-14) << angle;
  }
}

TEST(DescriptionFile, EveryShippedDescriptionLoads) {
  int descriptions = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SOURCE_DIR "/config")) {
    const std::string path = entry.path().string();
    if (("\n" + contentOf(path)).find("\nactuator:") == std::string::npos) {
      continue;
    }
    ++descriptions;
    EXPECT_NO_THROW(loadDescription(path)) << path;
  }
  EXPECT_GE(descriptions, 1);
}

TEST(DescriptionFile, TheShippedActuatorIsTheOneOfThePaper) {
  const Actuator actuator = loadActuator(SOURCE_DIR "/config/pm_spherical_8x24.yaml");
  EXPECT_EQ(actuator.serial, "unit-001");
  ASSERT_EQ(actuator.poles.size(), 8U);
  ASSERT_EQ(actuator.coils.size(), 24U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(actuator.poles[i].polar, 0.0);
    EXPECT_NEAR(actuator.poles[i].azimuth, static_cast<double>(i) * kPi / 4.0, 1e-15);
    EXPECT_EQ(actuator.poles[i].polarity, i % 2 == 0 ? 1 : -1);
  }
  for (std::size_t j = 0; j < 24; ++j) {
    EXPECT_EQ(actuator.coils[j].polar, j < 12 ? 0.2618 : -0.2618);
    EXPECT_NEAR(actuator.coils[j].azimuth, static_cast<double>(j % 12) * kPi / 6.0, 1e-15);
  }
  EXPECT_NEAR(TorqueCurve(*actuator.torque_curve).value(10.0 * kOneDegree), 0.2843, 1e-3);
}

}  // namespace
}  // namespace sac
