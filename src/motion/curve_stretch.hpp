#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "motion_point.hpp"
#include "motion_span.hpp"

namespace sac {

/// Derivative of a window's residuals by the share by which the torque curve is wider in angle than
/// described: f(ψ / (1 + s)). Of so many currents, `stride`, one counts.
Eigen::VectorXd balanceByStretch(const MotionSpan& span,
                                 const MotionWindow& window,
                                 const MotionPoint& point,
                                 int functions,
                                 std::size_t stride);

}  // namespace sac
