#include "schedules/synthesis/explanation/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "core/decimal.h"
#include "schedules/analysis/parameter_bounds.h"
#include "schedules/model/limits.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::explanation {

using instants::feasible;
using instants::Feasible;
using plan::Plan;
namespace {

using plan::by_time;
using plan::PlannedChain;

// A number that a statement sets, and in which direction it eases the plan.
struct Dial {
  std::int64_t now = 0, easiest = 0, grain = 1;  // `easiest` may be above or below
  std::function<void(plan::Plan&, std::int64_t)> set;
  std::function<std::string(std::int64_t)> words;  // "chains.laser.largest_age: 54.92 ms"
};

// A statement of the plan, as an explanation names it: its words, its line, and the plan without it.
struct Statement {
  std::string text;  // "chains.laser.largest_age: 40 ms"
  int line = 0;      // in the plan's text
  // Lengths of 1 to 16 ms in steps of 0.1 ms (or the plan's, if longer) stand for any cycle, four times a rate for any.
  std::function<void(plan::Plan&)> drop;
  std::optional<Dial> dial;
};

constexpr std::int64_t kGrain_ns = 10'000;

std::string ms(std::int64_t ns) { return fmt::format("{} ms", scaled_text(ns, 1'000'000)); }

class Collector {
 public:
  explicit Collector(const Plan& plan) : plan_(plan), cluster_(plan.cluster) {}

  std::vector<Statement> collect() {
    executions();
    lists();
    modes();
    slots();
    lengths();
    payload();
    rates();
    standing();
    ages();
    return std::move(found_);
  }

 private:
  void say(std::string text, int line, std::function<void(Plan&)> drop, std::optional<Dial> dial = std::nullopt) {
    found_.push_back({std::move(text), line, std::move(drop), std::move(dial)});
  }

  int line_of(const std::string& path, int otherwise) const {
    const auto line = plan_.unchanging->parameter_lines.find(path);
    return line == plan_.unchanging->parameter_lines.end() ? otherwise : line->second;
  }

  void executions() {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) {
        const model::Task& task = cluster_.nodes[n].tasks[t];
        const std::string key = fmt::format("nodes.{}.tasks.{}.worst_case", cluster_.nodes[n].name, task.name);
        const auto set = [n, t](Plan& plan, std::int64_t ns) {
          model::Task& one = plan.cluster.nodes[n].tasks[t];
          one.worst_case = {ns};
          one.best_case = std::min(one.best_case, one.worst_case);
        };
        const Dial dial{task.worst_case.ns, std::max<std::int64_t>(1'000, task.best_case.ns), kGrain_ns, set,
                        [key](std::int64_t ns) { return fmt::format("{}: {}", key, ms(ns)); }};
        say(
            dial.words(dial.now), line_of(key, task.line), [set](Plan& plan) { set(plan, 1'000); }, dial);
      }
  }

  void lists() {
    for (std::size_t p = 0; p < cluster_.pdus.size(); ++p) {
      const model::PduLayout& layout = cluster_.pdus[p];
      if (layout.max_elements <= layout.elements_per_fragment) continue;
      const std::string key = fmt::format("pdus.{}.max_elements", layout.name);
      const auto set = [p](Plan& plan, std::int64_t most) {
        plan.cluster.pdus[p].max_elements = static_cast<int>(most);
      };
      const Dial dial{layout.max_elements, 1, 1, set,
                      [key](std::int64_t most) { return fmt::format("{}: {}", key, most); }};
      say(
          dial.words(dial.now), layout.line, [set](Plan& plan) { set(plan, 1); }, dial);
    }
  }

  void modes() {
    if (cluster_.arrival_window)
      say(fmt::format("real_time.late: {}", ms(cluster_.arrival_window->late.ns)), line_of("real_time", 0),
          [](Plan& plan) { plan.cluster.arrival_window.reset(); });
    if (plan_.in_order && plan_.sensors.size() > 1)
      say("plan.in_order: true", 0, [](Plan& plan) { plan.in_order = false; });
  }

  // So many static slots fit into the longest cycle, beside the other segments and the shortest idle time.
  std::int64_t most_slots() const {
    const model::GlobalParameters& g = cluster_.flexray;
    const std::int64_t others = analysis::segments_sum(g) - std::int64_t{g.gNumberOfStaticSlots} * g.gdStaticSlot;
    const std::int64_t macroticks = plan_.cycle.longest.ns * 1'000 / g.gdMacrotick_ps;
    return std::min<std::int64_t>((macroticks - others - 2) / g.gdStaticSlot, 1023);
  }

  void slots() {
    if (plan_.parameters.static_slots) return;
    const int now = cluster_.flexray.gNumberOfStaticSlots;
    const auto free_rest = [](Plan& plan) { plan.parameters.idle_time = plan.parameters.correction_start = true; };
    const Dial dial{now, most_slots(), 1,
                    [free_rest](Plan& plan, std::int64_t slots) {
                      plan.cluster.flexray.gNumberOfStaticSlots = static_cast<int>(slots);
                      free_rest(plan);
                    },
                    [](std::int64_t slots) { return fmt::format("flexray.gNumberOfStaticSlots: {}", slots); }};
    say(
        dial.words(now), line_of("flexray.gNumberOfStaticSlots", 0),
        [free_rest](Plan& plan) {
          plan.parameters.static_slots = true;
          free_rest(plan);
        },
        dial);
  }

  void lengths() {
    if (!plan_.free_cycle) return;
    say(fmt::format("plan.cycle: {} to {}", ms(plan_.cycle.shortest.ns), ms(plan_.cycle.longest.ns)), plan_.cycle.line,
        [](Plan& plan) {
          plan.cycle.shortest = Duration::milliseconds(1);
          plan.cycle.longest = Duration::milliseconds(16);
          plan.cycle.step = std::max(plan.cycle.step, Duration::microseconds(100));
          if (!plan.payload) return;
          const int range = plan.payload->longest - plan.payload->shortest;
          plan.payload->step = std::max(plan.payload->step, range / 6 * 2);  // four payloads
        });
  }

  void payload() {
    if (!plan_.payload) return;
    say(fmt::format("plan.payload: {} to {} bytes", plan_.payload->shortest, plan_.payload->longest),
        plan_.payload->line, [](Plan& plan) {
          plan.payload->shortest = 2;
          plan.payload->longest = model::kMostFragmentBytes;
          plan.payload->step = 42;  // seven payloads
        });
  }

  void rates() {
    for (std::size_t s = 0; s < plan_.sensors.size(); ++s) {
      const auto& rate = plan_.sensors[s].rate;
      if (!rate) continue;
      const std::string key = fmt::format("plan.rates.{}", cluster_.sensors[s].name);
      const auto longest = [s](Plan& plan, std::int64_t ns) { plan.sensors[s].rate->longest = {ns}; };
      const auto shortest = [s](Plan& plan, std::int64_t ns) { plan.sensors[s].rate->shortest = {ns}; };
      say(
          fmt::format("{}.longest: {}", key, ms(rate->longest.ns)), rate->line,
          [longest, rate](Plan& plan) { longest(plan, 4 * rate->longest.ns); },
          Dial{rate->longest.ns, 4 * rate->longest.ns, kGrain_ns, longest,
               [key](std::int64_t ns) { return fmt::format("{}.longest: {}", key, ms(ns)); }});
      say(
          fmt::format("{}.shortest: {}", key, ms(rate->shortest.ns)), rate->line,
          [shortest, rate](Plan& plan) { shortest(plan, rate->shortest.ns / 4); },
          Dial{rate->shortest.ns, rate->shortest.ns / 4, kGrain_ns, shortest,
               [key](std::int64_t ns) { return fmt::format("{}.shortest: {}", key, ms(ns)); }});
    }
  }

  // Instants and slots that the plan says.
  void standing() {
    for (std::size_t s = 0; s < plan_.sensors.size(); ++s) {
      const model::Sensor& sensor = cluster_.sensors[s];
      if (!sensor.scheduled || plan_.sensors[s].at.instant) continue;
      say(fmt::format("sensors.{}: base_cycle {}, offset {}", sensor.name, sensor.at.base_cycle,
                      sensor.at.offset.value),
          sensor.line, [s](Plan& plan) { plan.sensors[s].at.instant = true; });
    }
    for (std::size_t n = 0; n < plan_.tasks.size(); ++n)
      for (std::size_t t = 0; t < plan_.tasks[n].size(); ++t) {
        const model::Task& task = cluster_.nodes[n].tasks[t];
        if (!by_time(task) || plan_.tasks[n][t].at.instant) continue;
        say(fmt::format("nodes.{}.tasks.{}.activation: base_cycle {}, offset {}", cluster_.nodes[n].name, task.name,
                        task.activation.at.base_cycle, task.activation.at.offset.value),
            plan_.tasks[n][t].line, [n, t](Plan& plan) { plan.tasks[n][t].at.instant = true; });
      }
    for (std::size_t l = 0; l < plan_.lists.size(); ++l) {
      if (plan_.lists[l].at.instant) continue;
      say(fmt::format("frames of {}: base_cycle {}, slot {}", cluster_.pdu(plan_.lists[l].pdu).name,
                      plan_.lists[l].base_cycle, plan_.lists[l].slot),
          plan_.lists[l].line, [l](Plan& plan) { plan.lists[l].at.instant = true; });
    }
    std::set<int> entries;
    for (const model::FrameSlot& frame : cluster_.frames)
      if (frame.pdu != kNoPdu && frame.entry && entries.insert(*frame.entry).second) standing_frame(frame);
  }

  void standing_frame(const model::FrameSlot& frame) {
    say(fmt::format("frames of {}: base_cycle {}, slot {}", cluster_.pdu(frame.pdu).name, frame.base_cycle, frame.slot),
        frame.line, [frame](Plan& plan) {
          std::erase_if(plan.cluster.frames, [&](const model::FrameSlot& one) { return one.entry == frame.entry; });
          plan.lists.push_back(
              {frame.pdu, frame.sender, frame.channels, 0, frame.repetition, 1, {true, false}, frame.line});
        });
  }

  void ages() {
    for (std::size_t c = 0; c < plan_.chains.size(); ++c) {
      const PlannedChain& chain = plan_.chains[c];
      if (!chain.largest_age) continue;
      const std::string key = fmt::format("plan.chains.{}.largest_age", chain.name);
      const Dial dial{chain.largest_age->ns, chain.largest_age->ns + 10'000'000'000, kGrain_ns,
                      [c](Plan& plan, std::int64_t ns) { plan.chains[c].largest_age = Duration{ns}; },
                      [key](std::int64_t ns) { return fmt::format("{}: {}", key, ms(ns)); }};
      say(
          dial.words(dial.now), chain.line, [c](Plan& plan) { plan.chains[c].largest_age.reset(); }, dial);
    }
  }

  const Plan& plan_;
  const model::Cluster& cluster_;
  std::vector<Statement> found_;
};

// Returns the statements that bind instants, those first that describe the machine: executions, lists, then slots, rates,
// instants that stand, and ages at last.
std::vector<Statement> statements(const Plan& plan) { return Collector(plan).collect(); }

class Explainer {
 public:
  explicit Explainer(const Plan& plan) : plan_(plan), all_(statements(plan)), kept_(all_.size(), true) {}

  Explanation run() {
    for (std::size_t i = 0; i < all_.size(); ++i) {
      kept_[i] = false;
      if (possible(weakened())) kept_[i] = true;
    }
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (!kept_[i]) continue;
      made_.core.push_back(said(all_[i].line, all_[i].text));
      if (!all_[i].dial) continue;
      if (const auto value = least_change(*all_[i].dial))
        made_.changes.push_back(said(all_[i].line, all_[i].dial->words(*value)));
    }
    return std::move(made_);
  }

 private:
  // Returns the plan without the statements that are not kept.
  Plan weakened() const {
    Plan plan = plan_;
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (!kept_[i]) all_[i].drop(plan);
    return plan;
  }

  bool possible(const Plan& plan) {
    const Feasible result = feasible(plan);
    made_.proven = made_.proven && result.exact;
    return result.found;
  }

  bool possible_at(const Dial& dial, std::int64_t value) {
    Plan plan = plan_;  // with all other statements: the change alone must help
    dial.set(plan, value);
    return feasible(plan).found;
  }

  // The search uses gaps and ages alone. The check has more rules, as that a task ends before its next activation.
  bool passes_at(const Dial& dial, std::int64_t value) const {
    Plan plan = plan_;
    dial.set(plan, value);
    return instants::passes(plan);
  }

  // Returns the value nearest to the plan's at which the whole plan has a solution. Where the check refuses it, values ever
  // farther away are tried. Returns none if it refuses all.
  std::optional<std::int64_t> least_change(const Dial& dial) {
    const std::int64_t way = dial.easiest > dial.now ? 1 : -1;
    const auto at = [&](std::int64_t steps) {
      const std::int64_t value = (dial.now / dial.grain + way * steps) * dial.grain;
      return way > 0 ? std::min(value, dial.easiest) : std::max(value, dial.easiest);
    };
    std::int64_t no = 0, yes = (dial.easiest - dial.now) * way / dial.grain + 1;
    if (!possible_at(dial, at(yes))) return std::nullopt;
    while (yes - no > 1) {
      const std::int64_t middle = no + (yes - no) / 2;
      (possible_at(dial, at(middle)) ? yes : no) = middle;
    }
    const std::int64_t least = yes, most = (dial.easiest - dial.now) * way / dial.grain + 1;
    for (std::int64_t farther = 1; !passes_at(dial, at(yes)); farther *= 2) {
      if (yes == most) return std::nullopt;
      yes = std::min(least + farther, most);
    }
    return at(yes);
  }

  Explanation::Said said(int line, const std::string& text) const {
    const TextPlace place = plan_.origins.place(plan_.cluster.file, line);
    return {place.file, place.line, text};
  }

  const Plan& plan_;
  std::vector<Statement> all_;
  std::vector<bool> kept_;
  Explanation made_;
};

}  // namespace

Explanation explain(const Plan& plan) { return Explainer(plan).run(); }

}  // namespace ttf::schedules::synthesis::explanation
