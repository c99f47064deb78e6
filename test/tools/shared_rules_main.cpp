// shared_rules DRAWING.yaml: what the core answers where programs in Python have a rule of their
// own, one JSON document a line: {"rule": ..., "given": [...], "answer": ...}. shared_rules_test.py
// holds both against each other.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "announced_lengths.hpp"
#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/actuator/usual_currents.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "spherical_actuator_calibration/planning/planned_capture.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/study/model_error.hpp"
#include "yaml_document.hpp"

namespace sac {
namespace {

constexpr int kTrials = 400;

std::string json(double value) {
  std::string text(32, '\0');
  text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.17g", value)));
  return text;
}

std::string json(bool value) {
  return value ? "true" : "false";
}

std::string json(const std::string& text) {
  std::string quoted;
  for (const char character : text) {
    if (character == '\n') {
      quoted += "\\n";
      continue;
    }
    quoted += (character == '"' ? "\\" : "");
    quoted += character;
  }
  return '"' + quoted + '"';
}

std::string json(const Eigen::VectorXd& values) {
  std::string text;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    text += (k == 0 ? "[" : ", ") + json(values[k]);
  }
  return text + "]";
}

/// Coils counted from 1, negative where their current is.
std::string json(const CoilPattern& pattern) {
  std::string text;
  for (const SignedCoil& coil : pattern) {
    text += text.empty() ? "" : ", ";
    text += std::to_string(coil.sign * static_cast<int>(numberOf(coil.coil)));
  }
  return '[' + text + ']';
}

template <typename Answer, typename... Given>
void tell(const char* rule, const Answer& answer, const Given&... given) {
  std::string list;
  ((list += (list.empty() ? "" : ", ") + json(given)), ...);
  std::printf("{\"rule\": \"%s\", \"given\": [%s], \"answer\": %s}\n",
              rule,
              list.c_str(),
              json(answer).c_str());
}

class Trials {
 public:
  double between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(engine_);
  }
  bool oneIn(int count) { return std::uniform_int_distribution<int>(1, count)(engine_) == 1; }

  /// Of four coils one or two, of any sign; none, too.
  PlannedCapture capture() {
    PlannedCapture planned;
    planned.current = between(0.2, 4.0);
    for (std::size_t coil = 0; coil < 4; ++coil) {
      if (oneIn(3)) {
        planned.pattern.push_back({coil, oneIn(2) ? -1 : 1});
      }
    }
    return planned;
  }

  /// What those coils measure: some by about as much off as is allowed.
  Eigen::VectorXd currents(const PlannedCapture& planned, const CurrentTolerance& tolerance) {
    Eigen::VectorXd measured = Eigen::VectorXd::Zero(4);
    for (const SignedCoil& coil : planned.pattern) {
      measured[static_cast<Eigen::Index>(coil.coil)] = coil.sign * planned.current;
    }
    for (Eigen::Index j = 0; j < measured.size(); ++j) {
      const double allowed = std::max(tolerance.absolute, tolerance.share * std::abs(measured[j]));
      measured[j] += between(-1.05, 1.05) * allowed;
    }
    return measured;
  }

  Eigen::Vector3d angles() { return {between(-7.0, 7.0), between(-7.0, 7.0), between(-7.0, 7.0)}; }

 private:
  std::mt19937_64 engine_{1};
};

void tellCurrents(Trials& trials) {
  for (int k = 0; k < kTrials; ++k) {
    const double threshold = trials.between(0.05, 0.5);
    const CurrentTolerance tolerance = currentTolerance(threshold);
    const PlannedCapture planned = trials.capture();
    const Eigen::VectorXd measured = trials.currents(planned, tolerance);
    tell("are_carried",
         !coilAmiss(planned, measured, threshold).has_value(),
         measured,
         planned.pattern,
         planned.current,
         tolerance.absolute,
         tolerance.share);
    Sample sample;
    sample.current = measured;
    tell("excited_coils", patternOf(sample, threshold), measured, threshold);
  }
}

void tellPoses(Trials& trials) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d pose = trials.angles();
    Sample sample;
    sample.joint_position = pose;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double turns = trials.oneIn(3) ? 1.0 : 0.0;
      sample.joint_position[k] +=
          1.2 * kPoseTolerance * trials.between(-1.0, 1.0) + turns * 2.0 * kPi;
    }
    tell("is_at",
         isAtPose(sample, pose),
         Eigen::VectorXd(pose),
         Eigen::VectorXd(sample.joint_position),
         kPoseTolerance);
  }
}

void tellOrientations(Trials& trials) {
  for (int k = 0; k < kTrials; ++k) {
    const Eigen::Vector3d v = 0.4 * trials.angles();
    const Eigen::Quaterniond q(rotationExp(v));
    const Eigen::VectorXd xyzw = q.coeffs();
    tell("turns_of", Eigen::VectorXd(freeRotorAngles(q)), xyzw);
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = q.toRotationMatrix();
    tell("quaternion", xyzw, Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(R.data(), R.size())));
    const double norm = 1.0 + trials.between(-2.0, 2.0) * kUnitTolerance;
    tell("is_unit",
         isUnit(Eigen::Quaterniond(Eigen::Vector4d(norm * q.coeffs()))),
         Eigen::VectorXd(norm * xyzw));
  }
}

void tellNames() {
  for (const JointAxis& joint : freeRotorJoints()) {
    tell("turn_name", joint.name);
  }
}

/// Whether a motion is planned as for a drawing: one axis that nobody knows is enough.
void tellDrawings(const std::string& path) {
  CalibratedDescription description = loadDescription(path);
  const auto say = [&] {
    const bool is_drawing =
        likelyModelError(description) == likelyModelError({description.actuator});
    tell("is_as_drawn", is_drawing, renderDescription(description, "description"));
  };
  say();
  description.stddevs.joints.fill({1e-3, 1e-3, 1e-3});
  description.stddevs.poles.assign(description.actuator.poles.size(), {1e-3, 1e-3});
  description.stddevs.coils.assign(description.actuator.coils.size(), {1e-3, 1e-3});
  say();
  const CalibratedDescription known = description;
  description.stddevs.joints[1].axis_v.reset();
  say();
  description = known;
  description.stddevs.poles[2].azimuth.reset();
  say();
  description = known;
  description.stddevs.coils[4] = {};
  say();
}

void tellDefaults() {
  const PosePlanOptions defaults;
  tell("default", static_cast<double>(defaults.max_poses), std::string("poses"));
  tell("default", defaults.current, std::string("current"));
  tell("default", defaults.total_current, std::string("total_current"));
  tell("usual_current", kUsualCoilCurrent, std::string("coil"));
  tell("usual_current", kUsualTotalCurrent, std::string("total"));
}

/// Of what comes from outside.
void tellLimits() {
  const auto say = [](const char* name, std::size_t most) {
    tell("limit", static_cast<double>(most), std::string(name));
  };
  say("file", kLargestTextFile);
  say("description", kLargestDescription);
  say("configuration", kLargestConfiguration);
  say("depth", kDeepestYaml);
  say("nodes", kMostYamlNodes);
  say("message", kLongestMessage);
  say("header", kLongestHeader);
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  if (argc != 2) {
    return 2;
  }
  sac::Trials trials;
  sac::tellCurrents(trials);
  sac::tellPoses(trials);
  sac::tellOrientations(trials);
  sac::tellNames();
  sac::tellDrawings(argv[1]);
  sac::tellDefaults();
  sac::tellLimits();
  return 0;
}
