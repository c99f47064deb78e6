#include <vector>

#include <gtest/gtest.h>

#include "estimation/example_whitening.hpp"
#include "support/autodiff_costs.hpp"
#include "support/ceres_costs.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

using ThreeRows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

/// Residual and Jacobians of a cost function side by side, at blocks of coordinates.
ThreeRows evaluated(const ceres::CostFunction& cost, const std::vector<const double*>& blocks) {
  std::vector<ThreeRows> jacobians;
  for (const int size : cost.parameter_block_sizes()) {
    jacobians.emplace_back(3, size);
  }
  std::vector<double*> pointers;
  pointers.reserve(jacobians.size());
  for (ThreeRows& jacobian : jacobians) {
    pointers.push_back(jacobian.data());
  }
  Eigen::Vector3d residual;
  EXPECT_TRUE(cost.Evaluate(blocks.data(), residual.data(), pointers.data()));
  ThreeRows all = residual;
  for (const ThreeRows& jacobian : jacobians) {
    ThreeRows wider(3, all.cols() + jacobian.cols());
    wider << all, jacobian;
    all = wider;
  }
  return all;
}

TEST(AnalyticJacobian, OfTheOrientationAgreesWithAutomaticDifferentiation) {
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  scenarios::Generator generator(31);
  const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(50, 0.6, generator);
  for (const Sample& sample :
       scenarios::orientationSamples(scenarios::paperTruth(), poses, 0.5, 1e-3, generator)) {
    const Eigen::VectorXd x = model.space().coordinatesOf(
        scenarios::perturbed(scenarios::paperNominal(), 0.2, 0.0, generator));
    const OrientationCost analytic(model, sample, someWhitening());
    const autodiff::OrientationCost reference(
        new autodiff::OrientationResidual(model, sample, someWhitening()));
    EXPECT_LT((evaluated(analytic, {x.data()}) - evaluated(reference, {x.data()})).norm(), 1e-12);
  }
}

TEST(AnalyticJacobian, OfTheTorqueAgreesWithAutomaticDifferentiationOverTheWholeCurve) {
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space = model.space();
  scenarios::Generator generator(32);
  const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(300, 0.6, generator);
  for (const Sample& sample :
       scenarios::torqueSamples(scenarios::paperTruth(), poses, 0, 2.0, 0.0, 1e-3, generator)) {
    const Eigen::VectorXd x =
        space.coordinatesOf(scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.03, generator));
    const std::vector<Excitation> excitations = excitedCoils(sample, 0.05);
    const TorqueCost analytic(model, sample, excitations, someWhitening());
    const autodiff::TorqueCost<8> reference(
        new autodiff::TorqueResidual(model, sample, excitations.front(), someWhitening()));
    const std::vector<const double*> blocks{
        x.data(), x.data() + space.pole(0), x.data() + space.coil(0)};
    EXPECT_LT((evaluated(analytic, blocks) - evaluated(reference, blocks)).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace sac
