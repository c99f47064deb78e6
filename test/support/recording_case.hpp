#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"
#include "support/bag_editing.hpp"
#include "support/error_message.hpp"
#include "support/not_a_number.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {

inline constexpr char kJoints3[] = "/actuator/joint_states";
inline constexpr char kOrientation[] = "/actuator/measured_orientation";
inline constexpr char kTorque[] = "/actuator/measured_torque";
inline constexpr char kCurrents[] = "/actuator/coil_currents";

inline Actuator unit() {
  Actuator actuator = scenarios::paperNominal();
  actuator.serial = "unit-001";
  return actuator;
}

inline void expectSame(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].id, b[n].id);
    EXPECT_EQ(a[n].stamp, b[n].stamp);
    EXPECT_EQ(a[n].joint_position, b[n].joint_position);
    EXPECT_EQ(a[n].R_stator_rotor, b[n].R_stator_rotor);
    EXPECT_EQ(a[n].torque, b[n].torque);
    EXPECT_EQ(a[n].current, b[n].current);
  }
}

/// A recorded session, and edited copies of it.
class RecordingCase : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared = new TemporaryFolder;
    bags::recordSession(session(), unit());
  }
  static void TearDownTestSuite() {
    delete shared;
    shared = nullptr;
  }

  static std::string session() { return shared->path("session.bag"); }
  std::string path(const std::string& name) const { return folder_.path(name); }

  std::string edited(const bags::Editor& editor, const std::string& name = "edited.bag") const {
    bags::edit(session(), path(name), editor);
    return path(name);
  }

  static Recording read(const std::vector<std::string>& paths, const Actuator& nominal = unit()) {
    return readRecordings(paths, nominal, {});
  }

  static std::string readError(const std::vector<std::string>& paths,
                               const Actuator& nominal = unit()) {
    return errorMessage<DataError>([&] { read(paths, nominal); });
  }

  static void expectError(const std::string& bag,
                          const std::string& part,
                          const Actuator& nominal = unit()) {
    const std::string message = readError({bag}, nominal);
    EXPECT_NE(message.find(bag), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  TemporaryFolder folder_;

 private:
  static inline TemporaryFolder* shared = nullptr;
};

}  // namespace sac
