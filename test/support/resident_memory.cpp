#include "support/resident_memory.hpp"

#include <fstream>
#include <string>

#include <malloc.h>

namespace sac {
namespace {

/// By its name in /proc [byte].
double memory(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0.0;
  while (status >> word && word != name) {
  }
  status >> kilobytes;
  return 1024.0 * kilobytes;
}

}  // namespace

double peakBeside(const std::function<void()>& action) {
  // What is free in the heap would be used first, and would not be seen.
  ::malloc_trim(0);
  const double before = memory("VmRSS:");
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak begins anew
  action();
  return memory("VmHWM:") - before;
}

}  // namespace sac
