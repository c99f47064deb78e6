// libFuzzer's entry: the target is the one that the environment names.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fuzz/fuzz_targets.hpp"

namespace {

const sac::fuzz::Target& chosenTarget() {
  const char* const name = std::getenv("FUZZ_TARGET");
  for (const sac::fuzz::Target& target : sac::fuzz::targets()) {
    if (name != nullptr && target.name == name) {
      return target;
    }
  }
  std::fprintf(stderr, "FUZZ_TARGET must be one of:");
  for (const sac::fuzz::Target& target : sac::fuzz::targets()) {
    std::fprintf(stderr, " %s", target.name.c_str());
  }
  std::fprintf(stderr, "\n");
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const sac::fuzz::Target& target = chosenTarget();
  target.run(data, size);
  return 0;
}
