#include "spherical_actuator_calibration/estimation/incremental_estimate.hpp"

#include <utility>

#include <Eigen/Cholesky>

#include "problem_check.hpp"
#include "spherical_actuator_calibration/estimation/same_dwell.hpp"

namespace sac {

IncrementalEstimate::IncrementalEstimate(const CalibrationModel& model,
                                         ParameterBelief prior,
                                         const EstimationOptions& options)
    : model_(model),
      options_(options),
      prior_(std::move(prior)),
      nothing_held_(static_cast<std::size_t>(prior_.x.size()), false),
      every_(ChosenCoordinates::all(prior_.x.size())) {
  const std::vector<Sample> none;
  checkProblem({&model, &none, {}, {}, prior_});
  restart(prior_.x);
}

void IncrementalEstimate::restart(const Eigen::VectorXd& at) {
  at_ = at;
  point_.emplace(model_, at_);
  mean_.setZero(size() + kSharedErrors);
  mean_.head(size()) = prior_.x - at_;
  covariance_.setZero(mean_.size(), mean_.size());
  covariance_.topLeftCorner(size(), size()) = prior_.covariance;
  dwell_.reset();
  forgetDwell();
}

/// The errors of the next dwell are independent of everything before.
void IncrementalEstimate::forgetDwell() {
  mean_.tail<kSharedErrors>().setZero();
  covariance_.rightCols<kSharedErrors>().setZero();
  covariance_.bottomRows<kSharedErrors>().setZero();
  covariance_.bottomRightCorner<kSharedErrors, kSharedErrors>().setIdentity();
}

void IncrementalEstimate::add(const Sample& sample) {
  if (sample.validation) {
    return;
  }
  const std::vector<Sample> samples{sample};
  EstimationProblem problem{&model_, &samples, {}, {}, prior_};
  if (model_.observesOrientation(sample)) {
    problem.observations.push_back({0, Quantity::kOrientation});
  }
  if (sample.has_torque) {
    problem.observations.push_back({0, Quantity::kTorque});
  }
  checkProblem(problem);
  const bool shares = options_.shared_errors && hasSharedErrors(sample, model_);
  if (!shares || !dwell_ || !isSameDwell(*dwell_, sample)) {
    forgetDwell();
    dwell_ = shares ? std::optional<Sample>(sample) : std::nullopt;
  }
  const ObservationEvaluator evaluator(problem, options_);
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, *point_, linear_);
    const Eigen::Matrix3d W =
        whiteningOf(shares ? evaluator.ownNoise(n, linear_) : evaluator.noise(n, linear_));
    whiten(linear_, W, every_, whitened_);
    observe(shares ? SharedLoading(W * evaluator.sharedErrors(n, linear_))
                   : SharedLoading(SharedLoading::Zero()));
  }
}

/// Takes in W r(at + δ) = residual + J δ = noise + G u, with unit noise: with H = (J, −G), S = 1 +
/// H P Hᵀ = LLᵀ and K = P Hᵀ L⁻ᵀ the mean goes by −K L⁻¹ (residual + H mean), the covariance P by
/// −K Kᵀ.
void IncrementalEstimate::observe(const SharedLoading& loading) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  Rows spread = -covariance_.rightCols<kSharedErrors>() * loading.transpose();
  spread += whitened_.timesTransposed(covariance_);
  Eigen::Matrix3d S = whitened_.times(spread) - loading * spread.bottomRows<kSharedErrors>();
  S.diagonal().array() += 1.0;
  Eigen::Vector3d residual = whitened_.residual - loading * mean_.tail<kSharedErrors>();
  for (std::size_t k = 0; k < whitened_.columns.size(); ++k) {
    residual += whitened_.jacobian.col(static_cast<Eigen::Index>(k)) * mean_[whitened_.columns[k]];
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(S);
  mean_.noalias() -= spread * factor.solve(residual);
  const Rows gain = factor.matrixL().solve(spread.transpose()).transpose();
  covariance_.noalias() -= gain * gain.transpose();
}

ParameterBelief IncrementalEstimate::belief() const {
  return {at_ + mean_.head(size()), covariance_.topLeftCorner(size(), size())};
}

bool IncrementalEstimate::hasMovedFar() const {
  // The torque curve bends over some 0.1 rad: within a thirtieth of that, the slope it was
  // linearised with is good to a few per cent of the step.
  constexpr double kFar = 3e-3;
  return mean_.head(size()).cwiseAbs().maxCoeff() > kFar;
}

void IncrementalEstimate::relinearize(const std::vector<Sample>& samples) {
  restart(at_ + mean_.head(size()));
  for (const Sample& sample : samples) {
    add(sample);
  }
}

}  // namespace sac
