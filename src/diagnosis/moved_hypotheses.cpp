#include "moved_hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "cube_rotations.hpp"
#include "explanation_words.hpp"
#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/nearest_rotation.hpp"
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
  result.cause = "joint_slipped:" + numberText(joint);
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

/// An orientation that was measured, and what the description makes of its joint angles.
struct Place {
  std::size_t row = 0;  ///< of its sample
  Eigen::Matrix3d expected;
  double loss = 0.0;  ///< as described
};

/// Sums over the places before each one, and at the end over all.
template <typename Sum>
std::vector<Sum> runningSums(std::size_t count,
                             const Sum& zero,
                             const std::function<Sum(std::size_t)>& term) {
  std::vector<Sum> sums = {zero};
  for (std::size_t k = 0; k < count; ++k) {
    sums.push_back(sums.back() + term(k));
  }
  return sums;
}

/// Tries every row from which on something may have moved.
class MovedScreen {
 public:
  MovedScreen(const WiringCase& described, const CalibrationConfig& config)
      : described_(described), config_(config), joints_(jointGeometry(described.actuator)) {
    for (std::size_t n = 0; n < described.samples.size(); ++n) {
      const Sample& sample = described.samples[n];
      if (sample.has_orientation) {
        const Eigen::Matrix3d R = rotorOrientation(joints_, sample.joint_position);
        const double loss = orientationLoss(sample.R_stator_rotor * R.transpose(),
                                            sample.joint_position,
                                            sample.orientation_stddev,
                                            config);
        places_.push_back({n, R, loss});
      }
    }
    losses_ =
        runningSums<double>(places_.size(), 0.0, [this](std::size_t k) { return places_[k].loss; });
  }

  std::vector<ScreenedCandidate> run() {
    if (places_.size() < 2 * kFewestOnOneSide) {
      return {};
    }
    std::vector<ScreenedCandidate> all;
    for (kind_ = 0; kind_ < 2 + static_cast<int>(kJoints); ++kind_) {
      sumMisfits();
      const Move best = bestMove();
      if (best.gain > 0.0) {
        all.push_back({{hypothesisOf(best)}, best.gain});
      }
    }
    return all;
  }

 private:
  /// What undoes a move of the samples on one side of a place.
  struct Move {
    std::size_t place = 0;
    bool is_late = true;
    Eigen::Vector3d back = Eigen::Vector3d::Zero();  ///< a slip: the first number of it
    double gain = 0.0;
  };

  const Sample& sampleAt(std::size_t k) const { return described_.samples[places_[k].row]; }

  /// Of the measured orientations, in the form that the kind of move needs.
  void sumMisfits() {
    if (kind_ < 2) {
      turns_ = runningSums<Eigen::Matrix3d>(
          places_.size(), Eigen::Matrix3d::Zero(), [this](std::size_t k) {
            const Eigen::Matrix3d& R = places_[k].expected;
            const Eigen::Matrix3d& measured = sampleAt(k).R_stator_rotor;
            return kind_ == 1 ? Eigen::Matrix3d(measured * R.transpose())
                              : Eigen::Matrix3d(R.transpose() * measured);
          });
    } else {
      slips_ = runningSums<double>(places_.size(), 0.0, [this](std::size_t k) {
        const JointLinearization at =
            linearizeRotorOrientation(joints_, sampleAt(k).joint_position);
        return at.d_offset.col(kind_ - 2).dot(
            rotationLog(sampleAt(k).R_stator_rotor * at.R_stator_rotor.transpose()));
      });
    }
  }

  /// Of many places only those near the best of some.
  Move bestMove() const {
    const std::size_t end = places_.size() - kFewestOnOneSide + 1;
    const std::size_t step = places_.size() / kMostPlaces + 1;
    Move best = bestOf(kFewestOnOneSide, end, step);
    if (step == 1 || best.gain == 0.0) {
      return best;
    }
    return bestOf(std::max(kFewestOnOneSide, best.place - std::min(best.place, step)),
                  std::min(end, best.place + step),
                  1);
  }

  /// Either side of a place may be that which is as described.
  Move bestOf(std::size_t begin, std::size_t end, std::size_t step) const {
    Move best;
    for (std::size_t place = begin; place < end; place += step) {
      const Eigen::Vector3d back = kind_ < 2 ? turnedBack(place) : slippedBack(place);
      for (const bool is_late : {true, false}) {
        Move move{place, is_late, is_late ? back : Eigen::Vector3d(-back), 0.0};
        move.gain = gainOf(move);
        if (move.gain > best.gain) {
          best = move;
        }
      }
    }
    return best;
  }

  double gainOf(const Move& move) const {
    const std::size_t begin = move.is_late ? move.place : 0;
    const std::size_t end = move.is_late ? places_.size() : move.place;
    const Eigen::Matrix3d back = rotationExp(move.back);
    double loss = 0.0;
    for (std::size_t k = begin; k < end; ++k) {
      const Sample& sample = sampleAt(k);
      Eigen::Vector3d q = sample.joint_position;
      Eigen::Matrix3d R = places_[k].expected;
      Eigen::Matrix3d measured = sample.R_stator_rotor;
      if (kind_ == 0) {
        measured = measured * back;
      } else if (kind_ == 1) {
        measured = back * measured;
      } else {
        q[kind_ - 2] += move.back[0];
        R = rotorOrientation(joints_, q);
      }
      loss += orientationLoss(measured * R.transpose(), q, sample.orientation_stddev, config_);
    }
    return losses_[end] - losses_[begin] - loss;
  }

  Hypothesis hypothesisOf(const Move& move) const {
    const std::size_t border = places_[move.place].row;
    const Rows rows{
        move.is_late ? border : 0, move.is_late ? described_.samples.size() : border, border};
    Hypothesis hypothesis =
        kind_ == 0   ? movedMarker(described_, rows)
        : kind_ == 1 ? movedTracker(described_, rows)
                     : slippedJoint(described_, rows, static_cast<std::size_t>(kind_ - 2));
    hypothesis.start = move.back.head(hypothesis.start.size());
    hypothesis.cost = std::log(static_cast<double>(places_.size()));
    return hypothesis;
  }

  /// What the mean from a place on must be turned by to be that before it.
  Eigen::Vector3d turnedBack(std::size_t place) const {
    const Eigen::Matrix3d before = nearestRotation(turns_[place]);
    const Eigen::Matrix3d after = nearestRotation(turns_.back() - turns_[place]);
    return rotationLog(kind_ == 1 ? Eigen::Matrix3d(before * after.transpose())
                                  : Eigen::Matrix3d(after.transpose() * before));
  }

  Eigen::Vector3d slippedBack(std::size_t place) const {
    const double before = slips_[place] / static_cast<double>(place);
    const double after =
        (slips_.back() - slips_[place]) / static_cast<double>(places_.size() - place);
    return {after - before, 0.0, 0.0};
  }

  const WiringCase& described_;
  const CalibrationConfig& config_;
  const JointGeometry joints_;
  std::vector<Place> places_;
  std::vector<double> losses_;
  int kind_ = 0;  ///< 0 marker, 1 tracker, then the joints
  std::vector<Eigen::Matrix3d> turns_;
  std::vector<double> slips_;
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
