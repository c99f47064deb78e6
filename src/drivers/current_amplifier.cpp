#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {
namespace {

constexpr double kLongestBeat = 1.0;  // [s]

std::optional<int> readAddress(const YamlMap& map, const char* key) {
  if (!map.has(key)) {
    return std::nullopt;
  }
  return static_cast<int>(map.integer(key, 0, kLargestAddress));
}

/// What the comparison of currents may be told, so that it is one: a larger tolerance or patience
/// would let currents flow that nobody has set.
constexpr double kLargestTolerance = 0.25;  // of the largest current of a coil
/// Less would accuse honest amplifiers, whose lag is between those that are tried.
constexpr double kSmallestTolerance = 0.03;
constexpr double kLongestPatience = 0.4;  // [s]
constexpr double kPatience = 0.2;         // [s] unless it is said

SupervisorLimits readSupervision(const YamlMap& map) {
  SupervisorLimits limits;
  limits.watchdog = map.number("watchdog", ValueRange::closed(0.01, 1.0, "s"), limits.watchdog);
  limits.clock_skew =
      map.number("clock_skew", ValueRange::closed(0.0, 1.0, "s"), limits.clock_skew);
  return limits;
}

void readDeviation(const YamlMap& map, CurrentAmplifierOptions& options) {
  SupervisorLimits& limits = options.supervision;
  const double largest = kLargestTolerance * options.limits.coil;
  const double smallest = kSmallestTolerance * options.limits.coil;
  limits.deviating_beats = static_cast<int>(std::lround(kPatience * options.rate));
  limits.beat_period = 1.0 / options.rate;
  if (map.has("deviation")) {
    const YamlMap deviation = map.map("deviation");
    limits.deviation = deviation.number("tolerance", ValueRange::closed(smallest, largest, "A"));
    const auto most = static_cast<std::int64_t>(kLongestPatience * options.rate + 1e-6);
    limits.deviating_beats = static_cast<int>(deviation.integer("beats", 1, most));
  } else if (limits.deviation > largest || limits.deviation < smallest) {
    map.fail("deviation.tolerance",
             "is missing, and 0.15 A do not suit where limits.coil is below 0.6 A or above 5 A.");
  }
}

/// An amplifier without a heartbeat goes on for ever once its driver was killed: that is accepted
/// in writing, or the driver does not start.
void requireHeartbeat(const YamlMap& map) {
  const bool accepted = map.has("unattended_amplifier") &&
                        map.choice("unattended_amplifier", {"accepted"}) == "accepted";
  if (!accepted && !map.has("heartbeat_address")) {
    map.fail(
        "heartbeat_address",
        "is missing: without a watchdog of the amplifier nothing ends its currents when this "
        "program is killed. Where that is accepted, write \"unattended_amplifier: accepted\".");
  }
}

/// Registers of a device that belong together.
struct RegisterBlock : RegisterRequest {
  std::string name;  ///< as in a configuration

  bool overlaps(const RegisterBlock& other) const {
    return isOfSameTable(other) && address < other.end() && other.address < end();
  }
};

std::vector<RegisterBlock> blocksOf(const CurrentAmplifierOptions& options, int coils) {
  std::vector<RegisterBlock> blocks{{requestFor(options.setpoints, coils), "setpoints"},
                                    {requestFor(options.currents, coils), "currents"}};
  const int unit = options.setpoints.unit;
  if (options.enable_address) {
    blocks.push_back(
        {{unit, RegisterTable::kHolding, *options.enable_address, 1}, "enable_address"});
  }
  if (options.heartbeat_address) {
    blocks.push_back(
        {{unit, RegisterTable::kHolding, *options.heartbeat_address, 1}, "heartbeat_address"});
  }
  if (options.tripped) {
    blocks.push_back({requestFor(*options.tripped), "tripped"});
  }
  return blocks;
}

void requireRegistersApart(const CurrentAmplifierOptions& options, std::size_t coils) {
  const std::vector<RegisterBlock> blocks = blocksOf(options, static_cast<int>(coils));
  for (auto block = blocks.begin(); block != blocks.end(); ++block) {
    const std::string range = block->name + " has the registers " + std::to_string(block->address) +
                              " to " + std::to_string(block->end() - 1);
    if (block->end() - 1 > kLargestAddress) {
      throw ConfigError(range + "; the last one of a device is 65535.");
    }
    const auto other = std::find_if(blocks.begin(), block, [&](const RegisterBlock& before) {
      return before.overlaps(*block);
    });
    if (other != block) {
      throw ConfigError(range + ", and " + other->name + " has " + std::to_string(other->address) +
                        " to " + std::to_string(other->end() - 1) + " of the same device.");
    }
  }
}

bool saysTripped(const RegisterField& field, const std::uint16_t* words) {
  return decodeRegisters(words, field.type, field.order) != 0.0;
}

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Both, and what is between them.
RegisterRequest spanOf(const RegisterRequest& a, const RegisterRequest& b) {
  const int first = std::min(a.address, b.address);
  return {a.unit, a.table, first, std::max(a.end(), b.end()) - first};
}

}  // namespace

CurrentAmplifierOptions readCurrentAmplifierOptions(const YamlMap& map) {
  CurrentAmplifierOptions options;
  options.link = readModbusLink(map.map("link"));
  if (options.link.response_timeout > kLongestBeat) {
    map.map("link").fail("response_timeout",
                         "more than 1 s: a slow amplifier would keep its currents too long.");
  }
  options.rate = map.number("rate", ValueRange::closed(20.0, 5000.0, "Hz"), options.rate);
  options.supervision = readSupervision(map);
  const YamlMap limits = map.map("limits");
  const ValueRange ampere{0.0, 1000.0, "A", true, false};
  options.limits.coil = limits.number("coil", ampere);
  readDeviation(map, options);
  options.limits.total = limits.number("total", ampere);
  options.limits.slew = limits.number("slew", ValueRange{0.0, 1e6, "A/s", true, false});
  options.setpoints = readRegisterField(map.map("setpoints"));
  if (options.setpoints.table != RegisterTable::kHolding) {
    map.map("setpoints").fail("table", "input registers cannot be written.");
  }
  options.currents = readRegisterField(map.map("currents"));
  options.enable_address = readAddress(map, "enable_address");
  requireHeartbeat(map);
  options.heartbeat_address = readAddress(map, "heartbeat_address");
  options.memory_limit =
      map.number("memory_limit", ValueRange::closed(50.0, 1e6, "MB"), options.memory_limit);
  if (map.has("tripped")) {
    options.tripped = readRegisterField(map.map("tripped"));
  }
  options.one_request = map.boolean("one_request", options.one_request);
  return options;
}

CurrentAmplifier::CurrentAmplifier(const CurrentAmplifierOptions& options,
                                   std::size_t coils,
                                   ModbusTransport& transport)
    : options_(options), coils_(coils), transport_(transport) {
  requireRegistersApart(options, coils);
  const RegisterRequest block = requestFor(options.currents, static_cast<int>(coils));
  if (options.one_request) {
    joined_ = options.tripped ? spanOf(block, requestFor(*options.tripped)) : block;
    requireOneRequest();
  } else if (options.tripped) {
    const std::vector<RegisterRequest> joined =
        joinedRequests({block, requestFor(*options.tripped)});
    if (joined.size() == 1) {
      joined_ = joined.front();
    }
  }
}

void CurrentAmplifier::requireOneRequest() const {
  const RegisterRequest setpoints = requestFor(options_.setpoints, static_cast<int>(coils_));
  const std::string refusal = "one_request: one request cannot hold all, because ";
  for (const RegisterBlock& block : blocksOf(options_, static_cast<int>(coils_))) {
    if (!block.isOfSameTable(setpoints)) {
      throw ConfigError(refusal + block.name +
                        " is not among the holding registers of the unit of setpoints.");
    }
  }
  if (options_.heartbeat_address && !isHeartbeatNext()) {
    throw ConfigError(refusal + "heartbeat_address is not right after the setpoints, at " +
                      std::to_string(setpoints.end()) + ".");
  }
  if (setpoints.count + (options_.heartbeat_address ? 1 : 0) > kMostWordsWrittenAndRead) {
    throw ConfigError(refusal + "it writes at most " + std::to_string(kMostWordsWrittenAndRead) +
                      " words.");
  }
  if (joined_->count > kMostWordsRead) {
    throw ConfigError(refusal + "currents and tripped together span " +
                      std::to_string(joined_->count) + " words, and it reads at most " +
                      std::to_string(kMostWordsRead) + ".");
  }
}

CurrentAmplifier::Words CurrentAmplifier::setpointWords(const Eigen::VectorXd& currents) const {
  Words words;
  words.reserve(coils_ * static_cast<std::size_t>(options_.setpoints.words()) + 1);
  for (const double current : currents) {
    const Words number = options_.setpoints.encode(current);
    words.insert(words.end(), number.begin(), number.end());
  }
  return words;
}

bool CurrentAmplifier::isHeartbeatNext() const {
  return options_.heartbeat_address ==
         requestFor(options_.setpoints, static_cast<int>(coils_)).end();
}

void CurrentAmplifier::write(const Eigen::VectorXd& currents,
                             OutputStages stages,
                             Heartbeat heartbeat) {
  Words words = setpointWords(currents);
  const bool is_given = options_.heartbeat_address && heartbeat == Heartbeat::kGiven;
  // A heartbeat that follows the setpoints goes with them: each request is a round trip.
  const bool is_next = is_given && isHeartbeatNext();
  if (is_next) {
    words.push_back(++heartbeat_);
  }
  writeSetpoints(words);
  if (is_given && !is_next) {
    feed();
  }
  switchStages(stages);
}

void CurrentAmplifier::switchStages(OutputStages stages) {
  if (options_.enable_address && stages_ != stages) {
    const std::uint16_t word = stages == OutputStages::kOn ? 1 : 0;
    transport_.write(options_.setpoints.unit, *options_.enable_address, {word});
  }
  stages_ = stages;
}

AmplifierReading CurrentAmplifier::exchange(const Eigen::VectorXd& currents,
                                            OutputStages stages,
                                            Heartbeat heartbeat) {
  if (!options_.one_request || stages_ != stages) {
    const Clock::time_point begin = Clock::now();
    write(currents, stages, heartbeat);
    const double writing = secondsSince(begin);
    AmplifierReading reading = read();
    reading.since_set = secondsSince(begin) - 0.5 * writing;
    return reading;
  }
  Words words = setpointWords(currents);
  if (options_.heartbeat_address && heartbeat == Heartbeat::kGiven) {
    words.push_back(++heartbeat_);
  }
  const Clock::time_point begin = Clock::now();
  AmplifierReading reading = readingOf(transport_.writeAndRead(options_.setpoints.unit,
                                                               options_.setpoints.address,
                                                               words,
                                                               joined_->address,
                                                               joined_->count));
  reading.duration = secondsSince(begin);
  reading.since_set = 0.5 * reading.duration;
  return reading;
}

AmplifierReading CurrentAmplifier::read() {
  const Clock::time_point begin = Clock::now();
  AmplifierReading reading;
  if (joined_) {
    reading =
        readingOf(transport_.read(joined_->unit, joined_->table, joined_->address, joined_->count));
  } else {
    const RegisterField& field = options_.currents;
    const RegisterRequest block = requestFor(field, static_cast<int>(coils_));
    const int most = kMostWordsRead / field.words() * field.words();
    Words words;
    for (int first = block.address; first < block.end(); first += most) {
      const Words some =
          transport_.read(field.unit, field.table, first, std::min(most, block.end() - first));
      words.insert(words.end(), some.begin(), some.end());
    }
    reading.currents = decoded(words.data());
  }
  reading.duration = secondsSince(begin);
  return reading;
}

Eigen::VectorXd CurrentAmplifier::decoded(const std::uint16_t* words) const {
  const RegisterField& field = options_.currents;
  Eigen::VectorXd currents(static_cast<Eigen::Index>(coils_));
  for (double& current : currents) {
    current = field.decode(words);
    words += field.words();
  }
  if (!currents.allFinite()) {
    throw TransportError(TransportFailure::kGarbled,
                         "The amplifier measures a current that is not finite.");
  }
  return currents;
}

AmplifierReading CurrentAmplifier::readingOf(const Words& words) const {
  const auto place = [&](const RegisterField& field) {
    return words.data() + (field.address - joined_->address);
  };
  AmplifierReading reading;
  reading.currents = decoded(place(options_.currents));
  reading.tripped = options_.tripped && saysTripped(*options_.tripped, place(*options_.tripped));
  return reading;
}

bool CurrentAmplifier::isTripped() {
  if (!options_.tripped) {
    return false;
  }
  const RegisterField& field = *options_.tripped;
  return saysTripped(field,
                     transport_.read(field.unit, field.table, field.address, field.words()).data());
}

bool CurrentAmplifier::tellsTripsByReadings() const {
  return !options_.tripped || (joined_ && stages_ == OutputStages::kOn);
}

void CurrentAmplifier::switchOff() {
  // Should this fail, nothing is known of the output stages.
  stages_.reset();
  if (options_.enable_address) {
    transport_.write(options_.setpoints.unit, *options_.enable_address, {0});
  }
}

void CurrentAmplifier::zero() {
  writeSetpoints(setpointWords(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils_))));
}

void CurrentAmplifier::feed() {
  if (options_.heartbeat_address) {
    transport_.write(options_.setpoints.unit, *options_.heartbeat_address, {++heartbeat_});
  }
}

void CurrentAmplifier::writeSetpoints(const Words& words) {
  const RegisterField& field = options_.setpoints;
  const auto most = static_cast<std::size_t>(kMostWordsWritten / field.words()) *
                    static_cast<std::size_t>(field.words());
  for (std::size_t first = 0; first < words.size(); first += most) {
    const std::size_t last = std::min(first + most, words.size());
    transport_.write(field.unit,
                     field.address + static_cast<int>(first),
                     {words.begin() + static_cast<std::ptrdiff_t>(first),
                      words.begin() + static_cast<std::ptrdiff_t>(last)});
  }
}

}  // namespace sac
