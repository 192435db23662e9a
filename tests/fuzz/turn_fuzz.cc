// Any bytes as a turn (sim/processes/turn.h). Laws: an invalid turn is refused with a sentence. A valid one
// is the same after writing and reading, and can be simulated.
#include <algorithm>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/check.h"
#include "schedules/file/loader.h"
#include "sim/processes/turn.h"
#include "tests/fuzz/harness.h"

using namespace ttf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const schedules::model::Cluster cluster =
      schedules::file::parse_cluster(fuzz::shipped_cluster("closed_loop_synchronised"), "closed_loop");
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  std::vector<sim::processes::Act> acts;
  try {
    const sim::processes::TurnHeader header = sim::processes::read_turn(cluster, bytes, acts);
    TTF_CHECK(header.promise.silent_until > header.at, "silent until {}", header.promise.silent_until.value);
    sim::processes::TurnWriter writer;
    for (const sim::processes::Act& act : acts) writer.add(act);
    const auto again = writer.finish(header);
    TTF_CHECK(std::equal(bytes.begin(), bytes.end(), again.begin(), again.end()), "{} bytes become {}", size,
              again.size());
  } catch (const std::runtime_error& error) {
    TTF_CHECK(!std::string_view(error.what()).empty(), "refused without a word");
  }
  return 0;
}
