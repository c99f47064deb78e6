#include "spherical_actuator_calibration/emulation/emulated_amplifier.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

void validate(const AmplifierDynamics& dynamics) {
  requireInRange("amplifier time constant", dynamics.time_constant, ValueRange::nonNegative("s"));
  requireInRange("amplifier watchdog", dynamics.watchdog, ValueRange::positive("s"));
  requireInRange("amplifier delay", dynamics.delay, ValueRange::closed(0.0, 0.5, "s"));
}

EmulatedAmplifier::EmulatedAmplifier(const CurrentAmplifierOptions& options,
                                     const AmplifierDynamics& dynamics,
                                     std::size_t coils,
                                     ModbusServer& server)
    : options_(options),
      dynamics_(dynamics),
      coils_(coils),
      server_(server),
      currents_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils))) {
  validate(dynamics);
  orders_.push_back({time_, currents_});
  server_.addUnit(options.setpoints.unit);
  server_.addUnit(options.currents.unit);
  if (options.tripped) {
    server_.addUnit(options.tripped->unit);
  }
  show(currents_);
}

void EmulatedAmplifier::advance(double step) {
  const Eigen::VectorXd wanted =
      isOn(step) ? setpoints() : Eigen::VectorXd::Zero(currents_.size()).eval();
  if (wanted != orders_.back().currents) {
    orders_.push_back({time_ + dynamics_.delay, wanted});
  }
  const double end = time_ + step;
  while (orders_.size() > 1 && orders_[1].time < end) {
    approach(orders_.front().currents, std::max(0.0, orders_[1].time - time_));
    time_ = std::max(time_, orders_[1].time);
    orders_.pop_front();
  }
  approach(orders_.front().currents, end - time_);
  time_ = end;
}

void EmulatedAmplifier::approach(const Eigen::VectorXd& wanted, double step) {
  const double share =
      dynamics_.time_constant > 0.0 ? -std::expm1(-step / dynamics_.time_constant) : 1.0;
  currents_ += share * (wanted - currents_);
}

void EmulatedAmplifier::setTripped(bool tripped) {
  tripped_ = tripped;
  if (options_.tripped) {
    const RegisterField& field = *options_.tripped;
    server_.setWords(field.unit,
                     field.table,
                     field.address,
                     encodeRegisters(tripped ? 1.0 : 0.0, field.type, field.order));
  }
}

void EmulatedAmplifier::show(const Eigen::VectorXd& measured) {
  const RegisterField& field = options_.currents;
  std::vector<std::uint16_t> words;
  words.reserve(coils_ * static_cast<std::size_t>(field.words()));
  for (const double current : measured) {
    const std::vector<std::uint16_t> number = field.encode(current);
    words.insert(words.end(), number.begin(), number.end());
  }
  server_.setWords(field.unit, field.table, field.address, words);
}

bool EmulatedAmplifier::isOn(double step) {
  const auto word = [this](int address) {
    return server_.words(options_.setpoints.unit, RegisterTable::kHolding, address, 1).front();
  };
  heartbeat_age_ += step;
  if (options_.heartbeat_address && word(*options_.heartbeat_address) != heartbeat_) {
    heartbeat_ = word(*options_.heartbeat_address);
    heartbeat_age_ = 0.0;
  }
  const bool is_alive = !options_.heartbeat_address || heartbeat_age_ <= dynamics_.watchdog;
  const bool is_enabled = !options_.enable_address || word(*options_.enable_address) == 1;
  return is_alive && is_enabled && !tripped_;
}

Eigen::VectorXd EmulatedAmplifier::setpoints() const {
  const RegisterField& field = options_.setpoints;
  const auto words_each = static_cast<std::size_t>(field.words());
  const std::vector<std::uint16_t> words =
      server_.words(field.unit, field.table, field.address, static_cast<int>(coils_ * words_each));
  Eigen::VectorXd result(currents_.size());
  for (std::size_t coil = 0; coil < coils_; ++coil) {
    result[static_cast<Eigen::Index>(coil)] = field.decode(&words[coil * words_each]);
  }
  return result;
}

}  // namespace sac
