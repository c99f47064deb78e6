// What an identified description has beside a nominal one.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "actuator/description_example.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

constexpr char kMap[] =
    "  orientation_map:\n"
    "    length: [0.3, 0.5, 0.8]\n"
    "    amplitude: [1.0e-3, 2.0e-3, 5.0e-4]\n"
    "    noise: [1.0e-4, 3.0e-4, 2.0e-4]\n"
    "    tracker_noise: 1.5e-4\n"
    "    points:\n"
    "      - {reading: [0.1, 0.2, 0.3], rotation: [1.0e-3, 0.0, -1.0e-3]}\n"
    "      - {reading: [0.4, 0.2, 0.3], rotation: [5.0e-4, 0.0, 2.0e-4]}\n";

constexpr char kDynamics[] =
    "  rotor_inertia: {xx: 8.0e-4, yy: 7.0e-4, zz: 1.3e-3, xy: 1.0e-6, xz: 2.0e-6, yz: -3.0e-6}\n"
    "  rotor_friction: {viscous: 6.0e-4, coulomb: 4.0e-4}\n";

/// The example with everything that may be identified.
std::string identified() {
  std::string text = spoilt(
      "offset: 0.1}",
      "offset: 0.1, linear: [1.0e-3, 2.0e-3, 0.0], harmonics: [1.0e-3, 2.0e-3, 3.0e-3, 4.0e-3], "
      "stddev: {linear: [1.0e-4, 0.0, 0.0], harmonics: [1.0e-5, 2.0e-5, 3.0e-5, 4.0e-5]}}");
  const std::string workspace = "  workspace: {tilt_limit: 0.6}\n";
  text.replace(text.find(workspace),
               workspace.size(),
               workspace + "  rotor_unbalance: [1.0e-3, 0.0, 2.0e-3]\n" + kDynamics + kMap);
  return text +
         "    orientation_map: {regions: 8, axes_rms: 1.0e-3, map_rms: 6.0e-4, inside: 0.94}\n"
         "    covariance: {effects: [tilt_cross_axis], names: [a, b], lower: [1.0, 0.5, 2.0]}\n";
}

void expectRefused(const std::string& from, const std::string& to, const std::string& told) {
  std::string text = identified();
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  const std::string message = messageFor(text.replace(at, from.size(), to));
  EXPECT_NE(message.find("f.yaml:"), std::string::npos) << message;
  EXPECT_NE(message.find(told), std::string::npos) << message;
}

TEST(IdentifiedDescription, IsReadWhole) {
  const CalibratedDescription description = parseDescription(identified(), "f.yaml");
  const JointAxis& joint = description.actuator.joints[1];
  EXPECT_EQ(joint.correction.linear, (std::array<double, 3>{1e-3, 2e-3, 0.0}));
  EXPECT_EQ(joint.correction.harmonics, (std::array<double, 4>{1e-3, 2e-3, 3e-3, 4e-3}));
  EXPECT_EQ((*description.stddevs.joints[1].harmonics)[3], 4e-5);
  EXPECT_EQ(description.actuator.joints[0].correction.harmonics, (std::array<double, 4>{}));
  EXPECT_EQ(description.actuator.unbalance, Eigen::Vector3d(1e-3, 0.0, 2e-3));
  const Eigen::Matrix3d& J = description.actuator.inertia.value();
  EXPECT_EQ(J.diagonal(), Eigen::Vector3d(8e-4, 7e-4, 1.3e-3));
  EXPECT_EQ(J(0, 1), 1e-6);
  EXPECT_EQ(J(2, 0), 2e-6);
  EXPECT_EQ(J(1, 2), -3e-6);
  EXPECT_EQ(description.actuator.friction.value().viscous, 6e-4);
  EXPECT_EQ(description.actuator.friction.value().coulomb, 4e-4);
  ASSERT_TRUE(description.actuator.orientation_map);
  EXPECT_EQ(description.actuator.orientation_map->description().rotations[1],
            Eigen::Vector3d(5e-4, 0.0, 2e-4));
  EXPECT_EQ(description.actuator.orientation_map->description().tracker_noise, 1.5e-4);
  EXPECT_EQ(description.calibration->covariance->lower, (std::vector<double>{1.0, 0.5, 2.0}));
  EXPECT_EQ(description.calibration->orientation_map->inside, 0.94);
}

TEST(IdentifiedDescription, IsWrittenAsItWasRead) {
  const CalibratedDescription read = parseDescription(identified(), "f.yaml");
  const std::string written = renderDescription(read, "f.yaml");
  const CalibratedDescription back = parseDescription(written, "f.yaml");
  EXPECT_EQ(renderDescription(back, "f.yaml"), written);
  for (std::size_t k = 0; k < kJoints; ++k) {
    EXPECT_EQ(back.actuator.joints[k].correction.linear, read.actuator.joints[k].correction.linear);
    EXPECT_EQ(back.actuator.joints[k].correction.harmonics,
              read.actuator.joints[k].correction.harmonics);
    EXPECT_EQ(back.stddevs.joints[k].linear, read.stddevs.joints[k].linear);
    EXPECT_EQ(back.stddevs.joints[k].harmonics, read.stddevs.joints[k].harmonics);
  }
  EXPECT_EQ(back.actuator.unbalance, read.actuator.unbalance);
  EXPECT_EQ(back.actuator.inertia, read.actuator.inertia);
  EXPECT_EQ(back.actuator.friction.value().coulomb, read.actuator.friction.value().coulomb);
  const Eigen::Vector3d q(0.2, 0.2, 0.3);
  EXPECT_EQ(back.actuator.orientation_map->mean(q), read.actuator.orientation_map->mean(q));
  EXPECT_EQ(back.actuator.orientation_map->description().tracker_noise, 1.5e-4);
  EXPECT_EQ(back.calibration->covariance->lower, read.calibration->covariance->lower);
  EXPECT_EQ(back.calibration->covariance->effects, read.calibration->covariance->effects);
  EXPECT_EQ(back.calibration->orientation_map->map_rms, 6e-4);
}

TEST(IdentifiedDescription, NamesThePlaceOfWhatIsWrong) {
  expectRefused("linear: [1.0e-3, 2.0e-3, 0.0]", "linear: [1.0e-3]", "joints[1].linear");
  expectRefused("harmonics: [1.0e-3, 2.0e-3, 3.0e-3, 4.0e-3]",
                "harmonics: [1.0, 0.0, 0.0, 0.0]",
                "joints[1].harmonics");
  expectRefused(
      "rotor_unbalance: [1.0e-3, 0.0, 2.0e-3]", "rotor_unbalance: [1]", "rotor_unbalance");
  expectRefused("yz: -3.0e-6", "zy: -3.0e-6", "rotor_inertia");
  expectRefused("xx: 8.0e-4", "xx: .inf", "rotor_inertia.xx");
  expectRefused("coulomb: 4.0e-4", "coulomb: much", "rotor_friction.coulomb");
  expectRefused("amplitude: [1.0e-3", "amplitude: [-1.0e-3", "orientation_map.amplitude");
  expectRefused("length: [0.3, 0.5, 0.8]", "length: [0.3, 0.5]", "orientation_map.length");
  expectRefused("tracker_noise: 1.5e-4", "tracker_noise: -1.5e-4", "orientation_map.tracker_noise");
  expectRefused("rotation: [5.0e-4, ", "rotation: [.nan, ", "orientation_map.points[1].rotation");
  expectRefused("reading: [0.4", "turned: [0.4", "orientation_map.points[1]");
  expectRefused("lower: [1.0, 0.5, 2.0]", "lower: [1.0, 0.5]", "calibration.covariance.lower");
  expectRefused("inside: 0.94", "inside: 1.5", "calibration.orientation_map.inside");
}

class TableFile : public testing::Test {
 protected:
  /// The example with a table in place of its polynomial.
  CalibratedDescription load(const std::string& curve, const std::string& table) const {
    const std::string text = spoilt(
        "{angle_unit: deg, coefficients: [0.0, 0.05], blend_start: 2.0, support: [28.0, 32.0]}",
        curve);
    std::ofstream(folder_.path("a.yaml")) << text;
    std::ofstream(folder_.path("curve.csv")) << table;
    return loadDescription(folder_.path("a.yaml"));
  }
  std::string errorOf(const std::string& curve, const std::string& table) const {
    return errorMessage<ConfigError>([&] { load(curve, table); });
  }

 private:
  TemporaryFolder folder_;
};

constexpr char kTable[] =
    "angle,torque,stddev\n0,0,0\n5,0.2,1e-3\n10,0.28,1e-3\n20,0.2,2e-3\n30,0,0\n";

TEST_F(TableFile, IsLookedForBesideTheDescription) {
  const CalibratedDescription description = load("{table: curve.csv}", kTable);
  const TorqueCurveDescription& curve = *description.actuator.torque_curve;
  EXPECT_EQ(curve.table.angles, (std::vector<double>{0.0, 5.0, 10.0, 20.0, 30.0}));
  EXPECT_EQ(curve.table.stddevs[3], 2e-3);
  EXPECT_EQ(curve.blend_start, 5.0);
  EXPECT_EQ(curve.support_end, 30.0);
  // Saved, it needs no other file.
  const CalibratedDescription back =
      parseDescription(renderDescription(description, "c.yaml"), "elsewhere.yaml");
  EXPECT_EQ(back.actuator.torque_curve->table.torques, curve.table.torques);
  EXPECT_EQ(back.actuator.torque_curve->support_begin, curve.support_begin);
}

TEST_F(TableFile, TakesUnitAndBlendsFromTheDescription) {
  const CalibratedDescription description = load(
      "{angle_unit: rad, table: curve.csv, coefficients: [1.0e-3], blend_start: 0.05, support: "
      "[0.4, "
      "0.5]}",
      "0.0,0.0\n0.1,0.2\n0.2,0.28\n0.4,0.1\n");
  const TorqueCurveDescription& curve = *description.actuator.torque_curve;
  EXPECT_EQ(curve.angle_unit, AngleUnit::kRadian);
  EXPECT_EQ(curve.support_end, 0.5);
  EXPECT_NEAR(TorqueCurve(curve).value(0.2), 0.281, 1e-12);
}

TEST_F(TableFile, IsRefusedByFileAndLine) {
  EXPECT_NE(errorOf("{table: curve.csv}", "0,0\n5,x\n").find("curve.csv:2: \"x\""),
            std::string::npos);
  EXPECT_NE(errorOf("{table: curve.csv}", "0,0\n5,0.2,0.1\n").find("curve.csv:2: 3 numbers; 2"),
            std::string::npos);
  EXPECT_NE(errorOf("{table: curve.csv}", "1\n2\n").find("curve.csv:1: a point is"),
            std::string::npos);
  EXPECT_NE(errorOf("{table: none.csv}", kTable).find("none.csv"), std::string::npos);
  const std::string falls = errorOf("{table: curve.csv}", "0,0\n9,0.2\n5,0.1\n20,0\n");
  EXPECT_NE(falls.find("a.yaml:13: actuator.torque_curve"), std::string::npos) << falls;
  const std::string short_one = errorOf("{table: curve.csv}", "5,0.2\n");
  EXPECT_NE(short_one.find("1 points"), std::string::npos) << short_one;
  EXPECT_NE(errorOf("{table: 5}", kTable).find("torque_curve.table"), std::string::npos);
}

}  // namespace
}  // namespace sac
