#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace sac {

/// Judges whether measured currents are those that were set, whatever an honest amplifier's lag is.
///
/// An amplifier is honest that follows its setpoints after a delay of up to 0.165 s with a time
/// constant of up to 0.03 s. Which one it has is not known, so that many are held against what is
/// measured, and a coil deviates when none of them explains its current any more. A range of all
/// that was set within the longest lag would not do: commands that change fast make it so wide that
/// every current lies within.
///
/// For each lag the beats are counted whose current lies beyond the tolerance. A beat that agrees
/// takes back only an eighth of one: current that comes and goes is an error, too. The time that
/// passes counts: a beat that took long counts for several, one that was begun early for less.
///
/// Output stages may cut the current at once, whatever the setpoints' delay is: while they are off,
/// and for the longest lag afterwards, less than what is set is right, down to zero. What was set
/// before the first measurement is not known: what that one has, or anything from there to zero;
/// and what flows within the longest delay after it may have been on its way.
///
/// Times are seconds of a steady clock. Not thread-safe.
class CurrentComparison {
 public:
  /// `tolerance`: of a current [A]; `beats`: that must deviate, one agreeing among them or not;
  /// `period`: of a beat that is not slowed down [s].
  CurrentComparison(std::size_t coils, double tolerance, int beats, double period);

  /// These setpoints [A] go to the amplifier next, and its output stages are on or off.
  void setting(const Eigen::VectorXd& setpoints, bool stages_on = true);
  /// These currents [A] were measured between two times, after the last setpoints were written.
  /// Returns the first coil that deviates, from 0.
  std::optional<std::size_t> observe(const Eigen::VectorXd& measured, double begin, double end);
  /// Half the way to a coil that deviates, or 0.1 s before it: an honest amplifier does not come so
  /// far.
  bool isSuspicious() const;
  /// Counts anew.
  void forgive();

  const Eigen::VectorXd& setpoints() const { return setpoints_; }

 private:
  /// What amplifiers without delay have as currents [A] in a span of time: a row for each coil, a
  /// column for each time constant.
  struct Span {
    double begin = 0.0;
    double end = 0.0;
    Eigen::ArrayXXd lowest;
    Eigen::ArrayXXd highest;
  };

  void beginWith(const Eigen::ArrayXd& measured);
  void widenBeginning(const Eigen::ArrayXd& measured);
  void advance(double until);
  Span settled(double from, double to, double elapsed);
  void remember(const Span& span);
  Eigen::ArrayXd tolerances() const;
  double weightOf(double end) const;
  void count(const Eigen::ArrayXd& measured, double begin, double end, double weight);

  double tolerance_;
  double beats_;
  double period_;
  Eigen::VectorXd setpoints_;
  Eigen::ArrayXd lowest_;   ///< that was set since the last measurement [A]
  Eigen::ArrayXd highest_;  ///< likewise
  /// Of amplifiers without delay, for each coil and time constant [A].
  Eigen::ArrayXXd lower_;
  Eigen::ArrayXXd upper_;       ///< likewise
  std::optional<double> last_;  ///< end of a measurement [s]
  bool is_off_ = false;         ///< the output stages
  bool was_off_ = false;        ///< at some time since the last measurement
  /// When they may have been off last, by a measurement [s].
  double off_at_ = -std::numeric_limits<double>::infinity();
  std::deque<Span> spans_;     ///< without gaps, as far back as the longest delay
  Eigen::ArrayXXd deviating_;  ///< beats, for each coil and each lag
  double most_ = 0.0;          ///< of the coil that deviates most, by the lag that explains it best
};

}  // namespace sac
