#include "spherical_actuator_calibration/motion/motion_estimator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "current_steps.hpp"
#include "motion_outliers.hpp"
#include "motion_probe.hpp"
#include "motion_solution.hpp"
#include "motion_terms.hpp"
#include "noise_factors.hpp"
#include "residual_alignment.hpp"
#include "residual_pace.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/joint_chi_square.hpp"
#include "spherical_actuator_calibration/estimation/misfit.hpp"
#include "steady_torque.hpp"
#include "tracker_colour.hpp"

namespace sac {
namespace {

/// The steps of one estimation from motion.
class Estimator {
 public:
  Estimator(const MotionProblem& problem,
            const EstimationOptions& estimation,
            const MotionOptions& options)
      : problem_(problem),
        estimation_(estimation),
        options_(options),
        terms_(problem, options),
        descent_(problem, estimation, options, terms_) {}

  MotionEstimate run();

 private:
  bool solve();
  bool solveFinely();
  bool leaveSaturated();
  bool leavePushed();
  bool fits() const;
  bool widenTracker();
  bool takeHeldOut();
  bool weighAnew();
  std::size_t activeWindows() const;
  double windowFreedom() const;
  double windowSquares() const;
  void judgeMisfit();
  void findCovariance();
  void judgeHeldOut();
  ObservationResidual residualOf(std::size_t window) const;
  HeldOutMotion countHeldOut();
  void listResiduals();
  void summarise();

  const MotionProblem& problem_;
  const EstimationOptions& estimation_;
  const MotionOptions& options_;
  MotionTerms terms_;
  MotionDescent descent_;
  NoiseFactors factors_;
  MotionEstimate result_;
};

std::size_t Estimator::activeWindows() const {
  const std::vector<WindowTerm>& windows = terms_.windows();
  return static_cast<std::size_t>(std::count_if(
      windows.begin(), windows.end(), [](const WindowTerm& term) { return term.serves(); }));
}

double Estimator::windowFreedom() const {
  const auto values = static_cast<double>(terms_.valuesPerWindow());
  return values * static_cast<double>(activeWindows()) -
         static_cast<double>(descent_.estimated().size());
}

double Estimator::windowSquares() const {
  return terms_.squares(descent_.x());
}

/// Noise and outliers at the present solution; whether that changes anything that counts.
bool Estimator::weighAnew() {
  constexpr double kLikelier = 1.0;  // as a χ²: what chance makes where the model fits
  const double values =
      static_cast<double>(terms_.valuesPerWindow()) * static_cast<double>(activeWindows());
  const double share = std::max(0.1, windowFreedom() / values);
  const std::vector<NoiseEvidence> evidence = terms_.noiseEvidence();
  const NoiseFactors& chance = terms_.noise().chance;
  const NoiseFactors factors = likelyFactors(evidence, chance, share);
  const double misfit = std::max(1.0, windowSquares() / std::max(1.0, windowFreedom()));
  const bool changes = likelierBy(factors, factors_, evidence, chance, share) > kLikelier * misfit;
  if (changes) {
    factors_ = factors;
    terms_.setNoiseFactors(factors.joints, factors.currents);
  }
  return rejectOutliers(terms_, estimation_.false_alarm_probability) || changes;
}

bool Estimator::solve() {
  if (problem_.start.size() == 0) {
    descent_.solveCoarsely();
  }
  terms_.findTrackerNoise(descent_.x());
  return solveFinely();
}

bool Estimator::solveFinely() {
  return descent_.solveFinely([this] { return weighAnew(); });
}

/// As many windows as tell all that is asked are left.
bool Estimator::leaveSaturated() {
  const auto values = static_cast<std::size_t>(terms_.valuesPerWindow());
  return !leaveCutOff(terms_, 1 + 2 * problem_.free.size() / values) || solveFinely();
}

/// Whether the misfit of what serves is that of noise.
bool Estimator::fits() const {
  const double freedom = windowFreedom();
  return freedom > 0.0 && !isMisfit(windowSquares(), freedom);
}

/// Without the windows over which something small held the rotor for long, where the others then
/// fit: where they do not, the model lacks something, and that must show. So it must where most
/// windows would be left out: they may be the ones that nothing held.
bool Estimator::leavePushed() {
  constexpr int kMostRuns = 4;
  // What fits so badly no run of windows explains: a push that large makes outliers of them.
  constexpr double kHopeless = 9.0;
  if (windowSquares() > kHopeless * windowFreedom()) {
    return true;
  }
  std::vector<WindowTerm>& windows = terms_.windows();
  const auto all = std::count_if(
      windows.begin(), windows.end(), [](const WindowTerm& term) { return !term.held_out; });
  const std::size_t half = static_cast<std::size_t>(all) / 2;
  bool any = false;
  bool solved = true;
  for (int n = 0; n < kMostRuns && solved; ++n) {
    const std::optional<WindowRun> run = steadilyPushed(terms_);
    if (!run) {
      break;
    }
    for (std::size_t k = run->first; k < run->first + run->count; ++k) {
      windows[k].is_pushed = true;
    }
    any = true;
    solved = solveFinely();
  }
  if (!any || (solved && fits() && activeWindows() > half)) {
    return true;
  }
  for (WindowTerm& term : windows) {
    term.is_pushed = false;
  }
  return solveFinely();
}

bool Estimator::widenTracker() {
  result_.tracker_colour = trackerColour(meansOfOrientations(terms_, descent_.x()));
  if (result_.tracker_colour == 1.0) {
    return true;
  }
  terms_.widenTracker(result_.tracker_colour);
  return solveFinely();
}

void Estimator::judgeMisfit() {
  Estimate& estimate = result_.estimate;
  const double freedom = windowFreedom();
  estimate.covariance_scale = 1.0;
  estimate.degrees_of_freedom = static_cast<int>(std::lround(freedom));
  if (freedom <= 0.0) {
    return;
  }
  const double squares = windowSquares();
  result_.summary.window_chi_square = squares / freedom;
  result_.orientations = meansOfOrientations(terms_, descent_.x());
  result_.summary.orientation_chi_square = result_.orientations.reduced();
  result_.pace = residualPace(terms_);
  estimate.reduced_chi_square = squares / freedom;
  estimate.covariance_scale = std::sqrt(misfitVariance(squares, freedom));
}

/// N⁻¹ (Σ s² N) N⁻¹ with a scale s for each kind of terms, and what held coordinates add.
void Estimator::findCovariance() {
  const std::vector<Eigen::Index>& estimated = descent_.estimated();
  const Eigen::MatrixXd prior = descent_.priorInformation();
  const MotionSums& sums = descent_.sums();
  const auto count = static_cast<Eigen::Index>(estimated.size());
  const Eigen::MatrixXd information = sums.information();
  const Eigen::MatrixXd all = information + prior;
  const Eigen::MatrixXd inverse =
      solveSemidefinite(all(estimated, estimated), Eigen::MatrixXd::Identity(count, count));
  result_.alignment = residualAlignment(terms_, estimated, inverse);
  const double windows =
      std::max(std::pow(result_.estimate.covariance_scale, 2), result_.alignment.variance());
  const double orientations = std::max(1.0, result_.summary.orientation_chi_square);
  const Eigen::MatrixXd all_noise =
      windows * sums.balance.information() + orientations * sums.orientation.information() + prior;
  const Eigen::MatrixXd noise = all_noise(estimated, estimated);
  Eigen::MatrixXd held = problem_.prior.covariance;
  for (const Eigen::Index a : estimated) {
    held.row(a).setZero();
    held.col(a).setZero();
  }
  Eigen::MatrixXd others = information(estimated, Eigen::all);
  others(Eigen::all, estimated).setZero();
  const Eigen::MatrixXd gain = -inverse * others;
  const Eigen::MatrixXd with_held = gain * held;
  const Eigen::MatrixXd own = inverse * noise * inverse + with_held * gain.transpose();
  ParameterBelief& belief = result_.estimate.belief;
  belief.x = descent_.x();
  belief.covariance = held;
  belief.covariance(estimated, Eigen::all) += with_held;
  belief.covariance(Eigen::all, estimated) += with_held.transpose();
  belief.covariance(estimated, estimated) = 0.5 * (own + own.transpose());
  const Eigen::VectorXd values = symmetricEigenvalues(information(estimated, estimated));
  const double least = values[0];
  result_.estimate.condition_number = least > 0.0 ? std::sqrt(values[count - 1] / least) : 0.0;
}

/// Windows and orientations that are held out, and their errors.
HeldOutMotion Estimator::countHeldOut() {
  HeldOutMotion held_out;
  double torques = 0.0;
  const std::vector<WindowTerm>& windows = terms_.windows();
  for (std::size_t n = 0; n < windows.size(); ++n) {
    if (!windows[n].held_out || windows[n].residual.size() == 0) {
      continue;
    }
    if (windows[n].isSound()) {
      held_out.residuals.push_back(residualOf(n));
      torques += held_out.residuals.back().residual.squaredNorm();
    } else {
      ++held_out.rejected;
    }
  }
  held_out.windows = held_out.residuals.size();
  double turns = 0.0;
  for (const OrientationGroup& group : terms_.orientations().groups()) {
    if (group.held_out) {
      held_out.orientations += static_cast<std::size_t>(group.mean.count);
      turns += std::pow(terms_.noise().orientation, 2) * group.squares;
    }
  }
  const auto root_mean = [](double sum, std::size_t count) {
    return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
  };
  held_out.torque_rms = root_mean(torques, held_out.windows);
  held_out.orientation_rms = root_mean(turns, held_out.orientations);
  return held_out;
}

/// Against the stated noise, whatever the misfit of the windows that serve: what these could not
/// explain must not excuse it.
void Estimator::judgeHeldOut() {
  HeldOutMotion& held_out = result_.summary.held_out;
  std::size_t values = 0;
  const InformationSum sum = terms_.heldOut(descent_.x(), values);
  if (values == 0) {
    return;
  }
  const double squares = std::max(0.0,
                                  jointChiSquare(sum.information(),
                                                 sum.gradient(),
                                                 sum.squaredMisfit(),
                                                 result_.estimate.belief.covariance));
  const auto freedom = static_cast<double>(values);
  held_out.reduced_chi_square = squares / freedom;
  held_out.probability = chiSquareProbability(freedom, squares);
}

/// Lets what is held out judge the solution, and then serve like all else: what was found is known
/// better for it, by so much that its derivatives stay as they are.
bool Estimator::takeHeldOut() {
  if (!terms_.holdsOut() || descent_.estimated().empty()) {
    return true;
  }
  judgeMisfit();
  findCovariance();
  result_.summary.held_out = countHeldOut();
  judgeHeldOut();
  terms_.admitHeldOut();
  return descent_.settleAnew();
}

/// Mean torque error over a window, stator frame [N·m].
ObservationResidual Estimator::residualOf(std::size_t window) const {
  const WindowTerm& term = terms_.windows()[window];
  const JointTrack& track = terms_.spans()[term.window.span].track;
  const TestFunctions functions(
      track.time(term.window.first), track.time(term.window.last), options_.test_functions);
  const Eigen::VectorXd residual =
      term.isKept()
          ? Eigen::VectorXd(term.whitening.triangularView<Eigen::Lower>().solve(term.residual))
          : term.balance.residual;
  ObservationResidual result;
  result.observation = {window, Quantity::kTorque};
  result.residual = residual.head<3>() / functions.integralOfFirst();
  result.standardized = std::sqrt(term.square);
  result.rejected = !term.isSound();
  return result;
}

void Estimator::listResiduals() {
  for (std::size_t n = 0; n < terms_.windowCount(); ++n) {
    if (!terms_.windows()[n].held_out && !terms_.windows()[n].is_cut_off) {
      result_.estimate.residuals.push_back(residualOf(n));
    }
  }
}

void Estimator::summarise() {
  MotionSummary& summary = result_.summary;
  summary.left_out = terms_.leftOut();
  summary.values = static_cast<std::size_t>(terms_.valuesPerWindow());
  summary.windows = terms_.windowCount();
  for (const WindowsLeftOut& left_out : summary.left_out) {
    summary.windows += left_out.count;
  }
  for (const WindowTerm& term : terms_.windows()) {
    if (term.held_out) {
      continue;
    }
    if (!term.at_end.empty()) {
      countLeftOut(term.at_end, result_.at_end);
    }
    if (!term.isSound()) {
      countLeftOut(leftOutReason(term), summary.left_out);
      continue;
    }
    const JointTrack& track = terms_.spans()[term.window.span].track;
    summary.duration += track.time(term.window.last) - track.time(term.window.first);
    ++summary.used;
  }
  for (const OrientationGroup& group : terms_.orientations().groups()) {
    summary.orientations += group.held_out ? 0 : static_cast<std::size_t>(group.mean.count);
  }
  for (const OrientationTerm& term : terms_.orientations().terms()) {
    summary.orientations_rejected += term.is_known && !term.active ? 1 : 0;
  }
  summary.joint_stddev = std::sqrt(factors_.joints) * terms_.noise().joint;
  summary.current_stddev = std::sqrt(factors_.currents) * terms_.noise().current;
  summary.orientation_stddev = terms_.noise().orientation;
  summary.response = responseOfLongest(terms_.spans());
}

MotionEstimate Estimator::run() {
  const auto begin = std::chrono::steady_clock::now();
  Estimate& estimate = result_.estimate;
  estimate.belief = problem_.prior;
  estimate.open_directions.resize(problem_.prior.x.size(), 0);
  if (terms_.windowCount() * static_cast<std::size_t>(terms_.valuesPerWindow()) <
      problem_.free.size()) {
    estimate.termination = Termination::kTooFewObservations;
    summarise();
    return std::move(result_);
  }
  const bool solved =
      solve() && leaveSaturated() && leavePushed() && widenTracker() && takeHeldOut();
  estimate.unobservable = descent_.open().coordinates;
  estimate.open_directions = descent_.open().directions;
  estimate.error_history = descent_.errors();
  estimate.iterations = descent_.iterations();
  estimate.termination = solved ? Termination::kConverged : Termination::kIterationLimit;
  if (descent_.estimated().empty()) {
    estimate.termination = Termination::kNothingObservable;
  }
  summarise();
  listResiduals();
  if (estimate.termination == Termination::kConverged) {
    judgeMisfit();
    findCovariance();
    probeMotion(terms_, options_, descent_.estimated(), result_);
    CurrentSteps steps;
    for (const MotionSpan& span : terms_.spans()) {
      steps.add(*span.streams);
    }
    steps.widen(problem_.model->space(), result_.summary.current_stddev, estimate.belief);
  }
  estimate.solve_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(result_);
}

}  // namespace

MotionEstimate estimateMotion(const MotionProblem& problem,
                              const EstimationOptions& estimation,
                              const MotionOptions& options) {
  return Estimator(problem, estimation, options).run();
}

}  // namespace sac
