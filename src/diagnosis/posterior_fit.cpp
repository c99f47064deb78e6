#include "posterior_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "torque_scale.hpp"

namespace sac {
namespace {

constexpr int kMostIterations = 8;
constexpr int kMostHalvings = 4;
constexpr double kEnough = 0.05;         // of the log posterior between two iterations [nats]
constexpr double kDifference = 1e-5;     // step of numeric derivatives by continuous values
constexpr double kUnknownEffect = 10.0;  // times the usual size of an effect
constexpr double kFlatPrecision = 1e-6;  // of continuous values, so that the system stays regular

/// Observations of one stream of one case, linearised.
struct Linearization {
  std::vector<LinearizedObservation> observations;
  std::vector<Eigen::Matrix3d> whitening;
  double log_noise = 0.0;  ///< Σ ½ log det
};

Actuator onlyJoints(Actuator actuator) {
  actuator.poles.clear();
  actuator.coils.clear();
  actuator.torque_curve.reset();
  return actuator;
}

/// One candidate against one stream.
class Fit {
 public:
  Fit(const WiringCase& described,
      const Candidate& candidate,
      FittedStream stream,
      const CalibrationConfig& config,
      const ModelAllowance& allowance,
      const EffectSelection& effects)
      : described_(described),
        candidate_(candidate),
        stream_(stream),
        config_(config),
        allowance_(allowance),
        effects_(effects) {}

  PosteriorFit run(const std::optional<Eigen::VectorXd>& start) {
    PosteriorFit best;
    best.values = startOf(candidate_);
    linearize(start, best);
    if (linear_.observations.empty()) {
      return best;
    }
    judge(best);
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      const double before = best.log_posterior;
      if (!improve(best) || best.log_posterior - before < kEnough) {
        break;
      }
    }
    return best;
  }

  Eigen::MatrixXd covarianceAt(PosteriorFit fit) {
    linearize(std::nullopt, fit);
    return Cholesky(informationAt(fit).information()).inverse();
  }

 private:
  CalibrationModel modelOf(const WiringCase& mended) const {
    return CalibrationModel(ParameterSpace(
        stream_ == FittedStream::kOrientations ? onlyJoints(mended.actuator) : mended.actuator,
        effects_));
  }

  /// Of an effect nothing is known beforehand unless it is stated: it is what is asked.
  CalibrationState nominalOf(const ParameterSpace& space) const {
    CalibrationState nominal = nominalState(space, config_.tolerance);
    for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
      if (space.effects().statedVariance(p - space.effect()) == 0.0) {
        nominal.belief.covariance(p, p) *= kUnknownEffect * kUnknownEffect;
      }
    }
    return nominal;
  }

  void linearize(const std::optional<Eigen::VectorXd>& start, PosteriorFit& fit) {
    const WiringCase mended = corrected(described_, candidate_, fit.values);
    const CalibrationModel model = modelOf(mended);
    const CalibrationState nominal = nominalOf(model.space());
    if (fit.x.size() == 0) {
      const bool fits = start && start->size() == model.space().size();
      fit.x = fits ? *start : nominal.belief.x;
    }
    precision_ = nominal.belief.covariance.diagonal().cwiseMax(1e-12).cwiseInverse();
    evaluate(model, mended, nominal.belief, fit.x, true, linear_);
    differentiateValues(fit);
  }

  /// Numeric derivatives of all residuals by the continuous values.
  void differentiateValues(const PosteriorFit& fit) {
    d_values_.assign(linear_.observations.size(), Eigen::Matrix3Xd(3, fit.values.size()));
    for (Eigen::Index v = 0; v < fit.values.size(); ++v) {
      Eigen::VectorXd shifted = fit.values;
      const double step = kDifference * std::max(1.0, std::abs(shifted[v]));
      shifted[v] += step;
      const WiringCase mended = corrected(described_, candidate_, shifted);
      const CalibrationModel model = modelOf(mended);
      Linearization moved;
      evaluate(model, mended, nominalOf(model.space()).belief, fit.x, false, moved);
      for (std::size_t n = 0; n < d_values_.size(); ++n) {
        d_values_[n].col(v) =
            (moved.observations[n].residual - linear_.observations[n].residual) / step;
      }
    }
  }

  std::vector<Observation> observationsOf(const std::vector<Sample>& samples) const {
    std::vector<Observation> observations;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      if (stream_ != FittedStream::kTorques && described_.actuator.has_joints &&
          samples[n].has_orientation) {
        observations.push_back({n, Quantity::kOrientation});
      }
      if (stream_ != FittedStream::kOrientations && samples[n].has_torque &&
          described_.actuator.hasTorqueModel()) {
        observations.push_back({n, Quantity::kTorque});
      }
    }
    return observations;
  }

  void evaluate(const CalibrationModel& model,
                const WiringCase& mended,
                const ParameterBelief& prior,
                const Eigen::VectorXd& x,
                bool with_jacobian,
                Linearization& out) const {
    EstimationProblem problem;
    problem.model = &model;
    problem.samples = &mended.samples;
    problem.prior = prior;
    problem.observations = observationsOf(mended.samples);
    const ObservationEvaluator evaluator(problem, config_.estimation);
    const ModelPoint point = evaluator.at(x);
    out.observations.resize(problem.observations.size());
    out.whitening.clear();
    out.log_noise = 0.0;
    const double large_torque =
        with_jacobian ? largeTorque(mended.samples, config_.estimation.default_torque_stddev) : 0.0;
    for (std::size_t n = 0; n < problem.observations.size(); ++n) {
      LinearizedObservation& linear = out.observations[n];
      if (!with_jacobian) {
        linear.residual = evaluator.residual(n, point);
        continue;
      }
      evaluator.linearize(n, point, linear);
      Eigen::Matrix3d noise = evaluator.noise(n, linear);
      const double allowance = problem.observations[n].quantity == Quantity::kOrientation
                                   ? allowance_.orientation
                                   : allowance_.torque * large_torque;
      noise.diagonal().array() += allowance * allowance;
      out.whitening.push_back(whiteningOf(noise));
      out.log_noise -= out.whitening.back().diagonal().array().log().sum();
    }
  }

  /// Log posterior at the linearised point, with its most probable scale.
  void judge(PosteriorFit& fit) const {
    std::vector<double>& misfits = fit.squared_misfits;
    misfits.clear();
    for (std::size_t n = 0; n < linear_.observations.size(); ++n) {
      misfits.push_back(squaredMisfit(n));
    }
    const auto count = static_cast<double>(misfits.size());
    double variance = 1.0;
    constexpr int kScaleIterations = 30;
    for (int i = 0; i < kScaleIterations; ++i) {
      double sum = 0.0;
      for (const double misfit : misfits) {
        sum += weight(misfit / variance) * misfit;
      }
      variance = std::max(1.0, sum / (3.0 * count));
    }
    fit.scale = std::sqrt(variance);
    double loss = 1.5 * count * std::log(variance) + linear_.log_noise;
    for (const double misfit : misfits) {
      loss += studentLoss(misfit / variance);
    }
    loss -= 3.0 * count * std::log(std::abs(torqueFactor(candidate_, fit.values)));
    fit.log_likelihood = -loss;
    fit.log_posterior = -loss - 0.5 * fit.x.dot(precision_.cwiseProduct(fit.x));
  }

  static double weight(double squared_misfit) {
    return (kStudentFreedom + 3.0) / (kStudentFreedom + squared_misfit);
  }

  double squaredMisfit(std::size_t n) const {
    return (linear_.whitening[n] * linear_.observations[n].residual).squaredNorm();
  }

  /// One Gauss–Newton step, shortened until it helps. False: none helped.
  bool improve(PosteriorFit& fit) {
    const Eigen::VectorXd step = this->step(fit);
    PosteriorFit trial;
    double length = 1.0;
    for (int halving = 0; halving < kMostHalvings; ++halving, length *= 0.5) {
      trial.x = fit.x + length * step.head(fit.x.size());
      trial.values = fit.values + length * step.tail(fit.values.size());
      linearize(std::nullopt, trial);
      judge(trial);
      if (trial.log_posterior > fit.log_posterior) {
        fit = trial;
        return true;
      }
    }
    return false;
  }

  Eigen::VectorXd step(const PosteriorFit& fit) const {
    const InformationSum sum = informationAt(fit);
    Eigen::VectorXd gradient = sum.gradient();
    gradient.head(fit.x.size()) += precision_.cwiseProduct(fit.x);
    return -Cholesky(sum.information()).solve(gradient);
  }

  /// Of the linearised observations, with what is known beforehand.
  InformationSum informationAt(const PosteriorFit& fit) const {
    const Eigen::Index size = fit.x.size();
    const Eigen::Index total = size + fit.values.size();
    Eigen::VectorXd precision(total);
    precision << precision_, Eigen::VectorXd::Constant(fit.values.size(), kFlatPrecision);
    InformationSum sum(Eigen::MatrixXd(precision.asDiagonal()));
    const ChosenCoordinates coordinates = ChosenCoordinates::all(size);
    const double variance = fit.scale * fit.scale;
    WhitenedObservation whitened;
    whitened.jacobian.resize(3, total);
    for (std::size_t n = 0; n < linear_.observations.size(); ++n) {
      whiten(linear_.observations[n], linear_.whitening[n], coordinates, whitened);
      appendValues(n, size, whitened);
      sum.add(whitened, weight(whitened.residual.squaredNorm() / variance) / variance);
    }
    return sum;
  }

  /// The continuous values stand behind the coordinates.
  void appendValues(std::size_t n, Eigen::Index size, WhitenedObservation& whitened) const {
    for (Eigen::Index v = 0; v < d_values_[n].cols(); ++v) {
      whitened.jacobian.col(static_cast<Eigen::Index>(whitened.columns.size())) =
          linear_.whitening[n] * d_values_[n].col(v);
      whitened.columns.push_back(size + v);
    }
  }

  const WiringCase& described_;
  const Candidate& candidate_;
  const FittedStream stream_;
  const CalibrationConfig& config_;
  const ModelAllowance& allowance_;
  const EffectSelection& effects_;
  Eigen::VectorXd precision_;
  Linearization linear_;
  std::vector<Eigen::Matrix3Xd> d_values_;
};

}  // namespace

double gainByChance(Eigen::Index values) {
  constexpr double kFalseAlarm = 1e-6;    // of a faultless session
  constexpr double kHypotheses = 1000.0;  // order of their number
  const double level = kFalseAlarm / kHypotheses;
  if (values == 0) {
    return -std::log(level);
  }
  return 0.5 * chiSquareLimit(static_cast<double>(values), level);
}

bool isStrained(const PosteriorFit& fit) {
  constexpr double kMisfit = 1.5;
  constexpr double kChance = 1e-4;
  const double bent = fit.log_likelihood - fit.log_posterior;
  return fit.scale > kMisfit ||
         bent > 0.5 * chiSquareLimit(static_cast<double>(fit.x.size()), kChance);
}

bool leavesMany(const PosteriorFit& fit) {
  constexpr double kFarOff = 100.0;
  constexpr double kMany = 0.1;
  const auto many = std::count_if(fit.squared_misfits.begin(),
                                  fit.squared_misfits.end(),
                                  [](double misfit) { return misfit > kFarOff; });
  return static_cast<double>(many) > kMany * static_cast<double>(fit.squared_misfits.size());
}

double studentLoss(double squared_misfit) {
  return 0.5 * (kStudentFreedom + 3.0) * std::log1p(squared_misfit / kStudentFreedom);
}

PosteriorFit fitPosterior(const WiringCase& described,
                          const Candidate& candidate,
                          FittedStream stream,
                          const CalibrationConfig& config,
                          const ModelAllowance& allowance,
                          const std::optional<Eigen::VectorXd>& start,
                          const EffectSelection& effects) {
  return Fit(described, candidate, stream, config, allowance, effects).run(start);
}

Eigen::MatrixXd posteriorCovariance(const WiringCase& described,
                                    const Candidate& candidate,
                                    FittedStream stream,
                                    const CalibrationConfig& config,
                                    const ModelAllowance& allowance,
                                    const EffectSelection& effects,
                                    const PosteriorFit& fit) {
  return Fit(described, candidate, stream, config, allowance, effects).covarianceAt(fit);
}

}  // namespace sac
