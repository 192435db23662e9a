#include "cli/schedule/packing/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/decimal.h"
#include "core/file_bytes.h"
#include "schedules/model/cluster.h"
#include "schedules/packing/variants/check.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using schedules::model::Channels;

// Gives each place the number of its bin.
StandingPlaces numbered(const table::Assignment& assignment) {
  StandingPlaces standing;
  std::map<std::tuple<int, Channels>, int> bins;
  for (const auto& place : assignment)
    if (place) bins.emplace(std::tuple(place->number.slot, place->number.channels), 0);
  for (auto& [number, bin] : bins) {
    bin = static_cast<int>(standing.numbers.size());
    standing.numbers.push_back({std::get<0>(number), std::get<1>(number)});
  }
  for (const auto& place : assignment) {
    standing.places.emplace_back();
    if (place)
      standing.places.back() = table::BitPlace{bins.at(std::tuple(place->number.slot, place->number.channels)),
                                               place->first_cycle, place->offset};
  }
  return standing;
}

// A FIBEX file is XML: it begins with a tag, perhaps behind a byte order mark and blanks. A heading of columns does
// not.
bool is_xml(const std::string& text) {
  const std::size_t mark = text.starts_with("\xEF\xBB\xBF") ? 3 : 0, first = text.find_first_not_of(" \t\r\n", mark);
  return first != std::string::npos && text[first] == '<';
}

void gather(std::string text, const std::string& name, const TableShape& shape, StandingGatherer& standing,
            Findings& findings) {
  standing.begin(name);
  if (is_xml(text))
    gather_bus(std::move(text), name, shape, standing, findings);
  else
    gather_csv(text, name, standing, findings);
}

}  // namespace

StandingGatherer::StandingGatherer(const SignalFile& signals, table::ChannelUse use) : signals_(signals), use_(use) {
  for (std::size_t i = 0; i < signals.instance.signals.size(); ++i)
    index_of_.emplace(signals.instance.signals[i].name, i);
  from_.resize(signals.instance.signals.size());
  assignment_.resize(signals.instance.signals.size());
}

void StandingGatherer::begin(const std::string& file) {
  file_ = file;
  names_.clear();
}

std::optional<std::size_t> StandingGatherer::find(const StandingSignal& signal, Findings& findings) {
  if (!names_.insert(signal.name).second) {
    findings.add({file_, signal.line, "signal", signal.name, "occurs twice"});
    return std::nullopt;
  }
  const auto known = index_of_.find(signal.name);
  if (known == index_of_.end()) {
    note(signal, fmt::format("is not among the signals of {}", signals_.name));
    return std::nullopt;
  }
  return keeps_its_kind(signal, known->second, findings) ? std::optional(known->second) : std::nullopt;
}

void StandingGatherer::note(const StandingSignal& signal, const std::string& why) {
  notes_.push_back(fmt::format("{}:{}: signal {} {}; its place is free", file_, signal.line, signal.name, why));
}

// Returns whether node, period and length are those of the signal file.
bool StandingGatherer::keeps_its_kind(const StandingSignal& standing, std::size_t index, Findings& findings) const {
  const table::Signal& signal = signals_.instance.signals[index];
  const SignalTimes& times = signals_.times[index];
  const std::size_t before = findings.size();
  const auto expect = [&](const char* column, const std::string& text, bool same, const std::string& value) {
    if (!same)
      findings.add({file_, standing.line, column, text,
                    fmt::format("must be {}, as in {}:{}: a signal that stands keeps its node, period and length",
                                value, signals_.name, times.line)});
  };
  const std::string& node = signals_.instance.nodes[static_cast<std::size_t>(signal.node)];
  expect("node", standing.node, standing.node == node, node);
  expect("period_ms", standing.period_ms, parse_scaled(standing.period_ms, 1'000'000) == times.period.ns,
         scaled_text(times.period.ns, 1'000'000));
  expect("bits", standing.bits, standing.bits == std::to_string(signal.bits), std::to_string(signal.bits));
  return findings.size() == before;
}

std::optional<Channels> StandingGatherer::channels_of(const StandingSignal& signal, Findings& findings) const {
  const Channels own = use_ == table::ChannelUse::kSame ? Channels::kAB : Channels::kA;
  if (signal.channel.empty() || signal.channel == schedules::model::channels_text(own)) return own;
  if (use_ == table::ChannelUse::kIndependent && signal.channel == "B") return Channels::kB;
  findings.add({file_, signal.line, "channel", signal.channel,
                use_ == table::ChannelUse::kSame  ? "must be AB with --channels same"
                : use_ == table::ChannelUse::kOne ? "must be A with --channels one"
                                                  : "must be A or B with --channels independent"});
  return std::nullopt;
}

void StandingGatherer::place(std::size_t index, const StandingSignal& signal, table::Assigned place,
                             Findings& findings) {
  const auto channels = channels_of(signal, findings);
  if (!channels) return;
  if (signals_.instance.signals[index].window.empty()) return note(signal, "cannot meet its own window");
  place.number.channels = *channels;
  const auto& before = assignment_[index];
  if (before && *before != place)
    return findings.add(
        {file_, signal.line, "signal", signal.name,
         fmt::format("must have the place that it has in {}:{}: slot {}, first cycle {}, bit {}", from_[index].file,
                     from_[index].line, before->number.slot, before->first_cycle, before->offset)});
  from_[index] = {file_, signal.line};
  assignment_[index] = place;
}

StandingPlaces StandingGatherer::finish(Findings& findings) {
  findings.throw_if_any();
  for (const table::Violation& violation : table::variants::variant_violations(signals_.instance, assignment_))
    findings.add({from_[violation.signal].file, from_[violation.signal].line, "signal",
                  signals_.instance.signals[violation.signal].name, violation.text});
  findings.throw_if_any();
  StandingPlaces standing = numbered(assignment_);
  standing.notes = std::move(notes_);
  return standing;
}

StandingPlaces parse_standing(const std::string& text, const std::string& name, const SignalFile& signals,
                              table::ChannelUse use) {
  Findings findings;
  StandingGatherer standing(signals, use);
  gather(text, name, signals.shape, standing, findings);
  return standing.finish(findings);
}

StandingPlaces read_standing(const std::vector<std::string>& paths, const SignalFile& signals, table::ChannelUse use) {
  Findings findings;
  StandingGatherer standing(signals, use);
  for (const std::string& path : paths) gather(read_file(path), path, signals.shape, standing, findings);
  return standing.finish(findings);
}

}  // namespace ttf::cli::schedule::packing
