#include "spherical_actuator_calibration/ros/calibration_markers.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/core/torque_model.hpp"

namespace spherical_actuator_calibration {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// Dimensions of the drawing [m], as in urdf/.
constexpr double kRotorRadius = 0.0565;
constexpr double kShellRadius = 0.117;
constexpr double kPoleLength = 0.022;
constexpr double kCoilLength = 0.03;
constexpr double kShaft = 0.005;
constexpr double kThinShaft = 0.0015;
constexpr double kSampleRadius = 0.16;
constexpr double kFullGlow = 2.0;  // [A]

struct Color {
  float red;
  float green;
  float blue;
  float alpha;
};
constexpr Color kGrey = {0.55F, 0.55F, 0.55F, 0.9F};
constexpr Color kNorth = {0.85F, 0.15F, 0.15F, 1.0F};
constexpr Color kSouth = {0.15F, 0.3F, 0.85F, 1.0F};
constexpr Color kCopper = {0.72F, 0.45F, 0.2F, 1.0F};
constexpr Color kGlow = {1.0F, 0.95F, 0.2F, 1.0F};
constexpr Color kSample = {0.1F, 0.6F, 0.3F, 1.0F};

geometry_msgs::Point pointOf(const Eigen::Vector3d& from) {
  geometry_msgs::Point point;
  point.x = from.x();
  point.y = from.y();
  point.z = from.z();
  return point;
}

Color mixed(const Color& one, const Color& other, float share) {
  const auto mix = [share](float a, float b) { return a + share * (b - a); };
  return {mix(one.red, other.red),
          mix(one.green, other.green),
          mix(one.blue, other.blue),
          mix(one.alpha, other.alpha)};
}

Marker marker(const std::string& frame, const std::string& group, int id, const Color& color) {
  Marker result;
  result.header.frame_id = frame;
  result.ns = group;
  result.id = id;
  result.action = Marker::ADD;
  result.frame_locked = 1;
  result.pose.orientation.w = 1.0;
  result.color.r = color.red;
  result.color.g = color.green;
  result.color.b = color.blue;
  result.color.a = color.alpha;
  return result;
}

/// Arrow along an axis between two radii.
void drawArrow(Marker& arrow, const Eigen::Vector3d& axis, double from, double to, double shaft) {
  arrow.type = Marker::ARROW;
  arrow.points = {pointOf(from * axis), pointOf(to * axis)};
  arrow.scale.x = shaft;
  arrow.scale.y = 2.0 * shaft;
  arrow.scale.z = 0.4 * std::abs(to - from);
}

/// Identified axis with its difference from nominal magnified.
Eigen::Vector3d magnified(const Eigen::Vector3d& nominal,
                          const Eigen::Vector3d& identified,
                          double magnification) {
  return (nominal + magnification * (identified - nominal)).normalized();
}

class Drawing {
 public:
  explicit Drawing(const CalibrationScene& scene)
      : scene_(scene),
        nominal_(torqueGeometry(scene.nominal)),
        identified_(torqueGeometry(scene.identified)) {}

  MarkerArray markers() {
    for (Eigen::Index i = 0; i < nominal_.poles_rotor.cols(); ++i) {
      addPole(i);
    }
    for (Eigen::Index j = 0; j < nominal_.coils_stator.cols(); ++j) {
      addCoil(j);
    }
    addSamples();
    return array_;
  }

 private:
  void addPole(Eigen::Index i) {
    const Eigen::Vector3d nominal = nominal_.poles_rotor.col(i);
    const Eigen::Vector3d axis =
        magnified(nominal, identified_.poles_rotor.col(i), scene_.magnification);
    const bool is_north = scene_.nominal.poles[static_cast<std::size_t>(i)].polarity > 0;
    const auto id = static_cast<int>(i);
    Marker pole = marker(scene_.rotor_frame, "poles", id, is_north ? kNorth : kSouth);
    drawArrow(pole, axis, kRotorRadius - kPoleLength, kRotorRadius + kPoleLength, kShaft);
    array_.markers.push_back(pole);
    Marker drawn = marker(scene_.rotor_frame, "nominal poles", id, kGrey);
    drawArrow(drawn, nominal, kRotorRadius, kRotorRadius + 1.5 * kPoleLength, kThinShaft);
    array_.markers.push_back(drawn);
  }

  void addCoil(Eigen::Index j) {
    const Eigen::Vector3d nominal = nominal_.coils_stator.col(j);
    const Eigen::Vector3d axis =
        magnified(nominal, identified_.coils_stator.col(j), scene_.magnification);
    const double current = j < scene_.currents.size() ? std::abs(scene_.currents[j]) : 0.0;
    const auto glow = static_cast<float>(std::min(1.0, current / kFullGlow));
    const auto id = static_cast<int>(j);
    Marker coil = marker(scene_.stator_frame, "coils", id, mixed(kCopper, kGlow, glow));
    drawArrow(coil,
              axis,
              kShellRadius + kCoilLength,
              kShellRadius - 0.5 * kCoilLength,
              kShaft * (1.0 + static_cast<double>(glow)));
    array_.markers.push_back(coil);
    Marker drawn = marker(scene_.stator_frame, "nominal coils", id, kGrey);
    drawArrow(drawn, nominal, kShellRadius + 1.4 * kCoilLength, kShellRadius, kThinShaft);
    array_.markers.push_back(drawn);
  }

  void addSamples() {
    Marker samples = marker(scene_.stator_frame, "samples", 0, kSample);
    samples.type = Marker::SPHERE_LIST;
    samples.scale.x = samples.scale.y = samples.scale.z = 0.006;
    for (const Eigen::Vector3d& direction : scene_.sampled_directions) {
      samples.points.push_back(pointOf(kSampleRadius * direction));
    }
    // An empty list would be an error in rviz.
    if (samples.points.empty()) {
      samples.action = Marker::DELETE;
    }
    array_.markers.push_back(samples);
  }

  const CalibrationScene& scene_;
  TorqueGeometry nominal_;
  TorqueGeometry identified_;
  MarkerArray array_;
};

}  // namespace

MarkerArray calibrationMarkers(const CalibrationScene& scene) {
  return Drawing(scene).markers();
}

}  // namespace spherical_actuator_calibration
