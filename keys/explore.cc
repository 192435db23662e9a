#include "keys/explore.h"

#include <algorithm>
#include <utility>

#include "core/errors.h"

namespace ttf::keys {
namespace {

using Decision = DescribedReading::Decision;
using Numbers = DescribedReading::Numbers;

DescribedReading read(const Loader& load, const DescribedReading::Answers& answers, Numbers numbers) {
  DescribedReading reading(answers, numbers);
  try {
    load(StrictYaml::described(reading));
  } catch (const InputError&) {
  }
  return reading;
}

bool is_number(KeyType type) {
  return type == KeyType::kInteger || type == KeyType::kNumber || type == KeyType::kDecimal ||
         type == KeyType::kDuration || type == KeyType::kIntegers;
}

std::vector<KeyValue> other_answers(const Decision& decision) {
  if (const bool* flag = std::get_if<bool>(&decision.answer)) return {!*flag};
  std::vector<KeyValue> others;
  for (std::size_t word = 0; word < decision.question.words.size(); ++word)
    if (const KeyValue value = static_cast<std::int64_t>(word); value != decision.answer) others.push_back(value);
  return others;
}

const KeyQuestion* find(const DescribedReading::Map& map, const std::string& key) {
  const auto found = std::find_if(map.questions.begin(), map.questions.end(),
                                  [&](const KeyQuestion& question) { return question.key == key; });
  return found == map.questions.end() ? nullptr : &*found;
}

bool same_bounds(const KeyQuestion& a, const KeyQuestion& b) { return a.low == b.low && a.high == b.high; }

bool same_values(const KeyQuestion& a, const KeyQuestion& b) {
  return a.type == b.type && a.optional == b.optional && a.scale == b.scale && a.words == b.words;
}
bool same_kind(const KeyQuestion& a, const KeyQuestion& b) { return same_values(a, b) && a.unit == b.unit; }

// Whether two readings have the same keys of a mapping, except `apart`. A key whose value was not asked for matches any.
bool same_keys(const DescribedReading::Map& a, const DescribedReading::Map& b, const std::string& apart) {
  if (std::set(a.known.begin(), a.known.end()) != std::set(b.known.begin(), b.known.end())) return false;
  return std::all_of(a.questions.begin(), a.questions.end(), [&](const KeyQuestion& question) {
    const KeyQuestion* other = find(b, question.key);
    return other == nullptr || question.key == apart || (same_kind(question, *other) && same_bounds(question, *other));
  });
}

bool changes_keys(const Run& run, const Run& parent) {
  const Decision& changed = *run.changed;
  const auto before = parent.usual().maps().find(changed.question.map);
  const auto after = run.usual().maps().find(changed.question.map);
  const std::string apart = changed.question.type == KeyType::kIsMap ? changed.question.key : "";
  return !same_keys(before->second, after->second, apart);
}

// Whether a mapping is a key's value in another.
bool is_within(const std::string& path, const std::string& around) {
  return !around.empty() && path.starts_with(around + ".") && path.find_first_of(".[", around.size() + 1) == path.npos;
}

// Both runs reach these mappings, with other keys.
std::set<std::string> changes_within(const Run& run, const Run& parent) {
  std::set<std::string> changed;
  for (const auto& [path, map] : run.usual().maps()) {
    const auto before = parent.usual().maps().find(path);
    if (!is_within(path, run.changed->question.map) || before == parent.usual().maps().end()) continue;
    if (std::set(map.known.begin(), map.known.end()) !=
        std::set(before->second.known.begin(), before->second.known.end()))
      changed.insert(path);
  }
  return changed;
}

class Explorer {
 public:
  explicit Explorer(const Loader& load) : load_(load) {}

  Exploration explore() {
    add({});
    for (std::size_t run = 0; run < found_.runs.size(); ++run) {
      branch(run);
      attribute(run);
    }
    return std::move(found_);
  }

 private:
  void add(Run run) {
    for (const Numbers numbers : {Numbers::kUsual, Numbers::kLeast, Numbers::kLargest})
      run.readings.push_back(read(load_, run.answers, numbers));
    if (run.changed) {
      const Run& parent = found_.runs[run.parent];
      run.changes_keys = changes_keys(run, parent);
      std::set<std::string> apart;
      if (run.changes_keys) {
        apart = run.changes_within = changes_within(run, parent);
        apart.insert(run.changed->question.map);
      }
      note_changes(parent.usual(), run.usual(), run.changed->question.path(), apart);
    }
    found_.runs.push_back(std::move(run));
  }

  // Adds a run for each other answer to a decision that this run is the first to meet.
  void branch(std::size_t index) {
    const Run& run = found_.runs[index];
    for (const Decision& decision : run.usual().decisions()) {
      if (is_number(decision.question.type) || run.answers.contains(decision.name)) continue;
      const bool anew = run.changes_keys && decision.question.map == run.changed->question.map;
      if (run.changed && !anew && has_decided(found_.runs[run.parent], decision)) continue;
      for (const KeyValue& answer : other_answers(decision)) {
        Run next;
        next.answers = run.answers;
        next.answers[decision.name] = answer;
        next.parent = index;
        next.changed = decision;
        add(std::move(next));
      }
    }
  }

  static bool has_decided(const Run& run, const Decision& decision) {
    const auto& decisions = run.usual().decisions();
    return std::any_of(decisions.begin(), decisions.end(), [&](const Decision& other) {
      return other.name == decision.name && other.question.words == decision.question.words;
    });
  }

  // Finds the numbers that set other keys' bounds and defaults. Only needed if all numbers together change some.
  void attribute(std::size_t index) {
    const Run& run = found_.runs[index];
    bool unexplained = false;
    for (std::size_t r = 1; r < run.readings.size(); ++r)
      for (const auto& [path, map] : run.readings[r].maps())
        for (const KeyQuestion& question : map.questions) {
          const KeyQuestion* usual = usual_of(run.usual(), path, question.key);
          if (usual != nullptr && !(same_bounds(question, *usual) && question.fallback == usual->fallback))
            unexplained |= explained_.insert(question.path()).second;
        }
    if (!unexplained) return;
    for (const Decision& decision : run.usual().decisions()) {
      if (!is_number(decision.question.type)) continue;
      for (const KeyValue& answer : {decision.question.low, decision.question.high}) {
        DescribedReading::Answers answers = run.answers;
        answers[decision.name] = answer;
        note_changes(run.usual(), read(load_, answers, Numbers::kUsual), decision.question.path());
      }
    }
  }

  static const KeyQuestion* usual_of(const DescribedReading& reading, const std::string& path, const std::string& key) {
    const auto map = reading.maps().find(path);
    return map == reading.maps().end() ? nullptr : find(map->second, key);
  }

  // Skips the mappings `apart`. Their cases decide.
  void note_changes(const DescribedReading& before, const DescribedReading& after, const std::string& cause,
                    const std::set<std::string>& apart = {}) {
    for (const auto& [path, map] : after.maps())
      for (const KeyQuestion& question : map.questions) {
        const KeyQuestion* other = usual_of(before, path, question.key);
        if (other == nullptr || !same_values(question, *other) || question.path() == cause) continue;
        if (apart.contains(path)) continue;
        if (!same_bounds(question, *other)) found_.bounds_by[question.path()].insert(cause);
        if (question.fallback != other->fallback) found_.default_by[question.path()].insert(cause);
      }
  }

  const Loader& load_;
  Exploration found_;
  std::set<std::string> explained_;  // paths of keys that were looked into
};

}  // namespace

Exploration explore(const Loader& load) { return Explorer(load).explore(); }

}  // namespace ttf::keys
