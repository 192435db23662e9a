// Edits of the shipped plans (tests/fuzz/edits.h) that pass the parser and reach the search.
#include <array>

#include "tests/fuzz/edits.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/plan_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  static const std::array<ttf::fuzz::Shipped, 6> kFiles{
      {{"paper_laser", ttf::fuzz::shipped_cluster("plans/paper_laser")},
       {"paper", ttf::fuzz::shipped_cluster("plans/paper")},
       {"paper_payload", ttf::fuzz::shipped_cluster("plans/paper_payload")},
       {"paper_short_scans", ttf::fuzz::shipped_cluster("plans/paper_short_scans")},
       {"paper_sixty_cycles", ttf::fuzz::shipped_cluster("plans/paper_sixty_cycles")},
       {"paper_two_lasers_radar", ttf::fuzz::shipped_cluster("plans/paper_two_lasers_radar")}}};
  ttf::fuzz::check_plan(edited(kFiles, ttf::fuzz::text_of(data, size)));
  return 0;
}
