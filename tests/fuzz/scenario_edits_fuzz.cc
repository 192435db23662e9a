// Edits of the shipped scenarios (tests/fuzz/edits.h).
#include <array>

#include "tests/fuzz/edits.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/scenario_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  static const std::array<ttf::fuzz::Shipped, 3> kFiles{
      {{"paper_scenario1", ttf::fuzz::shipped("scenarios/paper_scenario1.yaml")},
       {"paper_scenario2", ttf::fuzz::shipped("scenarios/paper_scenario2.yaml")},
       {"laser_radar_recorded", ttf::fuzz::shipped("scenarios/laser_radar_recorded.yaml")}}};
  ttf::fuzz::check_scenario(edited(kFiles, ttf::fuzz::text_of(data, size)));
  return 0;
}
