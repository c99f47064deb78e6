#include "spherical_actuator_calibration/emulation/laboratory_history.hpp"

#include <algorithm>
#include <iterator>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

void validate(const StreamDelays& delays) {
  const ValueRange range = ValueRange::closed(0.0, 0.5, "s");
  requireInRange("delay of the joint sensors", delays.joints, range);
  requireInRange("delay of the currents", delays.currents, range);
  requireInRange("delay of the tracker", delays.tracker, range);
  requireInRange("delay of the force/torque sensor", delays.ft_sensor, range);
}

double longestDelay(const StreamDelays& delays) {
  return std::max({delays.joints, delays.currents, delays.tracker, delays.ft_sensor});
}

void LaboratoryHistory::add(double time, const LaboratoryMoment& moment) {
  if (!entries_.empty() && time <= entries_.back().time) {
    entries_.back().moment = moment;
    return;
  }
  entries_.push_back({time, moment});
  // One moment at the begin of the span, or before it, stays: there the line begins.
  while (entries_.size() > 2 && entries_[1].time <= time - span_) {
    entries_.pop_front();
  }
}

LaboratoryMoment LaboratoryHistory::at(double time) const {
  const auto after =
      std::upper_bound(entries_.begin(), entries_.end(), time, [](double t, const Entry& entry) {
        return t < entry.time;
      });
  if (after == entries_.begin()) {
    return entries_.front().moment;
  }
  const Entry& before = *std::prev(after);
  if (after == entries_.end()) {
    return before.moment;
  }
  const double share = (time - before.time) / (after->time - before.time);
  return {before.moment.position + share * (after->moment.position - before.moment.position),
          before.moment.currents + share * (after->moment.currents - before.moment.currents)};
}

}  // namespace sac
