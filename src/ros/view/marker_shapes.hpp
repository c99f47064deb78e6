#pragma once

#include <string>

#include <Eigen/Core>

#include <visualization_msgs/Marker.h>

namespace sac {

/// Colour of a marker; each from 0 to 1.
struct MarkerColor {
  float red;
  float green;
  float blue;
  float alpha;
};

/// `share` (0 to 1) of the way from one colour to the other.
MarkerColor mixed(const MarkerColor& one, const MarkerColor& other, float share);

std_msgs::ColorRGBA colorToRos(const MarkerColor& color);

/// A marker without a shape that stays with its frame.
visualization_msgs::Marker emptyMarker(const std::string& frame,
                                       const std::string& group,
                                       int id,
                                       const MarkerColor& color);

/// Arrow along a unit axis through the origin, between two radii [m], `shaft` thick [m].
void drawArrow(visualization_msgs::Marker& marker,
               const Eigen::Vector3d& axis,
               double from,
               double to,
               double shaft);

/// Cylinder along a unit axis through the origin, its centre at `distance` [m].
void drawCylinder(visualization_msgs::Marker& marker,
                  const Eigen::Vector3d& axis,
                  double distance,
                  double radius,
                  double length);

/// The part between two radii [m] of a cone about a unit axis with its tip in the origin, closed at
/// the wide end. `half_angle` [rad] below π/2.
void drawCone(visualization_msgs::Marker& marker,
              const Eigen::Vector3d& axis,
              double from,
              double to,
              double half_angle);

/// Words that face the camera, their middle at `place` [m], a capital letter `height` tall [m].
void drawText(visualization_msgs::Marker& marker,
              const Eigen::Vector3d& place,
              const std::string& text,
              double height);

}  // namespace sac
