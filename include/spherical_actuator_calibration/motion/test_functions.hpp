#pragma once

#include <Eigen/Core>

namespace sac {

/// K test functions of a window at one time.
struct TestFunctionValues {
  Eigen::VectorXd value;  ///< φ
  Eigen::VectorXd first;  ///< dφ/dt [1/s]
};

/// How their slopes change there.
struct TestFunctionBends {
  Eigen::VectorXd second;  ///< d²φ/dt² [1/s²]
  Eigen::VectorXd third;   ///< d³φ/dt³ [1/s³]
};

/// The modulating functions of the weak form (doc/motion.md): φ̈_k is the Legendre polynomial P_k,
/// k = 2…K+1, over the window, so that φ and φ̇ vanish at both ends. For white noise of orientations
/// their residuals are nearly uncorrelated.
class TestFunctions {
 public:
  /// Times in [s]; `count` is K ≥ 1.
  TestFunctions(double begin, double end, int count);

  int count() const { return count_; }
  /// Fill `out`, whose storage is reused. `time` in the window.
  void evaluate(double time, TestFunctionValues& out) const;
  void evaluate(double time, TestFunctionBends& out) const;
  /// ∫ φ_2 dt of the first one, which has one sign [s].
  double integralOfFirst() const;

 private:
  double middle_;
  double half_;
  int count_;
};

}  // namespace sac
