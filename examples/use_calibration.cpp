// What a calibrated actuator does, without ROS:
//   use_calibration CALIBRATED.yaml q1 q2 q3
// Prints where the rotor is at these joint readings [rad], currents that turn it about its x axis,
// and what torque they make, each with its standard deviation.
// Exit status: 0 done; 2 bad usage or unreadable description or reading.
#include <cstddef>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <spherical_actuator_calibration/control/calibrated_actuator.hpp>

namespace {

double numberOf(const std::string& text) {
  std::size_t end = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;  // nothing of it is a number, or it is beyond all of them
  }
  if (end == 0 || end != text.size()) {
    throw std::invalid_argument("\"" + text + "\" is no joint reading: give a number of radians.");
  }
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: use_calibration CALIBRATED.yaml q1 q2 q3\n");
    return 2;
  }
  try {
    const sac::CalibratedActuator actuator = sac::CalibratedActuator::load(argv[1]);
    const Eigen::Vector3d joints(numberOf(argv[2]), numberOf(argv[3]), numberOf(argv[4]));

    if (!actuator.hasUncertainty()) {
      std::puts("No uncertainty is stated: nobody has calibrated this, and ± 0 is not known.");
    }
    if (actuator.isContradicted()) {
      std::puts("What was held out contradicted this calibration: do not use it, calibrate anew.");
    }
    if (actuator.hasJoints()) {
      const auto pose = actuator.orientation(joints);
      const Eigen::Quaterniond q(pose.R_stator_rotor);
      std::printf(
          "orientation %.6f %.6f %.6f %.6f ± %.6f rad\n", q.x(), q.y(), q.z(), q.w(), pose.stddev);
    }

    if (actuator.hasTorqueModel()) {
      const Eigen::Vector3d wanted(0.05, 0.0, 0.0);  // [N·m], rotor frame
      const auto found = actuator.currents(wanted, joints);
      for (Eigen::Index coil = 0; coil < found.currents.size(); ++coil) {
        std::printf("coil_%d %.6f ± %.6f A\n",
                    static_cast<int>(coil) + 1,
                    found.currents[coil],
                    found.stddev[coil]);
      }
      const auto made = actuator.torque(joints, found.currents);
      std::printf("torque %.5f %.5f %.5f ± %.5f N·m\n",
                  made.torque.x(),
                  made.torque.y(),
                  made.torque.z(),
                  made.stddev);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "use_calibration: %s\n", error.what());
    return 2;
  }
}
