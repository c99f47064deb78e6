#include "spherical_actuator_calibration/core/sample_builder_report.hpp"

#include <utility>

namespace spherical_actuator_calibration {

void SampleBuilderReport::add(DwellEvent event) {
  if (event.kind == DwellEvent::Kind::kDiscarded) {
    ++discarded;
  }
  if (events.size() < kMaxEvents) {
    events.push_back(std::move(event));
  } else {
    ++events_untold;
  }
}

}  // namespace spherical_actuator_calibration
