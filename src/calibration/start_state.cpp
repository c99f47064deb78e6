#include "start_state.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace sac {
namespace {

/// Enters what a calibrated description states into a state.
class StatedUncertainty {
 public:
  StatedUncertainty(const ParameterSpace& space, CalibrationState& state)
      : space_(space), state_(state) {}

  void enter(const ParameterStddevs& stddevs) const {
    for (std::size_t k = 0; k < space_.joints(); ++k) {
      enter(space_.joint(k), stddevs.joints[k].offset, 1.0);
      enter(space_.joint(k) + 1, stddevs.joints[k].axis_u, 1.0);
      enter(space_.joint(k) + 2, stddevs.joints[k].axis_v, 1.0);
    }
    for (std::size_t i = 0; i < stddevs.poles.size(); ++i) {
      enterAngles(space_.pole(i), stddevs.poles[i], space_.nominal().poles[i].polar);
    }
    for (std::size_t j = 0; j < stddevs.coils.size(); ++j) {
      enterAngles(space_.coil(j), stddevs.coils[j], space_.nominal().coils[j].polar);
    }
  }

 private:
  // Coordinate v of an axis is cos(polar) times the azimuth (AxisChart::aroundAngles).
  void enterAngles(Eigen::Index at, const AxisStddev& stddev, double polar) const {
    enter(at, stddev.polar, 1.0);
    enter(at + 1, stddev.azimuth, std::cos(polar));
  }

  void enter(Eigen::Index at, const std::optional<double>& stddev, double scale) const {
    if (stddev) {
      state_.belief.covariance(at, at) = std::pow(scale * *stddev, 2);
      state_.identified[static_cast<std::size_t>(at)] = true;
    }
  }

  const ParameterSpace& space_;
  CalibrationState& state_;
};

}  // namespace

CalibrationState startState(const ParameterSpace& space,
                            const CalibratedDescription& start,
                            const ManufacturingTolerance& tolerance) {
  CalibrationState state = nominalState(space, tolerance);
  StatedUncertainty(space, state).enter(start.stddevs);
  if (start.calibration) {
    const std::vector<std::string>& open = start.calibration->unidentified;
    for (Eigen::Index p = 0; p < space.size(); ++p) {
      if (std::find(open.begin(), open.end(), space.name(p)) != open.end()) {
        state.identified[static_cast<std::size_t>(p)] = false;
      }
    }
  }
  return state;
}

}  // namespace sac
