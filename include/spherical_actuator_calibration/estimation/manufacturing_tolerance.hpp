#pragma once

namespace sac {

/// How far a manufactured unit may lie from its drawing: standard deviations [rad], the uncertainty
/// of what is not identified yet.
struct ManufacturingTolerance {
  double joint_offset = 0.03;
  double joint_axis = 0.03;  ///< per tangential direction
  double pole = 0.03;        ///< per tangential direction
  double coil = 0.03;        ///< per tangential direction
  double effect = 0.03;      ///< of a modelled laboratory effect, in units of the EffectLayout
};

/// Throws ConfigError unless every tolerance lies in [0, 1] rad.
void validate(const ManufacturingTolerance& tolerance);

}  // namespace sac
