#include "covariance_record.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {
namespace {

constexpr int kDigits = 9;

/// Value of a parameter, as its record counts it, per coordinate: coordinate v of a pole or coil is
/// its azimuth as an arc already.
Eigen::VectorXd unitsOf(const ParameterSpace& space) {
  Eigen::VectorXd units = Eigen::VectorXd::Ones(space.size());
  for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
    units[space.effect() + e] = space.effects().scale(e);
  }
  return units;
}

std::vector<std::string> namesOf(const ParameterSpace& space) {
  std::vector<std::string> names;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    names.push_back(space.name(p));
  }
  return names;
}

double rounded(double value) {
  return parsedNumber(roundedText(value, kDigits)).value_or(value);
}

/// Where the parameters of a space are in a record. Beside other strengths, descriptions of before
/// had some that are references of strength now: those that nobody has are left out.
std::vector<std::size_t> placesIn(const CovarianceRecord& record, const ParameterSpace& space) {
  const std::set<std::string> references = {"pole_1/gain", "coil_1/gain", "torque_curve/t0"};
  const std::vector<std::string> names = namesOf(space);
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < record.names.size(); ++n) {
    const bool is_next = places.size() < names.size() && record.names[n] == names[places.size()];
    if (is_next) {
      places.push_back(n);
    } else if (references.count(record.names[n]) == 0) {
      break;
    }
  }
  if (places.size() != names.size() || record.names.size() > names.size() + references.size()) {
    throw ConfigError(
        "calibration.covariance.names: they are not the parameters of this actuator "
        "and its effects.");
  }
  return places;
}

/// Standard deviations without what parameters have in common.
class Diagonal {
 public:
  explicit Diagonal(const ParameterSpace& space)
      : space_(space), variance_(Eigen::VectorXd::Zero(space.size())) {}

  Eigen::VectorXd of(const ParameterStddevs& stddevs) {
    for (std::size_t k = 0; k < space_.joints(); ++k) {
      enter(space_.joint(k), stddevs.joints[k].offset, 1.0);
      enter(space_.joint(k) + 1, stddevs.joints[k].axis_u, 1.0);
      enter(space_.joint(k) + 2, stddevs.joints[k].axis_v, 1.0);
    }
    for (std::size_t i = 0; i < stddevs.poles.size(); ++i) {
      enter(space_.pole(i), stddevs.poles[i].polar, 1.0);
      enter(
          space_.pole(i) + 1, stddevs.poles[i].azimuth, std::cos(space_.nominal().poles[i].polar));
    }
    for (std::size_t j = 0; j < stddevs.coils.size(); ++j) {
      enter(space_.coil(j), stddevs.coils[j].polar, 1.0);
      enter(
          space_.coil(j) + 1, stddevs.coils[j].azimuth, std::cos(space_.nominal().coils[j].polar));
    }
    return variance_;
  }

 private:
  void enter(Eigen::Index at, const std::optional<double>& stddev, double scale) {
    variance_[at] = stddev ? std::pow(scale * *stddev, 2) : 0.0;
  }

  const ParameterSpace& space_;
  Eigen::VectorXd variance_;
};

}  // namespace

CovarianceRecord covarianceRecord(const ParameterSpace& space, const ParameterBelief& belief) {
  CovarianceRecord record;
  for (const PlacedEffect& placed : space.effects().effects()) {
    record.effects.push_back(placed.name);
  }
  record.names = namesOf(space);
  const Eigen::VectorXd units = unitsOf(space);
  for (Eigen::Index a = 0; a < space.size(); ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      record.lower.push_back(rounded(units[a] * belief.covariance(a, b) * units[b]));
    }
  }
  return record;
}

EffectSelection effectsOf(const std::optional<CalibrationRecord>& calibration) {
  EffectSelection selection;
  if (!calibration || !calibration->covariance) {
    return selection;
  }
  for (const std::string& effect : calibration->covariance->effects) {
    selection[effect] = true;
  }
  std::vector<std::size_t> joints;
  const std::vector<std::string>& names = calibration->covariance->names;
  for (std::size_t k = 0; k < kJoints; ++k) {
    if (std::find(names.begin(), names.end(), "joint_" + std::to_string(numberOf(k)) + "/cos_1") !=
        names.end()) {
      joints.push_back(k);
    }
  }
  selection.setHarmonicJoints(joints);
  return selection;
}

Eigen::MatrixXd coordinateCovariance(const ParameterSpace& space,
                                     const CalibratedDescription& description) {
  if (!description.calibration || !description.calibration->covariance) {
    return Diagonal(space).of(description.stddevs).asDiagonal();
  }
  const CovarianceRecord& record = *description.calibration->covariance;
  const std::vector<std::size_t> places = placesIn(record, space);
  const Eigen::VectorXd units = unitsOf(space);
  Eigen::MatrixXd covariance(space.size(), space.size());
  for (Eigen::Index a = 0; a < space.size(); ++a) {
    const std::size_t row = places[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b <= a; ++b) {
      const std::size_t entry = row * (row + 1) / 2 + places[static_cast<std::size_t>(b)];
      covariance(a, b) = record.lower[entry] / (units[a] * units[b]);
      covariance(b, a) = covariance(a, b);
    }
  }
  return covariance;
}

Eigen::MatrixXd machineCovariance(const ParameterSpace& space,
                                  const CalibratedDescription& description,
                                  bool has_load) {
  using BelongsTo = LaboratoryEffect::BelongsTo;
  Eigen::MatrixXd covariance = coordinateCovariance(space, description);
  for (const PlacedEffect& placed : space.effects().effects()) {
    const bool counts = placed.belongs_to == BelongsTo::kActuator ||
                        (has_load && placed.belongs_to == BelongsTo::kLoad);
    if (!counts) {
      const Eigen::Index first = space.effect() + placed.first;
      covariance.middleRows(first, placed.size()).setZero();
      covariance.middleCols(first, placed.size()).setZero();
    }
  }
  return covariance;
}

}  // namespace sac
