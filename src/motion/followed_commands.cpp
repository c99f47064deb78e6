#include "followed_commands.hpp"

#include <algorithm>
#include <cmath>

namespace sac {

FollowedCommands::FollowedCommands(const std::vector<double>& times,
                                   const StreamCurrents& commands,
                                   double delay,
                                   double lag)
    : times_(times),
      commands_(commands),
      delay_(delay),
      lag_(lag),
      command_(Eigen::ArrayXd::Zero(commands.cols())),
      current_(command_) {}

void FollowedCommands::take() {
  command_ = commands_.row(static_cast<Eigen::Index>(next_)).transpose().cast<double>();
  ++next_;
}

void FollowedCommands::start(double time) {
  time_ = time;
  const auto place = std::upper_bound(times_.begin(), times_.end(), time - delay_);
  next_ = static_cast<std::size_t>(place - times_.begin());
  if (next_ > 0) {
    --next_;
    take();
  }
  current_ = command_;
}

void FollowedCommands::approach(double time) {
  const double left = lag_ > 0.0 ? std::exp((time_ - time) / lag_) : 0.0;
  current_ = command_ + left * (current_ - command_);
  time_ = time;
}

/// Of the time until `end`, in which one command acts.
void FollowedCommands::add(double end,
                           double begin_of_all,
                           double length_of_all,
                           HatSums& sums) const {
  const double length = end - time_;
  const double left = lag_ > 0.0 ? std::exp(-length / lag_) : 0.0;
  // ∫ and ∫ x of the command's share and of what fades, with x from 0 to the length.
  const double fading = lag_ * (1.0 - left);
  const double moment = 0.5 * length * length;
  const double fading_moment = lag_ * (fading - length * left);
  const double first = (time_ - begin_of_all) / length_of_all;
  const double rising = first * length + moment / length_of_all;
  const double rising_fading = first * fading + fading_moment / length_of_all;
  sums.rising += rising * command_ + rising_fading * (current_ - command_);
  sums.falling += (length - rising) * command_ + (fading - rising_fading) * (current_ - command_);
}

template <typename Visitor>
void FollowedCommands::pass(double time, const Visitor& visitor) {
  const auto go = [&](double end) {
    visitor(end);
    approach(end);
  };
  for (; next_ < times_.size() && times_[next_] + delay_ <= time; take()) {
    go(std::max(time_, times_[next_] + delay_));
  }
  go(time);
}

void FollowedCommands::advance(double time) {
  pass(time, [](double /*end*/) {});
}

void FollowedCommands::advance(double time, HatSums& sums) {
  const double begin = time_;
  sums.rising.setZero(command_.size());
  sums.falling.setZero(command_.size());
  pass(time, [&](double end) { add(end, begin, time - begin, sums); });
}

}  // namespace sac
