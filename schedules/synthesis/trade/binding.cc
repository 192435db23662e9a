#include "schedules/synthesis/trade/binding.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/check.h"
#include "schedules/analysis/can_load.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/model/round.h"
#include "schedules/synthesis/instants/grid.h"
#include "schedules/synthesis/instants/order.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/instants/written.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::trade {

using instants::Fused;
using instants::in_the_way;
using instants::kStaticSegment;
using instants::latest_on_grid;
using instants::measure_in_order;
using instants::modulo;
using instants::place;
using instants::Read;
using instants::read_of;
using instants::Reading;
using instants::Search;
using instants::ticks;
using plan::by_time;
using plan::Hop;
using plan::Plan;
using plan::PlannedChain;
using plan::task_at;
using plan::way_to;
namespace {

// Why data rests on a chain's way in a schedule that was found (binding.h has the causes).
struct Rest {
  std::string cause;
  Ticks time = 0;
};

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
  if (const auto at = name.find(kTasks); at != std::string::npos)
    name = fmt::format("{}.{}", name.substr(0, at), name.substr(at + kTasks.size()));  // g++ 12 warns of replace()
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

// Returns the beginnings along a chain, in one count of ticks, for the measurement that grows oldest.
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

// Returns the rests between the i-th activity of a chain and the next one; `at` are the beginnings along the chain. They add up to
// the time between the two, less the first one's duration and the gap.
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

// Work between the beginnings of two activities of a chain: the first one's own, or a transfer or execution behind it.
struct Work {
  std::string name;
  Duration time{};
  bool of_activity = false;
};

class BindingFinder {
 public:
  BindingFinder(const Plan& plan, const Synthesis& made, Read read)
      : plan_(plan), made_(made), read_(std::move(read)), cluster_(made.cluster),
        clocks_(analysis::clock_bounds(cluster_)), offsets_(instants::offsets_of(read_, cluster_)),
        base_(place(read_.reading, {})) {}

  BindingWay way(std::size_t c) {
    const Chain& chain = problem().chains[c];
    BindingWay way{chain.name, {}, made_.ages[c].worst};
    const std::vector<std::vector<Work>> works = works_of(plan_.chains[c], chain);
    const std::vector<Ticks> at = oldest_way(problem(), chain, offsets_);
    Duration clocks = way.worst_age;
    for (std::size_t i = 0; i + 1 < chain.activities.size(); ++i) {
      for (const Work& work : works[i]) {
        way.pieces.push_back({WayPiece::Kind::kWorks, work.name, work.time, shorter(c, i, work)});
        clocks -= work.time;
      }
      for (const Rest& rest : rests(read_.reading, offsets_, c, i, at)) {
        way.pieces.push_back({WayPiece::Kind::kRests, rest.cause, duration(rest.time), std::nullopt});
        clocks -= duration(rest.time);
      }
    }
    way.pieces.push_back({WayPiece::Kind::kClocks, "clocks differ", clocks, std::nullopt});
    return way;
  }

 private:
  const Problem& problem() const { return read_.reading.problem; }
  Duration duration(Ticks ticks) const { return {ticks * cluster_.flexray.gdMacrotick_ps / 1'000}; }
  Duration span(Duration worst) const { return {worst.ns + clocks_.drift_ns(worst.ns) + model::kGranularity_ns}; }

  // Returns the work by activity of the chain, in the order in which the reading has it (reading.cc).
  std::vector<std::vector<Work>> works_of(const PlannedChain& planned, const Chain& chain) const {
    std::vector<std::vector<Work>> works(chain.activities.size());
    std::size_t i = 0;
    const auto next_is_list = [&] {
      return i + 1 < chain.activities.size() &&
             problem().activities[chain.activities[i + 1]].resource == kStaticSegment;
    };
    for (const Hop& hop : way_to(cluster_, planned.from, {planned.node, planned.task})) {
      if (hop.list != nullptr && hop.list->medium.is_flexray() && next_is_list()) {
        const Ticks sent = problem().activities[chain.activities[++i]].duration;
        works[i].push_back({cluster_.pdu(hop.list->pdu).name + " is sent", duration(sent), true});
      } else if (hop.list != nullptr && !hop.list->medium.is_flexray()) {
        works[i].push_back(transfer(*hop.list));
      }
      const model::Node& node = cluster_.node(hop.at.node);
      const model::Task& task = task_at(cluster_, hop.at);
      const std::string name = fmt::format("{}.{} executes", node.name, task.name);
      if (by_time(task))
        works[++i].push_back({name, task.worst_case, true});
      else
        works[i].push_back({name, span(response(hop.at)), false});
    }
    return works;
  }

  Work transfer(const model::PortBinding& list) const {
    const model::CanBus& bus = cluster_.can(list.medium);
    Work work{fmt::format("{} on {}", cluster_.pdu(list.pdu).name, bus.name), {}, false};
    for (const model::CanMessage& message : bus.messages)
      if (message.pdu == list.pdu)
        if (const auto worst = analysis::can_worst_response(cluster_, bus, message)) work.time = span(*worst);
    return work;
  }

  Duration response(plan::TaskId id) const {
    const auto responses = analysis::worst_responses(cluster_, id.node);
    const Duration least = task_at(cluster_, id).worst_case;
    return responses ? std::max(least, (*responses)[id.task].worst) : least;
  }

  // Finds the best instants anew, with this work behind the chain's i-th activity shorter.
  std::optional<Shorter> shorter(std::size_t c, std::size_t i, const Work& work) {
    const Chain& chain = problem().chains[c];
    const std::size_t a = chain.activities[i];
    const Ticks grain = problem().activities[a].grid.step;
    Ticks by = ticks(cluster_.flexray, std::min(work.time.ns, std::int64_t{1'000'000}));
    if (work.of_activity) by = std::min(by, problem().activities[a].duration - grain) / grain * grain;
    if (by <= 0 || !base_.best) return std::nullopt;
    const auto [known, fresh] = shortened_.try_emplace({a, work.of_activity, by});
    if (fresh) known->second = place(shortened(a, work.of_activity, by), {});
    const Search& found = known->second;
    if (!found.best) return std::nullopt;
    return Shorter{duration(by), duration(base_.best->ages[c] - found.best->ages[c]),
                   duration(base_.best->worst_age({}) - found.best->worst_age({})), base_.exact && found.exact};
  }

  Reading shortened(std::size_t a, bool of_activity, Ticks by) const {
    Reading changed = read_.reading;
    if (of_activity) {
      changed.problem.activities[a].duration -= by;
      return changed;
    }
    for (Precedence& one : changed.problem.precedences)
      if (one.before == a) one.gap -= by;
    for (Chain& chain : changed.problem.chains)
      for (std::size_t i = 0; i < chain.gaps.size(); ++i)
        if (chain.activities[i] == a) chain.gaps[i] -= by;
    return changed;
  }

  const Plan& plan_;
  const Synthesis& made_;
  Read read_;
  const model::Cluster& cluster_;
  analysis::ClockBounds clocks_;
  std::vector<Ticks> offsets_;
  Search base_;
  std::map<std::tuple<std::size_t, bool, Ticks>, Search> shortened_;  // by activity, its own work, and how much
};

}  // namespace

std::vector<BindingWay> what_binds(const Plan& plan, const Synthesis& made) {
  auto read = read_of(plan, made.candidate);
  TTF_CHECK(made.found && read, "nothing was found");
  BindingFinder finder(plan, made, std::move(*read));
  std::vector<BindingWay> ways;
  for (std::size_t c = 0; c < plan.chains.size(); ++c) ways.push_back(finder.way(c));
  return ways;
}

}  // namespace ttf::schedules::synthesis::trade
