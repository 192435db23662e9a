#include "schedules/synthesis/trade/rests.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "schedules/synthesis/instants/grid.h"
#include "schedules/synthesis/instants/order.h"

namespace ttf::schedules::synthesis::trade {

using instants::Fused;
using instants::in_the_way;
using instants::latest_on_grid;
using instants::measure_in_order;
using instants::modulo;
namespace {

// Takes causes one by one, from the latest beginning that the next activity allows back to the one that was found.
class Causes {
 public:
  explicit Causes(Ticks rest) : left_(rest) {}

  Ticks left() const { return left_; }
  // Notes a cause of at most so much.
  void note(std::string cause, Ticks time) {
    time = std::min(time, left_);
    if (time <= 0) return;
    left_ -= time;
    const auto same = std::find_if(found_.begin(), found_.end(), [&](const Rest& one) { return one.cause == cause; });
    if (same != found_.end())
      same->time += time;
    else
      found_.push_back({std::move(cause), time});
  }
  std::vector<Rest> take() { return std::move(found_); }

 private:
  Ticks left_;
  std::vector<Rest> found_;
};

// Returns beginnings by activity in one count of ticks, as far as chains lead back from their ends.
std::vector<Ticks> in_one_count(const Problem& problem, const std::vector<Ticks>& offsets) {
  std::vector<Ticks> at = offsets;
  for (const Chain& chain : problem.chains)
    for (std::size_t i = chain.activities.size() - 1; i > 0; --i) {
      const std::size_t a = chain.activities[i - 1];
      const Ticks latest = at[chain.activities[i]] - chain.gaps[i - 1] - problem.activities[a].duration;
      at[a] = latest - modulo(latest - offsets[a], problem.activities[a].period);
    }
  return at;
}

// Whether a later measurement would be fused out of order.
bool bound_by_order(const Reading& reading, const std::vector<Ticks>& offsets, std::size_t measuring, Ticks later) {
  if (std::none_of(reading.fused.begin(), reading.fused.end(),
                   [&](const Fused& one) { return one.measuring == measuring; }))
    return false;
  std::vector<Ticks> at = in_one_count(reading.problem, offsets);
  const Ticks moved = at[measuring] += later;
  return !measure_in_order(reading, std::vector<bool>(at.size(), true), at) || at[measuring] != moved;
}

// Returns what the activity is in the words of the plan, without its section.
std::string short_name(const Activity& activity) {
  std::string name = activity.name;
  for (const std::string_view section : {"sensors.", "nodes."})
    if (name.starts_with(section)) name = name.substr(section.size());
  constexpr std::string_view kTasks = ".tasks.";
  if (const auto at = name.find(kTasks); at != std::string::npos) name.replace(at, kTasks.size(), ".");
  return name;
}

std::string taken_by(const Reading& reading, const Activity& one, const Activity& other) {
  return fmt::format("{} is taken by {}", reading.problem.resources[*one.resource].name, short_name(other));
}

// Others that take the data of `a`, and begin before it would rest so long.
void note_others(const Problem& problem, const std::vector<Ticks>& offsets, std::size_t a, std::size_t next,
                 Causes& causes) {
  const Activity& one = problem.activities[a];
  for (const Precedence& precedence : problem.precedences) {
    if (precedence.before != a || precedence.after == next) continue;
    const Activity& other = problem.activities[precedence.after];
    const Ticks slack = modulo(offsets[precedence.after] - offsets[a] - one.duration - precedence.gap, other.period);
    if (slack < causes.left()) causes.note(fmt::format("{} takes it, too", short_name(other)), causes.left() - slack);
  }
}

// The grid and the others on the resource, back from the latest beginning.
void note_places(const Reading& reading, const std::vector<Ticks>& offsets, std::size_t a, Ticks found,
                 Causes& causes) {
  const std::vector<Activity>& activities = reading.problem.activities;
  const Activity& one = activities[a];
  const auto to_grid = [&] {
    const Ticks latest = found + causes.left();
    causes.note("lists begin with a slot", latest - latest_on_grid(one.grid, latest));
  };
  to_grid();
  for (std::size_t b = 0; one.resource && b < activities.size();) {
    const bool shares = b != a && share_a_lane(one, activities[b]);
    const Ticks way = shares ? in_the_way(one, found + causes.left(), activities[b], offsets[b], true) : 0;
    if (way == 0 || causes.left() == 0) {
      ++b;
      continue;
    }
    causes.note(taken_by(reading, one, activities[b]), way);
    to_grid();
    b = 0;
  }
}

}  // namespace

std::vector<Ticks> oldest_way(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets) {
  Ticks round = 1;
  for (const std::size_t a : chain.activities) round = std::lcm(round, problem.activities[a].period);
  std::vector<Ticks> oldest;
  const std::size_t first = chain.activities.front();
  for (Ticks start = offsets[first]; start < offsets[first] + round; start += problem.activities[first].period) {
    std::vector<Ticks> at{start};
    for (std::size_t i = 1; i < chain.activities.size(); ++i) {
      const std::size_t a = chain.activities[i];
      const Ticks ready = at.back() + problem.activities[chain.activities[i - 1]].duration + chain.gaps[i - 1];
      at.push_back(ready + modulo(offsets[a] - ready, problem.activities[a].period));
    }
    if (oldest.empty() || at.back() - at.front() > oldest.back() - oldest.front()) oldest = std::move(at);
  }
  return oldest;
}

std::vector<Rest> rests(const Reading& reading, const std::vector<Ticks>& offsets, std::size_t chain, std::size_t i,
                        const std::vector<Ticks>& at) {
  const Problem& problem = reading.problem;
  const Chain& way = problem.chains[chain];
  const std::size_t a = way.activities[i], next = way.activities[i + 1];
  const Activity &one = problem.activities[a], &other = problem.activities[next];
  Causes causes(at[i + 1] - at[i] - one.duration - way.gaps[i]);
  if (one.period != other.period)
    causes.note(fmt::format("{} and {} have different periods", short_name(one), short_name(other)), causes.left());
  note_others(problem, offsets, a, next, causes);
  if (one.fixed) causes.note(fmt::format("{} stands in the plan", short_name(one)), causes.left());
  note_places(reading, offsets, a, at[i], causes);
  if (bound_by_order(reading, offsets, a, causes.left()))
    causes.note("lists are fused in the order of their measurements", causes.left());
  causes.note("no age would be smaller without", causes.left());
  return causes.take();
}

}  // namespace ttf::schedules::synthesis::trade
