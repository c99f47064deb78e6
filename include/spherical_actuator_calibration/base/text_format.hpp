#pragma once

#include <cstddef>
#include <string>

namespace sac {

/// Text as printf() writes it, of any length.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

/// Three significant digits, for sentences.
std::string shortNumber(double value);

/// 1 pose, 2 poses.
std::string counted(std::size_t count, const std::string& what);

}  // namespace sac
