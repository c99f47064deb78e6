#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "motion_cycle.hpp"
#include "motion_dynamics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/covariance_record.hpp"
#include "spherical_actuator_calibration/calibration/identified_stddevs.hpp"
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

CycleRecord cycleRecord(const CycleReport& report) {
  CycleRecord record;
  record.cycle = cycleName(report.cycle);
  record.coil = report.coil;
  record.samples_used = report.samples_used;
  record.samples_rejected = report.samples_rejected;
  record.error_before = report.error_history.front();
  record.error_after = report.error_history.back();
  record.unit = unitOf(report.error_measure);
  record.reduced_chi_square = report.reduced_chi_square;
  return record;
}

ValidationRecord validationRecord(const HeldOutValidation& validation) {
  ValidationRecord record;
  record.samples = static_cast<std::uint32_t>(validation.samples);
  if (validation.orientations > 0) {
    record.orientation_rms = validation.orientation_rms;
  }
  if (validation.torques > 0) {
    record.torque_rms = validation.torque_rms;
  }
  return record;
}

/// Of two that may both have a verdict the one with the less probable misfit.
HeldOutValidation severer(const HeldOutValidation& one, const HeldOutValidation& other) {
  if (!one.hasVerdict()) {
    return other.samples > 0 ? other : one;
  }
  return other.hasVerdict() && other.probability < one.probability ? other : one;
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
  map_choice_.reset();
  expected_errors_.reset();
}

const CycleReport& CalibrationSession::run(const CycleRequest& request) {
  const bool is_motion = request.cycle == Cycle::kMotion;
  const bool joins_motion = request.cycle == Cycle::kRefine && motion_evidence_.has_value();
  CycleOutcome outcome = is_motion ? runMotionCycle(model_, motion(), state_, config_)
                                   : runCycle(model_,
                                              samples_,
                                              state_,
                                              request,
                                              config_.estimation,
                                              joins_motion ? &*motion_evidence_ : nullptr);
  state_ = std::move(outcome.state);
  reports_.push_back(std::move(outcome.report));
  if (is_motion && reports_.back().success) {
    motion_evidence_ = sac::motionEvidence(model_.space(), reports_.back(), state_, startState());
  }
  map_choice_.reset();
  expected_errors_.reset();
  return reports_.back();
}

bool CalibrationSession::isComplete() const {
  const auto is_mended = [this](std::size_t failed) {
    return std::any_of(reports_.begin() + static_cast<std::ptrdiff_t>(failed),
                       reports_.end(),
                       [&](const CycleReport& later) { return mends(later, reports_[failed]); });
  };
  for (std::size_t n = 0; n < reports_.size(); ++n) {
    if (!is_mended(n)) {
      return false;
    }
  }
  return openParameters().empty();
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

const OrientationMapChoice& CalibrationSession::orientationMap() const {
  if (map_choice_) {
    return *map_choice_;
  }
  map_choice_.emplace();
  std::optional<Cycle> last;
  for (const CycleReport& report : reports_) {
    if (report.success && (report.cycle == Cycle::kJoint || report.cycle == Cycle::kRefine)) {
      last = report.cycle;
    }
  }
  if (last) {
    *map_choice_ = chooseOrientationMap(
        model_, samples_, state_, {*last}, config_.estimation, config_.orientation_map);
  }
  return *map_choice_;
}

const WorkspaceUncertainty& CalibrationSession::expectedErrors() const {
  if (!expected_errors_) {
    expected_errors_ = workspaceUncertainty(model_, state_.belief);
  }
  return *expected_errors_;
}

/// The model with the orientation map that is in force.
CalibrationModel CalibrationSession::mappedModel() const {
  Actuator mapped = model_.space().nominal();
  mapped.orientation_map = orientationMap().map;
  return CalibrationModel(ParameterSpace(mapped, config_.effects));
}

Actuator CalibrationSession::actuator() const {
  Actuator actuator = model_.space().actuatorAt(state_.belief.x);
  if (orientationMap().map) {
    actuator.orientation_map = orientationMap().map;
  }
  return actuator;
}

std::optional<HeldOutValidation> CalibrationSession::validation() const {
  const auto last = std::find_if(
      reports_.rbegin(), reports_.rend(), [](const CycleReport& one) { return one.success; });
  const bool is_motion = last != reports_.rend() && last->motion;
  const bool joins_motion =
      last != reports_.rend() && last->cycle == Cycle::kRefine && motion_evidence_;
  HeldOutValidation result;
  if (!is_motion) {
    result = validateHeldOut(
        orientationMap().map ? mappedModel() : model_,
        samples_,
        state_,
        config_.estimation,
        last != reports_.rend() && !last->residuals.empty() ? outlierRate(*last) : 0.0);
  }
  if (is_motion || joins_motion) {
    const auto motion = std::find_if(
        last, reports_.rend(), [](const CycleReport& one) { return one.success && one.motion; });
    if (motion != reports_.rend()) {
      result = severer(result, validationOf(motion->motion->held_out));
    }
  }
  return result.samples == 0 ? std::nullopt : std::optional(result);
}

CalibratedDescription CalibrationSession::description(const CalibrationOrigin& origin) const {
  const ParameterSpace& space = model_.space();
  const Actuator calibrated = actuator();
  const std::vector<ParameterEstimate> values = parameters();
  const ParameterStddevs identified = identifiedStddevs(space, state_);
  const auto moved = [this](Eigen::Index first, Eigen::Index count) {
    return !state_.belief.x.segment(first, count).isZero(0.0);
  };
  // A value that moved has its uncertainty beside it, be it identified or only within an open
  // direction.
  const auto stddev = [&](Eigen::Index at) {
    const ParameterEstimate& estimate = values[static_cast<std::size_t>(at)];
    return estimate.observable || moved(at, 1) ? std::optional(estimate.stddev) : std::nullopt;
  };

  CalibratedDescription result = start_;
  for (std::size_t k = 0; k < space.joints(); ++k) {
    const Eigen::Index at = space.joint(k);
    result.actuator.joints[k].offset = calibrated.joints[k].offset;
    if (moved(at + 1, 2)) {
      result.actuator.joints[k].axis = calibrated.joints[k].axis;
    }
    result.actuator.joints[k].correction = calibrated.joints[k].correction;
    result.stddevs.joints[k] = identified.joints[k];
    result.stddevs.joints[k].offset = stddev(at);
    result.stddevs.joints[k].axis_u = stddev(at + 1);
    result.stddevs.joints[k].axis_v = stddev(at + 2);
  }
  result.stddevs.poles.resize(space.poles());
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const Eigen::Index at = space.pole(i);
    if (moved(at, 2)) {
      result.actuator.poles[i] = calibrated.poles[i];
    }
    result.actuator.poles[i].gain = calibrated.poles[i].gain;
    result.stddevs.poles[i] = {stddev(at), stddev(at + 1), identified.poles[i].gain};
  }
  result.stddevs.coils.resize(space.coils());
  for (std::size_t j = 0; j < space.coils(); ++j) {
    const Eigen::Index at = space.coil(j);
    if (moved(at, 2)) {
      result.actuator.coils[j] = calibrated.coils[j];
    }
    result.actuator.coils[j].gain = calibrated.coils[j].gain;
    result.stddevs.coils[j] = {stddev(at), stddev(at + 1), identified.coils[j].gain};
  }
  result.actuator.torque_curve = calibrated.torque_curve;
  result.actuator.unbalance = calibrated.unbalance;
  result.actuator.orientation_map = calibrated.orientation_map;
  takeDynamics(reports_, result.actuator);
  result.calibration = record(origin);
  return result;
}

CalibrationRecord CalibrationSession::record(const CalibrationOrigin& origin) const {
  CalibrationRecord record;
  record.date = origin.date;
  record.revision =
      origin.revision.value_or(start_.calibration ? start_.calibration->revision + 1 : 1);
  record.source = origin.recordings;
  record.software = origin.software;
  for (const CycleReport& report : reports_) {
    if (report.success) {
      record.cycles.push_back(cycleRecord(report));
    }
  }
  if (!record.cycles.empty() && model_.space().joints() > 0) {
    record.orientation_uncertainty = expectedErrors().orientation;
  }
  if (!record.cycles.empty() && model_.hasTorqueModel()) {
    record.torque_uncertainty = expectedErrors().torque;
  }
  const std::vector<ParameterEstimate> estimates = parameters();
  for (const ParameterEstimate& parameter : estimates) {
    if (!parameter.observable) {
      record.unidentified.push_back(parameter.name);
    }
  }
  const ParameterSpace& space = model_.space();
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    if (state_.identified[static_cast<std::size_t>(p)]) {
      const ParameterEstimate& effect = estimates[static_cast<std::size_t>(p)];
      record.effects.push_back({effect.name, effect.value, effect.stddev});
    }
  }
  if (std::find(state_.identified.begin(), state_.identified.end(), true) !=
      state_.identified.end()) {
    record.covariance = covarianceRecord(space, state_.belief);
  }
  if (orientationMap().map) {
    record.orientation_map = orientationMap().record;
  }
  if (const auto validation = this->validation()) {
    record.validation = validationRecord(*validation);
  }
  return record;
}

}  // namespace sac
