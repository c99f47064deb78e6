#pragma once

#include <cstdint>
#include <string>

namespace sac {

/// How well one kind of parameters is known.
struct GroupUncertainty {
  std::string group;        ///< joints, poles or coils
  std::string least_known;  ///< its parameter with the largest standard deviation
  double stddev = 0.0;      ///< of that one [rad]
  std::uint32_t parameters = 0;
  std::uint32_t left = 0;  ///< of them: not known as well as wanted
};

}  // namespace sac
