#pragma once

#include <cmath>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// First and second harmonic of the encoders of the chosen joints: a₁ cos q + b₁ sin q + a₂ cos 2q
/// + b₂ sin 2q added to each reading q. Over a limited travel some of them look like each other, or
/// like an offset: the usual size of harmonics keeps what the samples leave open at zero.
class EncoderHarmonics final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kEncoderHarmonics;
  static constexpr auto kUnit = "rad";
  static constexpr ActsOn kActsOn = ActsOn::kEverything;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  EncoderHarmonics(const Actuator& /*nominal*/, const EffectSelection& selection)
      : LaboratoryEffect(harmonicNames(selection.harmonicJoints()), kScale),
        joints_(selection.harmonicJoints()) {}

  double priorStddev() const override { return kUsualSize; }
  void addReadingColumns(const Eigen::Vector3d& reading, Columns columns) const override {
    for (std::size_t n = 0; n < joints_.size(); ++n) {
      const auto joint = static_cast<Eigen::Index>(joints_[n]);
      const double q = reading[joint];
      columns.row(joint).segment<kPerJoint>(kPerJoint * static_cast<Eigen::Index>(n))
          << std::cos(q),
          std::sin(q), std::cos(2.0 * q), std::sin(2.0 * q);
    }
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    for (std::size_t n = 0; n < joints_.size(); ++n) {
      std::array<double, kPerJoint>& harmonics = actuator.joints[joints_[n]].correction.harmonics;
      for (std::size_t h = 0; h < harmonics.size(); ++h) {
        harmonics[h] += values[static_cast<Eigen::Index>(kPerJoint * n + h)];
      }
    }
  }

 private:
  static constexpr int kPerJoint = 4;
  static constexpr double kScale = 0.1;
  static constexpr double kUsualSize = 3e-3;  // [rad]

  static std::vector<std::string> harmonicNames(const std::vector<std::size_t>& joints) {
    std::vector<std::string> names;
    for (const std::size_t joint : joints) {
      for (const char* harmonic : {"/cos_1", "/sin_1", "/cos_2", "/sin_2"}) {
        names.push_back("joint_" + std::to_string(numberOf(joint)) + harmonic);
      }
    }
    return names;
  }

  std::vector<std::size_t> joints_;  ///< from 0
};

}  // namespace sac::effects
