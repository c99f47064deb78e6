#include "cycle_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "frequent_outliers.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

/// Chance findings among all groups together are rarer than this.
constexpr double kChance = 1e-3;
constexpr double kChanceOfLoss = 0.01;

/// Observations that a common cause would spoil together.
struct Group {
  std::string name;
  bool is_stream = false;  ///< all that one sensor tells
  std::size_t count = 0;
  std::size_t rejected = 0;
  double squares = 0.0;  ///< standardised, of those not rejected
};

void count(const ObservationResidual& residual, Group& group) {
  ++group.count;
  if (residual.rejected) {
    ++group.rejected;
  } else {
    group.squares += residual.standardized * residual.standardized;
  }
}

/// The drawing, by which poles are told to pull.
class Drawing {
 public:
  explicit Drawing(const CalibrationModel& model)
      : curve_(model.hasTorqueModel() ? &model.curve() : nullptr),
        joints_(jointGeometry(model.space().nominal())),
        geometry_(torqueGeometry(model.space().nominal())) {}

  /// Per pole: whether the drawing lets it pull noticeably in a sample. `noticeable`: [N·m].
  std::vector<bool> pullingPoles(const Sample& sample,
                                 const std::vector<Excitation>& excitations,
                                 double noticeable) const {
    const Eigen::Matrix3d R_rotor_stator =
        rotorOrientation(joints_, sample.joint_position).transpose();
    std::vector<bool> pulling(static_cast<std::size_t>(geometry_.poles_rotor.cols()), false);
    for (const Excitation& excitation : excitations) {
      const Eigen::Vector3d coil =
          R_rotor_stator * geometry_.coils_stator.col(static_cast<Eigen::Index>(excitation.coil));
      for (std::size_t i = 0; i < pulling.size(); ++i) {
        const Eigen::Vector3d pole = geometry_.poles_rotor.col(static_cast<Eigen::Index>(i));
        pulling[i] =
            pulling[i] ||
            (interacts(*curve_, pole, coil) &&
             std::abs(excitation.current) * pairTorque(*curve_, pole, coil).norm() > noticeable);
      }
    }
    return pulling;
  }

 private:
  const TorqueCurve* curve_;  ///< null: no torque model, and no torques
  JointGeometry joints_;
  TorqueGeometry geometry_;
};

/// All observations first, then streams, coils and poles.
std::vector<Group> groupsOf(const EstimationProblem& problem,
                            const Estimate& estimate,
                            const EstimationOptions& options) {
  constexpr double kNoticeable = 10.0;  // standard deviations
  const ParameterSpace& space = problem.model->space();
  std::vector<Group> groups{{"all samples"}, {"the orientations", true}, {"the torques", true}};
  for (std::size_t j = 0; j < space.coils(); ++j) {
    groups.push_back({"the torques of coil " + std::to_string(numberOf(j))});
  }
  for (std::size_t i = 0; i < space.poles(); ++i) {
    groups.push_back({"the torques on pole " + std::to_string(numberOf(i))});
  }
  const Drawing drawing(*problem.model);
  const std::size_t first_coil = 3;
  const std::size_t first_pole = first_coil + space.coils();
  for (const ObservationResidual& residual : estimate.residuals) {
    const Sample& sample = (*problem.samples)[residual.observation.sample];
    count(residual, groups[0]);
    if (residual.observation.quantity == Quantity::kOrientation) {
      count(residual, groups[1]);
      continue;
    }
    count(residual, groups[2]);
    const std::vector<Excitation> excitations = excitedCoils(sample, options.current_threshold);
    for (const Excitation& excitation : excitations) {
      count(residual, groups[first_coil + excitation.coil]);
    }
    const double stddev =
        sample.torque_stddev > 0.0 ? sample.torque_stddev : options.default_torque_stddev;
    const std::vector<bool> pulling =
        drawing.pullingPoles(sample, excitations, kNoticeable * stddev);
    for (std::size_t i = 0; i < pulling.size(); ++i) {
      if (pulling[i]) {
        count(residual, groups[first_pole + i]);
      }
    }
  }
  return groups;
}

/// Whether so many rejections are no accident, where outliers come at the rate of all samples. A
/// sensor that loses most of its measurements is suspected sooner: of few ones, such as five
/// orientations, four are lost by chance once in 2000 sessions.
bool isRejected(const Group& group, double rate, std::size_t groups, double most) {
  if (group.rejected < 2 ||
      static_cast<double>(group.rejected) <= most * static_cast<double>(group.count)) {
    return false;
  }
  const double probability = binomialTail(group.count, rate, group.rejected);
  const bool is_lost = group.is_stream && 2 * group.rejected > group.count;
  return probability < (is_lost ? kChanceOfLoss : kChance / static_cast<double>(groups));
}

double shareOfRejected(const Group& group) {
  return group.count == 0 ? 0.0
                          : static_cast<double>(group.rejected) / static_cast<double>(group.count);
}

std::string rejections(const std::vector<Group>& groups, const EstimationOptions& options) {
  constexpr double kUsualRate = 0.1;
  const Group& all = groups.front();
  if (shareOfRejected(all) > options.max_rejected_fraction) {
    return format(
        ": the samples contradict each other (%.0f %% would be outliers); check "
        "sensors, frames and currents.",
        100.0 * shareOfRejected(all));
  }
  const double rate = std::max(kUsualRate, shareOfRejected(all));
  const Group* worst = nullptr;
  for (const Group& group : groups) {
    if (isRejected(group, rate, groups.size(), options.max_rejected_fraction) &&
        (worst == nullptr || shareOfRejected(group) > shareOfRejected(*worst))) {
      worst = &group;
    }
  }
  return worst == nullptr
             ? std::string()
             : format(
                   ": %s contradict the other samples (%zu of %zu would be outliers); check "
                   "frames, currents, polarities and wiring.",
                   worst->name.c_str(),
                   worst->rejected,
                   worst->count);
}

/// Whether a sum of squares is no accident, where so many groups are looked at.
bool isMisfit(double squares, double degrees_of_freedom, std::size_t groups) {
  return chiSquareProbability(degrees_of_freedom, squares) * static_cast<double>(groups) < kChance;
}

std::string misfits(const std::vector<Group>& groups,
                    const Estimate& estimate,
                    const EstimationOptions& options) {
  const auto words = [](const std::string& name, double chi_square) {
    return format(
        ": residuals of %s are %.1f times their stated uncertainty; the samples do not "
        "fit the model. Check units, frames, polarity and the nominal description.",
        name.c_str(),
        std::sqrt(chi_square));
  };
  const double freedom = estimate.degrees_of_freedom;
  const double squares = estimate.reduced_chi_square * freedom;
  if (freedom > 0.0 && estimate.reduced_chi_square > options.max_reduced_chi_square &&
      isMisfit(squares, freedom, groups.size())) {
    return words("all samples", estimate.reduced_chi_square);
  }
  for (const Group& group : groups) {
    const auto kept = static_cast<double>(group.count - group.rejected);
    const double mean = kept > 0.0 ? group.squares / kept : 0.0;
    if (kept > 0.0 && mean > options.max_reduced_chi_square &&
        isMisfit(3.0 * group.squares, 3.0 * kept, groups.size())) {
      return words(group.name, mean);
    }
  }
  return {};
}

/// Within the noise an error may grow: what earlier cycles were told by chance agrees with it.
std::string growth(const Estimate& estimate) {
  constexpr double kNotable = 1.1;
  constexpr double kBeyondNoise = 2.25;  // of the reduced chi-square
  constexpr double kRounding = 1e-6;
  const double before = estimate.error_history.front();
  const double after = estimate.error_history.back();
  return estimate.reduced_chi_square > kBeyondNoise && after > kNotable * before + kRounding
             ? format(
                   ": the error grew to %.3g times what it was before; the samples contradict "
                   "each other.",
                   after / std::max(before, kRounding))
             : std::string();
}

std::string registrations(const Estimate& estimate) {
  constexpr double kMost = 3.0;
  return estimate.stated_misfit > kMost
             ? format(
                   ": the registrations would be off by %.1f times their stated uncertainty; "
                   "register tracker, marker and force/torque sensor anew.",
                   estimate.stated_misfit)
             : std::string();
}

std::string axisName(const ParameterSpace& space, Eigen::Index p) {
  const ParameterId id = space.id(p);
  const bool is_pole =
      id.kind == ParameterKind::kPolePolar || id.kind == ParameterKind::kPoleAzimuth;
  return (is_pole ? "pole " : "coil ") + std::to_string(numberOf(id.index));
}

/// Axes of which no sample was left, though there had been many.
std::string lostAxes(const EstimationProblem& problem,
                     const Estimate& estimate,
                     const std::vector<Group>& groups) {
  constexpr std::size_t kMany = 3;
  for (const Eigen::Index p : estimate.rejected_away) {
    const std::string axis = axisName(problem.model->space(), p);
    for (const Group& group : groups) {
      const std::size_t end = group.name.size();
      if (end > axis.size() && group.name.substr(end - axis.size()) == axis &&
          group.name[end - axis.size() - 1] == ' ' && group.count >= kMany) {
        return ": " + group.name + " contradict the other samples; check its current and wiring.";
      }
    }
  }
  return {};
}

}  // namespace

std::string ambiguityInWords(const ParameterSpace& space,
                             const std::vector<Eigen::Index>& ambiguous) {
  std::string names;
  for (const Eigen::Index p : ambiguous) {
    const bool is_last = p == ambiguous.back();
    names += (names.empty() ? "" : is_last ? " and " : ", ") + axisName(space, p);
  }
  return ambiguous.size() == 1
             ? "Ambiguous: another place of " + names +
                   " explains its torques nearly as well; measure it at further poses."
             : "Ambiguous: other places of " + names +
                   " explain their torques nearly as well; measure them at further poses.";
}

std::string deviation(const ParameterSpace& space,
                      const Estimate& estimate,
                      const std::vector<Eigen::Index>& free,
                      const EstimationOptions& options) {
  // Standard deviations. Where they are as large as tolerances they hold near the drawing only: of
  // two nearly parallel joints the offsets' difference may end ten of them off.
  constexpr double kSure = 1.0;
  const auto is_told = [&](Eigen::Index p) {
    return std::binary_search(free.begin(), free.end(), p) &&
           !std::binary_search(estimate.unobservable.begin(), estimate.unobservable.end(), p);
  };
  for (Eigen::Index p = 0; p < space.effect(); ++p) {
    const double limit = options.max_deviation * toleranceOf(space.id(p).kind, options.tolerance);
    const double apart = std::abs(estimate.belief.x[p]);
    const double stddev = std::sqrt(std::max(0.0, estimate.belief.covariance(p, p)));
    if (limit > 0.0 && is_told(p) && apart - kSure * stddev > limit) {
      return format(
          "%s would lie %.2g rad from its drawing, more than %.0f tolerances of manufacture; check "
          "the wiring of sensors and coils, all frames, and the nominal description.",
          space.name(p).c_str(),
          apart,
          options.max_deviation);
    }
  }
  return {};
}

std::string contradiction(const EstimationProblem& problem,
                          const Estimate& estimate,
                          const EstimationOptions& options) {
  const std::vector<Group> groups = groupsOf(problem, estimate, options);
  const std::vector<std::function<std::string()>> checks{
      [&] { return rejections(groups, options); },
      [&] { return misfits(groups, estimate, options); },
      [&] {
        const std::string words =
            deviation(problem.model->space(), estimate, problem.free, options);
        return words.empty() ? words : ": " + words;
      },
      [&] { return lostAxes(problem, estimate, groups); },
      [&] { return registrations(estimate); },
      [&] { return growth(estimate); }};
  for (const auto& check : checks) {
    std::string words = check();
    if (!words.empty()) {
      return words;
    }
  }
  return {};
}

std::vector<std::string> doubts(const EstimationProblem& problem,
                                const Estimate& estimate,
                                const EstimationOptions& options) {
  constexpr double kLarge = 2.25;
  constexpr double kSmall = 0.25;
  constexpr double kLeastFreedom = 30.0;
  constexpr double kExact = 1e-12;  // without noise nothing is told of it
  std::vector<std::string> words = frequentOutliers(problem, estimate, options);
  const double chi_square = estimate.reduced_chi_square;
  if (estimate.covariance_scale > 1.0 && chi_square > kLarge) {
    words.push_back(
        format("Residuals are %.1f times their stated uncertainty: something is not modelled, and "
               "may bias the parameters.",
               std::sqrt(chi_square)));
  }
  // An orientation map follows the samples that it is found from.
  if (!problem.model->hasOrientationMap() && estimate.degrees_of_freedom > kLeastFreedom &&
      chi_square < kSmall && chi_square > kExact) {
    words.push_back(
        format("Residuals are only %.2g times their stated uncertainty: the stated noise is too "
               "large, or samples are copies of each other.",
               std::sqrt(chi_square)));
  }
  return words;
}

}  // namespace sac
