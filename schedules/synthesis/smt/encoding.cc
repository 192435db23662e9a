#include "schedules/synthesis/smt/encoding.h"

#include <algorithm>
#include <numeric>

#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::smt {
namespace {

// More instances of a chain, or more cases of a constraint, are not written down.
constexpr Ticks kMostInstances = 2000, kMostCases = 20'000;

Ticks ceil_divided(Ticks dividend, Ticks divisor) {
  return -((-dividend - solver::modulo(-dividend, divisor)) / divisor);
}
Ticks floor_divided(Ticks dividend, Ticks divisor) { return (dividend - solver::modulo(dividend, divisor)) / divisor; }

}  // namespace

Encoding::Encoding(const solver::Question& question, Logic logic)
    : question_(question), logic_(logic), solver_(context_, logic == Logic::kIntegers ? "QF_LIA" : "QF_IDL") {
  const solver::Model model(question);
  windows_ = model.windows;
  for (std::size_t at = 0; at < windows_.size(); ++at) add_place(at);
  add_precedences();
  for (const Chain& chain : question.problem.chains) {
    const solver::ChainTerms terms = solver::terms_of(question.problem, chain);
    const std::size_t number = ages_.size();
    const bool summed = std::ranges::any_of(
        question.sums, [&](const solver::SumLimit& sum) { return std::ranges::count(sum.chains, number) > 0; });
    const bool ordered = std::ranges::any_of(
        question.problem.orders, [&](const Order& order) { return order.first == number || order.second == number; });
    paths_.emplace_back();
    if (!summed && !chain.largest_age && !ordered) {
      ages_.push_back({value(0), 0, 0});
      continue;
    }
    ages_.push_back(terms.harmonic ? add_path(chain, paths_.back()) : add_outputs(chain, summed));
    if (terms.harmonic && chain.largest_age) solver_.add(ages_.back().term <= value(*chain.largest_age));
  }
  add_orders();
  add_sums();
  add_spans();
}

Encoding::Number Encoding::fresh(Ticks first, Ticks last) {
  const z3::expr term = context_.int_const(("n" + std::to_string(numbers_++)).c_str());
  solver_.add(term >= value(first) && term <= value(last));
  return {term, first, last};
}

z3::expr Encoding::apart(const Number& from, const Number& to, Ticks unit, Ticks least, Ticks most) {
  const Ticks first = ceil_divided(to.first - from.last - most, unit),
              last = floor_divided(to.last - from.first - least, unit);
  if (first > last) return context_.bool_val(false);
  const auto within = [&](const z3::expr& distance) { return distance >= value(least) && distance <= value(most); };
  if (logic_ == Logic::kIntegers && first < last)
    return within(to.term - from.term - value(unit) * fresh(first, last).term);
  if (last - first > kMostCases) {
    whole_ = false;
    return context_.bool_val(true);
  }
  z3::expr_vector cases(context_);
  for (Ticks k = first; k <= last; ++k)
    cases.push_back(to.term - from.term >= value(least + unit * k) && to.term - from.term <= value(most + unit * k));
  return z3::mk_or(cases);
}

void Encoding::add_place(std::size_t activity) {
  const Activity& own = question_.problem.activities[activity];
  const Window& window = windows_[activity];
  offsets_.push_back(context_.int_const(("o" + std::to_string(activity)).c_str()));
  solver_.add(offsets_.back() >= value(window.first) && offsets_.back() <= value(window.last));
  const Grid& grid = own.grid;
  if (own.fixed || (grid.period == 1 && grid.step == 1)) return;
  const Number origin{value(0), 0, 0};
  const Ticks steps = (grid.last - grid.first) / grid.step;
  if (grid.step == 1 || steps == 0) {
    solver_.add(apart(origin, offset(activity), grid.period, grid.first, grid.first + steps * grid.step));
    return;
  }
  if (logic_ == Logic::kIntegers) {
    const Ticks first = grid.first;
    const z3::expr start = value(grid.step) * fresh(0, steps).term;
    solver_.add(apart({start, 0, steps * grid.step}, offset(activity), grid.period, first, first));
    return;
  }
  z3::expr_vector cases(context_);
  for (Ticks step = 0; step <= steps; ++step) {
    const Ticks start = grid.first + step * grid.step;
    cases.push_back(apart(origin, offset(activity), grid.period, start, start));
  }
  solver_.add(z3::mk_or(cases));
}

void Encoding::add_precedences() {
  for (const Precedence& precedence : question_.problem.precedences) {
    const Activity& before = question_.problem.activities[precedence.before];
    const z3::expr behind = offsets_[precedence.after] - offsets_[precedence.before];
    const Ticks most = precedence.most.value_or(precedence.gap + before.period - 1);
    solver_.add(behind >= value(before.duration + precedence.gap) && behind <= value(before.duration + most));
  }
}

Encoding::Number Encoding::read_by(const Number& reader, std::size_t activity, Ticks ready, Ticks unit) {
  const Number instance = fresh(reader.first - ready - unit + 1, reader.last - ready);
  solver_.add(apart(offset(activity), instance, question_.problem.activities[activity].period, 0, 0));
  const z3::expr rest = reader.term - instance.term;
  solver_.add(rest >= value(ready) && rest <= value(ready + unit - 1));
  return instance;
}

// Every instance may be the first that reads news: the output at the end is anywhere within the largest period.
Encoding::Number Encoding::add_path(const Chain& chain, std::vector<Number>& path) {
  const solver::ChainTerms terms = solver::terms_of(question_.problem, chain);
  const std::size_t last = chain.activities.size() - 1;
  const auto period = [&](std::size_t at) { return question_.problem.activities[chain.activities[at]].period; };
  Number end = offset(chain.activities[last]);
  if (terms.stride.front() > period(last)) {
    const Number anywhere = fresh(end.first, end.last + terms.stride.front() - period(last));
    solver_.add(apart(end, anywhere, period(last), 0, 0));
    end = anywhere;
  }
  Number begin = end;
  path.push_back(begin);
  Ticks ready = 0;
  for (std::size_t at = last; at-- > 0;) {
    ready += terms.ready[at];
    begin = read_by(begin, chain.activities[at], terms.ready[at], std::min(terms.stride[at + 1], period(at)));
    path.push_back(begin);
  }
  std::ranges::reverse(path);
  return {end.term - begin.term + value(terms.base - ready), terms.base, end.last - begin.first + terms.base - ready};
}

Encoding::Number Encoding::add_outputs(const Chain& chain, bool summed) {
  const std::size_t last = chain.activities.size() - 1;
  const Activity& output = question_.problem.activities[chain.activities[last]];
  Ticks common = 1;
  for (const std::size_t at : chain.activities) common = std::lcm(common, question_.problem.activities[at].period);
  const solver::ChainTerms terms = solver::terms_of(question_.problem, chain);
  Ticks most = output.duration + output.period;
  for (std::size_t at = 0; at < last; ++at)
    most += terms.ready[at] + question_.problem.activities[chain.activities[at]].period;
  const Number age = fresh(0, most);
  if (common / output.period * static_cast<Ticks>(last + 1) > kMostInstances) whole_ = false;
  for (Ticks number = 0; whole_ && number < common / output.period; ++number) {
    Number begin = offset(chain.activities[last]);
    const z3::expr end = begin.term + value(number * output.period);
    begin = {end, begin.first + number * output.period, begin.last + number * output.period};
    for (std::size_t at = last; at-- > 0;)
      begin = read_by(begin, chain.activities[at], terms.ready[at],
                      question_.problem.activities[chain.activities[at]].period);
    const z3::expr age_then = end - begin.term + value(output.duration + (chain.reduced ? 0 : output.period));
    if (chain.largest_age) solver_.add(age_then <= value(*chain.largest_age));
    if (summed) solver_.add(age_then <= age.term);
  }
  return age;
}

// The second reader's next instance is k periods later than the one in its path.
void Encoding::add_orders() {
  for (const Order& order : question_.problem.orders) {
    const std::vector<Number>&first = paths_[order.first], &second = paths_[order.second];
    if (first.empty() || second.empty()) {
      whole_ = false;
      return;
    }
    const Ticks period = question_.problem.activities[question_.problem.chains[order.first].activities[0]].period;
    const Number &one = first[order.first_at], &other = second[order.second_at];
    const Number later =
        fresh(floor_divided(one.first - other.last, period) + 1, floor_divided(one.last - other.first, period) + 1);
    const z3::expr behind = other.term + value(period) * later.term - one.term;
    solver_.add(behind >= value(1) && behind <= value(period));
    solver_.add(first[0].term + value(order.apart) <= second[0].term + value(period) * later.term);
  }
}

void Encoding::add_sums() {
  for (const solver::SumLimit& sum : question_.sums) {
    z3::expr total = value(0);
    for (std::size_t at = 0; at < sum.chains.size(); ++at)
      total = total + value(sum.weights[at]) * ages_[sum.chains[at]].term;
    solver_.add(total <= value(sum.most));
  }
}

void Encoding::add_spans() {
  for (const solver::SpanLimit& span : question_.spans)
    for (const std::size_t a : span.activities)
      for (const std::size_t b : span.activities)
        solver_.add(offsets_[a] - offsets_[b] <= value(span.most - question_.problem.activities[a].duration));
}

bool Encoding::add_overlaps(const std::vector<Ticks>& offsets) {
  const std::vector<Activity>& all = question_.problem.activities;
  bool found = false;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      if (!share_a_lane(all[a], all[b]) || all[a].duration == 0 || all[b].duration == 0) continue;
      const Ticks common = meeting_time(all[a], all[b]);
      const Ticks behind = solver::modulo(offsets[b] - offsets[a], common);
      if (behind >= all[a].duration && behind <= common - all[b].duration) continue;
      if (!apart_.emplace(a, b).second) continue;
      found = true;
      if (all[a].duration + all[b].duration > common)
        solver_.add(context_.bool_val(false));
      else
        solver_.add(apart(offset(a), offset(b), common, all[a].duration, common - all[b].duration));
    }
  return found;
}

z3::check_result Encoding::check(std::uint32_t& steps, std::vector<Ticks>& offsets) {
  const auto used = [&] {
    const z3::stats all = solver_.statistics();
    for (unsigned at = 0; at < all.size(); ++at)
      if (all.key(at) == "rlimit count") return all.uint_value(at);
    return 0U;
  };
  const std::uint32_t before = used();
  z3::params parameters(context_);
  parameters.set("rlimit", steps);
  parameters.set("random_seed", 1U);
  solver_.set(parameters);
  const z3::check_result result = solver_.check();
  const std::uint32_t spent = used() - before;
  steps = spent < steps ? steps - spent : 0;
  if (result != z3::sat) return result;
  const z3::model model = solver_.get_model();
  offsets.clear();
  for (const z3::expr& offset : offsets_) offsets.push_back(model.eval(offset, true).get_numeral_int64());
  return result;
}

}  // namespace ttf::schedules::synthesis::smt
