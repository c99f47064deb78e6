#include "spherical_actuator_calibration/ros/recording/recorded_setup.hpp"

#include <std_msgs/String.h>

#include "support/recording_case.hpp"

namespace sac {
namespace {

class RecordedSetupOf : public ::testing::Test {
 protected:
  /// A recording of texts, each on its topic below /actuator.
  std::string bagOf(const std::vector<std::pair<std::string, std::string>>& texts,
                    const std::string& name = "a.bag") const {
    rosbag::Bag bag(folder_.path(name), rosbag::bagmode::Write);
    bag.write("/actuator/joint_states", ros::Time(1.0), sensor_msgs::JointState());
    for (const auto& [topic, text] : texts) {
      std_msgs::String message;
      message.data = text;
      bag.write("/actuator/" + topic, ros::Time(1.0), message);
    }
    bag.close();
    return folder_.path(name);
  }

  static RecordedSetup read(const std::vector<std::string>& bags, const SetupParts& parts = {}) {
    return recordedSetup(OpenRecordings(bags), "actuator", parts);
  }

  template <typename ErrorType>
  void expectError(const std::vector<std::pair<std::string, std::string>>& texts,
                   const std::string& part) const {
    const std::string bag = bagOf(texts);
    const std::string message = errorMessage<ErrorType>([&] { read({bag}); });
    EXPECT_NE(message.find(bag + ": /actuator/calibration_"), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  static std::string description() { return renderDescription({unit()}, "unit"); }

  TemporaryFolder folder_;
};

TEST_F(RecordedSetupOf, ASessionIsWhatItWasStartedWith) {
  CalibrationConfig config;
  config.samples.settle_after_motion = 0.7;
  RegistrationUncertainty registration;
  registration.rotor_marker = 1e-4;
  stateRegistration(config, registration);
  const std::string text = renderCalibrationConfig(config);
  // The node came back: it says the same again.
  const RecordedSetup setup = read({bagOf({{"calibration_description", description()},
                                           {"calibration_config", text},
                                           {"calibration_description", description()}})});
  ASSERT_TRUE(setup.description && setup.config);
  EXPECT_EQ(renderDescription(*setup.description, "read"), description());
  EXPECT_EQ(renderCalibrationConfig(*setup.config), text);
}

TEST_F(RecordedSetupOf, AnEarlierReleaseIsNothing) {
  const RecordedSetup setup = read({bagOf({})});
  EXPECT_FALSE(setup.description || setup.config);
}

TEST_F(RecordedSetupOf, SessionsThatDifferIsRefusedUnlessItIsNotWanted) {
  Actuator other = unit();
  other.joints[0].offset = 0.1;
  const std::string a = bagOf({{"calibration_description", description()}});
  const std::string b =
      bagOf({{"calibration_description", renderDescription({other}, "other")}}, "b.bag");
  const std::string message = errorMessage<DataError>([&] { read({a, b}); });
  EXPECT_NE(message.find(b + ": /actuator/calibration_description: another one"), std::string::npos)
      << message;
  EXPECT_NE(message.find(a), std::string::npos) << message;
  EXPECT_FALSE(read({a, b}, {false, true}).description);
}

TEST_F(RecordedSetupOf, NonsenseIsRefusedAsOfAFile) {
  expectError<ConfigError>({{"calibration_config", "dwell: {rest: 1.0}\n"}}, "rest");
  expectError<ConfigError>({{"calibration_config", "a: 1\n---\nb: 2\n"}}, "one YAML document");
  expectError<ConfigError>({{"calibration_description", ""}}, "empty");
  expectError<ConfigError>({{"calibration_description", "&a [*a]"}}, "alias");
  expectError<DataError>({{"calibration_description", std::string((16U << 20U) + 1, ' ')}},
                         "bytes");
}

TEST_F(RecordedSetupOf, AStrangerReadsNoOtherFile) {
  std::string text = description();
  const std::size_t curve = text.find("torque_curve:");
  const std::size_t end = text.find('\n', curve);
  text.replace(curve, end - curve, "torque_curve: {table: /etc/passwd}");
  expectError<ConfigError>({{"calibration_description", text}}, "names no file");
}

TEST_F(RecordedSetupOf, AnotherTypeIsRefused) {
  rosbag::Bag bag(folder_.path("a.bag"), rosbag::bagmode::Write);
  bag.write("/actuator/calibration_config", ros::Time(1.0), sensor_msgs::JointState());
  bag.close();
  const std::string message = errorMessage<DataError>([&] { read({folder_.path("a.bag")}); });
  EXPECT_NE(message.find("sensor_msgs/JointState, but must be std_msgs/String"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace sac
