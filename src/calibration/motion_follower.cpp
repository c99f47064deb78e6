#include "spherical_actuator_calibration/calibration/motion_follower.hpp"

#include <algorithm>

#include "motion_cycle.hpp"
#include "motion_words.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/defined_stddev.hpp"

namespace sac {

MotionFollower::MotionFollower(const Actuator& nominal,
                               const CalibrationConfig& config,
                               double wanted_stddev)
    : wanted_stddev_(wanted_stddev),
      model_(std::make_unique<const CalibrationModel>(
          ParameterSpace(nominal, withMotionEffects(config.effects)))),
      live_(*model_,
            nominalState(model_->space(), config.tolerance).belief,
            motionCoordinates(model_->space(), HasOrientations::kYes),
            config.estimation) {}

bool MotionFollower::suits(const Actuator& nominal) {
  return nominal.has_joints && nominal.hasTorqueModel();
}

GroupUncertainty MotionFollower::group(const std::string& name,
                                       Eigen::Index first,
                                       Eigen::Index end,
                                       const Eigen::VectorXd& stddevs) const {
  const Eigen::VectorXd own = stddevs.segment(first, end - first).unaryExpr(&definedStddev);
  Eigen::Index worst = 0;
  GroupUncertainty group;
  group.group = name;
  group.stddev = own.maxCoeff(&worst);
  group.least_known = model_->space().name(first + worst);
  group.parameters = static_cast<std::uint32_t>(own.size());
  group.left = static_cast<std::uint32_t>((own.array() > wanted_stddev_).count());
  return group;
}

std::vector<GroupUncertainty> MotionFollower::groups() const {
  const ParameterSpace& space = model_->space();
  const ParameterBelief& belief = estimate().belief;
  const Eigen::VectorXd stddevs = space.reportedStddevs(belief.x, belief.covariance);
  return {group("joints", 0, space.pole(0), stddevs),
          group("poles", space.pole(0), space.coil(0), stddevs),
          group("coils", space.coil(0), space.effect(), stddevs)};
}

std::optional<double> MotionFollower::timeLeft() const {
  if (!estimate().is_told) {
    return std::nullopt;
  }
  double worst = 0.0;
  for (const GroupUncertainty& one : groups()) {
    worst = std::max(worst, one.stddev / wanted_stddev_);
  }
  return estimate().duration * std::max(0.0, worst * worst - 1.0);
}

bool MotionFollower::canBeJudged() const {
  const std::size_t wanted = MotionOptions().least_windows_to_hold_out;
  return estimate().windows - estimate().left_out >= wanted + wanted / 5;
}

bool MotionFollower::isEnough() const {
  return canBeJudged() && timeLeft() == 0.0;
}

std::string MotionFollower::inWords() const {
  return motionInWords(estimate(), groups(), wanted_stddev_, canBeJudged(), timeLeft());
}

std::vector<ParameterEstimate> MotionFollower::dynamics() const {
  const ParameterSpace& space = model_->space();
  const ParameterBelief& belief = estimate().belief;
  const Eigen::VectorXd nominal = space.reportedValues(Eigen::VectorXd::Zero(space.size()));
  const Eigen::VectorXd values = space.reportedValues(belief.x);
  const Eigen::VectorXd stddevs = space.reportedStddevs(belief.x, belief.covariance);
  std::vector<ParameterEstimate> estimates;
  for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
    const PlacedEffect& placed = space.effects().at(e);
    if (placed.acts_on == LaboratoryEffect::ActsOn::kMotion ||
        placed.belongs_to == LaboratoryEffect::BelongsTo::kLoad) {
      const Eigen::Index p = space.effect() + e;
      estimates.push_back({space.name(p),
                           nominal[p],
                           nominal[p],
                           values[p],
                           stddevs[p],
                           estimate().is_told,
                           space.unit(p)});
    }
  }
  return estimates;
}

}  // namespace sac
