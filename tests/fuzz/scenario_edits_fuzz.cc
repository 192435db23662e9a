// Edits of the shipped scenarios (tests/fuzz/edits.h).
#include <array>

#include "tests/fuzz/edits.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/scenario_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  static const std::array<Shipped, 3> kFiles{
      {{"paper_scenario1", shipped("scenarios/paper_scenario1.yaml")},
       {"paper_scenario2", shipped("scenarios/paper_scenario2.yaml")},
       {"laser_radar_recorded", shipped("scenarios/laser_radar_recorded.yaml")}}};
  check_scenario(edited(kFiles, text_of(data, size)));
  return 0;
}
