#include "spherical_actuator_calibration/measurement/validation_poses.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"

namespace sac {
namespace {

constexpr double kTiltShare = 0.8;
constexpr int kMostPoses = 200;      // of which none has a coil
constexpr int kMostPosesForAll = 8;  // of which some have fewer coils than wanted

class CoilChoice {
 public:
  CoilChoice(const Actuator& nominal, double tilt)
      : sampler_(nominal, tilt), times_excited_(nominal.coils.size(), 0) {}

  /// Coils that see a pole from where it tells much, at most so many: those that were excited least
  /// first, then those that no other pole disturbs, else by lot.
  std::vector<std::size_t> choose(const Eigen::Vector3d& joint_position,
                                  std::size_t most,
                                  NoiseSource& noise) const {
    using Rank = std::pair<std::size_t, bool>;  // times excited, whether another pole disturbs
    std::vector<std::pair<Rank, std::size_t>> ranked;
    for (const std::size_t coil : byLot(noise)) {
      const PoseGrade grade = sampler_.grade(joint_position, coil, std::nullopt);
      if (grade != PoseGrade::kBlind) {
        ranked.push_back({{times_excited_[coil], grade == PoseGrade::kUncertain}, coil});
      }
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& one, const auto& other) {
      return one.first < other.first;
    });
    ranked.resize(std::min(most, ranked.size()));
    std::vector<std::size_t> coils(ranked.size());
    std::transform(
        ranked.begin(), ranked.end(), coils.begin(), [](const auto& one) { return one.second; });
    std::sort(coils.begin(), coils.end());
    return coils;
  }

  void excite(const std::vector<std::size_t>& coils) {
    for (const std::size_t coil : coils) {
      ++times_excited_[coil];
    }
  }

 private:
  std::vector<std::size_t> byLot(NoiseSource& noise) const {
    std::vector<std::size_t> coils(times_excited_.size());
    std::iota(coils.begin(), coils.end(), 0);
    for (std::size_t n = coils.size(); n > 1; --n) {
      std::swap(coils[n - 1], coils[noise.index(n)]);
    }
    return coils;
  }

  TorquePoseSampler sampler_;
  std::vector<std::size_t> times_excited_;
};

/// The first pose with enough coils that judge, else the one with most of a few, which differ in
/// the spin only: in the middle of the tilts most coils see a pole.
PoseToMeasure drawPose(double tilt, std::size_t coils, CoilChoice& choice, NoiseSource& noise) {
  PoseToMeasure best;
  std::vector<std::size_t> best_coils;
  const auto goes_on = [&](int drawn) {
    return drawn < (best_coils.empty() ? kMostPoses : kMostPosesForAll) &&
           best_coils.size() < coils;
  };
  for (int drawn = 0; drawn == 0 || goes_on(drawn); ++drawn) {
    Eigen::Vector3d position = randomPose(tilt, noise);
    if (!best_coils.empty()) {
      position.head<2>() = best.joint_position.head<2>();
    }
    std::vector<std::size_t> chosen = choice.choose(position, coils, noise);
    if (drawn == 0 || chosen.size() > best_coils.size()) {
      best.joint_position = position;
      best_coils = std::move(chosen);
    }
  }
  choice.excite(best_coils);
  best.patterns = singly(best_coils);
  return best;
}

}  // namespace

PosesToMeasure drawValidationPoses(const Actuator& nominal, const ValidationPoseOptions& options) {
  const ValueRange range = {0.0, 1000.0, ""};
  requireInRange("validation poses", static_cast<double>(options.poses), range);
  requireInRange("coils per validation pose", static_cast<double>(options.coils_per_pose), range);
  NoiseSource noise(options.seed, RandomPurpose::kValidationPoses);
  const double tilt = kTiltShare * nominal.workspace.tilt_limit;
  const std::size_t coils = std::min(options.coils_per_pose, nominal.coils.size());
  std::optional<CoilChoice> choice;
  if (nominal.hasTorqueModel()) {
    choice.emplace(nominal, tilt);
  }
  PosesToMeasure poses;
  for (std::size_t n = 0; n < options.poses; ++n) {
    PoseToMeasure pose;
    if (choice) {
      pose = drawPose(tilt, coils, *choice, noise);
    } else {
      pose.joint_position = randomPose(tilt, noise);
    }
    pose.validation = true;
    poses.push_back(std::move(pose));
  }
  return poses;
}

}  // namespace sac
