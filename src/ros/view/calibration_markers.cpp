#include "spherical_actuator_calibration/ros/view/calibration_markers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "marker_shapes.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// Sizes of what is no body [m].
constexpr double kShaft = 0.0035;
constexpr double kThinShaft = 0.0015;
constexpr double kArrowGap = 0.002;       ///< between a body and its arrow
constexpr double kArrowLength = 0.024;    ///< the way from the rotor to the coils
constexpr double kNominalLength = 0.030;  ///< looks out where both axes agree
constexpr double kGlowMargin = 0.0015;
constexpr double kDot = 0.006;
constexpr double kDotGap = 0.008;
constexpr double kNumberGap = 0.006;     ///< between an arrow's end and its number
constexpr double kNumberHeight = 0.009;  ///< of a capital letter
constexpr double kRingGap = 0.018;       ///< between the rotor and the ring of its joints
constexpr double kRingWidth = 0.003;
constexpr double kRodRadius = 0.0025;
constexpr double kRodEnd = 0.012;  ///< of the rod that carries the ring, beyond it
constexpr int kRingPoints = 72;
constexpr double kLegendHeight = 0.0078;
constexpr double kLegendDistance = 0.03;  ///< beyond the shaft's end and the dots

constexpr double kFullGlow = 2.0;          // [A]
constexpr double kSmallestGlow = 0.02;     // of the full one
constexpr double kLargestHalfAngle = 1.2;  // [rad]
constexpr double kBadResidual = 3.0;
constexpr double kSameDirection = 0.02;  // [rad]

constexpr MarkerColor kInk = {0.1F, 0.12F, 0.15F, 1.0F};
constexpr MarkerColor kGrey = {0.55F, 0.55F, 0.55F, 0.9F};
constexpr MarkerColor kNorth = {0.85F, 0.15F, 0.15F, 1.0F};
constexpr MarkerColor kSouth = {0.15F, 0.3F, 0.85F, 1.0F};
constexpr MarkerColor kCopper = {0.72F, 0.45F, 0.2F, 1.0F};
constexpr MarkerColor kJoint = {0.0F, 0.55F, 0.6F, 1.0F};
constexpr MarkerColor kGlow = {1.0F, 0.9F, 0.1F, 0.85F};
constexpr MarkerColor kDark = {1.0F, 0.9F, 0.1F, 0.0F};
constexpr MarkerColor kUncertain = {0.6F, 0.2F, 0.7F, 0.35F};
constexpr MarkerColor kGood = {0.1F, 0.65F, 0.25F, 1.0F};
constexpr MarkerColor kBad = {0.9F, 0.1F, 0.1F, 1.0F};
constexpr MarkerColor kWanted = {0.1F, 0.75F, 0.35F, 1.0F};
constexpr MarkerColor kRejected = {0.0F, 0.0F, 0.0F, 1.0F};
constexpr float kGhostAlpha = 0.25F;

MarkerColor ghost(MarkerColor color) {
  color.alpha = kGhostAlpha;
  return color;
}

/// Identified axis with its difference from nominal magnified.
Eigen::Vector3d magnified(const Eigen::Vector3d& nominal,
                          const Eigen::Vector3d& identified,
                          double magnification) {
  return (nominal + magnification * (identified - nominal)).normalized();
}

MarkerColor colorOf(const SampledDirection& sample) {
  if (sample.rejected) {
    return kRejected;
  }
  if (!sample.standardized) {
    return kGrey;
  }
  const double share = (*sample.standardized - 1.0) / (kBadResidual - 1.0);
  return mixed(kGood, kBad, static_cast<float>(std::clamp(share, 0.0, 1.0)));
}

/// Whether one sample fits worse than another; nothing known is best.
bool isWorse(const SampledDirection& one, const SampledDirection& other) {
  if (one.rejected != other.rejected) {
    return one.rejected;
  }
  return one.standardized.value_or(-1.0) > other.standardized.value_or(-1.0);
}

/// The worst sample of each direction.
std::vector<SampledDirection> worstOfEach(const std::vector<SampledDirection>& samples) {
  std::map<std::array<long, 3>, SampledDirection> worst;
  for (const SampledDirection& sample : samples) {
    const Eigen::Vector3d cell = sample.direction_stator / kSameDirection;
    const auto [place, is_new] = worst.try_emplace(
        {std::lround(cell.x()), std::lround(cell.y()), std::lround(cell.z())}, sample);
    if (!is_new && isWorse(sample, place->second)) {
      place->second = sample;
    }
  }
  std::vector<SampledDirection> dots;
  dots.reserve(worst.size());
  for (const auto& [cell, sample] : worst) {
    dots.push_back(sample);
  }
  return dots;
}

/// The axes of one kind, poles or coils, and how they are drawn.
struct AxisGroup {
  std::string name;    ///< pole or coil
  std::string letter;  ///< before its numbers
  std::string frame;
  double from;          ///< radius where the arrows begin [m]
  double to;            ///< radius where they end [m]
  double nominal_from;  ///< the same of the nominal ones [m]
  double nominal_to;
};

class Drawing {
 public:
  explicit Drawing(const CalibrationScene& scene)
      : scene_(scene),
        nominal_(torqueGeometry(scene.nominal)),
        identified_(torqueGeometry(scene.identified)) {}

  MarkerArray markers() {
    addPoles();
    addCoils();
    addJoints();
    addGhost();
    addWantedPose();
    addSamples();
    addLegend();
    return array_;
  }

 private:
  void addPoles() {
    const double start = scene_.dimensions.rotor_radius + kArrowGap;
    const AxisGroup group = {"pole",
                             "P",
                             scene_.frames.rotor,
                             start,
                             start + kArrowLength,
                             start,
                             start + kNominalLength};
    for (Eigen::Index i = 0; i < nominal_.poles_rotor.cols(); ++i) {
      addAxis(group,
              i,
              nominal_.poles_rotor.col(i),
              identified_.poles_rotor.col(i),
              colorOfPole(i),
              scene_.pole_stddevs);
    }
  }

  void addCoils() {
    // From outside, so that coils and arrows do not hide each other.
    const double end = scene_.dimensions.outer_shell_radius + kArrowGap;
    const AxisGroup group = {
        "coil", "C", scene_.frames.stator, end + kArrowLength, end, end + kNominalLength, end};
    for (Eigen::Index j = 0; j < nominal_.coils_stator.cols(); ++j) {
      addAxis(group,
              j,
              nominal_.coils_stator.col(j),
              identified_.coils_stator.col(j),
              kCopper,
              scene_.coil_stddevs);
      addGlow(j);
    }
  }

  MarkerColor colorOfPole(Eigen::Index i) const {
    return scene_.nominal.poles[static_cast<std::size_t>(i)].polarity > 0 ? kNorth : kSouth;
  }

  void addAxis(const AxisGroup& group,
               Eigen::Index index,
               const Eigen::Vector3d& nominal,
               const Eigen::Vector3d& identified,
               const MarkerColor& color,
               const std::vector<std::optional<double>>& stddevs) {
    const auto id = static_cast<int>(index);
    const Eigen::Vector3d axis = magnified(nominal, identified, scene_.magnification);
    Marker arrow = emptyMarker(group.frame, group.name + "s", id, color);
    drawArrow(arrow, axis, group.from, group.to, kShaft);
    array_.markers.push_back(arrow);
    Marker drawn = emptyMarker(group.frame, "nominal " + group.name + "s", id, kGrey);
    drawArrow(drawn, nominal, group.nominal_from, group.nominal_to, kThinShaft);
    array_.markers.push_back(drawn);

    // Numbers of messages and advice, which count from 1.
    Marker number = emptyMarker(group.frame, group.name + " numbers", id, kInk);
    const double outside = std::max({group.to, group.from, group.nominal_from, group.nominal_to});
    drawText(number,
             (outside + kNumberGap) * axis,
             group.letter + std::to_string(numberOf(static_cast<std::size_t>(index))),
             kNumberHeight);
    array_.markers.push_back(number);

    Marker cone = emptyMarker(group.frame, group.name + " uncertainty", id, kUncertain);
    const auto place = static_cast<std::size_t>(index);
    if (place < stddevs.size() && stddevs[place]) {
      const double half_angle = std::min(scene_.magnification * *stddevs[place], kLargestHalfAngle);
      drawCone(cone,
               axis,
               std::min(group.nominal_from, group.nominal_to),
               std::max(group.nominal_from, group.nominal_to),
               half_angle);
    } else {
      cone.action = Marker::DELETE;
    }
    array_.markers.push_back(cone);
  }

  void addGlow(Eigen::Index j) {
    const double current = j < scene_.currents.size() ? std::abs(scene_.currents[j]) : 0.0;
    // A sensor that measures nothing (NaN) lights nothing.
    const double share = std::isfinite(current) ? std::min(1.0, current / kFullGlow) : 0.0;
    const ActuatorDimensions& d = scene_.dimensions;
    Marker glow = emptyMarker(scene_.frames.stator,
                              "currents",
                              static_cast<int>(j),
                              mixed(kDark, kGlow, static_cast<float>(share)));
    drawCylinder(glow,
                 nominal_.coils_stator.col(j),
                 d.coilDistance(),
                 d.coil_radius + kGlowMargin,
                 d.coil_height + 2.0 * kGlowMargin);
    if (share < kSmallestGlow) {
      glow.action = Marker::DELETE;
    }
    array_.markers.push_back(glow);
  }

  /// As a gimbal around the rotor: what is inside it, nobody would see.
  void addJoints() {
    if (!scene_.nominal.has_joints) {
      return;
    }
    const Eigen::Matrix3d nominal = jointGeometry(scene_.nominal).axes;
    const Eigen::Matrix3d identified = jointGeometry(scene_.identified).axes;
    Eigen::Matrix3d axes;
    for (Eigen::Index k = 0; k < axes.cols(); ++k) {
      axes.col(k) = magnified(
          nominal.col(k).normalized(), identified.col(k).normalized(), scene_.magnification);
    }
    const ActuatorDimensions& d = scene_.dimensions;
    const double radius = d.rotor_radius + kRingGap;
    const SceneFrames& frames = scene_.frames;
    addRod(0, frames.stator, axes.col(0), kRodRadius, radius + kRodEnd, radius + kRodEnd);
    addRod(1, frames.joint_1, axes.col(1), kRodRadius, radius, radius + kRodEnd);
    // Around the shaft.
    addRod(2, frames.joint_2, axes.col(2), d.shaft_radius + kRodRadius, radius, d.shaft_length);
    addRing(axes.col(0), axes.col(1), radius);
  }

  /// To `end` [m] on both sides; its number at `number_at`.
  void addRod(int id,
              const std::string& frame,
              const Eigen::Vector3d& axis,
              double radius,
              double end,
              double number_at) {
    Marker rod = emptyMarker(frame, "joints", id, kJoint);
    drawCylinder(rod, axis, 0.0, radius, 2.0 * end);
    array_.markers.push_back(rod);
    Marker number = emptyMarker(frame, "joint numbers", id, kJoint);
    drawText(number,
             (number_at + kNumberGap) * axis,
             "J" + std::to_string(numberOf(static_cast<std::size_t>(id))),
             kNumberHeight);
    array_.markers.push_back(number);
  }

  /// Through the ends of two unit axes [m], in the frame between them.
  void addRing(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double radius) {
    Marker ring = emptyMarker(scene_.frames.joint_1, "joint ring", 0, kJoint);
    ring.type = Marker::LINE_STRIP;
    ring.scale.x = kRingWidth;
    const Eigen::Vector3d across = (second - second.dot(first) * first).normalized();
    for (int n = 0; n <= kRingPoints; ++n) {
      const double angle = 2.0 * kPi * n / kRingPoints;
      ring.points.push_back(
          pointToRos(radius * (std::cos(angle) * first + std::sin(angle) * across)));
    }
    array_.markers.push_back(ring);
  }

  void addGhost() {
    addRotor("nominal rotor", scene_.frames.nominal_rotor, Eigen::Matrix3d::Identity(), kGrey);
  }

  void addWantedPose() {
    const std::size_t first = array_.markers.size();
    const Eigen::Vector3d q = scene_.wanted_joint_position.value_or(Eigen::Vector3d::Zero());
    addRotor("wanted pose",
             scene_.frames.stator,
             rotorOrientation(jointGeometry(scene_.identified), q),
             kWanted);
    for (std::size_t k = first; !scene_.wanted_joint_position && k < array_.markers.size(); ++k) {
      array_.markers[k].action = Marker::DELETE;
    }
  }

  /// A rotor of glass, its body of one colour and its poles of theirs.
  void addRotor(const std::string& group,
                const std::string& frame,
                const Eigen::Matrix3d& R_frame_rotor,
                const MarkerColor& color_of_body) {
    const ActuatorDimensions& d = scene_.dimensions;
    const Eigen::Vector3d up = R_frame_rotor.col(2);
    int id = 0;
    const auto add = [&](const MarkerColor& color,
                         const Eigen::Vector3d& axis,
                         double distance,
                         double radius,
                         double length) {
      Marker body = emptyMarker(frame, group, id++, ghost(color));
      drawCylinder(body, axis, distance, radius, length);
      array_.markers.push_back(body);
    };
    add(color_of_body, up, 0.0, d.rotor_radius, d.hoop_height);
    add(color_of_body, up, 0.5 * d.shaft_length, d.shaft_radius, d.shaft_length);
    for (Eigen::Index i = 0; i < nominal_.poles_rotor.cols(); ++i) {
      add(colorOfPole(i),
          R_frame_rotor * nominal_.poles_rotor.col(i),
          d.poleDistance(),
          d.pole_radius,
          d.pole_height);
    }
  }

  void addSamples() {
    Marker dots = emptyMarker(scene_.frames.stator, "samples", 0, kGrey);
    dots.type = Marker::SPHERE_LIST;
    dots.scale.x = kDot;
    dots.scale.y = kDot;
    dots.scale.z = kDot;
    const double radius = scene_.dimensions.shaft_length + kDotGap;
    for (const SampledDirection& sample : worstOfEach(scene_.samples)) {
      dots.points.push_back(pointToRos(radius * sample.direction_stator));
      dots.colors.push_back(colorToRos(colorOf(sample)));
    }
    // An empty list would be an error in rviz.
    if (dots.points.empty()) {
      dots.action = Marker::DELETE;
    }
    array_.markers.push_back(dots);
  }

  /// What the colours mean, above everything.
  void addLegend() {
    Marker legend = emptyMarker(scene_.frames.stator, "legend", 0, kInk);
    const std::string times = "x " + shortNumber(scene_.magnification);
    drawText(
        legend,
        (scene_.dimensions.shaft_length + kLegendDistance) * Eigen::Vector3d::UnitZ(),
        std::string(
            "P, red and blue: north and south poles; C, copper: coils, yellow with current") +
            (scene_.nominal.has_joints ? "; J: joints" : "") +
            "\nthin grey, faint: as drawn; thick: identified, its error " + times +
            "; violet: 1 sigma " + times + "; green rotor: go there" +
            "\ndots: samples; green fit, red do not, black are rejected, grey wait or are held out",
        kLegendHeight);
    array_.markers.push_back(legend);
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

}  // namespace sac
