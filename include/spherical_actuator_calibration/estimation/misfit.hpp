#pragma once

namespace sac {

/// Whether a sum of squared whitened residuals is more than noise brings once in a thousand fits
/// that leave so many degrees of freedom. Without any there is no misfit.
bool isMisfit(double squares, double freedom);

/// By what covariances of a fit are multiplied: by the reduced misfit where it is one, else by 1.
double misfitVariance(double squares, double freedom);

}  // namespace sac
