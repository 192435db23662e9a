#include "schedules/synthesis/checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/check.h"

namespace ttf::schedules::synthesis {
namespace {

std::string place(int line) { return line > 0 ? fmt::format(" (line {})", line) : std::string(); }

std::string named(const Activity& activity) { return activity.name + place(activity.line); }

// Returns the least common multiple, or 0 above kLongestHyperperiod.
Ticks common_multiple(Ticks a, Ticks b) {
  const Ticks factor = b / std::gcd(a, b);
  return a > kLongestHyperperiod / factor ? 0 : a * factor;
}

Ticks hyperperiod(const Problem& problem, const std::vector<std::size_t>& activities) {
  Ticks common = 1;
  for (const std::size_t at : activities) {
    common = common_multiple(common, problem.activities[at].period);
    if (common == 0) return 0;
  }
  return common;
}

std::string activity_mistake(const Problem& problem, const Activity& activity) {
  if (activity.period <= 0) return fmt::format("{}: period {} is not positive", named(activity), activity.period);
  if (activity.period > kLongestHyperperiod)
    return fmt::format("{}: period {} is too long", named(activity), activity.period);
  if (activity.duration < 0 || activity.duration > activity.period)
    return fmt::format("{}: duration {} is not 0..{}, the period", named(activity), activity.duration, activity.period);
  if (activity.resource && *activity.resource >= problem.resources.size())
    return fmt::format("{}: resource {} of {}", named(activity), *activity.resource, problem.resources.size());
  const Grid& grid = activity.grid;
  if (grid.period <= 0 || grid.step <= 0 || grid.first < 0 || grid.last < grid.first || grid.last >= grid.period)
    return fmt::format("{}: grid {}..{} in steps of {} does not lie in its period {}", named(activity), grid.first,
                       grid.last, grid.step, grid.period);
  for (const Ticks bound : {activity.window.first, activity.window.last, activity.fixed.value_or(0)})
    if (bound < -kLongestHyperperiod || bound > kLongestHyperperiod)
      return fmt::format("{}: {} is too far away", named(activity), bound);
  return "";
}

std::string precedence_mistake(const Problem& problem, const Precedence& precedence) {
  const std::size_t count = problem.activities.size();
  if (precedence.before >= count || precedence.after >= count)
    return fmt::format("precedence{}: activity {} of {}", place(precedence.line),
                       std::max(precedence.before, precedence.after), count);
  const Activity &before = problem.activities[precedence.before], &after = problem.activities[precedence.after];
  if (before.period != after.period)
    return fmt::format("precedence{}: {} and {} have periods {} and {}", place(precedence.line), before.name,
                       after.name, before.period, after.period);
  if (std::abs(precedence.gap) > kLongestHyperperiod || std::abs(precedence.most.value_or(0)) > kLongestHyperperiod)
    return fmt::format("precedence{}: its gap is too long", place(precedence.line));
  return "";
}

std::string chain_mistake(const Problem& problem, const Chain& chain) {
  const std::size_t length = chain.activities.size(), count = problem.activities.size();
  const std::string name = "chain " + chain.name + place(chain.line);
  if (length == 0) return name + ": no activity";
  for (const std::size_t at : chain.activities)
    if (at >= count) return fmt::format("{}: activity {} of {}", name, at, count);
  if (!chain.gaps.empty() && chain.gaps.size() + 1 != length)
    return fmt::format("{}: {} gaps for {} activities", name, chain.gaps.size(), length);
  for (std::size_t at = 0; at < chain.gaps.size(); ++at) {
    const Ticks gap = chain.gaps[at], least = -problem.activities[chain.activities[at]].duration;
    if (gap < least || gap > kLongestHyperperiod)
      return fmt::format("{}: gap {} is not {}..{}", name, gap, least, kLongestHyperperiod);
  }
  const Ticks common = hyperperiod(problem, chain.activities);
  if (common == 0 || common / problem.activities[chain.activities.back()].period > kMostOutputs)
    return name + ": its periods have no common multiple within reach";
  return "";
}

std::string order_mistake(const Problem& problem, const Order& order) {
  const auto fits = [&](std::size_t chain, std::size_t at) {
    return chain < problem.chains.size() && at < problem.chains[chain].activities.size();
  };
  if (!fits(order.first, order.first_at) || !fits(order.second, order.second_at)) return "order: no such activity";
  const Ticks period = problem.activities[problem.chains[order.first].activities.front()].period;
  for (const auto& [chain, last] : {std::pair{order.first, order.first_at}, {order.second, order.second_at}})
    for (std::size_t at = 0; at <= last; ++at)
      if (problem.activities[problem.chains[chain].activities[at]].period != period)
        return fmt::format("order: chain {} has several periods", problem.chains[chain].name);
  if (std::abs(order.apart) > kLongestHyperperiod) return fmt::format("order: {} apart", order.apart);
  return "";
}

// Whether two activities ever overlap. Over a hyperperiod their beginnings take every distance that is the same modulo the greatest
// common divisor of the periods.
bool overlap(const Activity& a, Ticks offset_a, const Activity& b, Ticks offset_b) {
  if (a.duration == 0 || b.duration == 0) return false;
  const Ticks common = meeting_time(a, b);
  Ticks behind = (offset_b - offset_a) % common;
  if (behind < 0) behind += common;
  return behind < a.duration || behind + b.duration > common;
}

bool on_grid(const Grid& grid, Ticks offset) {
  Ticks rest = offset % grid.period;
  if (rest < 0) rest += grid.period;
  return rest >= grid.first && rest <= grid.last && (rest - grid.first) % grid.step == 0;
}

// Returns the beginning of a chain's first activity on which a beginning of its activity `from` rests.
Ticks source(const Problem& problem, const Chain& chain, std::size_t from, Ticks begin, const Solution& solution) {
  for (std::size_t at = from; at-- > 0;) {
    const Activity& activity = problem.activities[chain.activities[at]];
    const Ticks ready =
        solution.offsets[chain.activities[at]] + activity.duration + (chain.gaps.empty() ? 0 : chain.gaps[at]);
    Ticks rest = (begin - ready) % activity.period;  // since the newest was ready
    if (rest < 0) rest += activity.period;
    begin -= rest + ready - solution.offsets[chain.activities[at]];
  }
  return begin;
}

void check_place(const Activity& activity, Ticks offset, std::vector<std::string>& found) {
  if (activity.fixed) {
    if (offset != *activity.fixed)
      found.push_back(fmt::format("{} is fixed at {}, not {}", named(activity), *activity.fixed, offset));
    return;
  }
  const auto [first, last] = activity.window;
  if (offset < first || offset > last)
    found.push_back(fmt::format("{} begins at {}, outside {}..{}", named(activity), offset, first, last));
  if (!on_grid(activity.grid, offset))
    found.push_back(fmt::format("{} begins at {}, off its grid", named(activity), offset));
}

}  // namespace

std::vector<std::string> mistakes(const Problem& problem) {
  std::vector<std::string> found;
  const auto note = [&](std::string mistake) {
    if (!mistake.empty()) found.push_back(std::move(mistake));
  };
  for (const Activity& activity : problem.activities) note(activity_mistake(problem, activity));
  if (!found.empty()) return found;
  for (const Precedence& precedence : problem.precedences) note(precedence_mistake(problem, precedence));
  for (const Chain& chain : problem.chains) note(chain_mistake(problem, chain));
  if (!found.empty()) return found;
  for (const Order& order : problem.orders) note(order_mistake(problem, order));
  return found;
}

std::vector<std::pair<std::size_t, std::size_t>> overlaps(const Problem& problem, const Solution& solution) {
  const std::vector<Activity>& all = problem.activities;
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b)
      if (share_a_lane(all[a], all[b]) && overlap(all[a], solution.offsets[a], all[b], solution.offsets[b]))
        found.emplace_back(a, b);
  return found;
}

std::vector<std::string> violations(const Problem& problem, const Solution& solution) {
  const std::vector<Activity>& all = problem.activities;
  TTF_CHECK(solution.offsets.size() == all.size(), "{} offsets of {} activities", solution.offsets.size(), all.size());
  std::vector<std::string> found;
  for (std::size_t at = 0; at < all.size(); ++at) check_place(all[at], solution.offsets[at], found);
  for (const Precedence& precedence : problem.precedences) {
    const Activity &before = all[precedence.before], &after = all[precedence.after];
    const Ticks behind = solution.offsets[precedence.after] - solution.offsets[precedence.before] - before.duration;
    const Ticks most = precedence.most.value_or(precedence.gap + before.period - 1);
    if (behind < precedence.gap || behind > most)
      found.push_back(fmt::format("{} begins {} behind the end of {}, not {}..{}{}", after.name, behind, before.name,
                                  precedence.gap, most, place(precedence.line)));
  }
  for (const auto& [a, b] : overlaps(problem, solution))
    found.push_back(
        fmt::format("{} and {} overlap on {}", named(all[a]), named(all[b]), problem.resources[*all[a].resource].name));
  for (const Chain& chain : problem.chains)
    if (chain.largest_age && age(problem, chain, solution) > *chain.largest_age)
      found.push_back(fmt::format("chain {} is {} old, above {}{}", chain.name, age(problem, chain, solution),
                                  *chain.largest_age, place(chain.line)));
  for (const Order& order : problem.orders)
    if (const Ticks late = out_of_order(problem, order, solution); late > 0)
      found.push_back(fmt::format("{} begins {} too late for the order of its data with that of {}",
                                  all[problem.chains[order.first].activities.front()].name, late,
                                  all[problem.chains[order.second].activities.front()].name));
  return found;
}

Ticks out_of_order(const Problem& problem, const Order& order, const Solution& solution) {
  const Chain &first = problem.chains[order.first], &second = problem.chains[order.second];
  const std::size_t reader = second.activities[order.second_at];
  const Ticks period = problem.activities[reader].period, begin = solution.offsets[first.activities[order.first_at]];
  Ticks behind = (solution.offsets[reader] - begin) % period;
  if (behind <= 0) behind += period;
  return source(problem, first, order.first_at, begin, solution) + order.apart -
         source(problem, second, order.second_at, begin + behind, solution);
}

Ticks age(const Problem& problem, const Chain& chain, const Solution& solution) {
  const Activity& last = problem.activities[chain.activities.back()];
  const Ticks outputs = hyperperiod(problem, chain.activities) / last.period;
  Ticks oldest = 0;
  for (Ticks output = 0; output < outputs; ++output) {
    const Ticks end = solution.offsets[chain.activities.back()] + output * last.period;
    const Ticks begin = source(problem, chain, chain.activities.size() - 1, end, solution);
    oldest = std::max(oldest, end + last.duration + (chain.reduced ? 0 : last.period) - begin);
  }
  return oldest;
}

std::vector<Ticks> ages(const Problem& problem, const Solution& solution) {
  std::vector<Ticks> found;
  for (const Chain& chain : problem.chains) found.push_back(age(problem, chain, solution));
  return found;
}

}  // namespace ttf::schedules::synthesis
