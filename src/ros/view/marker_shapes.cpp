#include "marker_shapes.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {

using visualization_msgs::Marker;

MarkerColor mixed(const MarkerColor& one, const MarkerColor& other, float share) {
  const auto mix = [share](float a, float b) { return a + share * (b - a); };
  return {mix(one.red, other.red),
          mix(one.green, other.green),
          mix(one.blue, other.blue),
          mix(one.alpha, other.alpha)};
}

std_msgs::ColorRGBA colorToRos(const MarkerColor& color) {
  std_msgs::ColorRGBA message;
  message.r = color.red;
  message.g = color.green;
  message.b = color.blue;
  message.a = color.alpha;
  return message;
}

Marker emptyMarker(const std::string& frame,
                   const std::string& group,
                   int id,
                   const MarkerColor& color) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.ns = group;
  marker.id = id;
  marker.action = Marker::ADD;
  marker.frame_locked = 1;
  marker.pose.orientation.w = 1.0;
  marker.color = colorToRos(color);
  return marker;
}

void drawArrow(Marker& marker, const Eigen::Vector3d& axis, double from, double to, double shaft) {
  marker.type = Marker::ARROW;
  marker.points = {pointToRos(from * axis), pointToRos(to * axis)};
  marker.scale.x = shaft;
  marker.scale.y = 2.0 * shaft;
  marker.scale.z = 0.4 * std::abs(to - from);
}

void drawCylinder(
    Marker& marker, const Eigen::Vector3d& axis, double distance, double radius, double length) {
  marker.type = Marker::CYLINDER;
  marker.pose.position = pointToRos(distance * axis);
  marker.pose.orientation =
      quaternionToRos(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
  marker.scale.x = 2.0 * radius;
  marker.scale.y = 2.0 * radius;
  marker.scale.z = length;
}

void drawText(Marker& marker,
              const Eigen::Vector3d& place,
              const std::string& text,
              double height) {
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.pose.position = pointToRos(place);
  marker.text = text;
  marker.scale.x = height;
  marker.scale.y = height;
  marker.scale.z = height;
}

void drawCone(
    Marker& marker, const Eigen::Vector3d& axis, double from, double to, double half_angle) {
  constexpr int kSegments = 24;
  constexpr double kFullTurn = 2.0 * kPi;
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d third = axis.cross(across);
  const double slope = std::tan(half_angle);
  const auto rim = [&](int n, double radius) {
    const double angle = kFullTurn * n / kSegments;
    return pointToRos(radius *
                      (axis + slope * (std::cos(angle) * across + std::sin(angle) * third)));
  };
  marker.type = Marker::TRIANGLE_LIST;
  marker.scale.x = 1.0;
  marker.scale.y = 1.0;
  marker.scale.z = 1.0;
  const geometry_msgs::Point middle = pointToRos(to * axis);
  for (int n = 0; n < kSegments; ++n) {
    for (const geometry_msgs::Point& corner : {rim(n, from),
                                               rim(n + 1, from),
                                               rim(n, to),
                                               rim(n + 1, from),
                                               rim(n + 1, to),
                                               rim(n, to),
                                               rim(n, to),
                                               rim(n + 1, to),
                                               middle}) {
      marker.points.push_back(corner);
    }
  }
}

}  // namespace sac
