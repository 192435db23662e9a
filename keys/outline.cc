#include "keys/outline.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/check.h"

namespace ttf::keys {
namespace {

using Decision = DescribedReading::Decision;
constexpr std::size_t kTop = std::numeric_limits<std::size_t>::max();  // the runs that reach a mapping first

std::string word_of(const Decision& decision, const KeyValue& answer) {
  if (const bool* flag = std::get_if<bool>(&answer)) return *flag ? "true" : "false";
  return decision.question.words.at(static_cast<std::size_t>(std::get<std::int64_t>(answer)));
}

void widen(Key& key, const KeyQuestion& question) {
  key.question.low = std::min(key.question.low, question.low);
  key.question.high = std::max(key.question.high, question.high);
}

// The cases of one mapping.
class MappingOutline {
 public:
  MappingOutline(const Exploration& exploration, std::string path) : all_(exploration), runs_(exploration.runs) {
    mapping_.path = std::move(path);
    for (std::size_t run = 0; run < runs_.size(); ++run)
      if (reaches(run)) members_[case_of(run)].push_back(run);
  }

  Mapping outline() {
    split(kTop, {}, {});
    return std::move(mapping_);
  }

 private:
  bool reaches(std::size_t run) const { return runs_[run].usual().maps().contains(mapping_.path); }
  bool decides(std::size_t run) const {
    return runs_[run].changes_within.contains(mapping_.path) ||
           (runs_[run].changes_keys && runs_[run].changed->question.map == mapping_.path);
  }

  // Returns the run whose changed answer gave the mapping the keys that it has in this run.
  std::size_t case_of(std::size_t run) const {
    while (!decides(run)) {
      if (!runs_[run].changed || !reaches(runs_[run].parent)) return kTop;
      run = runs_[run].parent;
    }
    return run;
  }

  // Adds the cases below that of `at`. The `settled` decisions have their answers of this run.
  void split(std::size_t at, std::vector<Condition> conditions, std::set<std::string> settled) {
    std::vector<std::size_t> branches;  // runs that decide the first decision that matters
    for (const std::size_t run : members_[at])
      for (std::size_t next = 0; next < runs_.size() && branches.empty(); ++next)
        if (decides(next) && runs_[next].parent == run && !settled.contains(runs_[next].changed->name))
          for (std::size_t other = next; other < runs_.size(); ++other)
            if (decides(other) && runs_[other].parent == run && runs_[other].changed->name == runs_[next].changed->name)
              branches.push_back(other);
    if (branches.empty()) {
      mapping_.cases.push_back({std::move(conditions), keys_of(at)});
      return;
    }
    const Decision& decision = *runs_[branches.front()].changed;
    settled.insert(decision.name);
    conditions.push_back(condition(decision, branches, nullptr));
    split(at, conditions, settled);
    for (const std::size_t branch : branches) {
      conditions.back() = condition(decision, branches, &runs_[branch].answers.at(decision.name));
      split(branch, conditions, settled);
    }
  }

  // The condition of one branch; without an answer, of all answers that have no branch.
  Condition condition(const Decision& decision, const std::vector<std::size_t>& branches,
                      const KeyValue* answer) const {
    TTF_CHECK(decision.question.type != KeyType::kIsMap, "whether {} is a mapping decides which other keys there are",
              decision.question.path());
    Condition condition;
    condition.key = decision.question.key;
    condition.around = decision.question.map != mapping_.path;
    if (decision.question.type == KeyType::kIsThere) condition.of = Condition::Of::kPresence;
    if (answer != nullptr) {
      condition.values = {word_of(decision, *answer)};
    } else {
      condition.values = decision.question.words;
      if (condition.values.empty()) condition.values = {"true", "false"};
      for (const std::size_t branch : branches)
        std::erase(condition.values, word_of(decision, runs_[branch].answers.at(decision.name)));
    }
    const auto& usual = decision.question.fallback;
    condition.usual = usual && std::find(condition.values.begin(), condition.values.end(), word_of(decision, *usual)) !=
                                   condition.values.end();
    return condition;
  }

  std::vector<Key> keys_of(std::size_t at) {
    std::vector<Key> keys;
    std::vector<std::string> order;
    for (const std::size_t run : members_[at])
      for (const DescribedReading& reading : runs_[run].readings) {
        const auto map = reading.maps().find(mapping_.path);
        if (map == reading.maps().end()) continue;
        for (const std::string& key : map->second.known)
          if (std::find(order.begin(), order.end(), key) == order.end()) order.push_back(key);
        for (const KeyQuestion& question : map->second.questions) add(keys, question);
      }
    const auto place = [&](const Key& key) { return std::find(order.begin(), order.end(), key.question.key); };
    std::stable_sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) { return place(a) < place(b); });
    return keys;
  }

  void add(std::vector<Key>& keys, const KeyQuestion& question) const {
    const auto known =
        std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.question.key == question.key; });
    if (known == keys.end()) {
      Key key;
      key.question = question;
      keys.push_back(std::move(key));
      return;
    }
    if (known->question.type == KeyType::kMap && question.type == KeyType::kWord) known->words = question.words;
    if (known->question.type != question.type) return;
    if (known->question.unit != question.unit) known->question.unit.clear();
    const auto causes = [&](const std::map<std::string, std::set<std::string>>& by) {
      const auto found = by.find(question.path());
      return found == by.end() ? std::set<std::string>{} : found->second;
    };
    if (known->question.low != question.low || known->question.high != question.high) {
      widen(*known, question);
      known->bounds_by = causes(all_.bounds_by);
    }
    if (known->question.fallback != question.fallback) known->default_by = causes(all_.default_by);
  }

  const Exploration& all_;
  const std::deque<Run>& runs_;
  std::map<std::size_t, std::vector<std::size_t>> members_;  // by the run that case_of() says
  Mapping mapping_;
};

}  // namespace

const Mapping* Outline::find(const std::string& path) const {
  const auto found =
      std::find_if(mappings.begin(), mappings.end(), [&](const Mapping& mapping) { return mapping.path == path; });
  return found == mappings.end() ? nullptr : &*found;
}

Outline outline(const Exploration& exploration) {
  Outline outline;
  for (const Run& run : exploration.runs)
    for (const std::string& path : run.usual().order())
      if (outline.find(path) == nullptr) outline.mappings.push_back(MappingOutline(exploration, path).outline());
  return outline;
}

}  // namespace ttf::keys
