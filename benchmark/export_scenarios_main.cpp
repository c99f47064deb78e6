/// Writes the benchmarks' scenarios with their solutions for the reference script:
/// export_scenarios FILE.json

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "cycle_scenarios.hpp"

namespace sac::benchmarks {
namespace {

std::string solved(Cycle cycle, std::size_t samples) {
  const CycleScenario scenario = cycleScenario(cycle, samples);
  const CycleOutcome outcome =
      runCycle(scenario.model, scenario.samples, scenario.state, scenario.request, {});
  return toJson(scenario, outcome.state);
}

}  // namespace
}  // namespace sac::benchmarks

int main(int argc, char** argv) {
  using sac::Cycle;
  using sac::benchmarks::solved;
  if (argc != 2) {
    std::cerr << "usage: export_scenarios FILE.json\n";
    return 2;
  }
  std::ofstream file(argv[1]);
  file << "{\"joint\": " << solved(Cycle::kJoint, 30)
       << ",\n\"poles\": " << solved(Cycle::kPoles, 30)
       << ",\n\"coil\": " << solved(Cycle::kCoil, 4)
       << ",\n\"refine\": " << solved(Cycle::kRefine, 132) << "}\n";
  file.close();
  if (!file) {
    std::cerr << "export_scenarios: cannot write " << argv[1] << ".\n";
    return 1;
  }
  return 0;
}
