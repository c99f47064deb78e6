#include "coordinate_elimination.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

namespace sac {
namespace {

/// Coordinates that are held and uncertain, and that an observation feels.
std::vector<Eigen::Index> heldOf(const EstimationProblem& problem,
                                 const Eigen::MatrixXd& information) {
  std::vector<Eigen::Index> held;
  for (Eigen::Index p = 0; p < information.rows(); ++p) {
    if (!std::binary_search(problem.free.begin(), problem.free.end(), p) &&
        problem.prior.covariance(p, p) > 0.0 && information(p, p) > 0.0) {
      held.push_back(p);
    }
  }
  return held;
}

/// R with RRᵀ a covariance, without the directions in which it is zero.
Eigen::MatrixXd rootOf(const Eigen::MatrixXd& covariance) {
  if (covariance.size() == 0) {
    return covariance;
  }
  const SymmetricEigen eigen = symmetricEigen(covariance);
  const Eigen::VectorXd& values = eigen.values;
  const Eigen::Index rank = (values.array() > 0.0).count();  // they ascend
  return eigen.vectors.rightCols(rank) * values.tail(rank).cwiseSqrt().asDiagonal();
}

}  // namespace

CoordinateElimination::Told CoordinateElimination::toldBy(const EstimationProblem& problem,
                                                          const Estimate& estimate,
                                                          const ScoreSum& sum,
                                                          const MotionInformation* beside) {
  Told told{sum.information(), sum.gradient()};
  if (beside != nullptr) {
    told.information += beside->information;
    told.gradient += beside->information * estimate.belief.x - beside->vector;
  }
  const ParameterSpace& space = problem.model->space();
  const std::vector<Eigen::Index> stated = statedOf(space, problem.free);
  const Eigen::MatrixXd information = statedInformation(space, stated);
  told.information(stated, stated) += information;
  told.gradient(stated) += information * estimate.belief.x(stated);
  return told;
}

CoordinateElimination::CoordinateElimination(const EstimationProblem& problem,
                                             const Estimate& estimate,
                                             const EstimationOptions& options,
                                             const ScoreSum& sum,
                                             const MotionInformation* beside)
    : CoordinateElimination(problem,
                            toldBy(problem, estimate, sum, beside),
                            options.unobservable_stddev * options.unobservable_stddev) {}

CoordinateElimination::CoordinateElimination(const EstimationProblem& problem,
                                             const Told& told,
                                             double open)
    : free_(problem.free),
      held_(heldOf(problem, told.information)),
      root_(rootOf(problem.prior.covariance(held_, held_))),
      factor_(reducedInformation(told.information), known(open)),
      half_gradient_(half(told.gradient)) {}

/// Of the held ones in units of what is known of them, then of the free ones.
Eigen::MatrixXd CoordinateElimination::reduced(const Eigen::MatrixXd& crossed) const {
  if (held_.empty()) {
    return crossed(free_, Eigen::all);
  }
  Eigen::MatrixXd result(root_.cols() + static_cast<Eigen::Index>(free_.size()), crossed.cols());
  result << root_.transpose() * crossed(held_, Eigen::all), crossed(free_, Eigen::all);
  return result;
}

Eigen::MatrixXd CoordinateElimination::reducedInformation(
    const Eigen::MatrixXd& information) const {
  Eigen::MatrixXd of_free = information(free_, free_);
  if (held_.empty()) {
    return of_free;
  }
  const Eigen::Index held = root_.cols();
  Eigen::MatrixXd result(held + of_free.rows(), held + of_free.rows());
  result.topLeftCorner(held, held) = root_.transpose() * information(held_, held_) * root_;
  result.bottomLeftCorner(of_free.rows(), held) = information(free_, held_) * root_;
  result.topRightCorner(held, of_free.rows()) =
      result.bottomLeftCorner(of_free.rows(), held).transpose();
  result.bottomRightCorner(of_free.rows(), of_free.rows()) = of_free;
  return result;
}

/// What is known of each beside what was told. `open`: variance of a free coordinate, which stays
/// near where it is.
Eigen::VectorXd CoordinateElimination::known(double open) const {
  const Eigen::Index held = root_.cols();
  Eigen::VectorXd information(held + static_cast<Eigen::Index>(free_.size()));
  information.head(held).setOnes();
  information.tail(information.size() - held).setConstant(1.0 / open);
  return information;
}

Eigen::VectorXd CoordinateElimination::covarianceTimes(const Eigen::VectorXd& crossed) const {
  const Eigen::VectorXd solved = factor_.solve(reduced(crossed));
  const Eigen::Index held = root_.cols();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(crossed.size());
  result(free_) = solved.tail(solved.size() - held);
  if (held > 0) {
    result(held_) = root_ * solved.head(held);
  }
  return result;
}

}  // namespace sac
