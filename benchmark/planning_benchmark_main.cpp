/// Planned sessions against the paper's protocol at random poses, both estimated jointly:
/// planning_benchmark. Prints figures, one line each: name, tab, value.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <optional>
#include <vector>

#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"
#include "support/scenarios.hpp"

namespace sac::benchmarks {
namespace {

constexpr std::uint64_t kSeeds = 50;
constexpr double kTilt = 0.3;       // [rad]
constexpr double kWanted = 0.2e-3;  // [rad]
constexpr std::size_t kMostPoses = 30;

/// Plans for the paper's actuator before any calibration.
class Planner {
 public:
  PosePlan plan(std::size_t poses,
                std::uint64_t seed,
                double wanted,
                PlanPatterns patterns = PlanPatterns::kSingle) const {
    PlanningProblem problem;
    const std::vector<Sample> none;
    problem.model = &model_;
    problem.held = &none;
    problem.state = nominalState(model_.space(), {});
    PosePlanOptions options;
    options.max_poses = poses;
    options.tilt_limit = kTilt;
    options.wanted_stddev = wanted;
    options.seed = seed;
    options.patterns = patterns;
    return planPoses(problem, options);
  }

  /// Largest standard deviation of all parameters by the protocol at random poses [rad].
  double protocolStddev(std::uint64_t seed) const {
    scenarios::Generator generator(seed);
    const std::vector<Sample> samples =
        scenarios::randomSession(scenarios::paperNominal(), generator);
    const Eigen::VectorXd x = Eigen::VectorXd::Zero(model_.space().size());
    std::vector<Eigen::Index> all(static_cast<std::size_t>(x.size()));
    std::iota(all.begin(), all.end(), 0);
    const Eigen::MatrixXd covariance = cramerRaoBound(model_, samples, {Cycle::kRefine}, all, x);
    return model_.space().reportedStddevs(x, covariance).maxCoeff();
  }

 private:
  CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// 10 poses and 60 torques of patterns of several coils.
void printPatterns(const Planner& planner) {
  std::vector<double> planned;
  std::vector<double> gaps;
  double longest = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto begin = std::chrono::steady_clock::now();
    const PosePlan plan = planner.plan(10, seed, 0.0, PlanPatterns::kWeighing);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    longest = std::max(longest, time.count());
    planned.push_back(plan.worst_stddev);
    gaps.push_back(100.0 * (plan.worst_stddev / plan.stddev_bound.value_or(1e-9) - 1.0));
  }
  const auto worst = [](const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  };
  std::printf("several coils at once, median [mrad]\t%.4f\n", 1e3 * median(planned));
  std::printf("several coils at once, worst [mrad]\t%.4f\n", 1e3 * worst(planned));
  std::printf("above the bound, median [%%]\t%.1f\n", median(gaps));
  std::printf("above the bound, worst [%%]\t%.1f\n", worst(gaps));
  std::printf("longest planning of several coils at once [s]\t%.2f\n", longest);
}

void printFigures() {
  const Planner planner;
  std::vector<double> protocol;
  std::vector<double> planned;
  int better = 0;
  double longest = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    protocol.push_back(planner.protocolStddev(seed));
    const auto begin = std::chrono::steady_clock::now();
    const PosePlan plan = planner.plan(10, seed, 0.0);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    longest = std::max(longest, time.count());
    planned.push_back(plan.worst_stddev);
    const bool within = plan.success && plan.poses.size() <= 10 && plan.torque_samples <= 60;
    better += within && planned.back() < protocol.back() ? 1 : 0;
  }
  std::printf("protocol median [mrad]\t%.3f\n", 1e3 * median(protocol));
  std::printf("protocol best [mrad]\t%.3f\n",
              1e3 * *std::min_element(protocol.begin(), protocol.end()));
  std::printf("10 poses, 60 torques, median [mrad]\t%.3f\n", 1e3 * median(planned));
  std::printf("10 poses, 60 torques, worst [mrad]\t%.3f\n",
              1e3 * *std::max_element(planned.begin(), planned.end()));
  std::printf("planned better, of %d seeds\t%d\n", static_cast<int>(kSeeds), better);
  std::printf("longest planning [s]\t%.2f\n", longest);
  for (std::size_t poses = 3; poses <= kMostPoses; ++poses) {
    if (planner.plan(poses, 1, 0.0).worst_stddev <= median(protocol)) {
      std::printf("fewest poses that reach the protocol's median\t%zu\n", poses);
      break;
    }
  }
  printPatterns(planner);
  const PosePlan wanted = planner.plan(kMostPoses, 1, kWanted);
  std::printf("poses for 0.2 mrad\t%zu\n", wanted.poses.size());
  std::printf("torques for 0.2 mrad\t%zu\n", wanted.torque_samples);
  std::printf("0.2 mrad reached [mrad]\t%.3f\n", 1e3 * wanted.worst_stddev);
}

}  // namespace
}  // namespace sac::benchmarks

int main() {
  sac::benchmarks::printFigures();
  return 0;
}
