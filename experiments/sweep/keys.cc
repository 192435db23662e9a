#include "experiments/sweep/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace ttf::experiments::sweep {
namespace {

constexpr std::string_view kNotTheirs = "the experiment has a seed, and paradigms have clusters";

bool is_fixed(const Edit& edit) { return edit.key == "seed" || edit.key.starts_with("clusters"); }

// Returns whether one paradigm may have both; an empty name means all.
bool overlap(const std::string& one, const std::string& other) { return one.empty() || other.empty() || one == other; }

class KeyCheck {
 public:
  KeyCheck(const SweepFile& sweep, Findings& findings) : sweep_(sweep), findings_(findings) {}

  void check() {
    for (const Axis& axis : sweep_.axes) check(axis);
    for (const Paradigm& paradigm : sweep_.paradigms)
      for (const Edit& edit : paradigm.edits) {
        const auto [first, last] = owners_.equal_range(edit.key);
        const bool owned =
            std::any_of(first, last, [&](const auto& entry) { return overlap(entry.second.paradigm, paradigm.name); });
        if (owned || is_fixed(edit))
          fail(edit, "paradigms",
               fmt::format("must not set {} in {}: {}", edit.key, paradigm.name,
                           owned ? "an axis varies it" : kNotTheirs));
      }
  }

 private:
  struct Owner {
    std::string axis, paradigm;
  };

  // Adds one finding per axis at most: all its settings share a mistake.
  void check(const Axis& axis) {
    for (const Edit& key : axis.keys)
      if (!varied(key, axis.name)) return;
    for (const Setting& setting : axis.settings)
      for (auto edit = setting.edits.begin(); edit != setting.edits.end(); ++edit) {
        if (axis.keys.empty() && !varied(*edit, axis.name)) return;
        if (std::any_of(setting.edits.begin(), edit, [&](const Edit& other) {
              return other.key == edit->key && overlap(other.paradigm, edit->paradigm);
            }))
          return fail(*edit, "axes",
                      fmt::format("must not set {} twice in {} of {}", edit->key, setting.label, axis.name));
      }
  }

  bool varied(const Edit& edit, const std::string& axis) {
    if (is_fixed(edit)) {
      fail(edit, "axes", fmt::format("{} must not be varied: {}", edit.key, kNotTheirs));
      return false;
    }
    const auto [first, last] = owners_.equal_range(edit.key);
    bool known = false;
    for (auto other = first; other != last; ++other) {
      const Owner& owner = other->second;
      known = known || (owner.axis == axis && owner.paradigm == edit.paradigm);
      if (owner.axis == axis || !overlap(owner.paradigm, edit.paradigm)) continue;
      fail(edit, "axes", fmt::format("must not vary {} twice: {} and {} do", edit.key, owner.axis, axis));
      return false;
    }
    if (!known) owners_.emplace(edit.key, Owner{axis, edit.paradigm});
    return true;
  }

  void fail(const Edit& edit, const char* where, std::string expected) {
    findings_.add({sweep_.file, edit.line, where, "", std::move(expected)});
  }

  const SweepFile& sweep_;
  Findings& findings_;
  std::multimap<std::string, Owner> owners_;  // by key
};

}  // namespace

void check_keys(const SweepFile& sweep, Findings& findings) { KeyCheck(sweep, findings).check(); }

}  // namespace ttf::experiments::sweep
