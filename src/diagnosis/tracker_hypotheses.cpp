#include <Eigen/Geometry>

#include "cube_rotations.hpp"
#include "material_value.hpp"
#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

template <typename Change>
std::function<void(WiringCase&, const Eigen::VectorXd&)> changingOrientations(Change change) {
  return [change](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (Sample& sample : wiring.samples) {
      if (sample.has_orientation) {
        change(sample.R_stator_rotor, values);
      }
    }
  };
}

std::string trackerSentence(const Eigen::Matrix3d& rotation) {
  return "the measured orientations are in a frame that is turned by " +
         rotationInWords(rotation.transpose()) +
         " from the stator: turn the launch argument stator_tracker (registration of the tracker) "
         "by " +
         rotationInWords(rotation) + " in the stator frame.";
}

std::string markerSentence(const Eigen::Matrix3d& rotation) {
  return "the measured orientations are of a body that is turned by " +
         rotationInWords(rotation.transpose()) +
         " in the rotor: turn the launch argument rotor_marker (registration of the marker) by " +
         rotationInWords(rotation.transpose()) + " in the rotor frame.";
}

Hypothesis inverted() {
  Hypothesis result;
  result.cause = "orientation_inverted";
  result.family = result.cause;
  result.correct = changingOrientations(
      [](Eigen::Matrix3d& R, const Eigen::VectorXd& /*values*/) { R.transposeInPlace(); });
  result.sentence = [](const Eigen::VectorXd& /*values*/) {
    return std::string(
        "the measured orientations map the stator to the rotor: invert them where they are "
        "published (tracker pose of marker in tracker, not of tracker in marker).");
  };
  return result;
}

/// `forward`: w, x, y, z was taken for x, y, z, w; else the other way round.
Hypothesis quaternionOrder(bool forward) {
  Hypothesis result;
  result.cause = "quaternion_order";
  result.family = result.cause;
  result.correct =
      changingOrientations([forward](Eigen::Matrix3d& R, const Eigen::VectorXd& /*values*/) {
        const Eigen::Quaterniond q(R);
        R = (forward ? Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w())
                     : Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()))
                .toRotationMatrix();
      });
  result.sentence = [forward](const Eigen::VectorXd& /*values*/) {
    return std::string(
               "the components of the measured quaternions are in another order: they "
               "were written ") +
           (forward ? "w, x, y, z and read x, y, z, w" : "x, y, z, w and read w, x, y, z") +
           "; exchange the order in the tracker's driver.";
  };
  return result;
}

}  // namespace

std::vector<Hypothesis> trackerHypotheses() {
  std::vector<Hypothesis> all = {inverted(), quaternionOrder(true), quaternionOrder(false)};
  const std::vector<Eigen::Matrix3d> rotations = cubeRotations();
  for (std::size_t n = 1; n < rotations.size(); ++n) {
    const Eigen::Matrix3d& rotation = rotations[n];
    Hypothesis tracker;
    tracker.cause = "tracker_frame";
    tracker.family = tracker.cause;
    tracker.correct = changingOrientations(
        [rotation](Eigen::Matrix3d& R, const Eigen::VectorXd& /*values*/) { R = rotation * R; });
    tracker.sentence = [rotation](const Eigen::VectorXd& /*values*/) {
      return trackerSentence(rotation);
    };
    all.push_back(tracker);
    Hypothesis marker;
    marker.cause = "marker_frame";
    marker.family = marker.cause;
    marker.correct = changingOrientations(
        [rotation](Eigen::Matrix3d& R, const Eigen::VectorXd& /*values*/) { R = R * rotation; });
    marker.sentence = [rotation](const Eigen::VectorXd& /*values*/) {
      return markerSentence(rotation);
    };
    all.push_back(marker);
  }
  return all;
}

Hypothesis trackerRotation(double tolerance) {
  Hypothesis result;
  result.cause = "tracker_frame";
  result.family = result.cause;
  result.start = Eigen::Vector3d::Zero();
  result.correct = changingOrientations([](Eigen::Matrix3d& R, const Eigen::VectorXd& values) {
    R = rotationExp(values.head<3>()) * R;
  });
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return values.norm() > kMaterial * tolerance;
  };
  result.sentence = [](const Eigen::VectorXd& values) {
    return trackerSentence(rotationExp(values.head<3>()));
  };
  return result;
}

Hypothesis markerRotation(double tolerance) {
  Hypothesis result = trackerRotation(tolerance);
  result.cause = "marker_frame";
  result.family = result.cause;
  result.correct = changingOrientations([](Eigen::Matrix3d& R, const Eigen::VectorXd& values) {
    R = R * rotationExp(values.head<3>());
  });
  result.sentence = [](const Eigen::VectorXd& values) {
    return markerSentence(rotationExp(values.head<3>()));
  };
  return result;
}

}  // namespace sac
