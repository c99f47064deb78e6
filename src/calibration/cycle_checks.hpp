#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// Why a converged estimate must not be taken, in words to follow the name of the cycle, or empty:
/// too many rejected observations, or a misfit too large, of all, of a stream, a coil or a pole; an
/// error that grew; parameters farther from the drawing than anything is made; registrations
/// farther off than stated.
std::string contradiction(const EstimationProblem& problem,
                          const Estimate& estimate,
                          const EstimationOptions& options);

/// Which coordinate of `free` (ascending) would lie farther from its drawing than anything is made,
/// in words, or empty.
std::string deviation(const ParameterSpace& space,
                      const Estimate& estimate,
                      const std::vector<Eigen::Index>& free,
                      const EstimationOptions& options);

/// Which axes could lie elsewhere as well, by their first coordinates. Precondition: there are
/// some.
std::string ambiguityInWords(const ParameterSpace& space,
                             const std::vector<Eigen::Index>& ambiguous);

/// What keeps an estimate that is taken from being good, a sentence each, but that it is ambiguous.
std::vector<std::string> doubts(const EstimationProblem& problem,
                                const Estimate& estimate,
                                const EstimationOptions& options);

}  // namespace sac
