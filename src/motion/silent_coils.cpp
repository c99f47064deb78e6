#include "spherical_actuator_calibration/motion/silent_coils.hpp"

#include <algorithm>

namespace sac {
namespace {

/// Mean squares of a coil's readings [A²].
struct ReadCurrent {
  double square = 0.0;
  double noise = 0.0;  ///< of it, by third differences
};

std::vector<ReadCurrent> readCurrents(const MotionRecording& recording) {
  constexpr double kOfThird = 20.0;  // 1² + 3² + 3² + 1²
  std::vector<ReadCurrent> read;
  double readings = 0.0;
  double differences = 0.0;
  for (const MotionStreams& streams : recording.spans) {
    const Eigen::Index rows = streams.currents.rows();
    read.resize(static_cast<std::size_t>(streams.currents.cols()));
    readings += static_cast<double>(rows);
    differences += static_cast<double>(std::max<Eigen::Index>(0, rows - 3));
    for (Eigen::Index j = 0; j < streams.currents.cols(); ++j) {
      ReadCurrent& of_coil = read[static_cast<std::size_t>(j)];
      const auto current = streams.currents.col(j).cast<double>();
      of_coil.square += current.squaredNorm();
      for (Eigen::Index n = 0; n + 3 < rows; ++n) {
        const double third =
            current[n + 3] - 3.0 * current[n + 2] + 3.0 * current[n + 1] - current[n];
        of_coil.noise += third * third;
      }
    }
  }
  for (ReadCurrent& of_coil : read) {
    of_coil.square /= std::max(1.0, readings);
    of_coil.noise /= kOfThird * std::max(1.0, differences);
  }
  return read;
}

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

std::vector<std::size_t> silentCoils(const MotionRecording& recording) {
  constexpr double kAboveNoise = 5.0;  // a current of twice its noise, squared, beside it
  // Currents that step with the readings look like noise, but not like so little.
  constexpr double kSmall = 0.05 * 0.05;
  const std::vector<ReadCurrent> read = readCurrents(recording);
  double largest = 0.0;
  for (const ReadCurrent& of_coil : read) {
    largest = std::max(largest, of_coil.square);
  }
  std::vector<std::size_t> silent;
  for (std::size_t j = 0; j < read.size(); ++j) {
    if (read[j].square <= kAboveNoise * read[j].noise && read[j].square < kSmall * largest) {
      silent.push_back(j);
    }
  }
  return silent;
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
