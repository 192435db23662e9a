#include "cli/schedule/packing/signal_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cli/schedule/packing/columns.h"
#include "core/decimal.h"
#include "core/file_bytes.h"
#include "schedules/model/cluster.h"
#include "schedules/packing/instance.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;

constexpr std::size_t kLongestVariantName = 40;

// A variant's name becomes part of a file's name.
bool is_variant_name(std::string_view name) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !name.empty() && name.size() <= kLongestVariantName &&
         name.find_first_not_of(kAllowed) == std::string_view::npos;
}

// The variants of a vehicle by name, as a column of a file of signals has them: "base|sport". Numbers the variants in the order
// of their first line.
class VariantNames {
 public:
  // Returns the variants of a row: all, also those of later lines, if the field is blank. Adds a finding for a name
  // that is no part of a file's name, occurs twice, or is one too many.
  table::VariantSet read(const Rows& rows, Findings& findings) {
    const std::string_view field = rows.text(kVariants);
    if (field.empty()) return table::kAllVariants;
    table::VariantSet variants = 0;
    for (std::size_t begin = 0; begin <= field.size();) {
      const std::size_t end = std::min(field.find('|', begin), field.size());
      const std::string_view name = field.substr(begin, end - begin);
      begin = end + 1;
      if (!is_variant_name(name)) {
        findings.add(
            rows.finding(kVariants, fmt::format("must be names as in base|sport, each of 1..{} letters, digits, _, - "
                                                "or .; blank for all variants",
                                                kLongestVariantName)));
        return table::kAllVariants;
      }
      const auto known = std::find(names_.begin(), names_.end(), name);
      if (known == names_.end() && names_.size() == static_cast<std::size_t>(table::kMostVariants)) {
        findings.add(rows.finding(
            kVariants, fmt::format("must not name another variant: there are at most {}", table::kMostVariants)));
        return table::kAllVariants;
      }
      const table::VariantSet one = table::VariantSet{1} << (known - names_.begin());
      if (known == names_.end()) names_.emplace_back(name);
      if ((variants & one) != 0) findings.add(rows.finding(kVariants, fmt::format("must name {} once", name)));
      variants |= one;
    }
    return variants;
  }

  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

// Returns the field of a row with these variants.
std::string variants_text(table::VariantSet variants, const std::vector<std::string>& names) {
  if (variants == table::kAllVariants) return {};
  std::string text;
  table::each_variant(variants, [&](int variant) {
    if (static_cast<std::size_t>(variant) >= names.size()) return;
    text += (text.empty() ? "" : "|") + names[static_cast<std::size_t>(variant)];
  });
  return text;
}

constexpr std::size_t kLongestSignalName = 100;

std::string ms_text(Duration time) { return scaled_text(time.ns, 1'000'000); }

// Returns the repetition of a period, or none and a finding.
std::optional<int> repetition_of(const Rows& rows, Duration period, const TableShape& shape, Findings& findings) {
  const std::int64_t repetition = period.ns / shape.cycle.ns;
  if (period.ns % shape.cycle.ns == 0 && repetition >= 1 && repetition <= shape.cycles &&
      std::has_single_bit(static_cast<std::uint64_t>(repetition)))
    return static_cast<int>(repetition);
  std::vector<std::string> allowed;
  for (int times = 1; times <= shape.cycles; times *= 2) allowed.push_back(ms_text(shape.cycle * times));
  findings.add(rows.finding(kPeriod, fmt::format("must be a cycle of {} ms times 1, 2, 4, ...: {} ms",
                                                 ms_text(shape.cycle), fmt::join(allowed, ", "))));
  return std::nullopt;
}

// Returns why no packing can have a place for the signal, or an empty text.
std::string impossibility(const table::Signal& signal, const SignalTimes& times, const TableShape& shape) {
  if (signal.bits > shape.payload_bits)
    return fmt::format("has no place: its {} bits must fit a frame of {} bits", signal.bits, shape.payload_bits);
  if (!signal.window.empty()) return {};
  return fmt::format(
      "has no place: a cycle of {} ms must begin at or after its release, {} ms, and before its deadline, {} ms, "
      "within its "
      "period of {} ms",
      ms_text(shape.cycle), ms_text(times.release), ms_text(times.deadline), ms_text(times.period));
}

class SignalReader {
 public:
  SignalReader(const std::string& name, const TableShape& shape) {
    file_.name = name;
    file_.shape = shape;
    file_.instance.payload_bits = shape.payload_bits;
    file_.instance.cycles = shape.cycles;
    file_.instance.shared_slots = shape.shared_slots;
  }

  SignalFile read(const std::string& text) {
    Rows rows(text, file_.name, {kSignal, kNode, kPeriod, kBits});
    Findings findings;
    while (rows.next(findings)) take(rows, findings);
    if (findings.empty() && file_.times.empty())
      findings.add({file_.name, 0, "signals", "", "are missing: must have a line for each"});
    findings.throw_if_any();
    file_.instance.variants = names_of_variants_.names();
    return std::move(file_);
  }

 private:
  void take(const Rows& rows, Findings& findings) {
    const std::string& name = rows.text(kSignal);
    if (name.empty() || name.size() > kLongestSignalName)
      findings.add(rows.finding(kSignal, fmt::format("must be a name of 1..{} characters", kLongestSignalName)));
    else if (const auto [known, added] = line_of_.emplace(name, rows.line()); !added)
      findings.add(rows.finding(kSignal, fmt::format("must be a name of its own: line {} has it, too", known->second)));
    if (rows.text(kNode).empty()) findings.add(rows.finding(kNode, "must be the name of the sender"));
    const auto period =
        rows.milliseconds(kPeriod, {file_.shape.cycle, file_.shape.cycle * file_.shape.cycles}, std::nullopt, findings);
    const auto bits = rows.whole(kBits, {1, table::kMostPayloadBits}, findings);
    const table::VariantSet variants = names_of_variants_.read(rows, findings);
    if (!period) return;
    const auto repetition = repetition_of(rows, *period, file_.shape, findings);
    const auto release = rows.milliseconds(kRelease, {Duration{}, *period}, Duration{}, findings);
    const auto deadline = rows.milliseconds(kDeadline, {Duration{}, *period}, *period, findings);
    if (!repetition || !release || !deadline || !bits) return;
    const table::Signal signal{name,        node(rows.text(kNode)),
                               *repetition, table::window_of(file_.shape.cycle, *release, *deadline, *repetition),
                               *bits,       variants};
    const SignalTimes times{*period, *release, *deadline, rows.line()};
    if (std::string why = impossibility(signal, times, file_.shape); !why.empty())
      file_.impossible.push_back({file_.name, rows.line(), "signal", name, std::move(why)});
    file_.instance.signals.push_back(signal);
    file_.times.push_back(times);
  }

  int node(const std::string& name) {
    const auto [known, added] = nodes_.emplace(name, static_cast<int>(file_.instance.nodes.size()));
    if (added) file_.instance.nodes.push_back(name);
    return known->second;
  }

  SignalFile file_;
  VariantNames names_of_variants_;
  std::map<std::string, int> nodes_, line_of_;
};

}  // namespace

SignalFile parse_signals(const std::string& text, const std::string& name, const TableShape& shape) {
  return SignalReader(name, shape).read(text);
}

SignalFile read_signals(const std::string& path, const TableShape& shape) {
  return parse_signals(read_file(path), path, shape);
}

std::string packing_csv(const SignalFile& signals, const table::Assignment& assignment) {
  const std::vector<std::string>& variants = signals.instance.variants;
  std::string text;
  for (std::size_t column = 0; column < kColumns; ++column)
    if (column != kVariants || !variants.empty())
      text += fmt::format("{}{}", column == 0 ? "" : ",", kColumnNames[column]);
  text += '\n';
  for (std::size_t i = 0; i < assignment.size(); ++i) {
    const table::Signal& signal = signals.instance.signals[i];
    const SignalTimes& times = signals.times[i];
    text += fmt::format("{},{},{},{},{},{},", csv_field(signal.name),
                        csv_field(signals.instance.nodes[static_cast<std::size_t>(signal.node)]), ms_text(times.period),
                        ms_text(times.release), ms_text(times.deadline), signal.bits);
    if (!variants.empty()) text += variants_text(signal.variants, variants) + ',';
    if (const auto& place = assignment[i])
      text += fmt::format("{},{},{},{}\n", place->number.slot, place->first_cycle, place->offset,
                          schedules::model::channels_text(place->number.channels));
    else
      text += ",,,\n";
  }
  return text;
}

}  // namespace ttf::cli::schedule::packing
