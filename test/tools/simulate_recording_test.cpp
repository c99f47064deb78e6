#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/emulation_node/session_bag_writer.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"
#include "tools/program_outcome.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription = SOURCE_DIR "/config/pm_spherical_8x24.yaml";
/// Five dwells, so that a recording takes a moment only.
constexpr const char* kShort =
    " --joint-poses 2 --main-coil-poses 2 --coil-poses 0 --validation-poses 1";

class SimulateRecording : public testing::Test {
 protected:
  Outcome run(const std::string& arguments) const {
    return outcomeOf(std::string(SIMULATE_RECORDING) + " " + arguments, folder_);
  }

  /// Records a short session and expects success.
  void record(const std::string& name, const std::string& options = {}) const {
    const Outcome outcome = run("--actuator " + std::string(kDescription) + " --output " +
                                path(name) + kShort + " " + options);
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
  }

  std::string path(const std::string& name) const { return folder_.path(name); }

  TemporaryFolder folder_;
};

/// Messages of one type on one topic, in the order of their recording.
template <typename Message>
std::vector<Message> messagesOn(const std::string& bag_path, const std::string& topic) {
  rosbag::Bag bag(bag_path);
  std::vector<Message> messages;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto message = instance.instantiate<Message>();
    EXPECT_TRUE(message) << topic << " has another type";
    if (message) {
      messages.push_back(*message);
    }
  }
  return messages;
}

/// Number of messages on each topic.
std::map<std::string, int> topicsOf(const std::string& bag_path) {
  rosbag::Bag bag(bag_path);
  std::map<std::string, int> topics;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag)) {
    ++topics[instance.getTopic()];
  }
  return topics;
}

Eigen::Isometry3d transformFromRos(const geometry_msgs::Transform& message) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = quaternionFromRos(message.rotation).toRotationMatrix();
  X.translation() = vectorFromRos(message.translation);
  return X;
}

TEST_F(SimulateRecording, RecordsEveryTopicAtItsRate) {
  record("s.bag");
  const auto topics = topicsOf(path("s.bag"));
  rosbag::Bag bag(path("s.bag"));
  rosbag::View view(bag);
  const double duration = (view.getEndTime() - view.getBeginTime()).toSec();
  const std::map<std::string, double> rates = {{"/actuator/joint_states", 200.0},
                                               {"/actuator/coil_currents", 200.0},
                                               {"/actuator/tracker/pose", 120.0},
                                               {"/actuator/measured_orientation", 120.0},
                                               {"/actuator/ft_sensor/wrench", 500.0},
                                               {"/actuator/measured_torque", 500.0}};
  for (const auto& [topic, rate] : rates) {
    ASSERT_EQ(topics.count(topic), 1U) << topic;
    EXPECT_NEAR(topics.at(topic), rate * duration, 0.02 * rate + 2.0) << topic;
  }
  EXPECT_EQ(topics.at("/actuator/parameters"), 1);
  EXPECT_EQ(topics.at("/tf_static"), 1);
  EXPECT_EQ(topics.at("/actuator/calibration_description"), 1);
  EXPECT_EQ(topics.size(), 9U);
}

TEST_F(SimulateRecording, HoldsTheDescriptionThatItIsCalibratedFrom) {
  record("s.bag");
  const std::string topic = "/actuator/calibration_description";
  const std::string text = messagesOn<std_msgs::String>(path("s.bag"), topic).at(0).data;
  EXPECT_EQ(renderDescription(parseDescription(text, topic), topic),
            renderDescription(loadDescription(kDescription), topic));
}

TEST_F(SimulateRecording, MessagesNameJointsAndFrames) {
  record("s.bag");
  const auto joints =
      messagesOn<sensor_msgs::JointState>(path("s.bag"), "/actuator/joint_states").at(0);
  EXPECT_EQ(joints.name, (std::vector<std::string>{"joint_1", "joint_2", "joint_3"}));
  EXPECT_EQ(joints.position.size(), 3U);
  const auto currents =
      messagesOn<msg::CoilCurrents>(path("s.bag"), "/actuator/coil_currents").at(0);
  EXPECT_EQ(currents.current.size(), 24U);
  const auto frame_of = [](const auto& messages) { return messages.at(0).header.frame_id; };
  const std::string bag = path("s.bag");
  EXPECT_EQ(frame_of(messagesOn<geometry_msgs::PoseStamped>(bag, "/actuator/tracker/pose")),
            "tracker");
  EXPECT_EQ(frame_of(messagesOn<geometry_msgs::WrenchStamped>(bag, "/actuator/ft_sensor/wrench")),
            "ft_sensor");
  EXPECT_EQ(
      frame_of(messagesOn<geometry_msgs::QuaternionStamped>(bag, "/actuator/measured_orientation")),
      "stator");
  EXPECT_EQ(frame_of(messagesOn<geometry_msgs::Vector3Stamped>(bag, "/actuator/measured_torque")),
            "rotor");
}

TEST_F(SimulateRecording, StartsWithTheNominalParameters) {
  record("s.bag");
  const Actuator nominal = loadActuator(kDescription);
  const auto parameters =
      messagesOn<msg::ActuatorParameters>(path("s.bag"), "/actuator/parameters").at(0);
  EXPECT_EQ(parameters.actuator, "pm_spherical_8x24");
  EXPECT_EQ(parameters.serial, "unit-001");
  EXPECT_EQ(parameters.source, "nominal");
  EXPECT_EQ(parameters.header.frame_id, "stator");
  ASSERT_EQ(parameters.poles.size(), 8U);
  ASSERT_EQ(parameters.coils.size(), 24U);
  EXPECT_EQ(parameters.poles[3].polarity, -1);
  EXPECT_EQ(parameters.coils[20].azimuth, nominal.coils[20].azimuth);
}

TEST_F(SimulateRecording, MeasuredTopicsFollowFromRawOnesAndRegistrations) {
  record("s.bag");
  const std::string bag = path("s.bag");
  Registration registration;
  std::set<std::string> seen;
  const auto transforms = messagesOn<tf2_msgs::TFMessage>(bag, "/tf_static").at(0).transforms;
  for (const auto& transform : transforms) {
    const std::string frames = transform.header.frame_id + ">" + transform.child_frame_id;
    seen.insert(frames);
    const Eigen::Isometry3d X = transformFromRos(transform.transform);
    if (frames == "stator>tracker") {
      registration.X_stator_tracker = X;
    } else if (frames == "rotor>marker") {
      registration.X_rotor_marker = X;
    } else {
      registration.X_rotor_sensor = X;
    }
    EXPECT_GT(X.translation().norm(), 0.01);
    EXPECT_GT(Eigen::AngleAxisd(X.linear()).angle(), 0.1);
  }
  EXPECT_EQ(seen, (std::set<std::string>{"stator>tracker", "rotor>marker", "rotor>ft_sensor"}));

  const auto poses = messagesOn<geometry_msgs::PoseStamped>(bag, "/actuator/tracker/pose");
  const auto orientations =
      messagesOn<geometry_msgs::QuaternionStamped>(bag, "/actuator/measured_orientation");
  ASSERT_EQ(poses.size(), orientations.size());
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const Eigen::Quaterniond expected =
        orientationFromMarkerPose(registration,
                                  {0,
                                   vectorFromRos(geometry_msgs::Vector3()),
                                   quaternionFromRos(poses[n].pose.orientation)})
            .q_stator_rotor;
    ASSERT_LT(expected.angularDistance(quaternionFromRos(orientations[n].quaternion)), 1e-7);
    ASSERT_EQ(poses[n].header.stamp, orientations[n].header.stamp);
  }
  const auto wrenches = messagesOn<geometry_msgs::WrenchStamped>(bag, "/actuator/ft_sensor/wrench");
  const auto torques = messagesOn<geometry_msgs::Vector3Stamped>(bag, "/actuator/measured_torque");
  ASSERT_EQ(wrenches.size(), torques.size());
  for (std::size_t n = 0; n < wrenches.size(); ++n) {
    const WrenchMeasurement wrench{
        0, vectorFromRos(wrenches[n].wrench.force), vectorFromRos(wrenches[n].wrench.torque)};
    const Eigen::Vector3d expected = torqueFromWrench(registration, wrench).torque;
    ASSERT_LT((expected - vectorFromRos(torques[n].vector)).norm(), 1e-12);
    ASSERT_EQ(wrenches[n].header.stamp, torques[n].header.stamp);
  }
}

TEST_F(SimulateRecording, MessagesAreRecordedSoonAfterTheirStamps) {
  record("s.bag");
  rosbag::Bag bag(path("s.bag"));
  for (const rosbag::MessageInstance& instance :
       rosbag::View(bag, rosbag::TopicQuery("/actuator/tracker/pose"))) {
    const auto pose = instance.instantiate<geometry_msgs::PoseStamped>();
    EXPECT_EQ((instance.getTime() - pose->header.stamp).toNSec(), 8'000'000);
  }
}

TEST_F(SimulateRecording, SameSeedGivesTheSameFiles) {
  record("a.bag", "--seed 5");
  record("b.bag", "--seed 5");
  record("c.bag", "--seed 6");
  EXPECT_EQ(contentOf(path("a.bag")), contentOf(path("b.bag")));
  EXPECT_EQ(contentOf(path("a.truth.yaml")), contentOf(path("b.truth.yaml")));
  EXPECT_NE(contentOf(path("a.bag")), contentOf(path("c.bag")));
  EXPECT_NE(contentOf(path("a.truth.yaml")), contentOf(path("c.truth.yaml")));
}

TEST_F(SimulateRecording, TruthLiesBesideTheRecordingOrWhereAsked) {
  record("s.bag", "--seed 5");
  const Actuator truth = loadActuator(path("s.truth.yaml"));
  EXPECT_EQ(truth.serial, "unit-001");
  EXPECT_NE(truth.coils[3].polar, loadActuator(kDescription).coils[3].polar);
  record("t.bag", "--seed 9 --truth-in " + path("s.truth.yaml") + " --truth-out " + path("t.yaml"));
  EXPECT_EQ(contentOf(path("t.yaml")), contentOf(path("s.truth.yaml")));
  EXPECT_FALSE(fs::exists(path("t.truth.yaml")));
}

TEST_F(SimulateRecording, NamespaceAndCompressionAreOptions) {
  record("s.bag", "--ns lab/unit_2/ --compression none");
  const auto topics = topicsOf(path("s.bag"));
  EXPECT_EQ(topics.count("/lab/unit_2/joint_states"), 1U);
  EXPECT_EQ(topics.count("/tf_static"), 1U);
  EXPECT_EQ(topics.count("/actuator/joint_states"), 0U);
  record("lz4.bag", "--ns lab/unit_2/");
  EXPECT_LT(fs::file_size(path("lz4.bag")), fs::file_size(path("s.bag")));
}

TEST_F(SimulateRecording, DefectsReachTheRecording) {
  record("clean.bag");
  record("s.bag", "--dropouts 1 --nan-share 0.02 --repeated-share 0.05");
  const auto clean = topicsOf(path("clean.bag"));
  const auto defective = topicsOf(path("s.bag"));
  EXPECT_NE(clean.at("/actuator/joint_states"), defective.at("/actuator/joint_states"));
  int not_finite = 0;
  int repeated = 0;
  ros::Time previous;
  for (const auto& torque :
       messagesOn<geometry_msgs::Vector3Stamped>(path("s.bag"), "/actuator/measured_torque")) {
    not_finite += vectorFromRos(torque.vector).allFinite() ? 0 : 1;
    repeated += torque.header.stamp == previous ? 1 : 0;
    previous = torque.header.stamp;
  }
  EXPECT_GT(not_finite, 20);
  EXPECT_GT(repeated, 50);
}

TEST_F(SimulateRecording, WithoutCoilsThereAreJointsAndTrackerOnly) {
  std::ofstream(path("joints.yaml")) << "actuator:\n"
                                        "  name: gimbal\n"
                                        "  joints:\n"
                                        "    - {name: roll, axis: [1.0, 0.0, 0.0], offset: 0.0}\n"
                                        "    - {name: pitch, axis: [0.0, 1.0, 0.0], offset: 0.0}\n"
                                        "    - {name: yaw, axis: [0.0, 0.0, 1.0], offset: 0.0}\n"
                                        "  workspace: {tilt_limit: 0.5}\n";
  const Outcome outcome =
      run("--actuator " + path("joints.yaml") + " --output " + path("s.bag") + kShort);
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  std::set<std::string> topics;
  for (const auto& [topic, messages] : topicsOf(path("s.bag"))) {
    topics.insert(topic);
  }
  EXPECT_EQ(topics,
            (std::set<std::string>{"/actuator/calibration_description",
                                   "/actuator/joint_states",
                                   "/actuator/measured_orientation",
                                   "/actuator/parameters",
                                   "/actuator/tracker/pose",
                                   "/tf_static"}));
  const auto joints =
      messagesOn<sensor_msgs::JointState>(path("s.bag"), "/actuator/joint_states").at(0);
  EXPECT_EQ(joints.name.at(2), "yaw");
}

TEST_F(SimulateRecording, ReplacesFilesOnlyWhenForced) {
  record("s.bag");
  const std::string before = contentOf(path("s.bag"));
  const std::string again =
      "--seed 2 --actuator " + std::string(kDescription) + " --output " + path("s.bag") + kShort;
  const Outcome refused = run(again);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find(path("s.bag") + ": the file exists already"), std::string::npos)
      << refused.errors;
  EXPECT_EQ(contentOf(path("s.bag")), before);
  EXPECT_EQ(run(again + " --force").status, 0);
  EXPECT_NE(contentOf(path("s.bag")), before);
  EXPECT_FALSE(fs::exists(path("s.bag.active")));
}

TEST_F(SimulateRecording, BadUsageEndsWithTwoAndASentence) {
  const std::string good = "--actuator " + std::string(kDescription) + " --output " + path("s.bag");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "--actuator is needed"},
      {"--actuator " + std::string(kDescription), "--output is needed"},
      {"--actuator " + path("none.yaml") + " --output " + path("s.bag"), "none.yaml"},
      {"--actuator " + std::string(kDescription) + " --output " + path("no/s.bag"), "no/s.bag"},
      {good + " --sead 3", "--sead"},
      {good + " --seed three", "three"},
      {good + " --torque-bias 1,2", "--torque-bias: \"1,2\" is not of the form X,Y,Z"},
      {good + " --compression zip", "--compression: \"zip\""},
      {good + " --main-coil 25", "25 is not one of the coils 1 to 24"},
      {good + " --main-coil 0", "coils count from 1"},
      {good + " --jitter 1", "jitter"},
      {good + " --truth-in " + path("none.yaml"), "none.yaml"},
      {good + " stray", "positional"},
  };
  for (const auto& [arguments, sentence] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.errors.find(sentence), std::string::npos) << arguments << "\n"
                                                                << outcome.errors;
    EXPECT_FALSE(fs::exists(path("s.bag"))) << arguments;
    EXPECT_FALSE(fs::exists(path("s.bag.active"))) << arguments;
    EXPECT_FALSE(fs::exists(path("s.truth.yaml"))) << arguments;
  }
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.output.find("--tracker-poses"), std::string::npos);
}

TEST(SessionBagWriter, LeavesNothingWithoutClose) {
  const TemporaryFolder folder;
  SessionBagOptions options;
  options.begin = 1'000'000'000;
  {
    SessionBagWriter writer(folder.path("s.bag"), loadDescription(kDescription), options);
    writer.add(JointMeasurement{options.begin, Eigen::Vector3d::Zero()});
    EXPECT_EQ(writer.messages(), 4U);
    EXPECT_TRUE(fs::exists(folder.path("s.bag.active")));
  }
  EXPECT_EQ(folder.files(), 0);
}

TEST(SessionBagWriter, RefusesWhatIsNoFile) {
  SessionBagOptions options;
  options.overwrite = OverwritePolicy::kReplace;
  EXPECT_THROW(
      SessionBagWriter(fs::temp_directory_path().string(), loadDescription(kDescription), options),
      DataError);
}

}  // namespace
}  // namespace sac
