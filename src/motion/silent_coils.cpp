#include "spherical_actuator_calibration/motion/silent_coils.hpp"

#include <algorithm>

namespace sac {
namespace {

/// Whether the strengths of a coil's pairs have this coordinate, and those of other coils have not.
bool isOfCoilAlone(const ParameterSpace& space, const PlacedEffect& placed, std::size_t coil) {
  const Eigen::Index place = placed.effect->strengthCoordinate(0, coil);
  if (place < 0) {
    return false;
  }
  for (std::size_t i = 0; i < space.poles(); ++i) {
    for (std::size_t j = 0; j < space.coils(); ++j) {
      if ((placed.effect->strengthCoordinate(i, j) == place) != (j == coil)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

void SilentCoils::add(const MotionStreams& streams) {
  const Eigen::Index rows = streams.currents.rows();
  if (rows == 0) {
    return;
  }
  if (squares_.size() == 0) {
    squares_.setZero(streams.currents.cols());
    third_.setZero(streams.currents.cols());
  }
  const auto at = [&](Eigen::Index n) {
    return streams.currents.row(n).transpose().cast<double>().array().eval();
  };
  for (Eigen::Index n = 0; n < rows; ++n) {
    squares_ += at(n).square();
  }
  for (Eigen::Index n = 0; n + 3 < rows; ++n) {
    third_ += (at(n + 3) - at(n) + 3.0 * (at(n + 1) - at(n + 2))).square();
  }
  readings_ += static_cast<double>(rows);
  differences_ += static_cast<double>(std::max<Eigen::Index>(0, rows - 3));
}

std::vector<std::size_t> SilentCoils::found() const {
  constexpr double kOfThird = 20.0;    // 1² + 3² + 3² + 1²
  constexpr double kAboveNoise = 5.0;  // a current of twice its noise, squared, beside it
  // Currents that step with the readings look like noise, but not like so little.
  constexpr double kSmall = 0.05 * 0.05;
  const double largest = squares_.size() > 0 ? squares_.maxCoeff() : 0.0;
  std::vector<std::size_t> silent;
  for (Eigen::Index j = 0; j < squares_.size(); ++j) {
    const double square = squares_[j] / std::max(1.0, readings_);
    const double noise = third_[j] / (kOfThird * std::max(1.0, differences_));
    if (square <= kAboveNoise * noise && squares_[j] < kSmall * largest) {
      silent.push_back(static_cast<std::size_t>(j));
    }
  }
  return silent;
}

std::vector<std::size_t> silentCoils(const MotionRecording& recording) {
  SilentCoils silent;
  for (const MotionStreams& streams : recording.spans) {
    silent.add(streams);
  }
  return silent.found();
}

std::vector<Eigen::Index> coordinatesOfCoils(const ParameterSpace& space,
                                             const std::vector<std::size_t>& coils) {
  std::vector<Eigen::Index> coordinates;
  for (const std::size_t j : coils) {
    coordinates.insert(coordinates.end(), {space.coil(j), space.coil(j) + 1});
    for (const PlacedEffect& placed : space.effects().effects()) {
      if (isOfCoilAlone(space, placed, j)) {
        coordinates.push_back(space.effect() + placed.first +
                              placed.effect->strengthCoordinate(0, j));
      }
    }
  }
  std::sort(coordinates.begin(), coordinates.end());
  return coordinates;
}

}  // namespace sac
