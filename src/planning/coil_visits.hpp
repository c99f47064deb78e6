#pragma once

#include <cstddef>
#include <vector>

#include "design_task.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// At so many poses a coil is to be excited: where it is at one only, another place of the coil may
/// explain its torques nearly as well, which variances do not tell.
inline constexpr std::size_t kLeastVisits = 2;

/// Poses of samples that excite each coil, counted up to kLeastVisits. Those whose joint angles are
/// closer together than `spacing` [rad] count as one, and those held out for none.
std::vector<std::size_t> measuredVisits(const std::vector<Sample>& samples,
                                        std::size_t coils,
                                        double current_threshold,
                                        double spacing);

/// Which poses of a design excite which coil.
class CoilVisits {
 public:
  CoilVisits(const DesignTask& task,
             const std::vector<PoseCandidate>& candidates,
             const std::vector<DesignedPose>& poses);

  /// Coils, counted from 0, of the candidates that are excited at fewer poses than they are to be,
  /// those measured already included.
  std::vector<std::size_t> lacking() const;
  bool isExcitedAt(std::size_t coil, std::size_t place) const { return patterns_[coil][place] > 0; }
  /// Whether one pattern of this pose may do without the coil, and it is not lacking for it.
  bool isSpareAt(std::size_t coil, std::size_t place) const {
    return patterns_[coil][place] > 1 || visits_[coil] > kLeastVisits;
  }

 private:
  std::vector<bool> can_be_excited_;                ///< per coil
  std::vector<std::size_t> visits_;                 ///< per coil
  std::vector<std::vector<std::size_t>> patterns_;  ///< per coil and pose, that excite it
};

}  // namespace sac
