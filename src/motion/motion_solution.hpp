#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/estimation/unidentified_part.hpp"

namespace sac {

/// Both kinds of terms at one place.
struct MotionSums {
  InformationSum balance{0};
  InformationSum orientation{0};

  Eigen::MatrixXd information() const { return balance.information() + orientation.information(); }
  Eigen::VectorXd gradient() const { return balance.gradient() + orientation.gradient(); }
  double misfit() const { return balance.squaredMisfit() + orientation.squaredMisfit(); }
};

/// The descent from the prior to the solution, coarse first.
class MotionDescent {
 public:
  MotionDescent(const MotionProblem& problem,
                const EstimationOptions& estimation,
                const MotionOptions& options,
                MotionTerms& terms);

  /// Coarsely from the prior, with the delay of the currents that explains most.
  void solveCoarsely();
  /// On from the present place, to the last digit that counts; false where there is no end.
  /// `weigh_anew` looks at noise and outliers at the present place, and tells whether that changed
  /// what counts.
  bool solveFinely(const std::function<bool()>& weigh_anew);

  /// On with terms that serve only now, as they are linearised; false where nothing can be told.
  /// Windows that are summed up are linearised once more: each tells its misfit only then.
  bool settleAnew();

  const Eigen::VectorXd& x() const { return x_; }
  const MotionSums& sums() const { return sums_; }
  const UnidentifiedPart& open() const { return open_; }
  /// Free coordinates without those held whole.
  const std::vector<Eigen::Index>& estimated() const { return estimated_; }
  /// Information of stated effects and of directions that are held, P×P.
  Eigen::MatrixXd priorInformation() const;
  int iterations() const { return iterations_; }
  /// Root mean squares of standardised residuals, before the first and after each iteration.
  const std::vector<double>& errors() const { return errors_; }

 private:
  bool settle(double tolerance);
  double advance(const Eigen::VectorXd& start, const TermOrder& order);
  double lengthOf(const Eigen::VectorXd& change) const;
  void adaptDamping(int halvings);
  void linearizeAt(const Eigen::VectorXd& x, const TermOrder& order);
  void noteError();
  MotionSums sumsAt(const Eigen::VectorXd& x);
  void rescale();
  double cost(const MotionSums& sums) const;
  Eigen::VectorXd step(double damping_of_all);
  Eigen::VectorXd pull() const;
  void judgeOpen();
  void holdOpen(const TermOrder& order);
  Eigen::Index countOpen() const {
    return open_.directions.cols() + static_cast<Eigen::Index>(open_.coordinates.size());
  }

  const MotionProblem& problem_;
  const EstimationOptions& estimation_;
  const MotionOptions& options_;
  MotionTerms& terms_;
  Eigen::VectorXd x_;
  Eigen::VectorXd linearized_at_;
  double damping_ = 0.0;  ///< information of each coordinate in units of the prior's
  MotionSums sums_;
  bool is_fine_ = false;  ///< what is open is no longer pulled
  double open_limit_;     ///< standard deviation of what is open [rad]
  UnidentifiedPart open_;
  std::vector<Eigen::Index> estimated_;
  int iterations_ = 0;
  std::vector<double> errors_;
};

}  // namespace sac
