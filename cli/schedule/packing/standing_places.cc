#include <fmt/format.h>

#include <map>
#include <set>
#include <tuple>

#include "cli/schedule/packing/columns.h"
#include "cli/schedule/packing/signal_file.h"
#include "core/decimal.h"
#include "core/file_bytes.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/packing/variants/check.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::synthesis::packing;
using schedules::model::Channels;

class StandingReader {
 public:
  StandingReader(const std::string& name, const SignalFile& signals, table::ChannelUse use)
      : name_(name), signals_(signals), use_(use) {
    for (std::size_t i = 0; i < signals.instance.signals.size(); ++i)
      index_of_.emplace(signals.instance.signals[i].name, i);
    lines_.resize(signals.instance.signals.size());
    assignment_.resize(signals.instance.signals.size());
  }

  StandingPlaces read(const std::string& text) {
    Rows rows(text, name_, {kSignal, kNode, kPeriod, kBits, kSlot, kFirstCycle, kBitOffset});
    Findings findings;
    while (rows.next(findings)) take(rows, findings);
    findings.throw_if_any();
    for (const table::Violation& violation : table::variants::variant_violations(signals_.instance, assignment_))
      findings.add({name_, lines_[violation.signal], "signal", signals_.instance.signals[violation.signal].name,
                    violation.text});
    findings.throw_if_any();
    number_bins();
    return std::move(standing_);
  }

 private:
  void take(const Rows& rows, Findings& findings) {
    const std::string& name = rows.text(kSignal);
    if (rows.text(kSlot).empty() && rows.text(kFirstCycle).empty() && rows.text(kBitOffset).empty()) return;
    if (!names_.insert(name).second) return findings.add(rows.finding(kSignal, "occurs twice"));
    const auto known = index_of_.find(name);
    if (known == index_of_.end()) return note(rows, "is not among the signals of " + signals_.name);
    const std::size_t index = known->second;
    if (!keeps_its_kind(rows, index, findings)) return;
    const auto slot = rows.whole(kSlot, {0, table::kLastStaticSlot}, findings);
    const auto cycle = rows.whole(kFirstCycle, {0, table::kMostCycles - 1}, findings);
    const auto offset = rows.whole(kBitOffset, {0, table::kMostPayloadBits - 1}, findings);
    const auto channels = channels_of(rows, findings);
    if (!slot || !cycle || !offset || !channels) return;
    if (signals_.instance.signals[index].window.empty()) return note(rows, "cannot meet its own window");
    lines_[index] = rows.line();
    assignment_[index] = {{*slot, *channels}, *cycle, *offset};
  }

  void note(const Rows& rows, const std::string& why) {
    standing_.notes.push_back(
        fmt::format("{}:{}: signal {} {}; its place is free", name_, rows.line(), rows.text(kSignal), why));
  }

  // Returns whether node, period and length are those of the signal file.
  bool keeps_its_kind(const Rows& rows, std::size_t index, Findings& findings) const {
    const table::Signal& signal = signals_.instance.signals[index];
    const SignalTimes& times = signals_.times[index];
    const std::size_t before = findings.size();
    const auto expect = [&](Column column, bool same, const std::string& value) {
      if (!same)
        findings.add(rows.finding(
            column, fmt::format("must be {}, as in {}:{}: a signal that stands keeps its node, period and length",
                                value, signals_.name, times.line)));
    };
    const std::string& node = signals_.instance.nodes[static_cast<std::size_t>(signal.node)];
    expect(kNode, rows.text(kNode) == node, node);
    expect(kPeriod, parse_scaled(rows.text(kPeriod), 1'000'000) == times.period.ns,
           scaled_text(times.period.ns, 1'000'000));
    expect(kBits, rows.text(kBits) == std::to_string(signal.bits), std::to_string(signal.bits));
    return findings.size() == before;
  }

  // The channel that belongs to the use, if the file has no channels.
  std::optional<Channels> channels_of(const Rows& rows, Findings& findings) const {
    const Channels own = use_ == table::ChannelUse::kSame ? Channels::kAB : Channels::kA;
    const std::string& text = rows.text(kChannel);
    if (text.empty() || text == schedules::model::channels_text(own)) return own;
    if (use_ == table::ChannelUse::kIndependent && text == "B") return Channels::kB;
    findings.add(rows.finding(kChannel, use_ == table::ChannelUse::kSame ? "must be AB with --channels same"
                                        : use_ == table::ChannelUse::kOne
                                            ? "must be A with --channels one"
                                            : "must be A or B with --channels independent"));
    return std::nullopt;
  }

  // Numbers the bins by slot and channel.
  void number_bins() {
    std::map<std::tuple<int, Channels>, int> bins;
    for (const auto& place : assignment_)
      if (place) bins.emplace(std::tuple(place->number.slot, place->number.channels), 0);
    for (auto& [number, bin] : bins) {
      bin = static_cast<int>(standing_.numbers.size());
      standing_.numbers.push_back({std::get<0>(number), std::get<1>(number)});
    }
    for (const auto& place : assignment_) {
      standing_.places.emplace_back();
      if (place)
        standing_.places.back() = table::Place{bins.at(std::tuple(place->number.slot, place->number.channels)),
                                               place->first_cycle, place->offset};
    }
  }

  std::string name_;
  const SignalFile& signals_;
  table::ChannelUse use_;
  std::map<std::string, std::size_t> index_of_;
  std::set<std::string> names_;
  std::vector<int> lines_;
  table::Assignment assignment_;
  StandingPlaces standing_;
};

}  // namespace

StandingPlaces parse_standing(const std::string& text, const std::string& name, const SignalFile& signals,
                              table::ChannelUse use) {
  return StandingReader(name, signals, use).read(text);
}

StandingPlaces read_standing(const std::string& path, const SignalFile& signals, table::ChannelUse use) {
  return parse_standing(read_file(path), path, signals, use);
}

}  // namespace ttf::cli::schedule::packing
