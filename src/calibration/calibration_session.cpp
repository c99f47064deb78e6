#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>

#include "identified_stddevs.hpp"
#include "motion_cycle.hpp"
#include "motion_dynamics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/mending_cycle.hpp"
#include "start_state.hpp"

namespace sac {
namespace {

const CalibrationConfig& validated(const CalibrationConfig& config) {
  validate(config);
  return config;
}

/// Whether the sample with this index, from 0, is held out by its turn.
bool isHeldOut(std::size_t index, const CalibrationConfig& config) {
  const auto every = static_cast<std::size_t>(config.hold_out_every);
  return every > 0 && index % every == every - 1;
}

/// A sample as the model reads it.
Sample checked(Sample sample, const Actuator& actuator, const CalibrationConfig& config) {
  validate(sample, actuator.coils.size());
  return actuator.has_joints
             ? sample
             : trackedSample(std::move(sample), config.estimation.default_orientation_stddev);
}

std::vector<Sample> prepared(std::vector<Sample> samples,
                             const Actuator& actuator,
                             const CalibrationConfig& config) {
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n] = checked(std::move(samples[n]), actuator, config);
    samples[n].validation = samples[n].validation || isHeldOut(n, config);
  }
  return samples;
}

/// Cycles that orientations take part in, and so what a map is found in.
bool tellsTheMap(Cycle cycle) {
  return cycle == Cycle::kJoint || cycle == Cycle::kRefine;
}

}  // namespace

CalibrationSession::CalibrationSession(CalibratedDescription start,
                                       std::vector<Sample> samples,
                                       CalibrationConfig config)
    : start_(std::move(start)),
      samples_(sac::prepared(std::move(samples), start_.actuator, validated(config))),
      config_(std::move(config)),
      model_(ParameterSpace(start_.actuator, config_.effects)),
      state_(sac::startState(model_.space(), start_, config_.tolerance)) {}

CalibrationSession::CalibrationSession(CalibratedDescription start,
                                       std::vector<Sample> samples,
                                       CalibrationConfig config,
                                       CalibrationState state,
                                       std::vector<CycleReport> reports)
    : CalibrationSession(std::move(start), {}, std::move(config)) {
  for (Sample& sample : samples) {
    sample = checked(std::move(sample), start_.actuator, config_);
  }
  samples_ = std::move(samples);
  resume(std::move(state), std::move(reports));
}

Sample CalibrationSession::prepared(Sample sample) const {
  sample = checked(std::move(sample), start_.actuator, config_);
  sample.validation = sample.validation || isHeldOut(samples_.size(), config_);
  return sample;
}

bool CalibrationSession::remove(std::uint32_t id) {
  const auto place = std::find_if(
      samples_.begin(), samples_.end(), [id](const Sample& sample) { return sample.id == id; });
  if (place == samples_.end()) {
    return false;
  }
  samples_.erase(place);
  map_of_samples_.reset();
  return true;
}

CalibrationState CalibrationSession::startState() const {
  return sac::startState(model_.space(), start_, config_.tolerance);
}

void CalibrationSession::resume(CalibrationState state,
                                std::vector<CycleReport> reports,
                                std::optional<MotionEvidence> motion_evidence) {
  const Eigen::Index size = model_.space().size();
  if (state.belief.x.size() != size || state.belief.covariance.rows() != size ||
      state.belief.covariance.cols() != size ||
      state.identified.size() != static_cast<std::size_t>(size)) {
    throw DataError(
        "The stored parameters are of an actuator with other poles or coils, or of other effects.");
  }
  state_ = std::move(state);
  reports_ = std::move(reports);
  motion_evidence_ = std::move(motion_evidence);
  putInForce(mapOfReports());
}

const CycleReport& CalibrationSession::run(const CycleRequest& request) {
  const bool is_motion = request.cycle == Cycle::kMotion;
  const bool joins_motion = request.cycle == Cycle::kRefine && motion_evidence_.has_value();
  const OrientationMapChoice before = map_;
  if (tellsTheMap(request.cycle)) {
    putInForce(mapOfSamples());
  }
  CycleOutcome outcome = is_motion ? runMotionCycle(model_, motion(), state_, config_)
                                   : runCycle(model_,
                                              samples_,
                                              state_,
                                              request,
                                              config_.estimation,
                                              joins_motion ? &*motion_evidence_ : nullptr);
  state_ = std::move(outcome.state);
  expected_errors_.reset();
  reports_.push_back(std::move(outcome.report));
  reports_.back().registration = inWords(config_.registration);
  if (!reports_.back().success) {
    putInForce(before);
  } else if (is_motion) {
    motion_evidence_ = sac::motionEvidence(model_.space(), reports_.back(), state_, startState());
  }
  return reports_.back();
}

bool CalibrationSession::isComplete() const {
  const std::vector<const CycleReport*> last = unmended(reports_);
  return std::all_of(last.begin(), last.end(), [](const auto* one) { return one->success; }) &&
         openParameters().empty();
}

bool CalibrationSession::isSettled() const {
  const std::vector<const CycleReport*> last = unmended(reports_);
  return std::none_of(
             last.begin(), last.end(), [](const auto* one) { return one->contradicted; }) &&
         openParameters().empty();
}

std::set<std::uint32_t> CalibrationSession::fittedSamples() const {
  std::set<std::uint32_t> ids;
  for (const CycleReport* report : unmended(reports_)) {
    if (!report->success || report->cycle == Cycle::kMotion) {
      continue;  // the residuals of a motion are of its windows
    }
    for (const SampleResidual& residual : report->residuals) {
      if (!residual.rejected) {
        ids.insert(residual.id);
      }
    }
  }
  return ids;
}

std::vector<std::string> CalibrationSession::openParameters() const {
  std::set<std::string> asked;
  for (const CycleReport& report : reports_) {
    for (const ParameterEstimate& estimate : report.estimates) {
      asked.insert(estimate.name);
    }
  }
  std::vector<std::string> open;
  const ParameterSpace& space = model_.space();
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    if (!state_.identified[static_cast<std::size_t>(p)] && asked.count(space.name(p)) > 0) {
      open.push_back(space.name(p));
    }
  }
  return open;
}

std::vector<ParameterEstimate> CalibrationSession::parameters() const {
  const ParameterSpace& space = model_.space();
  const Eigen::VectorXd nominal = space.reportedValues(Eigen::VectorXd::Zero(space.size()));
  const Eigen::VectorXd values = space.reportedValues(state_.belief.x);
  const Eigen::VectorXd stddevs = space.reportedStddevs(state_.belief.x, state_.belief.covariance);
  std::vector<ParameterEstimate> parameters;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    parameters.push_back({space.name(p),
                          nominal[p],
                          nominal[p],
                          values[p],
                          stddevs[p],
                          state_.identified[static_cast<std::size_t>(p)],
                          space.unit(p)});
  }
  return parameters;
}

/// The map that all orientations in use tell; searched anew where samples came or went.
const OrientationMapChoice& CalibrationSession::mapOfSamples() {
  if (!map_of_samples_) {
    map_of_samples_ = chosenMap(samples_);
  }
  return *map_of_samples_;
}

/// The map that was in force with parameters that are taken up again: of the samples that their
/// last cycle took.
OrientationMapChoice CalibrationSession::mapOfReports() const {
  const auto last = std::find_if(reports_.rbegin(), reports_.rend(), [](const CycleReport& one) {
    return one.success && tellsTheMap(one.cycle);
  });
  if (last == reports_.rend()) {
    return {};
  }
  std::set<std::uint32_t> taken;
  for (const SampleResidual& residual : last->residuals) {
    taken.insert(residual.id);
  }
  std::vector<Sample> samples;
  std::copy_if(samples_.begin(), samples_.end(), std::back_inserter(samples), [&](const Sample& s) {
    return taken.count(s.id) > 0;
  });
  return chosenMap(samples);
}

OrientationMapChoice CalibrationSession::chosenMap(const std::vector<Sample>& samples) const {
  return chooseOrientationMap(
      modelWith(nullptr), samples, startState(), config_.estimation, config_.orientation_map);
}

/// The model of the start, with another map where there is one.
CalibrationModel CalibrationSession::modelWith(std::shared_ptr<const OrientationMap> map) const {
  Actuator nominal = start_.actuator;
  if (map) {
    nominal.orientation_map = std::move(map);
  }
  return CalibrationModel(ParameterSpace(std::move(nominal), config_.effects));
}

void CalibrationSession::putInForce(OrientationMapChoice choice) {
  map_ = std::move(choice);
  model_ = modelWith(map_.map);
  expected_errors_.reset();
}

const WorkspaceUncertainty& CalibrationSession::expectedErrors() const {
  if (!expected_errors_) {
    expected_errors_ = workspaceUncertainty(model_, state_.belief);
  }
  return *expected_errors_;
}

Actuator CalibrationSession::actuator() const {
  Actuator actuator = model_.space().actuatorAt(state_.belief.x);
  const ToldDynamics dynamics = toldDynamics(reports_);
  actuator.inertia = dynamics.inertia ? dynamics.inertia : actuator.inertia;
  actuator.friction = dynamics.friction ? dynamics.friction : actuator.friction;
  actuator.unbalance = dynamics.unbalance.value_or(actuator.unbalance);
  return actuator;
}

double CalibrationSession::worstStddev() const {
  return sac::worstStddev(model_.space(), state_);
}

ParameterStddevs CalibrationSession::stddevs() const {
  ParameterStddevs stddevs = identifiedStddevs(model_.space(), state_);
  const ToldDynamics dynamics = toldDynamics(reports_);
  if (dynamics.unbalance) {
    stddevs.unbalance = dynamics.unbalance_stddev;
  }
  if (!stddevs.unbalance) {
    stddevs.unbalance = start_.stddevs.unbalance;
  }
  if (!stddevs.torque_curve) {
    stddevs.torque_curve = start_.stddevs.torque_curve;
  }
  return stddevs;
}

const CycleReport* CalibrationSession::lastSuccess() const {
  const auto last = std::find_if(
      reports_.rbegin(), reports_.rend(), [](const CycleReport& one) { return one.success; });
  return last == reports_.rend() ? nullptr : &*last;
}

const MotionEvidence* CalibrationSession::joinedMotion() const {
  const CycleReport* last = lastSuccess();
  const bool joins = last != nullptr && last->cycle == Cycle::kRefine && motion_evidence_;
  return joins ? &*motion_evidence_ : nullptr;
}

HeldOutJudge CalibrationSession::heldOutJudge() const {
  const CycleReport* last = lastSuccess();
  HeldOutJudge judge(model_, state_, config_.estimation, usualOutliers(reports_));
  const bool is_motion = last != nullptr && last->motion;
  if (is_motion || joinedMotion() != nullptr) {
    const auto motion = std::find_if(reports_.rbegin(), reports_.rend(), [](const auto& one) {
      return one.success && one.motion;
    });
    if (motion != reports_.rend()) {
      judge.join(validationOf(motion->motion->held_out), is_motion);
    }
  }
  return judge;
}

std::optional<HeldOutValidation> CalibrationSession::validation() const {
  HeldOutJudge judge = heldOutJudge();
  const HeldOutValidation& validation = judge.judge(samples_);
  return validation.samples == 0 ? std::nullopt : std::optional(validation);
}

}  // namespace sac
