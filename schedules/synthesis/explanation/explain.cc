#include "schedules/synthesis/explanation/explain.h"

#include <algorithm>
#include <optional>

#include "schedules/synthesis/explanation/statements.h"
#include "schedules/synthesis/instants/synthesize.h"

namespace ttf::schedules::synthesis::explanation {

using instants::feasible;
using instants::Feasible;
using plan::Plan;
namespace {

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

  // The search knows gaps and ages alone. The check has more rules, as that a task ends before its next activation.
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
