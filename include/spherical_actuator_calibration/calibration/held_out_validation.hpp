#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// Held-out measurements in which one kind of change would show: among all it might not
/// (doc/method.md, Held-out samples).
struct HeldOutGroup {
  std::string name;              ///< "the orientation", "coil 3", "the newest of coil 3"
  std::size_t observations = 0;  ///< judged together
  /// Squared Mahalanobis norm of their misfits, with the uncertainty of the parameters, and the
  /// errors of a dwell, that they have in common.
  double chi_square = 0.0;
  /// By how much it grows, in the mean over all directions, with the squared norm of an error that
  /// all of them have in common [1/rad²], [1/(N·m)²].
  double sensitivity = 0.0;

  double freedom() const { return 3.0 * static_cast<double>(observations); }
  /// Of a misfit at least this large by chance.
  double probability() const;
};

/// The group of all orientations. Those of torques are of a coil that was on, alone or with others,
/// and of its newest ones where these stand out.
inline constexpr char kOrientations[] = "the orientation";
/// So many of a group are judged together, the newest.
inline constexpr std::size_t kJudgedOfAGroup = 24;

/// How samples that no estimate has used agree with the parameters.
struct HeldOutValidation {
  bool is_of_windows = false;  ///< of a motion: validationOf()
  std::size_t samples = 0;     ///< held out; the rest is meaningless when there are none
  std::size_t orientations = 0;
  double orientation_rms = 0.0;  ///< root mean square norm of the rotation error [rad]
  std::size_t torques = 0;
  double torque_rms = 0.0;  ///< root mean square norm of the torque error [N·m]
  /// Torques of coils that are not identified, or to more than 10 mrad only: too far from linear
  /// in such uncertainties to be judged.
  std::size_t unjudged_torques = 0;
  /// That repeat another measurement, in use or held out, to a thousandth of the noise: they tell
  /// nothing, and have no residual.
  std::size_t repeated = 0;
  /// That stand out by themselves, where they are no more than among the samples in use: they have
  /// a residual that is `rejected`, and no part in the test.
  std::size_t outliers = 0;
  /// Coils that torques in the test judge: an error of 10 mrad of their axes would show in all of
  /// them together. A torque where no pole is near is the same wherever axes are.
  std::set<std::size_t> told_coils;
  /// Windows of a motion judge them beside.
  bool has_windows_beside = false;
  /// Coils of which every held-out torque is such an outlier: nothing is told of them. Ascending.
  std::vector<std::size_t> undecided_coils;
  /// Coils of which the newest torque is such an outlier, by accident or since they have changed.
  std::vector<std::size_t> doubtful_coils;
  /// Each judged by itself, by name.
  std::vector<HeldOutGroup> groups;
  /// Squared Mahalanobis norm of all misfits over their number, with the noise of the samples and
  /// the common uncertainty of the parameters: 1 on average when both are as stated.
  double reduced_chi_square = 0.0;
  /// Probability of misfits at least this large when the stated uncertainties hold; where single
  /// groups contradict, of what the worst of so many groups shows.
  double probability = 1.0;
  /// One per observation; `standardized` with its own covariance.
  std::vector<SampleResidual> residuals;

  /// What was held out, in the plural: "samples", or "windows" of a motion.
  const char* things() const { return is_of_windows ? "windows" : "samples"; }
  /// Whether it says anything of poles and coils.
  bool judgesCoils() const {
    return has_windows_beside || (is_of_windows ? torques > 0 : !told_coils.empty());
  }
  /// Whether any observation took part in the test.
  bool hasVerdict() const { return residuals.size() > unjudged_torques; }
  /// Largest probability at which one of the groups contradicts, so that all of them together
  /// rarely do by chance.
  double leastOfAGroup() const;
  std::vector<HeldOutGroup> contradicting() const;
};

/// What cycles made of the samples in use.
struct UsualOutliers {
  double rate = 0.0;  ///< of the last that succeeded; 0: none, so that none is excused elsewhere
  /// By the id of its sample: whether a torque was rejected, by the last that looked at it.
  std::map<std::uint32_t, bool> torques = {};
};

/// Of those that succeeded.
UsualOutliers usualOutliers(const std::vector<CycleReport>& reports);

/// What windows of motion that were held out tell, in the same words: a window is a sample with a
/// torque, its mean error.
HeldOutValidation validationOf(const HeldOutMotion& motion);

/// Of two that may both have a verdict the one with the less probable misfit.
const HeldOutValidation& severer(const HeldOutValidation& one, const HeldOutValidation& other);

/// Smaller probabilities mean that the held-out samples contradict the parameters.
inline constexpr double kLeastProbability = 1e-3;

/// "coil 3 (chi-square 56 of 12, probability 1e-07), coil 7 (…)".
std::string inWords(const std::vector<HeldOutGroup>& groups);

/// "coil 3", "coils 3, 7".
std::string coilsInWords(const std::vector<std::size_t>& coils);

/// The verdict in a sentence that an operator can act on.
std::string verdict(const HeldOutValidation& validation);

}  // namespace sac
