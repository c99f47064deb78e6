#include "score_sum.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr Eigen::Index kCoordinates = 5;
/// Columns 5, then 6 to 8, then 9 and 10.
std::vector<Eigen::Index> groups() {
  return {0, 1, 1, 1, 4, 4};
}
constexpr Eigen::Index kColumns = 11;

class ScoreSumTest : public ::testing::Test {
 protected:
  double normal() { return normal_(generator_); }

  /// In some of the columns.
  WhitenedObservation observation() {
    WhitenedObservation result;
    result.residual = Eigen::Vector3d::NullaryExpr([&] { return normal(); });
    for (Eigen::Index p = 0; p < kColumns; ++p) {
      if (normal() > -0.3) {
        result.columns.push_back(p);
      }
    }
    result.jacobian = Eigen::Matrix3Xd::NullaryExpr(
        3, static_cast<Eigen::Index>(result.columns.size()), [&] { return normal(); });
    return result;
  }
  SharedLoading loading() {
    return SharedLoading::NullaryExpr([&] { return normal(); });
  }

  /// What is asked for is as in the sum over everything.
  static void expectEqual(const ScoreSum& some, const InformationSum& all) {
    const Eigen::MatrixXd information = all.information();
    const Eigen::Index P = kCoordinates;
    EXPECT_TRUE(some.information().isApprox(information.topLeftCorner(P, P), 1e-12));
    EXPECT_TRUE(some.gradient().isApprox(all.gradient().head(P), 1e-12));
    for (Eigen::Index a = 0; a < kColumns; ++a) {
      EXPECT_TRUE(some.crossed(a).isApprox(information.col(a).head(P), 1e-12)) << a;
      EXPECT_NEAR(some.gradient(a), all.gradient()[a], 1e-12) << a;
      for (Eigen::Index b = 0; b < kColumns; ++b) {
        if (groupOf(a) == groupOf(b)) {
          EXPECT_NEAR(some.between(a, b), information(a, b), 1e-12) << a << ' ' << b;
        }
      }
    }
  }

 private:
  static Eigen::Index groupOf(Eigen::Index column) {
    return column < kCoordinates ? -1 : groups()[static_cast<std::size_t>(column - kCoordinates)];
  }

  std::mt19937 generator_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(ScoreSumTest, IsThatOfAllColumns) {
  ScoreSum some(kCoordinates, groups());
  InformationSum all(kColumns);
  for (int n = 0; n < 20; ++n) {
    const WhitenedObservation one = observation();
    some.add(one, 0.5 + 0.1 * n);
    all.add(one, 0.5 + 0.1 * n);
  }
  expectEqual(some, all);
}

TEST_F(ScoreSumTest, IsThatOfAllColumnsWhereDwellsShareErrors) {
  ScoreSum some(kCoordinates, groups());
  InformationSum all(kColumns);
  DwellSum dwell(kColumns);
  for (int d = 0; d < 4; ++d) {
    dwell.begin();
    for (int n = 0; n < 3; ++n) {
      dwell.add(observation(), loading());
    }
    dwell.addTo(some);
    dwell.addTo(all);
  }
  expectEqual(some, all);
}

}  // namespace
}  // namespace sac
