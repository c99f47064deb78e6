#include "spherical_actuator_calibration/ros/recording/recording_report.hpp"

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/streams/stream_statistics.hpp"

namespace sac {
namespace {

/// Reasons why dwells gave no sample are told up to this number; the rest is counted.
constexpr std::size_t kMaxEventsTold = 20;

void addCount(std::vector<std::string>& lines, std::uint64_t count, const std::string& sentence) {
  if (count > 0) {
    lines.push_back(std::to_string(count) + " " + sentence);
  }
}

std::string eventLine(const DwellEvent& event) {
  return format("At %.2f s: ", static_cast<double>(event.stamp) * kSecondsPerTick) + event.reason;
}

void addEvents(std::vector<std::string>& lines, const SampleBuilderReport& report) {
  std::uint64_t told = 0;
  for (const DwellEvent& event : report.events) {
    if (told == kMaxEventsTold) {
      break;
    }
    lines.push_back(eventLine(event));
    ++told;
  }
  addCount(lines,
           report.events.size() + report.events_untold - told,
           "more remarks on dwells are left out.");
}

void addStreams(std::vector<std::string>& lines, const RecordedStreamsReport& streams) {
  const SampleBuilderReport& report = streams.samples;
  if (report.joints.received > 0 || streams.incomplete_joint_states > 0) {
    lines.push_back(describe("joint_states", report.joints));
  }
  addCount(lines, streams.incomplete_joint_states, "joint_states without one of the joints.");
  lines.push_back(describe("measured_orientation", report.orientations));
  addCount(lines, streams.orientations_in_other_frame, "orientations in another frame dropped.");
  lines.push_back(describe("measured_torque", report.torques));
  addCount(lines, streams.torques_in_other_frame, "torques in another frame dropped.");
  lines.push_back(describe("coil_currents", report.currents));
  lines.push_back(counted(report.dwells, "dwell") + " at rest gave " +
                  counted(report.samples, "sample") + "; " + counted(report.discarded, "dwell") +
                  " or parts of them gave none.");
  addEvents(lines, report);
}

void addSamples(std::vector<std::string>& lines, const RecordedSamplesReport& samples) {
  lines.push_back("samples: " + std::to_string(samples.received) + " received, " +
                  std::to_string(samples.repeated + samples.invalid) + " dropped (" +
                  std::to_string(samples.repeated) + " repeated, " +
                  std::to_string(samples.invalid) + " invalid).");
  lines.insert(lines.end(), samples.invalid_reasons.begin(), samples.invalid_reasons.end());
}

}  // namespace

std::vector<std::string> describe(const RecordingReport& report) {
  std::vector<std::string> lines;
  if (report.has_streams) {
    addStreams(lines, report.streams);
  }
  if (report.has_samples) {
    addSamples(lines, report.samples);
  }
  lines.insert(lines.end(), report.notes.begin(), report.notes.end());
  lines.insert(lines.end(), report.missing.begin(), report.missing.end());
  return lines;
}

}  // namespace sac
