#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <thread>
#include <tuple>
#include <vector>

#include "spherical_actuator_calibration/drivers/modbus_transport.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {

/// A bus with devices that are tables of words, and with failures on demand.
class ScriptedTransport : public ModbusTransport {
 public:
  struct Write {
    int unit = 0;
    int address = 0;
    std::vector<std::uint16_t> words;
  };

  void set(int unit, RegisterTable table, int address, const std::vector<std::uint16_t>& words) {
    for (std::size_t n = 0; n < words.size(); ++n) {
      words_[{unit, table, address + static_cast<int>(n)}] = words[n];
    }
  }
  std::uint16_t at(int unit, RegisterTable table, int address) const {
    const auto place = words_.find({unit, table, address});
    return place == words_.end() ? std::uint16_t{0} : place->second;
  }

  /// The next requests fail so, one each; nothing: it succeeds.
  void failNext(std::optional<TransportFailure> failure, int times = 1) {
    failures_.insert(failures_.end(), static_cast<std::size_t>(times), failure);
  }
  /// While it is unreachable, nothing can be opened.
  void setReachable(bool reachable) {
    reachable_ = reachable;
    is_open_ = is_open_ && reachable;
  }

  /// While it refuses, it takes no words, and can be read.
  void setRefusing(bool refusing) { is_refusing_ = refusing; }

  /// Reading from this address on takes so long [s], from now on.
  void setSlow(int address, double seconds) {
    slow_address_ = address;
    slow_time_ = seconds;
  }

  const std::vector<Write>& writes() const { return writes_; }
  int reads() const { return reads_; }
  /// Writes that read, too.
  int exchanges() const { return exchanges_; }
  int opened() const { return opened_; }

  /// How often a span of time began, and its length [s].
  int spans() const { return spans_; }
  double span() const { return span_; }

  void allow(double seconds) override {
    ++spans_;
    span_ = seconds;
  }
  void open() override {
    if (is_open_) {
      return;
    }
    if (!reachable_) {
      throw TransportError(TransportFailure::kUnreachable, "the device cannot be reached");
    }
    is_open_ = true;
    ++opened_;
  }
  void close() override { is_open_ = false; }
  bool isOpen() const override { return is_open_; }

  std::vector<std::uint16_t> read(int unit, RegisterTable table, int address, int count) override {
    request();
    ++reads_;
    return wordsAt(unit, table, address, count);
  }

  void write(int unit, int address, const std::vector<std::uint16_t>& words) override {
    request();
    if (is_refusing_) {
      throw TransportError(TransportFailure::kRefused, "the device takes no words");
    }
    writes_.push_back({unit, address, words});
    set(unit, RegisterTable::kHolding, address, words);
  }

  std::vector<std::uint16_t> writeAndRead(int unit,
                                          int address,
                                          const std::vector<std::uint16_t>& words,
                                          int read_address,
                                          int count) override {
    write(unit, address, words);
    ++exchanges_;
    return wordsAt(unit, RegisterTable::kHolding, read_address, count);
  }

 private:
  /// As they are read.
  std::vector<std::uint16_t> wordsAt(int unit, RegisterTable table, int address, int count) const {
    if (address == slow_address_) {
      std::this_thread::sleep_for(std::chrono::duration<double>(slow_time_));
    }
    std::vector<std::uint16_t> words(static_cast<std::size_t>(count));
    std::generate(words.begin(), words.end(), [&] { return at(unit, table, address++); });
    return words;
  }

  void request() {
    if (!is_open_) {
      throw TransportError(TransportFailure::kUnreachable, "the link is closed");
    }
    if (failures_.empty()) {
      return;
    }
    const std::optional<TransportFailure> failure = failures_.front();
    failures_.pop_front();
    if (failure) {
      is_open_ = *failure == TransportFailure::kRefused;
      throw TransportError(*failure, "the script wants it so");
    }
  }

  std::map<std::tuple<int, RegisterTable, int>, std::uint16_t> words_;
  std::deque<std::optional<TransportFailure>> failures_;
  std::vector<Write> writes_;
  bool reachable_ = true;
  bool is_open_ = false;
  bool is_refusing_ = false;
  int reads_ = 0;
  int exchanges_ = 0;
  int opened_ = 0;
  int spans_ = 0;
  double span_ = 0.0;
  int slow_address_ = -1;
  double slow_time_ = 0.0;
};

}  // namespace sac
