#pragma once

#include <deque>

#include <Eigen/Core>

namespace sac {

/// By how much each stream of an emulated laboratory is late: what a device delivers at a time was
/// so before [s]. Stamps do not know of it.
struct StreamDelays {
  double joints = 0.0;
  double currents = 0.0;
  double tracker = 0.0;
  double ft_sensor = 0.0;
};

/// Throws ConfigError that names the delay, its value and the allowed range.
void validate(const StreamDelays& delays);
/// The largest of them [s].
double longestDelay(const StreamDelays& delays);

/// What moves and flows in an emulated laboratory.
struct LaboratoryMoment {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the joints, without errors [rad]
  Eigen::VectorXd currents;                            ///< of the coils [A]
};

/// The recent past of an emulated laboratory.
class LaboratoryHistory {
 public:
  /// `span` ≥ 0 [s]: what is older is forgotten.
  explicit LaboratoryHistory(double span) : span_(span) {}

  /// `time` [s] no earlier than that of the moment before; the same time replaces it.
  void add(double time, const LaboratoryMoment& moment);

  /// At a time between two moments, on the straight line between them; before the first one and
  /// after the last one, that one. Precondition: one was added.
  LaboratoryMoment at(double time) const;

 private:
  struct Entry {
    double time = 0.0;
    LaboratoryMoment moment;
  };

  double span_;
  std::deque<Entry> entries_;
};

}  // namespace sac
