#include "pose_capture.hpp"

#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {
namespace {

using msg::MeasurementProgress;

std::string coilsInWords(const MeasurementProgress& progress) {
  std::string text;
  for (const std::int32_t coil : progress.coils) {
    text += (text.empty() ? "" : " ") + std::to_string(coil);
  }
  return text;
}

std::string stageInWords(const MeasurementProgress& progress) {
  if (progress.stage == MeasurementProgress::TURNING) {
    return "Waiting until the rotor rests there …";
  }
  return progress.coils.empty() ? "Measuring without current …"
                                : "Measuring with coil " + coilsInWords(progress) + " …";
}

}  // namespace

void ProgressWords::receive(const MeasurementProgress& progress) {
  text_ = stageInWords(progress);
  if (progress.captures != captures_) {
    captures_ = progress.captures;
    told_ = progress.told;
  }
  if (progress.told != told_ && !progress.sentences.empty()) {
    text_ += "\n" + printable(progress.sentences.back());
  }
}

PoseCapture::PoseCapture(ros::NodeHandle node) : client_(node, "calibration/capture", false) {}

void PoseCapture::begin(const msg::CaptureGoal& goal) {
  is_running_ = true;
  end_.reset();
  words_ = ProgressWords();
  if (!client_.isServerConnected()) {
    end_ = {false, "The engine does not answer (calibration/capture): is session_engine running?"};
    return;
  }
  client_.sendGoal(
      goal,
      [this](const actionlib::SimpleClientGoalState& state,
             const msg::CaptureResultConstPtr& result) {
        const bool success =
            state == actionlib::SimpleClientGoalState::SUCCEEDED && result && result->success != 0;
        const bool is_told = result && !result->message.empty();
        end_ = {success,
                is_told ? printable(result->message)
                        : "The engine has been started anew: measure the pose again."};
      },
      {},
      [this](const msg::CaptureFeedbackConstPtr& feedback) { words_.receive(feedback->progress); });
}

std::optional<CaptureEnd> PoseCapture::takeEnd() {
  if (is_running_ && !end_ && !client_.isServerConnected()) {
    client_.stopTrackingGoal();
    end_ = {false, "The engine has ended, and with it the currents: measure the pose again."};
  }
  if (!is_running_ || !end_) {
    return std::nullopt;
  }
  is_running_ = false;
  return end_;
}

}  // namespace sac
