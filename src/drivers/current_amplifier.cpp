#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {
namespace {

// Words that fit into one request (Modbus application protocol).
constexpr std::size_t kLargestWrite = 123;
constexpr std::size_t kLargestRead = 125;

constexpr std::int64_t kLargestAddress = 65535;

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
constexpr double kLongestPatience = 0.4;    // [s]
constexpr double kPatience = 0.2;           // [s] unless it is said

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
  limits.deviating_beats = static_cast<int>(std::lround(kPatience * options.rate));
  limits.beat_period = 1.0 / options.rate;
  if (map.has("deviation")) {
    const YamlMap deviation = map.map("deviation");
    limits.deviation = deviation.number("tolerance", ValueRange{0.0, largest, "A", true, false});
    const auto most = static_cast<std::int64_t>(kLongestPatience * options.rate + 1e-6);
    limits.deviating_beats = static_cast<int>(deviation.integer("beats", 1, most));
  } else if (limits.deviation > largest) {
    map.fail("deviation.tolerance",
             "is missing, and 0.15 A are too much where limits.coil is less than 0.6 A.");
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
struct RegisterBlock {
  std::string name;  ///< as in a configuration
  int unit = 0;
  RegisterTable table = RegisterTable::kHolding;
  int first = 0;
  int count = 1;

  int end() const { return first + count; }
  bool overlaps(const RegisterBlock& other) const {
    return unit == other.unit && table == other.table && first < other.end() && other.first < end();
  }
};

std::vector<RegisterBlock> blocksOf(const CurrentAmplifierOptions& options, int coils) {
  const auto block = [](const std::string& name, const RegisterField& field, int numbers) {
    return RegisterBlock{name, field.unit, field.table, field.address, numbers * field.words()};
  };
  std::vector<RegisterBlock> blocks{block("setpoints", options.setpoints, coils),
                                    block("currents", options.currents, coils)};
  const int unit = options.setpoints.unit;
  if (options.enable_address) {
    blocks.push_back({"enable_address", unit, RegisterTable::kHolding, *options.enable_address});
  }
  if (options.heartbeat_address) {
    blocks.push_back(
        {"heartbeat_address", unit, RegisterTable::kHolding, *options.heartbeat_address});
  }
  if (options.tripped) {
    blocks.push_back(block("tripped", *options.tripped, 1));
  }
  return blocks;
}

void requireRegistersApart(const CurrentAmplifierOptions& options, std::size_t coils) {
  const std::vector<RegisterBlock> blocks = blocksOf(options, static_cast<int>(coils));
  for (auto block = blocks.begin(); block != blocks.end(); ++block) {
    const std::string range = block->name + " has the registers " + std::to_string(block->first) +
                              " to " + std::to_string(block->end() - 1);
    if (block->end() - 1 > kLargestAddress) {
      throw ConfigError(range + "; the last one of a device is 65535.");
    }
    const auto other = std::find_if(blocks.begin(), block, [&](const RegisterBlock& before) {
      return before.overlaps(*block);
    });
    if (other != block) {
      throw ConfigError(range + ", and " + other->name + " has " + std::to_string(other->first) +
                        " to " + std::to_string(other->end() - 1) + " of the same device.");
    }
  }
}

/// Numbers of one field that a request of so many words holds.
std::size_t perRequest(const RegisterField& field, std::size_t words) {
  return words / static_cast<std::size_t>(field.words());
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
  return options;
}

CurrentAmplifier::CurrentAmplifier(const CurrentAmplifierOptions& options,
                                   std::size_t coils,
                                   ModbusTransport& transport)
    : options_(options), coils_(coils), transport_(transport) {
  requireRegistersApart(options, coils);
}

void CurrentAmplifier::write(const Eigen::VectorXd& currents,
                             OutputStages stages,
                             Heartbeat heartbeat) {
  const RegisterField& field = options_.setpoints;
  std::vector<std::uint16_t> words;
  words.reserve(coils_ * static_cast<std::size_t>(field.words()));
  for (const double current : currents) {
    const std::vector<std::uint16_t> number = field.encode(current);
    words.insert(words.end(), number.begin(), number.end());
  }
  const bool is_given = options_.heartbeat_address && heartbeat == Heartbeat::kGiven;
  const int next = field.address + static_cast<int>(words.size());
  // A heartbeat that follows the setpoints goes with them: each request is a round trip.
  const bool is_next = is_given && *options_.heartbeat_address == next;
  if (is_next) {
    words.push_back(++heartbeat_);
  }
  writeSetpoints(words);
  if (is_given && !is_next) {
    transport_.write(field.unit, *options_.heartbeat_address, {++heartbeat_});
  }
  if (options_.enable_address && stages_ != stages) {
    const std::uint16_t word = stages == OutputStages::kOn ? 1 : 0;
    transport_.write(field.unit, *options_.enable_address, {word});
    stages_ = stages;
  }
}

Eigen::VectorXd CurrentAmplifier::read() {
  const RegisterField& field = options_.currents;
  const auto words_each = static_cast<std::size_t>(field.words());
  const std::size_t most = perRequest(field, kLargestRead);
  Eigen::VectorXd currents(static_cast<Eigen::Index>(coils_));
  for (std::size_t first = 0; first < coils_; first += most) {
    const std::size_t count = std::min(most, coils_ - first);
    const std::vector<std::uint16_t> words =
        transport_.read(field.unit,
                        field.table,
                        field.address + static_cast<int>(first * words_each),
                        static_cast<int>(count * words_each));
    for (std::size_t n = 0; n < count; ++n) {
      currents[static_cast<Eigen::Index>(first + n)] = field.decode(&words[n * words_each]);
    }
  }
  if (!currents.allFinite()) {
    throw TransportError(TransportFailure::kGarbled,
                         "The amplifier measures a current that is not finite.");
  }
  return currents;
}

bool CurrentAmplifier::isTripped() {
  if (!options_.tripped) {
    return false;
  }
  const RegisterField& field = *options_.tripped;
  const std::vector<std::uint16_t> words =
      transport_.read(field.unit, field.table, field.address, field.words());
  return decodeRegisters(words.data(), field.type, field.order) != 0.0;
}

void CurrentAmplifier::switchOff() {
  // Should this fail, nothing is known of the output stages.
  stages_.reset();
  if (options_.enable_address) {
    transport_.write(options_.setpoints.unit, *options_.enable_address, {0});
  }
}

void CurrentAmplifier::zero() {
  const RegisterField& field = options_.setpoints;
  std::vector<std::uint16_t> words;
  const std::vector<std::uint16_t> zero = field.encode(0.0);
  for (std::size_t coil = 0; coil < coils_; ++coil) {
    words.insert(words.end(), zero.begin(), zero.end());
  }
  writeSetpoints(words);
}

void CurrentAmplifier::writeSetpoints(const std::vector<std::uint16_t>& words) {
  const RegisterField& field = options_.setpoints;
  const std::size_t most =
      perRequest(field, kLargestWrite) * static_cast<std::size_t>(field.words());
  for (std::size_t first = 0; first < words.size(); first += most) {
    const std::size_t last = std::min(first + most, words.size());
    transport_.write(field.unit,
                     field.address + static_cast<int>(first),
                     {words.begin() + static_cast<std::ptrdiff_t>(first),
                      words.begin() + static_cast<std::ptrdiff_t>(last)});
  }
}

}  // namespace sac
