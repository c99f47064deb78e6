#include "coil_visits.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

namespace sac {

std::vector<std::size_t> measuredVisits(const std::vector<Sample>& samples,
                                        std::size_t coils,
                                        double current_threshold,
                                        double spacing) {
  std::vector<std::size_t> visits(coils, 0);
  for (std::size_t coil = 0; coil < coils; ++coil) {
    std::vector<Eigen::Vector3d> places;
    for (const Sample& sample : samples) {
      const bool excites =
          sample.has_torque && !sample.validation &&
          isExcited(sample.current[static_cast<Eigen::Index>(coil)], current_threshold);
      const auto is_near = [&](const Eigen::Vector3d& place) {
        return (place - sample.joint_position).norm() < spacing;
      };
      if (excites && std::none_of(places.begin(), places.end(), is_near)) {
        places.push_back(sample.joint_position);
      }
    }
    visits[coil] = std::min(places.size(), kLeastVisits);
  }
  return visits;
}

CoilVisits::CoilVisits(const DesignTask& task,
                       const std::vector<PoseCandidate>& candidates,
                       const std::vector<DesignedPose>& poses)
    : can_be_excited_(task.visited.size(), false),
      visits_(task.visited),
      patterns_(task.visited.size(), std::vector<std::size_t>(poses.size(), 0)) {
  for (const PoseCandidate& candidate : candidates) {
    for (const std::size_t coil : candidate.coils) {
      can_be_excited_[coil] = true;
    }
  }
  for (std::size_t place = 0; place < poses.size(); ++place) {
    for (const TermPattern& pattern : poses[place].patterns) {
      for (const SignedTerm& term : pattern) {
        const std::size_t coil = candidates[poses[place].candidate].coils[term.term];
        visits_[coil] += patterns_[coil][place]++ == 0 ? 1 : 0;
      }
    }
  }
}

std::vector<std::size_t> CoilVisits::lacking() const {
  std::vector<std::size_t> coils;
  for (std::size_t coil = 0; coil < visits_.size(); ++coil) {
    if (can_be_excited_[coil] && visits_[coil] < kLeastVisits) {
      coils.push_back(coil);
    }
  }
  return coils;
}

}  // namespace sac
