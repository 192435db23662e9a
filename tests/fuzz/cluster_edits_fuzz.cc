// Edits of the shipped clusters (tests/fuzz/edits.h): past the parser, into the checker, the ages and the nodes' code.
#include <array>

#include "tests/fuzz/cluster_laws.h"
#include "tests/fuzz/edits.h"
#include "tests/fuzz/harness.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  static const std::array<Shipped, 6> kFiles{
      {{"paper_synchronised", shipped("schedules/paper_synchronised.yaml")},
       {"paper_unsynchronised", shipped("schedules/paper_unsynchronised.yaml")},
       {"laser_radar", shipped("schedules/laser_radar.yaml")},
       {"laser_radar_synchronised", shipped("schedules/laser_radar_synchronised.yaml")},
       {"flexray_demo", shipped("schedules/flexray_demo.yaml")},
       {"paper_free_flexray", shipped("schedules/paper_free_flexray.yaml")}}};
  check_cluster(edited(kFiles, text_of(data, size)));
  return 0;
}
