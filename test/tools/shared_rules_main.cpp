// shared_rules: what the core answers where programs in Python have a rule of their
// own, one JSON document a line: {"rule": ..., "given": [...], "answer": ...}. shared_rules_test.py
// holds both against each other.

#include <cstdio>
#include <optional>
#include <random>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "announced_lengths.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/actuator/unit_identity.hpp"
#include "spherical_actuator_calibration/actuator/usual_currents.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
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
  return '"' + text + '"';
}

std::string json(const Eigen::VectorXd& values) {
  std::string text;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    text += (k == 0 ? "[" : ", ") + json(values[k]);
  }
  return text + "]";
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
  Eigen::Vector3d angles() { return {between(-7.0, 7.0), between(-7.0, 7.0), between(-7.0, 7.0)}; }

 private:
  std::mt19937_64 engine_{1};
};

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

/// Whose unit something is; an empty list: it may be one's own.
void tellUnits() {
  for (const char* own_serial : {"", "unit-1"}) {
    Actuator own;
    own.name = "cube";
    own.serial = own_serial;
    for (const char* name : {"", "cube", "sphere"}) {
      for (const char* serial : {"", "unit-1", "unit-2"}) {
        const std::optional<OtherUnit> other = otherUnit(own, name, serial);
        tell("other_unit",
             other ? other->kind + " " + other->its + "|" + other->own : std::string(),
             std::string(name),
             std::string(serial),
             own.name,
             own.serial);
      }
    }
  }
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

int main() {
  sac::Trials trials;
  sac::tellOrientations(trials);
  sac::tellNames();
  sac::tellUnits();
  sac::tellDefaults();
  sac::tellLimits();
  return 0;
}
