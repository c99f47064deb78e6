#include "pose_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"

namespace sac {
namespace {

using Factor = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Exponent p of the norm of variances that stands for the largest one: the maximum alone does not
/// tell which of two poses is better for the second worst parameter, which comes next. The power
/// is computed by squaring, so p is 2³.
double steepPower(double x) {
  const double square = x * x;
  const double fourth = square * square;
  return fourth * fourth;
}

/// Covariance of the coordinates while observations are added to it one by one, as far as the
/// observations of one candidate need it.
class Update {
 public:
  Update(const PoseCandidate& candidate, const Eigen::MatrixXd& covariance)
      : variances_(covariance.diagonal()) {
    if (candidate.orientation) {
      add(*candidate.orientation, covariance);
    }
    for (const WhitenedObservation& torque : candidate.torques) {
      add(torque, covariance);
    }
  }

  /// ln of the factor by which det N grows with this observation, in halves.
  double information(std::size_t observation) const {
    return Cholesky3(items_[observation].innovation).lower().diagonal().array().log().sum();
  }

  /// How much this observation lowers the weighted sum of variances.
  double reduction(std::size_t observation, const Eigen::VectorXd& weights) const {
    const Item& item = items_[observation];
    const Eigen::Matrix3d weighted = item.effect.transpose() * (weights.asDiagonal() * item.effect);
    return Cholesky3(item.innovation).solve(weighted).trace();
  }

  /// Takes this observation: the variances and what the others would add change.
  void take(std::size_t observation) {
    Item& taken = items_[observation];
    const Eigen::Matrix3d inverse_root =
        Cholesky3(taken.innovation).half(Eigen::Matrix3d::Identity()).transpose();
    const Factor gain = taken.effect * inverse_root;
    variances_ -= gain.rowwise().squaredNorm();
    taken.is_taken = true;
    for (Item& item : items_) {
      if (!item.is_taken) {
        const Eigen::Matrix3d shared = item.observation->times(gain);
        item.effect.noalias() -= gain * shared.transpose();
        item.innovation.noalias() -= shared * shared.transpose();
      }
    }
  }

  const Eigen::VectorXd& variances() const { return variances_; }

 private:
  struct Item {
    const WhitenedObservation* observation = nullptr;
    Factor effect;               ///< C Jᵀ
    Eigen::Matrix3d innovation;  ///< J C Jᵀ + 1
    bool is_taken = false;
  };

  void add(const WhitenedObservation& observation, const Eigen::MatrixXd& covariance) {
    Item item;
    item.observation = &observation;
    item.effect = observation.timesTransposed(covariance);
    item.innovation = Eigen::Matrix3d::Identity() + observation.times(item.effect);
    items_.push_back(std::move(item));
  }

  Eigen::VectorXd variances_;
  std::vector<Item> items_;
};

/// The norm of variances that stands for the largest one.
double steepNorm(const Eigen::VectorXd& variances) {
  const double largest = variances.maxCoeff();
  return largest * std::pow((variances / largest).unaryExpr(&steepPower).sum(), 1.0 / 8.0);
}

/// Its gradient, up to a factor.
Eigen::VectorXd steepWeights(const Eigen::VectorXd& variances) {
  const Eigen::ArrayXd shares = variances.array() / variances.maxCoeff();
  return shares.unaryExpr(&steepPower) / shares;
}

/// How good a covariance is, in units of a relative standard deviation or, for information, of a
/// factor on the volume of the uncertainty: more is better.
double meritOf(const Eigen::MatrixXd& covariance, PlanCriterion criterion) {
  if (criterion == PlanCriterion::kInformation) {
    return -Cholesky(covariance).lower().diagonal().array().log().sum();
  }
  return -0.5 * std::log(steepNorm(covariance.diagonal()));
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& information) {
  return InformationFactor(information).inverse();
}

void addPose(const PoseCandidate& candidate,
             const std::vector<std::size_t>& torques,
             InformationSum& sum) {
  if (candidate.orientation) {
    sum.add(*candidate.orientation);
  }
  for (const std::size_t torque : torques) {
    sum.add(candidate.torques[torque]);
  }
}

}  // namespace

PoseSelection::PoseSelection(const std::vector<PoseCandidate>& candidates,
                             Eigen::MatrixXd information,
                             const Options& options)
    : candidates_(candidates), known_(std::move(information)), options_(options) {}

bool PoseSelection::add() {
  const Choice choice = best(covariance(), PlanCriterion::kInformation);
  if (std::isinf(choice.merit)) {
    return false;
  }
  poses_.push_back(choice.pose);
  return true;
}

bool PoseSelection::exchange() {
  // Less is rounding, or not worth another pass.
  constexpr double kLeastGain = 1e-3;
  bool exchanged = false;
  double merit = meritOf(covariance(), options_.criterion);
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    const SelectedPose old = poses_.front();
    poses_.erase(poses_.begin());
    poses_.push_back(best(covariance(), options_.criterion).pose);
    const double changed_merit = meritOf(covariance(), options_.criterion);
    if (changed_merit > merit + kLeastGain) {
      merit = changed_merit;
      exchanged = true;
    } else {
      poses_.back() = old;
    }
  }
  return exchanged;
}

double PoseSelection::worstStddev() const {
  return std::sqrt(covariance().diagonal().maxCoeff());
}

bool PoseSelection::keepsDistance(std::size_t candidate) const {
  return std::all_of(poses_.begin(), poses_.end(), [&](const SelectedPose& pose) {
    return pose.candidate != candidate &&
           areApart(candidates_[pose.candidate], candidates_[candidate], options_.minimum_spacing);
  });
}

PoseSelection::Choice PoseSelection::evaluate(std::size_t candidate,
                                              const Eigen::MatrixXd& covariance,
                                              PlanCriterion criterion) const {
  const PoseCandidate& pose = candidates_[candidate];
  Update update(pose, covariance);
  const std::size_t first_torque = pose.orientation ? 1 : 0;
  double information = 0.0;
  const auto take = [&](std::size_t observation) {
    information += update.information(observation);
    update.take(observation);
  };
  if (pose.orientation) {
    take(0);
  }
  Choice choice;
  choice.pose.candidate = candidate;
  std::vector<bool> is_taken(pose.torques.size(), false);
  const std::size_t most = std::min(options_.torques_per_pose, pose.torques.size());
  while (choice.pose.torques.size() < most) {
    const Eigen::VectorXd weights = steepWeights(update.variances());
    double best_merit = -1.0;
    std::size_t best_torque = 0;
    for (std::size_t t = 0; t < is_taken.size(); ++t) {
      if (is_taken[t]) {
        continue;
      }
      const double merit = criterion == PlanCriterion::kInformation
                               ? update.information(first_torque + t)
                               : update.reduction(first_torque + t, weights);
      if (merit > best_merit) {
        best_merit = merit;
        best_torque = t;
      }
    }
    take(first_torque + best_torque);
    is_taken[best_torque] = true;
    choice.pose.torques.push_back(best_torque);
  }
  std::sort(choice.pose.torques.begin(), choice.pose.torques.end());
  choice.merit =
      criterion == PlanCriterion::kInformation ? information : -steepNorm(update.variances());
  return choice;
}

PoseSelection::Choice PoseSelection::best(const Eigen::MatrixXd& covariance,
                                          PlanCriterion criterion) const {
  Choice best_choice;
  best_choice.merit = -std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (!keepsDistance(c)) {
      continue;
    }
    Choice choice = evaluate(c, covariance, criterion);
    if (choice.merit > best_choice.merit) {
      best_choice = std::move(choice);
    }
  }
  return best_choice;
}

Eigen::MatrixXd PoseSelection::covariance() const {
  InformationSum sum(known_);
  for (const SelectedPose& pose : poses_) {
    addPose(candidates_[pose.candidate], pose.torques, sum);
  }
  return inverse(sum.information());
}

}  // namespace sac
