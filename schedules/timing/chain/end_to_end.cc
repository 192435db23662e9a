#include "schedules/timing/chain/end_to_end.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/timing/chain/segment.h"

namespace ttf::schedules::timing::chain {
namespace {

void add(Figure& sum, const Figure& part) {
  sum.time += part.time;
  for (std::size_t s = 0; s < sum.shares.size(); ++s) {
    sum.shares[s].waits += part.shares[s].waits;
    sum.shares[s].runs += part.shares[s].runs;
    sum.shares[s].stays += part.shares[s].stays;
  }
}

// The stages [0, end), which are activated.
Figure activated_part(std::span<const Stage> stages, std::size_t end) {
  Figure figure{.time = {}, .shares = std::vector<Share>(stages.size())};
  for (std::size_t s = 0; s < end; ++s) {
    TTF_CHECK(stages[s].longest >= Duration{} && stages[s].longest <= kLongest, "{}: takes {} ns", stages[s].name,
              stages[s].longest.ns);
    figure.time += stages[s].longest;
    figure.shares[s].runs = stages[s].longest;
  }
  return figure;
}

}  // namespace

EndToEnd end_to_end(std::span<const Stage> stages) {
  TTF_CHECK(!stages.empty(), "a chain of {} stages", stages.size());
  std::size_t first = 0;
  while (first < stages.size() && stages[first].activated) ++first;
  const Figure before = activated_part(stages, first);
  EndToEnd times{.reaction = before, .reduced_reaction = before, .age = {}, .reduced_age = {}, .exact = false};
  const std::vector<Segment> segments = segments_of(stages, first);
  const std::size_t parts = segments.size() + (first > 0 ? 1 : 0);
  times.exact = parts == 1 && std::ranges::all_of(stages, &Stage::exact);
  if (segments.empty()) times.reduced_age = before;
  if (first == 0) times.age = times.reduced_age = before;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Figure reaction = segments[s].reaction(stages);
    add(times.reaction, reaction);
    add(times.reduced_reaction, s == 0 && first == 0 ? segments[s].reduced_reaction(stages) : reaction);
    if (first > 0) continue;
    const Figure age = segments[s].age(stages);
    add(*times.age, age);
    add(*times.reduced_age, s + 1 == segments.size() ? segments[s].reduced_age(stages) : age);
  }
  return times;
}

}  // namespace ttf::schedules::timing::chain
