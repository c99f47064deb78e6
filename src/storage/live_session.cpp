#include "spherical_actuator_calibration/storage/live_session.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"

namespace sac {
namespace {

/// Databases kept no units before their format 4: they were those of the model.
CycleReport withUnits(CycleReport report, const ParameterSpace& space) {
  std::map<std::string, Eigen::Index> places;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    places[space.name(p)] = p;
  }
  for (ParameterEstimate& estimate : report.estimates) {
    const auto place = places.find(estimate.name);
    if (estimate.unit.empty() && place != places.end()) {
      estimate.unit = space.unit(place->second);
    }
  }
  return report;
}

std::vector<CycleReport> withUnits(std::vector<CycleReport> reports, const ParameterSpace& space) {
  for (CycleReport& report : reports) {
    report = withUnits(std::move(report), space);
  }
  return reports;
}

/// Whether a sample holds the same measurements as one in use, whatever its id. That one may be
/// held out by its turn, which is another one's by now.
bool isSameCapture(const Sample& a, const Sample& b) {
  return a.stamp == b.stamp && a.duration == b.duration && a.measurements == b.measurements &&
         (a.validation || !b.validation) && a.joint_position == b.joint_position &&
         a.has_orientation == b.has_orientation && a.has_torque == b.has_torque &&
         (!a.has_orientation || a.R_stator_rotor == b.R_stator_rotor) &&
         (!a.has_torque || a.torque == b.torque) && a.current.size() == b.current.size() &&
         a.current == b.current;
}

/// Those that hold what no sample can are told with the file's name.
std::vector<Sample> samplesOf(const SessionDatabase& database,
                              const std::string& path,
                              std::size_t coils) {
  std::vector<Sample> samples = database.samplesInUse();
  for (const Sample& sample : samples) {
    try {
      validate(sample, coils);
    } catch (const DataError& error) {
      throw DataError(path + ": " + error.what());
    }
  }
  return samples;
}

}  // namespace

LiveSession::LiveSession(const CalibratedDescription& start,
                         const CalibrationConfig& config,
                         const std::string& database_path,
                         const std::string& software)
    : software_(software),
      database_(database_path, {start, config, software}),
      revision_(database_.current()),
      session_(start,
               samplesOf(database_, database_path, start.actuator.coils.size()),
               config,
               revision_.state,
               {}),
      linearity_search_(config.estimation) {
  putInForce(revision_);
  searchLinearityAnew();
}

Actuator LiveSession::actuator() const {
  return session_.actuator();
}

Sample LiveSession::addSample(const Sample& sample, const std::string& date) {
  Sample stored = session_.prepared(sample);
  // Asked again after an answer that was lost or failed: it is stored once. Only the last one can
  // be asked for again; the same measurements later come from a recording that is played once more.
  if (!session_.samples().empty() && isSameCapture(session_.samples().back(), sample)) {
    database_.confirmSample(session_.samples().back().id);
    return session_.samples().back();
  }
  stored.id = database_.nextSampleId();
  database_.addSample(stored, date);
  session_.add(stored);
  counter_->add(stored);
  linearity_search_.add(stored);
  linearity_ = linearity_search_.best();
  if (grader_) {
    grader_->settle();
  }
  grade_.reset();
  return stored;
}

bool LiveSession::removeSample(std::uint32_t id, const std::string& date) {
  if (!database_.removeSample(id, date)) {
    return false;
  }
  const bool is_removed = session_.remove(id);
  countAnew();
  searchLinearityAnew();
  return is_removed;
}

std::size_t LiveSession::clearSamples(const std::string& date) {
  const std::size_t count = database_.clearSamples(date);
  session_.clearSamples();
  countAnew();
  searchLinearityAnew();
  return count;
}

std::vector<MotionSlice> LiveSession::motionWindows() const {
  std::vector<MotionSlice> windows = database_.motion();
  const std::size_t coils = modelledCoils(session_.model().space().nominal());
  for (const MotionSlice& window : windows) {
    try {
      validate(window, coils, MotionOptions());
    } catch (const DataError& error) {
      throw DataError(database_.path() + ": " + error.what());
    }
  }
  return windows;
}

PosesToMeasure LiveSession::plan() const {
  PosesToMeasure plan = database_.plan();
  const std::size_t coils = modelledCoils(session_.model().space().nominal());
  for (const PoseToMeasure& pose : plan) {
    for (const CoilPattern& pattern : pose.patterns) {
      const bool has_all = std::all_of(
          pattern.begin(), pattern.end(), [&](const SignedCoil& one) { return one.coil < coils; });
      if (!has_all) {
        throw DataError(database_.path() + ": the plan has the coils " + patternText(pattern) +
                        " of " + std::to_string(coils) + ".");
      }
    }
    if (!pose.joint_position.allFinite()) {
      throw DataError(database_.path() + ": the plan has a pose without angles.");
    }
  }
  return plan;
}

CycleReport LiveSession::run(const CycleRequest& request, const std::string& date) {
  // What cannot be stored must not be in force.
  CalibrationState before = session_.state();
  std::vector<CycleReport> reports = session_.reports();
  std::optional<MotionEvidence> motion = session_.motionEvidence();
  CycleReport report = session_.run(request);
  try {
    if (report.success) {
      revision_ =
          database_.addCycle(report, session_.state(), request.cycle == Cycle::kRefine, date);
    } else {
      database_.addCycle(report, date);
    }
  } catch (...) {
    session_.resume(std::move(before), std::move(reports), std::move(motion));
    countAnew();
    throw;
  }
  countAnew();
  return report;
}

std::optional<CycleReport> LiveSession::lastReport() const {
  const std::optional<CycleReport> report = database_.lastCycle();
  return report ? std::optional(withUnits(*report, session_.model().space())) : std::nullopt;
}

void LiveSession::reset(const std::string& date) {
  putInForce(database_.addRevision(session_.startState(), "nominal", "reset", false, date));
}

void LiveSession::restore(std::uint32_t number, const std::string& date) {
  const std::optional<Revision> earlier = database_.revision(number);
  if (!earlier) {
    throw DataError("There is no revision " + std::to_string(number) + ": the newest is " +
                    std::to_string(revision_.number) + ".");
  }
  putInForce(database_.addRevision(earlier->state,
                                   "restored",
                                   "revision " + std::to_string(number),
                                   earlier->refined,
                                   date,
                                   number));
}

SessionProgress LiveSession::progress() const {
  SessionProgress progress = counter_->progress();
  progress.refined = revision_.refined;
  const std::vector<CycleReport>& reports = session_.reports();
  // What a cycle of poles or of a coil makes of few samples, a refinement may mend.
  progress.refused = !reports.empty() && reports.back().contradicted &&
                     reports.back().cycle != Cycle::kPoles && reports.back().cycle != Cycle::kCoil;
  // A session without a cycle leaves nothing open that it was asked for, and is not done.
  progress.complete = progress.isAllIdentified() && is_settled_;
  progress.removed = removed_;
  return progress;
}

const GradedCalibration& LiveSession::grade() const {
  if (!grade_) {
    if (!grader_) {
      grader_.emplace(session_);
    }
    grade_ = grader_->grade();
  }
  return *grade_;
}

/// After what changes more than one sample more: other parameters look at other poles.
void LiveSession::countAnew() {
  counter_.emplace(session_.model(), session_.state(), session_.config().estimation);
  counter_->add(session_.samples());
  is_settled_ = session_.isSettled();
  std::set<std::uint32_t> fitted = session_.fittedSamples();
  for (const Sample& sample : session_.samples()) {
    fitted.erase(sample.id);
  }
  removed_ = fitted.size();
  grader_.reset();
  grade_.reset();
}

/// Parameters have no part in it: only samples that went change it.
void LiveSession::searchLinearityAnew() {
  linearity_search_ = LinearitySearch(session_.config().estimation);
  for (const Sample& sample : session_.samples()) {
    linearity_search_.add(sample);
  }
  linearity_ = linearity_search_.best();
}

CalibratedDescription LiveSession::description(const std::string& date) const {
  return gradedDescription(session_, origin(date), grade());
}

CalibrationOrigin LiveSession::origin(const std::string& date) const {
  CalibrationOrigin origin;
  origin.date = date;
  origin.software = software_;
  origin.revision = revision_.number;
  return origin;
}

/// What the last motion before a revision told, or nothing.
std::optional<MotionEvidence> LiveSession::motionBefore(std::uint32_t number) const {
  const std::optional<std::uint32_t> motion = database_.motionBefore(number);
  if (!motion) {
    return std::nullopt;
  }
  const std::vector<CycleReport> reports = database_.cyclesOfRevision(*motion);
  const auto last = std::find_if(
      reports.rbegin(), reports.rend(), [](const CycleReport& one) { return one.success; });
  return motionEvidence(session_.model().space(),
                        *last,
                        database_.revision(*motion).value().state,
                        session_.startState());
}

void LiveSession::putInForce(const Revision& revision) {
  session_.resume(revision.state,
                  withUnits(database_.cyclesOfRevision(revision.number), session_.model().space()),
                  motionBefore(revision.number));
  revision_ = revision;
  countAnew();
}

}  // namespace sac
