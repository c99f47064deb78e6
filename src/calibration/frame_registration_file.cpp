#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/calibration/frame_registration.hpp"

namespace sac {
namespace {

constexpr int kQuaternionDigits = 12;

/// The one of the two signs with a positive real part.
Eigen::Quaterniond quaternionOf(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  if (q.w() < 0.0) {
    q.coeffs() *= -1.0;
  }
  return q;
}

void writeFrame(YamlWriter& writer,
                const std::string& name,
                const Eigen::Matrix3d& rotation,
                const FrameRegistration& registration,
                Eigen::Index first) {
  const auto stddev = [first](const FrameRegistration::Covariance& covariance) {
    return yamlNumbers(Eigen::Vector3d(covariance.diagonal().segment<3>(first).cwiseSqrt()));
  };
  writer.map(1, name);
  writer.entry(2, "quaternion_xyzw", yamlNumbers(quaternionOf(rotation).coeffs()));
  writer.entry(2, "stddev", stddev(registration.covariance));
  writer.entry(2, "stddev_of_noise", stddev(registration.noise_covariance));
}

std::string render(const Actuator& actuator, const FrameRegistration& registration) {
  YamlWriter writer;
  writer.line(0, "# Where tracker and marker sit, found by register_frames (doc/registration.md).");
  writer.map(0, "registered_frames");
  writer.entry(1, "actuator", yamlText(actuator.name));
  writer.entry(1, "serial", yamlText(actuator.serial));
  writer.entry(1, "poses", std::to_string(registration.poses_used));
  writer.entry(
      1, "poses_rejected", std::to_string(registration.poses.size() - registration.poses_used));
  writer.entry(1, "residual_rms", yamlNumber(registration.residual_rms));
  writer.entry(1, "reduced_chi_square", yamlNumber(registration.reduced_chi_square));
  writeFrame(writer, "stator_tracker", registration.R_stator_tracker, registration, 0);
  writeFrame(writer, "rotor_marker", registration.R_rotor_marker, registration, 3);
  writer.line(1, "# [rad2] turn of the tracker in stator axes, then of the marker in rotor axes.");
  std::vector<std::string> rows;
  rows.reserve(static_cast<std::size_t>(registration.covariance.rows()));
  for (Eigen::Index row = 0; row < registration.covariance.rows(); ++row) {
    rows.push_back(yamlNumbers(Eigen::RowVectorXd(registration.covariance.row(row))));
  }
  writer.list(1, "covariance", rows);
  writer.line(0, "# Arguments of lab.launch.");
  writer.map(0, "launch");
  writer.entry(1, "stator_tracker", yamlText(launchArgument(registration.R_stator_tracker)));
  writer.entry(1, "rotor_marker", yamlText(launchArgument(registration.R_rotor_marker)));
  writer.entry(1, "tracker_and_marker_covariance", yamlText(covarianceArgument(registration)));
  writer.line(0, "# For the configuration of a calibration [rad2].");
  writer.map(0, "registration");
  writer.map(1, "tracker_and_marker");
  writer.entry(2, "covariance", covarianceArgument(registration));
  return writer.text();
}

}  // namespace

std::string launchArgument(const Eigen::Matrix3d& rotation) {
  std::string text = "0 0 0";
  for (const double value : quaternionOf(rotation).coeffs()) {
    text += " " + roundedText(value, kQuaternionDigits);
  }
  return text;
}

std::string covarianceArgument(const FrameRegistration& registration) {
  std::string text;
  for (Eigen::Index row = 0; row < registration.covariance.rows(); ++row) {
    for (Eigen::Index column = 0; column < registration.covariance.cols(); ++column) {
      // With a point in each: YAML 1.1 takes 1e-05 for a word.
      text += format("%s%.8e", text.empty() ? "[" : ", ", registration.covariance(row, column));
    }
  }
  return text + "]";
}

void saveFrameRegistration(const std::string& path,
                           const Actuator& actuator,
                           const FrameRegistration& registration,
                           OverwritePolicy overwrite) {
  writeFileAtomically(path, render(actuator, registration), overwrite);
}

}  // namespace sac
