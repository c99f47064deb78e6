#include "spherical_actuator_calibration/estimation/incremental_estimate.hpp"

#include <utility>

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
  update_.emplace(prior_.x - at_, prior_.covariance);
  dwell_.reset();
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
    update_->beginDwell();
    dwell_ = shares ? std::optional<Sample>(sample) : std::nullopt;
  }
  tracker_.add(sample, options_);
  const ObservationEvaluator evaluator(problem, options_, tracker_);
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, *point_, linear_);
    const Eigen::Matrix3d W =
        whiteningOf(shares ? evaluator.ownNoise(n, linear_) : evaluator.noise(n, linear_));
    whiten(linear_, W, every_, whitened_);
    update_->observe(whitened_,
                     shares ? SharedLoading(W * evaluator.sharedErrors(n, linear_))
                            : SharedLoading(SharedLoading::Zero()));
  }
}

ParameterBelief IncrementalEstimate::belief() const {
  return {at_ + update_->mean(), update_->covariance()};
}

bool IncrementalEstimate::hasMovedFar() const {
  // The torque curve bends over some 0.1 rad: within a thirtieth of that, the slope it was
  // linearised with is good to a few per cent of the step.
  constexpr double kFar = 3e-3;
  return update_->mean().cwiseAbs().maxCoeff() > kFar;
}

void IncrementalEstimate::relinearize(const std::vector<Sample>& samples) {
  restart(at_ + update_->mean());
  tracker_ = TrackerNoise();
  for (const Sample& sample : samples) {
    add(sample);
  }
}

}  // namespace sac
