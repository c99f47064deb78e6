#include "spherical_actuator_calibration/drivers/register_request.hpp"

#include <algorithm>
#include <tuple>

namespace sac {
namespace {

/// Words that may be read in vain to save a request. More take longer than a request on a serial
/// line, and a device need not have them.
constexpr int kLargestGap = 8;

}  // namespace

RegisterRequest requestFor(const RegisterField& field, int numbers) {
  return {field.unit, field.table, field.address, numbers * field.words()};
}

std::vector<RegisterRequest> joinedRequests(std::vector<RegisterRequest> requests) {
  std::sort(
      requests.begin(), requests.end(), [](const RegisterRequest& a, const RegisterRequest& b) {
        return std::tie(a.unit, a.table, a.address) < std::tie(b.unit, b.table, b.address);
      });
  std::vector<RegisterRequest> joined;
  for (const RegisterRequest& request : requests) {
    if (!joined.empty()) {
      RegisterRequest& last = joined.back();
      if (last.isOfSameTable(request) && request.address <= last.end() + kLargestGap &&
          request.end() - last.address <= kMostWordsRead) {
        last.count = std::max(last.count, request.end() - last.address);
        continue;
      }
    }
    joined.push_back(request);
  }
  return joined;
}

}  // namespace sac
