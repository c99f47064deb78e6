#pragma once

#include <vector>

#include "spherical_actuator_calibration/drivers/register_field.hpp"

namespace sac {

/// Words that fit into one request (Modbus application protocol): read, written, and written where
/// the same request reads.
inline constexpr int kMostWordsRead = 125;
inline constexpr int kMostWordsWritten = 123;
inline constexpr int kMostWordsWrittenAndRead = 121;

/// Words of one device, in one request.
struct RegisterRequest {
  int unit = 1;
  RegisterTable table = RegisterTable::kHolding;
  int address = 0;
  int count = 0;

  int end() const { return address + count; }
  bool isOfSameTable(const RegisterRequest& other) const {
    return unit == other.unit && table == other.table;
  }
  bool holds(const RegisterRequest& other) const {
    return isOfSameTable(other) && other.address >= address && other.end() <= end();
  }
};

/// The words of so many numbers of one kind, one after the other.
RegisterRequest requestFor(const RegisterField& field, int numbers = 1);

/// The requests that read all these words: neighbours of one table are read at once, also where
/// few words are in vain between them.
std::vector<RegisterRequest> joinedRequests(std::vector<RegisterRequest> requests);

}  // namespace sac
