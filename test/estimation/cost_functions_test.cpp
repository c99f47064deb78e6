#include <vector>

#include <gtest/gtest.h>

#include "estimation/example_whitening.hpp"
#include "support/ceres_costs.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Residual, and on request the Jacobians, of a cost function at its blocks.
Eigen::VectorXd evaluate(const ceres::CostFunction& cost,
                         const std::vector<Eigen::VectorXd>& blocks,
                         std::vector<RowMajor>* jacobians = nullptr) {
  std::vector<const double*> parameters(blocks.size());
  std::vector<double*> d_blocks(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    parameters[b] = blocks[b].data();
    d_blocks[b] = jacobians != nullptr ? (*jacobians)[b].data() : nullptr;
  }
  Eigen::VectorXd residual(3);
  cost.Evaluate(
      parameters.data(), residual.data(), jacobians != nullptr ? d_blocks.data() : nullptr);
  return residual;
}

/// Largest deviation of a cost function's Jacobians from numeric ones.
double jacobianError(const ceres::CostFunction& cost, const std::vector<Eigen::VectorXd>& blocks) {
  std::vector<RowMajor> jacobians(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    jacobians[b].resize(3, blocks[b].size());
  }
  EXPECT_LT((evaluate(cost, blocks, &jacobians) - evaluate(cost, blocks)).norm(), 1e-15);
  double worst = 0.0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto residual = [&](const Eigen::VectorXd& moved) {
      std::vector<Eigen::VectorXd> at = blocks;
      at[b] = moved;
      return evaluate(cost, at);
    };
    const Eigen::MatrixXd error = jacobians[b] - numericJacobian(residual, blocks[b]);
    worst = std::max(worst, error.cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(OrientationCost, JacobianIsTheDerivativeAlsoFarFromTheSolution) {
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  scenarios::Generator generator(5);
  std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(10, 0.6, generator);
  // One radian of noise: the residual's own Jacobian J_r⁻¹(y) counts.
  for (const Sample& sample :
       scenarios::orientationSamples(scenarios::paperTruth(), poses, 1.0, 1e-3, generator)) {
    const OrientationCost cost(model, sample, someWhitening());
    const Eigen::VectorXd joints =
        model.space()
            .coordinatesOf(scenarios::perturbed(scenarios::paperNominal(), 0.2, 0.0, generator))
            .head(9);
    EXPECT_LT(jacobianError(cost, {joints}), 1e-8);
  }
}

TEST(TorqueCost, JacobianIsTheDerivativeForSeveralCoilsAtOnce) {
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space = model.space();
  scenarios::Generator generator(6);
  const std::vector<Eigen::Vector3d> poses =
      scenarios::posesThatSeeEveryPole(scenarios::paperNominal(), 0, 8, 0.3, generator);
  std::vector<Sample> samples =
      scenarios::torqueSamples(scenarios::paperTruth(), poses, 0, 2.0, 0.0, 1e-3, generator);
  for (Sample& sample : samples) {
    sample.current[13] = -1.5;
    sample.current[5] = 0.7;
    const std::vector<Excitation> excitations = excitedCoils(sample, 0.05);
    ASSERT_EQ(excitations.size(), 3u);
    const TorqueCost cost(model, sample, excitations, someWhitening());
    const Eigen::VectorXd x =
        space.coordinatesOf(scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator));
    std::vector<Eigen::VectorXd> blocks{x.head(9), x.segment(9, 16)};
    for (const Excitation& excitation : excitations) {
      blocks.emplace_back(x.segment<2>(space.coil(excitation.coil)));
    }
    // The curve's second derivative jumps at its blends; numeric differences across one are off.
    EXPECT_LT(jacobianError(cost, blocks), 2e-5);
  }
}

TEST(TorqueCost, GainsOfTheDescriptionScaleItsJacobian) {
  Actuator nominal = scenarios::paperNominal();
  nominal.coils[0].gain = 1.1;
  nominal.poles[2].gain = 0.9;
  const CalibrationModel model{ParameterSpace(nominal)};
  scenarios::Generator generator(8);
  const std::vector<Eigen::Vector3d> poses =
      scenarios::posesThatSeeEveryPole(nominal, 0, 8, 0.3, generator);
  for (const Sample& sample :
       scenarios::torqueSamples(nominal, poses, 0, 2.0, 0.0, 1e-3, generator)) {
    const std::vector<Excitation> excitations = excitedCoils(sample, 0.05);
    const TorqueCost cost(model, sample, excitations, Eigen::Matrix3d::Identity());
    EXPECT_LT(
        jacobianError(
            cost, {Eigen::VectorXd::Zero(9), Eigen::VectorXd::Zero(16), Eigen::VectorXd::Zero(2)}),
        2e-5);
  }
}

}  // namespace
}  // namespace sac
