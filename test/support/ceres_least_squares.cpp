#include "support/ceres_least_squares.hpp"

#include <memory>

#include <ceres/ceres.h>

namespace sac {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// All coordinates, with the free ones at the values of Ceres' one block.
Eigen::VectorXd coordinatesAt(const LeastSquaresInput& input, const double* block) {
  Eigen::VectorXd x = input.start;
  x(input.free) = Eigen::Map<const Eigen::VectorXd>(block, static_cast<int>(input.free.size()));
  return x;
}

/// Rows of residuals as functions of the free coordinates.
class Cost : public ceres::CostFunction {
 public:
  Cost(const LeastSquaresInput& input, Eigen::Index rows) : input_(input) {
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(input.free.size()));
  }

 protected:
  template <typename Jacobian>
  void write(const Jacobian& jacobian, double** jacobians) const {
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      const auto columns = static_cast<Eigen::Index>(input_.free.size());
      Eigen::Map<RowMajor>(jacobians[0], num_residuals(), columns) =
          jacobian(Eigen::all, input_.free);
    }
  }

  const LeastSquaresInput& input_;
};

class ObservationCost final : public Cost {
 public:
  ObservationCost(const LeastSquaresInput& input, std::size_t observation)
      : Cost(input, 3), observation_(observation) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::Matrix3d W = (*input_.whitening)[observation_];
    LinearizedObservation linear;
    const ModelPoint point = input_.evaluator->at(coordinatesAt(input_, blocks[0]));
    input_.evaluator->linearize(observation_, point, linear);
    Eigen::Map<Eigen::Vector3d> whitened(residuals);
    whitened = W * linear.residual;
    write((W * linear.jacobian).eval(), jacobians);
    return true;
  }

 private:
  std::size_t observation_;
};

class PriorCost final : public Cost {
 public:
  explicit PriorCost(const LeastSquaresInput& input) : Cost(input, input.prior.mean.size()) {
    const Eigen::MatrixXd lower = input.prior.covariance.llt().matrixL();
    const auto whitening = lower.triangularView<Eigen::Lower>();
    directions_ = whitening.solve(input.prior.directions.transpose());
    mean_ = whitening.solve(input.prior.mean);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> whitened(residuals, mean_.size());
    whitened = directions_ * coordinatesAt(input_, blocks[0]) - mean_;
    write(directions_, jacobians);
    return true;
  }

 private:
  Eigen::MatrixXd directions_;
  Eigen::VectorXd mean_;
};

ceres::LossFunction* makeLoss(const LeastSquaresInput& input) {
  switch (input.loss) {
    case Loss::kHuber:
      return new ceres::HuberLoss(input.loss_transition);
    case Loss::kCauchy:
      return new ceres::CauchyLoss(input.loss_transition);
    case Loss::kSquared:
      break;
  }
  return nullptr;
}

}  // namespace

LeastSquaresResult solveWithCeres(const LeastSquaresInput& input) {
  Eigen::VectorXd block = input.start(input.free);
  ceres::Problem problem;
  for (std::size_t n = 0; n < input.active.size(); ++n) {
    if (input.active[n]) {
      problem.AddResidualBlock(new ObservationCost(input, n), makeLoss(input), block.data());
    }
  }
  if (input.prior.directions.cols() > 0) {
    problem.AddResidualBlock(new PriorCost(input), nullptr, block.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = input.max_iterations;
  options.initial_trust_region_radius = 1e8;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  LeastSquaresResult result;
  result.path = {input.start, coordinatesAt(input, block.data())};
  result.solve_time = summary.total_time_in_seconds;
  if (summary.termination_type == ceres::CONVERGENCE) {
    result.termination = Termination::kConverged;
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    result.termination = Termination::kIterationLimit;
  }
  return result;
}

}  // namespace sac
