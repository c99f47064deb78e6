#include "spherical_actuator_calibration/measurement/sample_file.hpp"

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace sac {
namespace {

/// Standard deviations for samples that state none.
struct DefaultStddevs {
  double orientation;  ///< [rad]
  double torque;       ///< [N·m]
};

Eigen::Vector3d vector3(const YamlMap& map, const std::string& key, const ValueRange& range) {
  return Eigen::Vector3d(map.numbers(key, range, 3).data());
}

Eigen::Matrix3d rotation(const YamlMap& map, const std::string& key) {
  const std::vector<double> xyzw =
      map.numbers(key, ValueRange::closed(-1.0 - kUnitTolerance, 1.0 + kUnitTolerance), 4);
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!isUnit(q)) {
    map.fail(key, "the quaternion has norm " + std::to_string(q.norm()) + " instead of 1.");
  }
  return q.normalized().toRotationMatrix();
}

Sample readSample(const YamlMap& map, const DefaultStddevs& defaults, bool has_joints) {
  Sample sample;
  if (has_joints) {
    sample.joint_position = vector3(map, "joint_position", ValueRange::finite("rad"));
    if (map.has("joint_stddev")) {
      sample.joint_stddev = vector3(map, "joint_stddev", ValueRange::nonNegative("rad"));
    }
  }
  sample.has_orientation = !has_joints || map.has("orientation_xyzw");
  if (sample.has_orientation) {
    sample.R_stator_rotor = rotation(map, "orientation_xyzw");
    sample.orientation_stddev =
        map.number("orientation_stddev", ValueRange::nonNegative("rad"), defaults.orientation);
  }
  sample.has_torque = map.has("torque");
  if (sample.has_torque) {
    sample.torque = vector3(map, "torque", ValueRange::finite("N m"));
    sample.torque_stddev =
        map.number("torque_stddev", ValueRange::nonNegative("N m"), defaults.torque);
    sample.torque_shared_stddev = map.number(
        "torque_shared_stddev", ValueRange::closed(0.0, sample.torque_stddev, "N m"), 0.0);
  }
  if (map.has("current")) {
    const std::vector<double> current = map.numbers("current", ValueRange::finite("A"));
    sample.current = Eigen::Map<const Eigen::VectorXd>(current.data(),
                                                       static_cast<Eigen::Index>(current.size()));
  }
  sample.validation = map.boolean("validation", false);
  sample.measurements = 1;
  return sample;
}

}  // namespace

std::vector<Sample> loadSamples(const std::string& path, std::size_t coils, bool has_joints) {
  const YamlMap file = YamlMap::parse(readInputFile(path), path);
  const DefaultStddevs defaults{
      file.number("orientation_stddev", ValueRange::nonNegative("rad"), 0.0),
      file.number("torque_stddev", ValueRange::nonNegative("N m"), 0.0)};
  file.text("provenance", "");
  std::vector<Sample> samples;
  for (const YamlMap& entry : file.maps("samples")) {
    samples.push_back(readSample(entry, defaults, has_joints));
    samples.back().id = static_cast<std::uint32_t>(samples.size());
  }
  file.finish();
  for (const Sample& sample : samples) {
    validate(sample, coils);
  }
  return samples;
}

}  // namespace sac
