#include "design_task.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/angle_difference.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"

namespace sac {
namespace {

/// Slopes of an angle [rad/rad] beyond which it says nothing: its axis is along that of the angles.
constexpr double kFlattest = 0.5;
constexpr double kSteepest = 1e3;

/// Difference of two values; of angles the short way round.
double difference(double a, double b, bool is_angle) {
  return is_angle ? angleDifference(a, b) : a - b;
}

/// Adds the derivative by `term`, times `sign`, to columns that hold all of its.
void addTerm(const WhitenedObservation& term, double sign, WhitenedObservation& sum) {
  auto place = sum.columns.begin();
  for (std::size_t k = 0; k < term.columns.size(); ++k) {
    place = std::lower_bound(place, sum.columns.end(), term.columns[k]);
    sum.jacobian.col(place - sum.columns.begin()) +=
        sign * term.jacobian.col(static_cast<Eigen::Index>(k));
  }
}

/// The terms of a pattern, what is unexcited among them.
std::vector<std::pair<const WhitenedObservation*, int>> termsOf(const PoseCandidate& candidate,
                                                                const TermPattern& pattern) {
  std::vector<std::pair<const WhitenedObservation*, int>> terms;
  for (const SignedTerm& signed_term : pattern) {
    terms.emplace_back(&candidate.terms[signed_term.term], signed_term.sign);
  }
  if (candidate.unexcited) {
    terms.emplace_back(&*candidate.unexcited, 1);
  }
  return terms;
}

}  // namespace

Eigen::SparseMatrix<double> reportedDerivative(const ParameterSpace& space,
                                               const Eigen::VectorXd& x,
                                               const std::vector<Eigen::Index>& coordinates) {
  constexpr double kStep = 1e-6;
  const auto count = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd derivative(count, count);
  for (Eigen::Index b = 0; b < count; ++b) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(x.size());
    step[coordinates[static_cast<std::size_t>(b)]] = kStep;
    const Eigen::VectorXd above = space.reportedValues(x + step);
    const Eigen::VectorXd below = space.reportedValues(x - step);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Eigen::Index p = coordinates[static_cast<std::size_t>(a)];
      derivative(a, b) = difference(above[p], below[p], p < space.effect()) / (2.0 * kStep);
    }
  }
  for (Eigen::Index a = 0; a < count; ++a) {
    const double slope = derivative.row(a).norm();
    const bool is_angle = coordinates[static_cast<std::size_t>(a)] < space.effect();
    if (is_angle && !(slope > kFlattest && slope < kSteepest)) {
      derivative.row(a) = Eigen::RowVectorXd::Unit(count, a);
    }
  }
  return derivative.sparseView(1.0, 1e-9);
}

Eigen::VectorXd reportedVariances(const DesignTask& task, const Eigen::MatrixXd& covariance) {
  const Eigen::Index count = task.reported.cols();
  const Eigen::MatrixXd mapped = task.reported * covariance.topLeftCorner(count, count);
  return (mapped * task.reported.transpose()).diagonal();
}

WhitenedObservation patternObservation(const PoseCandidate& candidate, const TermPattern& pattern) {
  WhitenedObservation sum;
  const auto terms = termsOf(candidate, pattern);
  for (const auto& [term, sign] : terms) {
    sum.columns.insert(sum.columns.end(), term->columns.begin(), term->columns.end());
  }
  std::sort(sum.columns.begin(), sum.columns.end());
  sum.columns.erase(std::unique(sum.columns.begin(), sum.columns.end()), sum.columns.end());
  sum.jacobian.setZero(3, static_cast<Eigen::Index>(sum.columns.size()));
  for (const auto& [term, sign] : terms) {
    addTerm(*term, sign, sum);
  }
  return sum;
}

Eigen::MatrixXd poseInformation(const DesignTask& task,
                                const PoseCandidate& candidate,
                                const std::vector<TermPattern>& patterns) {
  InformationSum sum(task.known.rows() + kPoseErrors);
  if (candidate.tracked) {
    sum.add(*candidate.tracked);
  }
  for (const TermPattern& pattern : patterns) {
    sum.add(patternObservation(candidate, pattern));
  }
  Eigen::MatrixXd information = sum.information();
  information.bottomRightCorner<kPoseErrors, kPoseErrors>().diagonal().array() += 1.0;
  return information;
}

Eigen::MatrixXd designInformation(const DesignTask& task,
                                  const std::vector<PoseCandidate>& candidates,
                                  const std::vector<DesignedPose>& poses) {
  const Eigen::Index count = task.known.rows();
  Eigen::MatrixXd information = task.known;
  for (const DesignedPose& pose : poses) {
    const Eigen::MatrixXd all = poseInformation(task, candidates[pose.candidate], pose.patterns);
    const Eigen::Matrix<double, Eigen::Dynamic, kPoseErrors> shared =
        all.topRightCorner(count, kPoseErrors);
    const Eigen::Matrix3d own = all.bottomRightCorner<kPoseErrors, kPoseErrors>();
    information += all.topLeftCorner(count, count);
    information.noalias() -= shared * own.inverse() * shared.transpose();
  }
  return information;
}

Eigen::MatrixXd covarianceAtPose(const DesignTask& task,
                                 const std::vector<PoseCandidate>& candidates,
                                 const std::vector<DesignedPose>& poses,
                                 std::size_t place) {
  std::vector<DesignedPose> others = poses;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
  const DesignedPose& pose = poses[place];
  Eigen::MatrixXd information = poseInformation(task, candidates[pose.candidate], pose.patterns);
  const Eigen::Index count = task.known.rows();
  information.topLeftCorner(count, count) += designInformation(task, candidates, others);
  return covarianceOf(information);
}

Eigen::MatrixXd covarianceAtNewPose(const Eigen::MatrixXd& covariance) {
  const Eigen::Index count = covariance.rows();
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(count + kPoseErrors, count + kPoseErrors);
  result.topLeftCorner(count, count) = covariance;
  return result;
}

double steepNorm(const Eigen::VectorXd& variances, double exponent) {
  const double largest = variances.maxCoeff();
  const double sum = (variances.array() / largest).pow(exponent).sum();
  return largest * std::pow(sum, 1.0 / exponent);
}

Eigen::VectorXd steepWeights(const Eigen::VectorXd& variances, double exponent) {
  const Eigen::VectorXd weights =
      (variances.array() / variances.maxCoeff()).max(0.0).pow(exponent - 1.0);
  return weights / weights.sum();
}

Eigen::MatrixXd covarianceOf(const Eigen::MatrixXd& information) {
  return InformationFactor(information).inverse();
}

}  // namespace sac
