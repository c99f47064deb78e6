#include "spherical_actuator_calibration/streams/sample_builder_report.hpp"

#include <utility>

namespace sac {

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

}  // namespace sac
