#include "schedules/model/repetitions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "schedules/model/round.h"

namespace ttf::schedules::model {
namespace {

constexpr int kFrameRepetitions[] = {1, 2, 4, 5, 8, 10, 16, 20, 32, 40, 50, 64};

}  // namespace

std::vector<int> repetitions(const GlobalParameters& flexray) {
  std::vector<int> found;
  for (int one = 1; one <= cycles_per_round(flexray); ++one)
    if (cycles_per_round(flexray) % one == 0) found.push_back(one);
  return found;
}

std::vector<int> frame_repetitions(const GlobalParameters& flexray) {
  std::vector<int> found;
  for (const int one : kFrameRepetitions)
    if (cycles_per_round(flexray) % one == 0) found.push_back(one);
  return found;
}

std::string repetitions_text(const GlobalParameters& flexray, const std::vector<int>& among) {
  std::string text = fmt::format("must be one of {}", fmt::join(among, ", "));
  if (cycles_per_round(flexray) != kMostCycles)
    text += fmt::format(": repetitions divide gCycleCountMax + 1 = {}", cycles_per_round(flexray));
  return text;
}

}  // namespace ttf::schedules::model
