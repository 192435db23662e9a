// Edits of the shipped clusters (tests/fuzz/edits.h) that pass the parser and reach the checker, the ages and
// the nodes' code.
#include <array>

#include "tests/fuzz/cluster_laws.h"
#include "tests/fuzz/edits.h"
#include "tests/fuzz/harness.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  static const std::array<ttf::fuzz::Shipped, 6> kFiles{
      {{"paper_synchronised", ttf::fuzz::shipped("schedules/paper_synchronised.yaml")},
       {"paper_unsynchronised", ttf::fuzz::shipped("schedules/paper_unsynchronised.yaml")},
       {"laser_radar", ttf::fuzz::shipped("schedules/laser_radar.yaml")},
       {"laser_radar_synchronised", ttf::fuzz::shipped("schedules/laser_radar_synchronised.yaml")},
       {"flexray_demo", ttf::fuzz::shipped("schedules/flexray_demo.yaml")},
       {"paper_free_flexray", ttf::fuzz::shipped("schedules/paper_free_flexray.yaml")}}};
  ttf::fuzz::check_cluster(edited(kFiles, ttf::fuzz::text_of(data, size)));
  return 0;
}
