#include "schedules/synthesis/solver/decide.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/bounds.h"
#include "schedules/synthesis/solver/tree.h"
#include "schedules/synthesis/solver/turns.h"

namespace ttf::schedules::synthesis::solver {
namespace {

// Whether a limit is too low whatever the offsets.
bool too_low(const Model& model) {
  for (const ChainTerms& chain : model.chains)
    if (chain.base > chain.limit) return true;
  for (const SumLimit& sum : model.sums) {
    Ticks least = 0;
    for (std::size_t at = 0; at < sum.chains.size(); ++at) least += sum.weights[at] * model.chains[sum.chains[at]].base;
    if (least > sum.most) return true;
  }
  for (const SpanLimit& span : model.spans)
    for (const std::size_t activity : span.activities)
      if (model.problem.activities[activity].duration > span.most) return true;
  return false;
}

// A split of turns counts as so many nodes of a tree, where there are no more than so many pairs of numbers.
constexpr std::int64_t kNodesOfASplit = 10, kUsualPairs = 64 * 64;
// All questions of an objective may take so many times what one may.
constexpr std::int64_t kQuestions = 3;

std::int64_t splits_of(const Effort& effort) { return std::max<std::int64_t>(1, effort.exhaustion / kNodesOfASplit); }

Verdict infeasible() { return {Verdict::Kind::kInfeasible, {}, 0}; }

}  // namespace

Decider::Decider(const Effort& effort, Prover* prover) : effort_(effort), prover_(prover) { renew(); }

void Decider::renew() {
  left_ = effort_.proofs;
  splits_ = kQuestions * splits_of(effort_);
}

bool keeps(const Question& question, const Solution& solution) {
  if (!violations(question.problem, solution).empty()) return false;
  for (const SumLimit& sum : question.sums) {
    Ticks total = 0;
    for (std::size_t at = 0; at < sum.chains.size(); ++at)
      total += sum.weights[at] * age(question.problem, question.problem.chains[sum.chains[at]], solution);
    if (total > sum.most) return false;
  }
  for (const SpanLimit& span : question.spans) {
    Ticks first = kNoLimit, last = -kNoLimit;
    for (const std::size_t at : span.activities) {
      first = std::min(first, solution.offsets[at]);
      last = std::max(last, solution.offsets[at] + question.problem.activities[at].duration);
    }
    if (last - first > span.most) return false;
  }
  return true;
}

// Lets the chains' first activities begin earlier until all orders hold, if that keeps the question.
std::optional<Solution> in_order(const Question& question, Solution solution) {
  const Problem& problem = question.problem;
  for (std::size_t round = 0; round <= problem.orders.size(); ++round)
    for (const Order& order : problem.orders) {
      const Ticks late = out_of_order(problem, order, solution);
      if (late <= 0) continue;
      const std::size_t source = problem.chains[order.first].activities.front();
      const Window& window = problem.activities[source].window;
      Ticks& offset = solution.offsets[source];
      offset = window.first + modulo(offset - late - window.first, problem.activities[source].period);
    }
  if (!keeps(question, solution)) return std::nullopt;
  return solution;
}

// Turns know neither orders nor sums, so theirs may break these. A split costs as many steps as there are pairs of
// numbers.
Verdict Decider::turned(const Question& question, const Model& model) {
  if (!question.sums.empty() || splits_ <= 0) return {};
  way_ = "exhausted";
  if (two_chains_contradict(question.problem, splits_)) return infeasible();
  const Rules rules(model);
  const auto numbers = static_cast<std::int64_t>(rules.windows.size());
  if (numbers > static_cast<std::int64_t>(Turns::kMostNumbers)) return {};
  const std::int64_t dearer = std::max<std::int64_t>(1, numbers * numbers / kUsualPairs);
  Turns turns(rules);
  const Turns::End end = turns.run(std::min(splits_, splits_of(effort_)) / dearer);
  splits_ -= turns.splits() * dearer;
  if (end == Turns::End::kExhausted) return infeasible();
  if (end == Turns::End::kGaveUp) return {};
  way_ = "placement";
  const std::optional<Solution> kept = in_order(question, {turns.found()});
  TTF_CHECK(kept || !question.problem.orders.empty() || !std::ranges::all_of(model.chains, &ChainTerms::harmonic),
            "the turns' offsets break the problem");
  return kept ? Verdict{Verdict::Kind::kFeasible, *kept, 0} : Verdict{};
}

Verdict Decider::search(const Question& question) {
  std::int64_t steps = effort_.steps;
  const std::int64_t exhaustion = effort_.exhaustion;
  const Model model(question);
  way_ = "windows and precedences";
  if (model.contradictory || too_low(model)) return infeasible();
  std::vector<std::int64_t> weights(question.problem.activities.size(), 0);
  const auto run = [&](Tree& tree, std::int64_t most_nodes, const char* way) {
    const Tree::End end = tree.run(most_nodes);
    way_ = way;
    for (std::size_t at = 0; at < weights.size(); ++at) weights[at] = weights[at] / 2 + tree.dead_ends()[at];
    return end;
  };
  const auto count = static_cast<std::int64_t>(weights.size());
  // Trees know no orders: their offsets may break these, and nothing else.
  const auto found = [&](const Tree& tree) {
    const std::optional<Solution> kept = in_order(question, tree.solution());
    TTF_CHECK(kept || !question.problem.orders.empty(), "the search's offsets break the problem");
    return kept ? Verdict{Verdict::Kind::kFeasible, *kept, 0} : Verdict{};
  };
  std::int64_t most = 4 * count + 100;
  for (int probe = 0; steps > 0; ++probe, steps -= most, most += most / 8) {
    Tree coarse(model, placing_order(model, weights, probe % 4 != 3), false,
                probe < 2 ? 0 : static_cast<std::uint64_t>(probe));
    if (run(coarse, std::min(most, steps), "placement") == Tree::End::kFound)
      if (Verdict verdict = found(coarse); verdict.kind == Verdict::Kind::kFeasible) return verdict;
    if (probe != 1 && probe != 3) continue;
    // Many questions are small: a short exhaustion answers them before long probing would.
    Tree all(model, placing_order(model, weights, true), true);
    const Tree::End end = run(all, std::min(exhaustion, 4 * most), "exhausted");
    if (end == Tree::End::kFound)
      if (Verdict verdict = found(all); verdict.kind == Verdict::Kind::kFeasible) return verdict;
    if (end == Tree::End::kExhausted) return infeasible();
    if (probe == 1)
      if (Verdict verdict = turned(question, model); verdict.kind != Verdict::Kind::kUnknown) return verdict;
  }
  Tree all(model, placing_order(model, weights, true), true);
  const Tree::End end = run(all, exhaustion, "exhausted");
  if (end == Tree::End::kFound)
    if (Verdict verdict = found(all); verdict.kind == Verdict::Kind::kFeasible) return verdict;
  if (end == Tree::End::kExhausted) return infeasible();
  way_.clear();
  return {};
}

// Holds activities of chains where they are unless they overlap with others, and searches for the rest.
std::optional<Solution> Decider::repaired(const Question& question, const Solution& almost) {
  const Model model(question);
  Problem held = question.problem;
  for (std::size_t chain = 0; chain < model.chains.size(); ++chain) {
    if (model.chains[chain].limit >= kNoLimit && question.sums.empty()) continue;
    for (const std::size_t at : held.chains[chain].activities) held.activities[at].fixed = almost.offsets[at];
  }
  for (const auto& [a, b] : overlaps(question.problem, almost))
    for (const std::size_t at : {a, b}) held.activities[at].fixed = question.problem.activities[at].fixed;
  const Effort all = effort_;
  effort_ = {.steps = all.steps / 10, .exhaustion = all.exhaustion / 10, .seeds = all.seeds, .proofs = all.proofs};
  Verdict verdict = search({held, question.sums, question.spans});
  effort_ = all;
  if (verdict.kind != Verdict::Kind::kFeasible || !keeps(question, verdict.solution)) return std::nullopt;
  return verdict.solution;
}

Verdict Decider::asked(const Question& question, double share, const Repair& repair) {
  if (left_ <= 0) return {};
  Verdict verdict = prover_->decide(question, std::min(share, left_), repair);
  left_ -= verdict.spent;
  return verdict;
}

bool Decider::few_chains_contradict(const Question& question) {
  std::vector<std::pair<Ticks, std::size_t>> chains;  // slack, chain
  for (std::size_t at = 0; at < question.problem.chains.size(); ++at) {
    const ChainTerms terms = terms_of(question.problem, question.problem.chains[at]);
    if (terms.limit < kNoLimit) chains.emplace_back(terms.limit - terms.base, at);
  }
  std::ranges::sort(chains);
  for (std::size_t count = 1; prover_ != nullptr && count < chains.size(); count *= 2) {
    std::vector<std::size_t> activities;
    for (std::size_t at = 0; at < count; ++at)
      for (const std::size_t activity : question.problem.chains[chains[at].second].activities)
        activities.push_back(activity);
    Part part = part_of(question.problem, activities);
    for (std::size_t at = 0; at < count; ++at) part.add(question.problem.chains[chains[at].second]);
    const Question few{part.problem, {}, {}};
    Verdict verdict = search(few);
    if (verdict.kind == Verdict::Kind::kUnknown)
      verdict = asked(few, 0.1, [](const Solution&) { return std::nullopt; });
    if (verdict.kind != Verdict::Kind::kInfeasible) continue;
    way_ = "integers";
    return true;
  }
  return false;
}

Verdict Decider::prove(const Question& question) {
  if (few_chains_contradict(question)) return infeasible();
  way_.clear();
  if (prover_ == nullptr) return {};
  Verdict verdict = asked(question, 1.0, [&](const Solution& almost) { return repaired(question, almost); });
  if (verdict.kind == Verdict::Kind::kFeasible)
    TTF_CHECK(keeps(question, verdict.solution), "the prover's offsets break the problem");
  way_ = verdict.kind == Verdict::Kind::kUnknown ? "" : "integers";
  return verdict;
}

Verdict Decider::decide(const Question& question) {
  const Verdict verdict = search(question);
  return verdict.kind == Verdict::Kind::kUnknown ? prove(question) : verdict;
}

}  // namespace ttf::schedules::synthesis::solver
