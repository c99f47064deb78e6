#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// Finds currents that no setpoint explains, however rarely and shortly they come: in coils that
/// next to nothing is set in, and in others beyond anything that was set lately. CurrentComparison
/// forgives what comes for a moment now and then.
///
/// Times are seconds of a steady clock. Not thread-safe.
class StrayCurrents {
 public:
  /// `tolerance`: of a current [A].
  StrayCurrents(std::size_t coils, double tolerance);

  /// These setpoints [A] go to the amplifier next.
  void setting(const Eigen::VectorXd& setpoints);
  /// These currents [A] were measured after that. Returns a coil, from 0, that has a stray current
  /// now, when there was too much of them: 0.2 s in all, of which a second without takes back
  /// 0.005 s. What flows in the first 0.3 s may have been set before.
  std::optional<std::size_t> observe(const Eigen::VectorXd& measured, double steady);
  /// Counts anew.
  void forgive() { strays_ = 0.0; }

 private:
  struct Coil {
    double setpoint = 0.0;             ///< [A]
    std::optional<double> since;       ///< no more than the tolerance is set [s]; nothing: more
    double highest = 0.0;              ///< |setpoint| since then [A]
    std::optional<double> zero_since;  ///< likewise; nothing: not exactly zero is set
    double lately = 0.0;  ///< highest |setpoint| of a span that goes on, of kLongestFlow [A]
    double before = 0.0;  ///< of the span before it [A]
  };

  double allowed(Coil& coil, double steady) const;

  const double tolerance_;
  std::vector<Coil> coils_;
  std::optional<double> last_;  ///< measurement [s]
  double began_at_ = 0.0;       ///< first measurement [s]
  double span_since_ = 0.0;     ///< [s]
  double strays_ = 0.0;         ///< less what was forgiven [s]
};

}  // namespace sac
