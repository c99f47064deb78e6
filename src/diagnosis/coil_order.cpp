#include "coil_order.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

namespace sac {
namespace {

constexpr std::array<std::pair<int, int>, 4> kSigns{{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// Orders of one motion, with what each leaves.
class OrderSearch {
 public:
  explicit OrderSearch(const ChannelImpulses& impulses)
      : impulses_(impulses), squares_(impulses.through.colwise().squaredNorm()) {}

  CoilOrder shifted(std::size_t steps) const;
  /// The best that single changes lead to.
  CoilOrder improved(CoilOrder order) const;
  /// Of some places nothing tells: two coils on opposite sides of the rotor turn it alike where
  /// its poles are opposite each other. Then that with fewer mistakes counts for more.
  double cost(const CoilOrder& order) const {
    constexpr double kMistake = 0.005;
    return order.left + kMistake * static_cast<double>(order.mistakes());
  }

 private:
  struct Change {
    std::size_t first = 0;
    std::size_t second = 0;  ///< another channel, exchanged with it, or the same
    int first_sign = 1;      ///< from then on
    int second_sign = 1;
    double left = 0.0;  ///< then
    double cost = std::numeric_limits<double>::infinity();
  };

  Eigen::VectorXd remainder(const CoilOrder& order) const;
  Eigen::VectorXd of(const CoilOrder& order, std::size_t channel) const {
    return order.sign[channel] * impulses_.at(channel, order.coil[channel]);
  }
  double explained(const CoilOrder& order, std::size_t channel) const {
    const std::size_t place = channel * impulses_.coils + order.coil[channel];
    return order.sign[channel] == 0 ? 0.0 : squares_[static_cast<Eigen::Index>(place)];
  }
  double explained(const CoilOrder& order) const;
  Change bestChange(const CoilOrder& order) const;
  static void apply(const Change& change, CoilOrder& order);

  const ChannelImpulses& impulses_;
  Eigen::RowVectorXd squares_;  ///< of `through`
};

CoilOrder OrderSearch::shifted(std::size_t steps) const {
  CoilOrder order;
  order.coil.resize(impulses_.coils);
  std::iota(order.coil.begin(), order.coil.end(), std::size_t{0});
  std::rotate(order.coil.begin(),
              order.coil.begin() + static_cast<std::ptrdiff_t>(steps),
              order.coil.end());
  order.sign.assign(impulses_.coils, 1);
  order.left = remainder(order).squaredNorm() / explained(order);
  return order;
}

Eigen::VectorXd OrderSearch::remainder(const CoilOrder& order) const {
  Eigen::VectorXd left = impulses_.momentum;
  for (std::size_t channel = 0; channel < impulses_.coils; ++channel) {
    left -= of(order, channel);
  }
  return left;
}

double OrderSearch::explained(const CoilOrder& order) const {
  double sum = 0.0;
  for (std::size_t channel = 0; channel < impulses_.coils; ++channel) {
    sum += explained(order, channel);
  }
  return sum;
}

OrderSearch::Change OrderSearch::bestChange(const CoilOrder& order) const {
  const Eigen::VectorXd now = remainder(order);
  Change best;
  const auto consider = [&](Change change, const Eigen::VectorXd& left) {
    CoilOrder changed = order;
    apply(change, changed);
    // Inertia may shrink with the currents: of nothing nothing is left.
    changed.left = left.squaredNorm() / explained(changed);
    change.left = changed.left;
    change.cost = cost(changed);
    if (change.cost < best.cost) {
      best = change;
    }
  };
  for (std::size_t a = 0; a < impulses_.coils; ++a) {
    const Eigen::VectorXd without = now + of(order, a);
    for (const int sign : {-1, 0, 1}) {
      if (sign != order.sign[a]) {
        consider({a, a, sign, sign}, without - sign * impulses_.at(a, order.coil[a]));
      }
    }
    for (std::size_t b = a + 1; b < impulses_.coils; ++b) {
      for (const auto& [first, second] : kSigns) {
        consider({a, b, first, second},
                 without + of(order, b) - first * impulses_.at(a, order.coil[b]) -
                     second * impulses_.at(b, order.coil[a]));
      }
    }
  }
  return best;
}

void OrderSearch::apply(const Change& change, CoilOrder& order) {
  if (change.first != change.second) {
    std::swap(order.coil[change.first], order.coil[change.second]);
  }
  order.sign[change.first] = change.first_sign;
  order.sign[change.second] = change.second_sign;
  order.left = change.left;
}

CoilOrder OrderSearch::improved(CoilOrder order) const {
  const std::size_t most = 4 * impulses_.coils;
  for (std::size_t n = 0; n < most; ++n) {
    const Change change = bestChange(order);
    if (!(change.cost < cost(order))) {
      break;
    }
    apply(change, order);
  }
  return order;
}

}  // namespace

std::size_t CoilOrder::steps() const {
  std::vector<std::size_t> counts(coil.size(), 0);
  for (std::size_t channel = 0; channel < coil.size(); ++channel) {
    ++counts[(coil[channel] + coil.size() - channel) % coil.size()];
  }
  return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

std::size_t CoilOrder::mistakes() const {
  const std::size_t shift = steps();
  std::size_t count = shift > 0 ? 1 : 0;
  for (std::size_t channel = 0; channel < coil.size(); ++channel) {
    count += coil[channel] == (channel + shift) % coil.size() ? 0 : 1;
  }
  const auto turned =
      sign.size() - static_cast<std::size_t>(std::count(sign.begin(), sign.end(), 1));
  return count + turned;
}

CoilOrder bestCoilOrder(const ChannelImpulses& impulses) {
  const OrderSearch search(impulses);
  const CoilOrder described = search.shifted(0);
  CoilOrder start = described;
  for (std::size_t steps = 1; steps < impulses.coils; ++steps) {
    CoilOrder shifted = search.shifted(steps);
    if (shifted.left < start.left) {
      start = std::move(shifted);
    }
  }
  CoilOrder best = search.improved(described);
  CoilOrder other = search.improved(std::move(start));
  return search.cost(other) < search.cost(best) ? other : best;
}

double leftAsDescribed(const ChannelImpulses& impulses) {
  return OrderSearch(impulses).shifted(0).left;
}

}  // namespace sac
