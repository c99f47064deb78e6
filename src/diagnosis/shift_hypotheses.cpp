#include <cstdlib>
#include <utility>

#include "orientation_hypotheses.hpp"

namespace sac {
namespace {

/// Somewhat more than torques of one dwell.
constexpr int kMostRows = 10;

/// Takes a measured quantity of each sample from the one that stands `rows` further down, among
/// those that have it.
template <typename Has, typename Move>
std::function<void(WiringCase&, const Eigen::VectorXd&)> moving(int rows, Has has, Move move) {
  return [rows, has, move](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    std::vector<std::size_t> places;
    for (std::size_t n = 0; n < wiring.samples.size(); ++n) {
      if (has(wiring.samples[n])) {
        places.push_back(n);
      }
    }
    const std::vector<Sample> before = wiring.samples;
    const auto count = static_cast<int>(places.size());
    for (int n = 0; n < count; ++n) {
      const int from = ((n + rows) % count + count) % count;
      move(before[places[static_cast<std::size_t>(from)]],
           wiring.samples[places[static_cast<std::size_t>(n)]]);
    }
  };
}

Hypothesis shift(int rows, const std::string& what) {
  Hypothesis result;
  result.cause = "rows_shifted";
  result.family = result.cause;
  const std::string direction = rows > 0 ? "later" : "earlier";
  std::string text = "the " + what + " stand " + std::to_string(std::abs(rows)) +
                     (std::abs(rows) == 1 ? " row " : " rows ") + direction +
                     " than the joint angles they belong to: mend the columns of the file "
                     "that the samples were made from, or the stamps of that stream.";
  result.sentence = [text = std::move(text)](const Eigen::VectorXd& /*values*/) -> std::string {
    return text;
  };
  return result;
}

}  // namespace

std::vector<Hypothesis> shiftHypotheses(Quantity stream) {
  std::vector<Hypothesis> all;
  for (int n = 2; n < 2 * kMostRows + 2; ++n) {
    const int rows = n % 2 == 0 ? n / 2 : -(n / 2);
    if (stream == Quantity::kOrientation) {
      Hypothesis orientation = shift(rows, "orientations");
      orientation.correct = moving(
          rows,
          [](const Sample& sample) { return sample.has_orientation; },
          [](const Sample& from, Sample& to) { to.R_stator_rotor = from.R_stator_rotor; });
      all.push_back(orientation);
      continue;
    }
    const auto has_torque = [](const Sample& sample) { return sample.has_torque; };
    Hypothesis torque = shift(rows, "torques");
    torque.correct =
        moving(rows, has_torque, [](const Sample& from, Sample& to) { to.torque = from.torque; });
    all.push_back(torque);
    Hypothesis current = shift(rows, "currents");
    current.correct =
        moving(rows, has_torque, [](const Sample& from, Sample& to) { to.current = from.current; });
    all.push_back(current);
  }
  return all;
}

}  // namespace sac
