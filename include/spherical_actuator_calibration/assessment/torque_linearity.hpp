#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// A number with its standard deviation.
struct UncertainValue {
  double value = 0.0;
  double stddev = 0.0;
};

/// How the torque of one coil goes with its current I, at one pose. With x = I / full_current:
/// T = T₀ + g x (1 + deviation |x| + asymmetry x), g a vector.
struct TorqueLinearity {
  std::size_t coil = 0;                ///< counted from 0
  std::vector<std::uint32_t> samples;  ///< ids of those that tell, all of one dwell
  std::vector<double> currents;        ///< of the coil in them [A]
  double full_current = 0.0;           ///< largest of their |currents| [A]
  /// By what share torque is more at full current than in proportion to small ones, mean of both
  /// signs [1].
  UncertainValue deviation;
  /// By what share the torque of the positive current is more than that mean, and that of the
  /// negative one less [1]; nothing where the samples do not tell.
  std::optional<UncertainValue> asymmetry;
  /// Of proportionality, T = T₀ + g x.
  double chi_square = 0.0;
  int degrees_of_freedom = 0;
  double probability = 1.0;  ///< of a chi-square as large by chance, where torque is proportional
  double law_probability = 1.0;  ///< the same of the law above

  /// Whether the torques may be proportional to the current.
  bool isProportional() const;
};

/// Tests proportionality by a dwell that has torques of one coil alone at three or more currents;
/// of several, by the one that tells the deviation best. Torques whose part without current was
/// taken off share its error; of others T₀ is estimated along. Held-out samples count as well.
/// Measured currents count as known within 0.5 mA. Nothing where none tells the deviation within
/// 10 %.
std::optional<TorqueLinearity> torqueLinearity(const std::vector<Sample>& samples,
                                               const CalibrationConfig& config);

/// The same of samples that come one after the other: only the last rest is looked at again.
class LinearitySearch {
 public:
  explicit LinearitySearch(const EstimationOptions& options);

  void add(const Sample& sample);
  /// Of all samples so far.
  std::optional<TorqueLinearity> best();

 private:
  /// One coil at the last rest.
  struct Found {
    std::vector<std::size_t> places;  ///< of the samples that tell, in rest_
    std::optional<TorqueLinearity> linearity;
  };

  void fitRest();
  static void keepBetter(const std::optional<TorqueLinearity>& found,
                         std::optional<TorqueLinearity>& best);

  double current_threshold_;
  double default_torque_stddev_;
  std::vector<Sample> rest_;              ///< torques of the last rest
  std::map<std::size_t, Found> of_coil_;  ///< by coil, at the last rest
  std::optional<TorqueLinearity> best_;   ///< of the rests before it
};

/// A sentence or two for people: deviations in percent, each with its standard deviation, or what
/// to measure.
std::string describe(const std::optional<TorqueLinearity>& linearity);

}  // namespace sac
