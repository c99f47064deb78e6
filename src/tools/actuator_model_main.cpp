#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/control/calibrated_actuator.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

constexpr char kIntroduction[] =
    "Usage: actuator_model --actuator CALIBRATED.yaml [--describe]\n\n"
    "Answers questions about a calibrated actuator, a line for each line of the standard input;\n"
    "other programs ask it through a pipe, those in Python by the module calibrated_actuator.\n"
    "  orientation q1 q2 q3          -> qx qy qz qw stddev supported\n"
    "  torque q1 q2 q3 i1 i2 ...     -> tx ty tz stddev\n"
    "  currents tx ty tz q1 q2 q3 limit -> outcome i1 i2 ... s1 s2 ... tx ty tz stddev\n"
    "A rotor without joints has the tracker's unit quaternion qx qy qz qw in the place of q1 q2 "
    "q3,\n"
    "and no orientation to ask for.\n"
    "All are in rad, A and N.m, torques in the rotor frame; outcome is reached, limited or\n"
    "singular. What cannot be "
    "answered is \"error: the reason\".\n"
    "With --describe it answers none, and prints the description as recordings and session "
    "databases\n"
    "hold it: a table of the torque curve is in it.\n"
    "Exit status: 0 at the end of the input; 2 bad usage or unreadable description.\n\n";

/// Numbers of one question.
class Numbers {
 public:
  explicit Numbers(std::istringstream& line) {
    std::string word;
    while (line >> word) {
      const std::optional<double> number = parsedNumber(word);
      if (!number) {
        throw DataError("\"" + word + "\" is no number.");
      }
      values_.push_back(*number);
    }
  }

  void require(std::size_t count) const {
    if (values_.size() != count) {
      throw DataError("There are " + std::to_string(values_.size()) + " numbers where " +
                      std::to_string(count) + " belong.");
    }
  }
  double number(std::size_t place) const { return values_[place]; }
  Eigen::Vector3d vector(std::size_t first) const { return Eigen::Vector3d(&values_[first]); }
  Eigen::VectorXd from(std::size_t first) const {
    return Eigen::Map<const Eigen::VectorXd>(values_.data() + first,
                                             static_cast<Eigen::Index>(values_.size() - first));
  }

 private:
  std::vector<double> values_;
};

template <typename Values>
void append(const Values& values, std::string& text) {
  for (const double value : values) {
    text += (text.empty() ? "" : " ") + shortestText(value);
  }
}

/// How many numbers tell where the rotor is: joint angles, or a quaternion.
std::size_t poseNumbers(const CalibratedActuator& actuator) {
  return actuator.hasJoints() ? kJoints : 4;
}

/// Joint angles, or those that stand for a quaternion.
Eigen::Vector3d reading(const CalibratedActuator& actuator,
                        const Numbers& asked,
                        std::size_t first) {
  if (actuator.hasJoints()) {
    return asked.vector(first);
  }
  return freeRotorAngles(Eigen::Quaterniond(asked.number(first + 3),
                                            asked.number(first),
                                            asked.number(first + 1),
                                            asked.number(first + 2)));
}

std::string orientation(const CalibratedActuator& actuator, const Numbers& asked) {
  if (!actuator.hasJoints()) {
    throw DataError("The rotor has no joints: the tracker alone tells its orientation.");
  }
  asked.require(3);
  const Predictor::Orientation pose = actuator.orientation(asked.vector(0));
  std::string text;
  append(Eigen::Quaterniond(pose.R_stator_rotor).normalized().coeffs(), text);
  return text + " " + shortestText(pose.stddev) + (pose.is_supported ? " 1" : " 0");
}

std::string torque(const CalibratedActuator& actuator, const Numbers& asked) {
  const std::size_t pose = poseNumbers(actuator);
  asked.require(pose + actuator.coils());
  const Predictor::Torque made = actuator.torque(reading(actuator, asked, 0), asked.from(pose));
  std::string text;
  append(made.torque, text);
  return text + " " + shortestText(made.stddev);
}

std::string currents(const CalibratedActuator& actuator, const Numbers& asked) {
  const std::size_t limit = 3 + poseNumbers(actuator);
  asked.require(limit + 1);
  AllocationOptions options;
  options.current_limit = asked.number(limit);
  const CalibratedActuator::Currents found =
      actuator.currents(asked.vector(0), reading(actuator, asked, 3), options);
  std::string text = found.outcome == Allocation::kReached   ? "reached"
                     : found.outcome == Allocation::kLimited ? "limited"
                                                             : "singular";
  append(found.currents, text);
  append(found.stddev, text);
  append(found.torque, text);
  return text + " " + shortestText(found.torque_stddev);
}

std::string answer(const CalibratedActuator& actuator, const std::string& question) {
  std::istringstream line(question);
  std::string word;
  line >> word;
  const Numbers numbers(line);
  if (word == "orientation") {
    return orientation(actuator, numbers);
  }
  if (word == "torque") {
    return torque(actuator, numbers);
  }
  if (word == "currents") {
    return currents(actuator, numbers);
  }
  throw DataError("\"" + printable(word) + "\" is none of: orientation, torque, currents.");
}

/// The next line of the standard input; false at its end. Throws DataError where it has none.
bool nextLine(std::string& line) {
  constexpr std::size_t kLongest = std::size_t{1} << 20U;
  line.clear();
  char sign = '\0';
  while (std::cin.get(sign) && sign != '\n') {
    line.push_back(sign);
    if (line.size() > kLongest) {
      throw DataError("A line of the input has more than " + std::to_string(kLongest) + " bytes.");
    }
  }
  return !line.empty() || std::cin.good();
}

void printDescription(const std::string& path) {
  std::cout << renderDescription(loadDescription(path), path);
}

void serve(const std::string& path) {
  const CalibratedActuator actuator = CalibratedActuator::load(path);
  std::cout << "ready " << (actuator.hasTorqueModel() ? actuator.coils() : 0) << " "
            << (actuator.hasUncertainty() ? 1 : 0) << " " << (actuator.isContradicted() ? 1 : 0)
            << " " << (actuator.isAsDrawn() ? 1 : 0) << std::endl;
  std::string question;
  while (nextLine(question)) {
    std::string text;
    try {
      text = answer(actuator, question);
    } catch (const Error& error) {
      text = "error: " + printable(error.what());
    }
    // Who asked waits for it.
    std::cout << text << std::endl;
  }
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("actuator_model", [&] {
    std::string path;
    sac::CommandLine line(sac::kIntroduction);
    line.addRequired("actuator", path, "YAML", "description, usually a calibrated one");
    bool is_described = false;
    line.addSwitch("describe", is_described, "print the description, and answer no questions");
    if (!line.parse(argc, argv, std::cout)) {
      return sac::kToolSuccess;
    }
    if (is_described) {
      sac::printDescription(path);
    } else {
      sac::serve(path);
    }
    return sac::kToolSuccess;
  });
}
