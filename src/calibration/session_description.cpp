#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "covariance_record.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {
namespace {

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
  record.contradicted = validation.hasVerdict() && validation.probability < kLeastProbability;
  return record;
}

}  // namespace

CalibratedDescription CalibrationSession::description(const CalibrationOrigin& origin) const {
  const ParameterSpace& space = model_.space();
  const Actuator calibrated = actuator();
  const std::vector<ParameterEstimate> values = parameters();
  const ParameterStddevs identified = stddevs();
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
  result.stddevs.unbalance = identified.unbalance;
  result.stddevs.torque_curve = identified.torque_curve;
  result.actuator.inertia = calibrated.inertia;
  result.actuator.friction = calibrated.friction;
  result.actuator.orientation_map = calibrated.orientation_map;
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
  // Nothing has changed, and nothing judges it anew.
  if (record.cycles.empty() && isContradicted(start_) && !record.validation) {
    record.validation = start_.calibration->validation;
  }
  return record;
}

}  // namespace sac
