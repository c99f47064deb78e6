#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "motion_point.hpp"
#include "motion_span.hpp"

namespace sac {

/// A law of friction beside that of the model.
struct FrictionLaw {
  const char* words;  ///< "that grows with …"
  const char* unit;   ///< of its coefficient
};

constexpr std::size_t kFrictionLaws = 2;
constexpr std::array<FrictionLaw, kFrictionLaws> kFrictionLawsInWords{
    {{"that grows with the square of the speed, as of air", "N.m.s2/rad2"},
     {"that is another about the rotor's axis z than about others", "N.m.s/rad"}}};

/// Derivatives of a window's residuals by the coefficient of each law. `functions`: how many of the
/// test functions.
Eigen::MatrixXd balanceByFrictions(const MotionWindow& window,
                                   const JointTrack& track,
                                   const MotionPoint& point,
                                   int functions);

}  // namespace sac
