#include "moved_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <Eigen/SVD>

#include "cube_rotations.hpp"
#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {
namespace {

/// Fewer orientations before or after tell nothing of three angles.
constexpr std::size_t kFewestOnOneSide = 3;
/// More rows than so many are tried in steps.
constexpr std::size_t kMostPlaces = 60;
constexpr std::size_t kMostFitted = 1;

std::string number(std::size_t index) {
  return std::to_string(numberOf(index));
}

/// Samples that something moved before or after.
struct Rows {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t border = 0;  ///< the first one after it moved

  /// Of what a correction of them is, what it is that happened at the border.
  double sign() const { return begin == border ? -1.0 : 1.0; }
};

std::string leaveOut(const WiringCase& described, std::size_t first) {
  const std::string sample = std::to_string(described.samples[first].id);
  return ": fasten it, and leave out the samples from " + sample + " on or those before it.";
}

Hypothesis movedMarker(const WiringCase& described, const Rows& rows) {
  Hypothesis result;
  result.cause = "marker_moved";
  result.family = result.cause;
  result.start = Eigen::Vector3d::Zero();
  result.correct = [rows](WiringCase& wiring, const Eigen::VectorXd& values) {
    const Eigen::Matrix3d back = rotationExp(values.head<3>());
    for (std::size_t n = rows.begin; n < rows.end; ++n) {
      wiring.samples[n].R_stator_rotor *= back;
    }
  };
  result.sentence = [rows,
                     words = leaveOut(described, rows.border)](const Eigen::VectorXd& values) {
    return "the marker moved on the rotor while samples were taken, by " +
           rotationInWords(rotationExp(rows.sign() * values.head<3>())) + " of the rotor" + words;
  };
  return result;
}

Hypothesis movedTracker(const WiringCase& described, const Rows& rows) {
  Hypothesis result;
  result.cause = "tracker_moved";
  result.family = result.cause;
  result.start = Eigen::Vector3d::Zero();
  result.correct = [rows](WiringCase& wiring, const Eigen::VectorXd& values) {
    const Eigen::Matrix3d back = rotationExp(values.head<3>());
    for (std::size_t n = rows.begin; n < rows.end; ++n) {
      wiring.samples[n].R_stator_rotor = back * wiring.samples[n].R_stator_rotor;
    }
  };
  result.sentence = [rows,
                     words = leaveOut(described, rows.border)](const Eigen::VectorXd& values) {
    return "tracker or stator moved while samples were taken: orientations are turned by " +
           rotationInWords(rotationExp(rows.sign() * values.head<3>())) + " of the stator" + words;
  };
  return result;
}

Hypothesis slippedJoint(const WiringCase& described, const Rows& rows, std::size_t joint) {
  Hypothesis result;
  result.cause = "joint_slipped:" + number(joint);
  result.family = result.cause;
  result.start = Eigen::VectorXd::Zero(1);
  const auto row = static_cast<Eigen::Index>(joint);
  result.correct = [rows, row](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (std::size_t n = rows.begin; n < rows.end; ++n) {
      wiring.samples[n].joint_position[row] += values[0];
    }
  };
  result.sentence = [name = described.actuator.joints[joint].name,
                     rows,
                     words = leaveOut(described, rows.border)](const Eigen::VectorXd& values) {
    const double angle = rows.sign() * std::remainder(values[0], 2.0 * kPi);
    return "the sensor of the joint " + name +
           format(" slipped while samples were taken, by %.4g rad (%.4g deg)",
                  angle,
                  angle / kOneDegree) +
           words;
  };
  return result;
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& sum) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, handed).asDiagonal() * svd.matrixV().transpose();
}

/// Tries every row from which on something may have moved.
class MovedScreen {
 public:
  MovedScreen(const WiringCase& described, const CalibrationConfig& config)
      : described_(described),
        config_(config),
        joints_(jointGeometry(described.actuator)),
        unchanged_(orientationLoss(described, config)) {
    for (std::size_t n = 0; n < described.samples.size(); ++n) {
      if (described.samples[n].has_orientation) {
        places_.push_back(n);
      }
    }
  }

  std::vector<ScreenedCandidate> run() {
    if (places_.size() < 2 * kFewestOnOneSide) {
      return {};
    }
    std::vector<ScreenedCandidate> all;
    for (int kind = 0; kind < 2 + static_cast<int>(kJoints); ++kind) {
      const std::vector<std::size_t> rows = rowsFor(kind);
      std::vector<ScreenedCandidate> best;
      for (const std::size_t row : rows) {
        add(row, kind, best);
      }
      keepBest(best, kMostFitted);
      all.insert(all.end(), best.begin(), best.end());
    }
    return all;
  }

 private:
  /// Of many only those near the best of some.
  std::vector<std::size_t> rowsFor(int kind) {
    const std::size_t end = places_.size() - kFewestOnOneSide + 1;
    const std::size_t step = places_.size() / kMostPlaces + 1;
    std::vector<std::size_t> rows = range(kFewestOnOneSide, end, step);
    if (step == 1) {
      return rows;
    }
    std::size_t best_row = rows.front();
    double best_gain = 0.0;
    for (const std::size_t row : rows) {
      std::vector<ScreenedCandidate> one;
      add(row, kind, one);
      if (!one.empty() && one.front().gain > best_gain) {
        best_gain = one.front().gain;
        best_row = row;
      }
    }
    return range(std::max(kFewestOnOneSide, best_row - std::min(best_row, step)),
                 std::min(end, best_row + step),
                 1);
  }

  static std::vector<std::size_t> range(std::size_t begin, std::size_t end, std::size_t step) {
    std::vector<std::size_t> rows;
    for (std::size_t row = begin; row < end; row += step) {
      rows.push_back(row);
    }
    return rows;
  }

  /// Either side of a row may be that which is as described.
  void add(std::size_t row, int kind, std::vector<ScreenedCandidate>& candidates) const {
    const Eigen::VectorXd back = kind < 2 ? Eigen::VectorXd(turnedBack(row, kind == 1))
                                          : Eigen::VectorXd::Constant(1, slipBack(row, kind - 2));
    const std::size_t border = places_[row];
    for (const bool is_late : {true, false}) {
      const Rows rows{is_late ? border : 0, is_late ? described_.samples.size() : border, border};
      Hypothesis hypothesis =
          kind == 0   ? movedMarker(described_, rows)
          : kind == 1 ? movedTracker(described_, rows)
                      : slippedJoint(described_, rows, static_cast<std::size_t>(kind - 2));
      hypothesis.start = is_late ? back : Eigen::VectorXd(-back);
      hypothesis.cost = std::log(static_cast<double>(places_.size()));
      const double gain =
          unchanged_ -
          orientationLoss(corrected(described_, {hypothesis}, hypothesis.start), config_);
      if (gain > 0.0) {
        candidates.push_back({{std::move(hypothesis)}, gain});
      }
    }
  }

  /// What the mean after a row must be turned by to be that before it.
  Eigen::Vector3d turnedBack(std::size_t row, bool is_tracker) const {
    Eigen::Matrix3d before = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d after = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const Sample& sample = described_.samples[places_[k]];
      const Eigen::Matrix3d R = rotorOrientation(joints_, sample.joint_position);
      (k < row ? before : after) += is_tracker
                                        ? Eigen::Matrix3d(sample.R_stator_rotor * R.transpose())
                                        : Eigen::Matrix3d(R.transpose() * sample.R_stator_rotor);
    }
    before = nearestRotation(before);
    after = nearestRotation(after);
    return rotationLog(is_tracker ? Eigen::Matrix3d(before * after.transpose())
                                  : Eigen::Matrix3d(after.transpose() * before));
  }

  double slipBack(std::size_t row, int joint) const {
    double before = 0.0;
    double after = 0.0;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const Sample& sample = described_.samples[places_[k]];
      const JointLinearization at = linearizeRotorOrientation(joints_, sample.joint_position);
      const double misfit = at.d_offset.col(joint).dot(
          rotationLog(sample.R_stator_rotor * at.R_stator_rotor.transpose()));
      (k < row ? before : after) += misfit;
    }
    return after / static_cast<double>(places_.size() - row) - before / static_cast<double>(row);
  }

  const WiringCase& described_;
  const CalibrationConfig& config_;
  const JointGeometry joints_;
  const double unchanged_;
  std::vector<std::size_t> places_;
};

}  // namespace

std::vector<ScreenedCandidate> screenMoved(const WiringCase& described,
                                           const Eigen::VectorXd& x,
                                           const CalibrationConfig& config) {
  WiringCase fitted = described;
  fitted.actuator.poles.clear();
  fitted.actuator.coils.clear();
  fitted.actuator.torque_curve.reset();
  fitted.actuator = ParameterSpace(fitted.actuator).actuatorAt(x);
  return MovedScreen(fitted, config).run();
}

}  // namespace sac
