#include "spherical_actuator_calibration/calibration/motion_evidence.hpp"

#include <set>
#include <string>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

namespace sac {
namespace {

/// Information y = Fᵀ x + unit noise of some coordinates x.
struct WhitenedEvidence {
  Eigen::MatrixXd factor;  ///< F
  Eigen::VectorXd value;   ///< y
};

/// What the motion itself told, without what was stated beforehand (of mean zero).
WhitenedEvidence ownEvidence(const ParameterSpace& space, const MotionEvidence& motion) {
  constexpr double kNothing = 1e-9;  // of the largest information
  const auto size = static_cast<Eigen::Index>(motion.told.size());
  const Eigen::MatrixXd covariance = motion.belief.covariance(motion.told, motion.told);
  Eigen::MatrixXd information = Cholesky(covariance).inverse();
  const Eigen::VectorXd vector = information * motion.belief.x(motion.told);
  information -= statedInformation(space, motion.told);
  const SymmetricEigen eigen = symmetricEigen(information);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < size; ++k) {
    if (eigen.values[k] > kNothing * eigen.values[size - 1]) {
      kept.push_back(k);
    }
  }
  const Eigen::MatrixXd directions = eigen.vectors(Eigen::all, kept);
  const Eigen::VectorXd roots = eigen.values(kept).cwiseSqrt();
  return {directions * roots.asDiagonal(), (directions.transpose() * vector).cwiseQuotient(roots)};
}

}  // namespace

MotionEvidence motionEvidence(const ParameterSpace& space,
                              const CycleReport& report,
                              const CalibrationState& state,
                              const CalibrationState& start) {
  std::set<std::string> told;
  for (const ParameterEstimate& estimate : report.estimates) {
    if (estimate.observable) {
      told.insert(estimate.name);
    }
  }
  MotionEvidence evidence;
  evidence.belief = state.belief;
  evidence.covariance = start.belief.covariance;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    // What counts as exact beforehand stays so.
    if (told.count(space.name(p)) > 0 && state.belief.covariance(p, p) > 0.0) {
      evidence.told.push_back(p);
    }
  }
  return evidence;
}

ParameterBelief withoutMotion(ParameterBelief belief, const MotionEvidence& motion) {
  // What they had in common with others may be of others that are known better since.
  for (const Eigen::Index p : motion.told) {
    belief.covariance.row(p).setZero();
    belief.covariance.col(p).setZero();
  }
  belief.covariance(motion.told, motion.told) = motion.covariance(motion.told, motion.told);
  return belief;
}

MotionInformation ownInformation(const ParameterSpace& space, const MotionEvidence& motion) {
  MotionInformation all{Eigen::MatrixXd::Zero(space.size(), space.size()),
                        Eigen::VectorXd::Zero(space.size())};
  if (!motion.told.empty()) {
    const WhitenedEvidence own = ownEvidence(space, motion);
    all.information(motion.told, motion.told) = own.factor * own.factor.transpose();
    all.vector(motion.told) = own.factor * own.value;
  }
  return all;
}

CombinedBelief combined(const ParameterSpace& space,
                        const ParameterBelief& by_samples,
                        const MotionEvidence& motion) {
  CombinedBelief result{by_samples};
  if (motion.told.empty()) {
    return result;
  }
  const WhitenedEvidence own = ownEvidence(space, motion);
  if (own.value.size() == 0) {
    return result;
  }
  const Eigen::MatrixXd spread = by_samples.covariance(Eigen::all, motion.told) * own.factor;
  const Eigen::VectorXd apart = own.value - own.factor.transpose() * by_samples.x(motion.told);
  const Eigen::MatrixXd expected = Eigen::MatrixXd::Identity(apart.size(), apart.size()) +
                                   own.factor.transpose() * spread(motion.told, Eigen::all);
  const Cholesky factor(expected);
  const Eigen::MatrixXd gain = factor.solve(spread.transpose()).transpose();
  result.belief.x += gain * apart;
  // Joseph's form: what was hardly known before loses many digits in a difference.
  Eigen::MatrixXd kept = Eigen::MatrixXd::Identity(gain.rows(), gain.rows());
  kept(Eigen::all, motion.told) -= gain * own.factor.transpose();
  result.belief.covariance =
      kept * by_samples.covariance * kept.transpose() + gain * gain.transpose();
  const double misfit = factor.half(apart).squaredNorm();
  result.probability = chiSquareProbability(static_cast<double>(apart.size()), misfit);
  return result;
}

}  // namespace sac
