#include "spherical_actuator_calibration/estimation/unidentified_part.hpp"

#include <algorithm>
#include <utility>

#include "observability.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

namespace sac {
namespace {

/// The free coordinates that are not held yet, and their information.
class OpenCoordinates {
 public:
  OpenCoordinates(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& free)
      : information_(information), free_(free), places_(free.size()) {
    for (std::size_t k = 0; k < free.size(); ++k) {
      places_[k] = static_cast<Eigen::Index>(k);
    }
  }

  Observability judged(double limit) const {
    const Eigen::MatrixXd information = information_(places_, places_);
    return leavesNothingOpen(information, limit) ? Observability()
                                                 : judgeInformation(information, limit);
  }

  /// Whether the data would leave a coordinate open though all else were known.
  bool tellNothing(Eigen::Index k, double limit) const {
    const Eigen::Index place = places_[static_cast<std::size_t>(k)];
    return information_(place, place) * limit * limit < 1.0;
  }

  Eigen::Index coordinate(Eigen::Index k) const {
    return free_[static_cast<std::size_t>(places_[static_cast<std::size_t>(k)])];
  }

  /// Takes the chosen ones of `candidates` (positions, ascending) out. Returns their coordinates.
  template <typename Choice>
  std::vector<Eigen::Index> hold(const std::vector<Eigen::Index>& candidates,
                                 const Choice& choose) {
    std::vector<Eigen::Index> held;
    std::vector<Eigen::Index> remaining;
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(places_.size()); ++k) {
      if (std::binary_search(candidates.begin(), candidates.end(), k) && choose(k)) {
        held.push_back(coordinate(k));
      } else {
        remaining.push_back(places_[static_cast<std::size_t>(k)]);
      }
    }
    places_ = std::move(remaining);
    return held;
  }

 private:
  const Eigen::MatrixXd& information_;
  const std::vector<Eigen::Index>& free_;
  std::vector<Eigen::Index> places_;  ///< in free_
};

/// Orthonormal, what directions have beside the coordinates of which something is stated: these are
/// known by that, and not by the prior once more.
Eigen::MatrixXd besideStated(Eigen::MatrixXd directions, const ParameterSpace& space) {
  constexpr double kSome = 1e-3;  // of a squared length of 1
  for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
    if (statedVariance(space, p) > 0.0) {
      directions.row(p).setZero();
    }
  }
  const SymmetricEigen left = symmetricEigen(directions.transpose() * directions);
  const Eigen::Index count = (left.values.array() > kSome).count();  // they ascend
  return directions * left.vectors.rightCols(count) *
         left.values.tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

UnidentifiedPart unidentifiedPart(const Eigen::MatrixXd& information,
                                  const std::vector<Eigen::Index>& free,
                                  const ParameterSpace& space,
                                  double limit) {
  UnidentifiedPart part;
  part.directions.resize(space.size(), 0);
  OpenCoordinates open(information, free);
  while (true) {
    const Observability observability = open.judged(limit);
    const std::vector<Eigen::Index>& weak = observability.weak;
    if (weak.empty()) {
      break;
    }
    std::vector<Eigen::Index> held = open.hold(weak, [&](Eigen::Index k) {
      const Eigen::Index p = open.coordinate(k);
      return p >= space.effect() && statedVariance(space, p) == 0.0;
    });
    if (held.empty()) {
      held = open.hold(weak, [&](Eigen::Index k) { return open.tellNothing(k, limit); });
    }
    if (held.empty()) {
      part.directions.setZero(space.size(), observability.open_directions.cols());
      for (Eigen::Index k = 0; k < observability.open_directions.rows(); ++k) {
        part.directions.row(open.coordinate(k)) = observability.open_directions.row(k);
      }
      part.directions = besideStated(std::move(part.directions), space);
      break;
    }
    part.coordinates.insert(part.coordinates.end(), held.begin(), held.end());
  }
  std::sort(part.coordinates.begin(), part.coordinates.end());
  return part;
}

}  // namespace sac
