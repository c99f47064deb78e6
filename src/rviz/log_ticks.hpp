#pragma once

#include <vector>

namespace sac {

/// Values that label a logarithmic axis from `least` to `most` > 0, both among its labels where few
/// round ones are between: at least two, and not many more than six.
std::vector<double> logTicks(double least, double most);

}  // namespace sac
