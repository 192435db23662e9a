#include "schedules/synthesis/trade/binding.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/check.h"
#include "schedules/analysis/can_load.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/model/round.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/instants/written.h"
#include "schedules/synthesis/plan/ways.h"
#include "schedules/synthesis/trade/rests.h"

namespace ttf::schedules::synthesis::trade {

using instants::kStaticSegment;
using instants::place;
using instants::read_of;
using instants::Search;
using instants::ticks;
using plan::by_time;
using plan::Hop;
using plan::Plan;
using plan::PlannedChain;
using plan::task_at;
using plan::way_to;
namespace {

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
