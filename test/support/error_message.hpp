#pragma once

#include <string>

namespace sac {

/// Message of the exception of type `Expected` that `action` throws; "no exception" otherwise.
template <typename Expected, typename Action>
std::string errorMessage(Action action) {
  try {
    action();
  } catch (const Expected& error) {
    return error.what();
  }
  return "no exception";
}

}  // namespace sac
