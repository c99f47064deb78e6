#include "stream_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kReadings = 3;  // the first of the shared errors

/// Rows of one stream: whitened residuals and what they lose to shared errors.
struct StreamMisfits {
  explicit StreamMisfits(Eigen::Index size) : sum(size) {}

  InformationSum sum;
  double values = 0.0;  ///< less what shared errors take up
};

/// Sums up over observations whose shared errors are unknowns of their own: then the noise of all
/// rows is independent, those of the shared errors themselves included.
class NoiseSums {
 public:
  NoiseSums(const EstimationProblem& problem,
            const Estimate& estimate,
            const EstimationOptions& options)
      : problem_(problem),
        estimate_(estimate),
        evaluator_(problem, options),
        point_(evaluator_.at(estimate.belief.x)),
        shared_(groupByDwell(problem, options)),
        all_(ChosenCoordinates::all(problem.model->space().size())),
        orientations_(all_.size()),
        torques_(all_.size()),
        readings_(all_.size()),
        crossed_(kSharedErrors, all_.size()) {
    addAll();
  }

  const StreamMisfits& orientations() const { return orientations_; }
  const StreamMisfits& torques() const { return torques_; }
  const StreamMisfits& readings() const { return readings_; }

 private:
  void addAll() {
    constexpr std::size_t kMost = 2000;  // tells noise to a few percent
    const std::size_t every = 1 + problem_.observations.size() / kMost;
    std::size_t unit = 0;
    for (const std::vector<std::size_t>& dwell : shared_.dwells) {
      if (unit++ % every == 0) {
        addDwell(dwell);
      }
    }
    for (std::size_t n = 0; n < problem_.observations.size(); ++n) {
      if (!shared_.shares[n] && unit++ % every == 0) {
        addAlone(n);
      }
    }
  }

  StreamMisfits& streamOf(std::size_t n) {
    return problem_.observations[n].quantity == Quantity::kOrientation ? orientations_ : torques_;
  }

  void addAlone(std::size_t n) {
    if (estimate_.residuals[n].rejected) {
      return;
    }
    evaluator_.linearize(n, point_, linear_);
    whiten(linear_, whiteningOf(evaluator_.noise(n, linear_)), all_, whitened_);
    streamOf(n).sum.add(whitened_);
    streamOf(n).values += 3.0;
  }

  struct Row {
    std::size_t observation;
    WhitenedObservation whitened;
    SharedLoading loading;
  };

  void addDwell(const std::vector<std::size_t>& dwell) {
    std::vector<Row> rows;
    DwellElimination elimination;
    crossed_.setZero();
    std::vector<Eigen::Index> touched;
    for (const std::size_t n : dwell) {
      if (estimate_.residuals[n].rejected) {
        continue;
      }
      evaluator_.linearize(n, point_, linear_);
      const Eigen::Matrix3d whitening = whiteningOf(evaluator_.ownNoise(n, linear_));
      whiten(linear_, whitening, all_, whitened_);
      rows.push_back({n, whitened_, whitening * evaluator_.sharedErrors(n, linear_)});
      elimination.add(rows.back().loading, whitened_.residual);
      for (std::size_t k = 0; k < whitened_.columns.size(); ++k) {
        crossed_.col(whitened_.columns[k]).noalias() +=
            rows.back().loading.transpose() * whitened_.jacobian.col(static_cast<Eigen::Index>(k));
      }
      touched.insert(touched.end(), whitened_.columns.begin(), whitened_.columns.end());
    }
    if (rows.empty()) {
      return;
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    const SharedErrors errors = elimination.errors();
    const Eigen::Matrix<double, kSharedErrors, kSharedErrors> left = elimination.covariance();
    const Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic> moved = left * crossed_;
    for (const Row& row : rows) {
      addRow(row, touched, errors, moved, left);
    }
    readings_.sum.addDense(moved.topRows<kReadings>(), errors.head<kReadings>());
    readings_.values += static_cast<double>(kReadings) - left.topLeftCorner<3, 3>().trace();
  }

  /// A row once the shared errors took of it what they explain. `touched`: columns of its dwell.
  void addRow(const Row& row,
              const std::vector<Eigen::Index>& touched,
              const SharedErrors& errors,
              const Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic>& moved,
              const Eigen::Matrix<double, kSharedErrors, kSharedErrors>& left) {
    WhitenedObservation rest;
    rest.residual = row.whitened.residual - row.loading * errors;
    rest.columns = touched;
    rest.jacobian.resize(3, static_cast<Eigen::Index>(touched.size()));
    std::size_t own = 0;
    for (std::size_t k = 0; k < touched.size(); ++k) {
      auto column = rest.jacobian.col(static_cast<Eigen::Index>(k));
      column = -row.loading * moved.col(touched[k]);
      if (own < row.whitened.columns.size() && row.whitened.columns[own] == touched[k]) {
        column += row.whitened.jacobian.col(static_cast<Eigen::Index>(own++));
      }
    }
    StreamMisfits& stream = streamOf(row.observation);
    stream.sum.add(rest);
    stream.values += 3.0 - (row.loading * left * row.loading.transpose()).trace();
  }

  const EstimationProblem& problem_;
  const Estimate& estimate_;
  ObservationEvaluator evaluator_;
  ModelPoint point_;
  SharedErrorModel shared_;
  ChosenCoordinates all_;
  StreamMisfits orientations_;
  StreamMisfits torques_;
  StreamMisfits readings_;
  // Storage that is reused.
  LinearizedObservation linear_;
  WhitenedObservation whitened_;
  Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic> crossed_;
};

}  // namespace

std::vector<StreamNoise> streamNoise(const EstimationProblem& problem,
                                     const Estimate& estimate,
                                     const EstimationOptions& options) {
  const NoiseSums sums(problem, estimate, options);
  // By the noise as stated.
  const Eigen::MatrixXd covariance =
      estimate.belief.covariance / (estimate.covariance_scale * estimate.covariance_scale);
  const auto of = [&](const char* name, const StreamMisfits& stream) {
    return StreamNoise{name,
                       stream.sum.squaredMisfit(),
                       stream.values - stream.sum.information().cwiseProduct(covariance).sum()};
  };
  const bool has_joints = problem.model->space().joints() > 0;
  return {of("orientations", sums.orientations()),
          of("torques", sums.torques()),
          of(has_joints ? "readings of the joints" : "orientations", sums.readings())};
}

std::vector<std::string> noiseInWords(const std::vector<StreamNoise>& streams, bool has_map) {
  constexpr double kChance = 1e-5;  // in each direction of each stream
  constexpr double kLarge = 1.15;   // of 95 % of the intervals 91 % would hold
  constexpr double kSmall = 0.5;
  constexpr double kLeastFreedom = 3.0;
  constexpr double kExact = 1e-6;  // without noise nothing is told of it
  std::vector<std::string> words;
  for (const StreamNoise& stream : streams) {
    if (stream.freedom < kLeastFreedom) {
      continue;
    }
    const double factor = std::sqrt(std::max(0.0, stream.squares) / stream.freedom);
    const double larger = chiSquareProbability(stream.freedom, stream.squares);
    if (factor > kLarge && larger < kChance) {
      words.push_back(
          format("The %s scatter by %.2g times what their samples state (by chance: %.1g), so that "
                 "weights and uncertainties are wrong: state their noise as it is.",
                 stream.name.c_str(),
                 factor,
                 std::max(larger, 1e-300)));
    } else if (!has_map && factor < kSmall && factor > kExact && 1.0 - larger < kChance) {
      words.push_back(
          format("The %s scatter by only %.2g times what their samples state: uncertainties are "
                 "too large, and errors may hide below the stated noise. State it as it is.",
                 stream.name.c_str(),
                 factor));
    }
  }
  return words;
}

}  // namespace sac
