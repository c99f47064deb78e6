#include "tracker_term.hpp"

namespace sac {

TrackerTerm::TrackerTerm(const CalibrationModel& model,
                         const MotionPlaces& places,
                         const Eigen::VectorXd& x)
    : space_(model.space()), places_(places), point_(model, x) {
  if (places.tracker_delay >= 0) {
    scale_ = space_.effects().scale(places.tracker_delay - space_.effect());
    delay_ = scale_ * x[places.tracker_delay];
  }
}

bool TrackerTerm::evaluate(const MotionSpan& span, std::size_t orientation) {
  time_ = span.orientation_times[orientation] - delay_;
  const std::optional<TrackPoint> track = span.track.at(time_);
  if (!track) {
    return false;
  }
  sample_.joint_position = track->position;
  rates_ = track->velocity;
  sample_.R_stator_rotor = span.streams->orientations[orientation].toRotationMatrix();
  residual_ = point_.orientationResidual(sample_, &jacobian_);
  if (places_.tracker_delay >= 0) {
    for (std::size_t k = 0; k < kJoints; ++k) {
      jacobian_.col(places_.tracker_delay) -= scale_ * byTime(k);
    }
  }
  return true;
}

}  // namespace sac
