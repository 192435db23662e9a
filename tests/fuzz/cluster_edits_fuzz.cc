// Edits of the shipped clusters (tests/fuzz/edits.h) that pass the parser and reach the checker, the ages and
// the nodes' code.
#include <array>

#include "tests/fuzz/cluster_laws.h"
#include "tests/fuzz/edits.h"
#include "tests/fuzz/harness.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  static const std::array<ttf::fuzz::Shipped, 6> kFiles{
      {{"paper_synchronised", ttf::fuzz::shipped_cluster("paper_synchronised")},
       {"paper_unsynchronised", ttf::fuzz::shipped_cluster("paper_unsynchronised")},
       {"laser_radar", ttf::fuzz::shipped_cluster("laser_radar")},
       {"laser_radar_synchronised", ttf::fuzz::shipped_cluster("laser_radar_synchronised")},
       {"flexray_demo", ttf::fuzz::shipped_cluster("flexray_demo")},
       {"paper_free_flexray", ttf::fuzz::shipped_cluster("paper_free_flexray")}}};
  ttf::fuzz::check_cluster(edited(kFiles, ttf::fuzz::text_of(data, size)));
  return 0;
}
