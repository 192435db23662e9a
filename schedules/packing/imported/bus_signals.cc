#include "schedules/packing/imported/bus_signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "schedules/exchange/fibex/assumptions.h"
#include "schedules/exchange/fibex/file.h"
#include "schedules/exchange/fibex/references.h"
#include "schedules/exchange/fibex/xml.h"

namespace ttf::schedules::packing::imported {
namespace {

namespace fibex = exchange::fibex;

// The cycles in which a signal's bits are sent, by channel.
using Sent = std::array<std::set<int>, 2>;

struct Found {
  BusSignal signal;
  Sent sent;
};

std::string place_text(const Assigned& place) {
  return fmt::format("bit {} of slot {}", place.offset, place.number.slot);
}

// Returns the series with these cycles: repetition and first cycle. None for another set.
std::optional<std::pair<int, int>> series_of(const std::set<int>& cycles, int round) {
  if (cycles.empty() || round % static_cast<int>(cycles.size()) != 0) return std::nullopt;
  const int repetition = round / static_cast<int>(cycles.size()), first = *cycles.begin();
  int next = first;
  for (const int cycle : cycles) {
    if (cycle != next) return std::nullopt;
    next += repetition;
  }
  return std::pair(repetition, first);
}

class BusReader {
 public:
  BusReader(fibex::FibexFile file, std::string name, Findings wrong)
      : file_(std::move(file)), name_(std::move(name)), wrong_(std::move(wrong)) {
    for (const fibex::FibexFrame& frame : file_.frames) frames_[frame.id] = &frame;
    for (const fibex::FibexPdu& pdu : file_.pdus) pdus_[pdu.id] = &pdu;
    for (const fibex::FibexEcu& ecu : file_.ecus)
      for (const std::string& sent : ecu.sends) senders_[sent].insert(ecu.name);
  }

  BusSignals read() {
    const model::GlobalParameters& global = file_.global;
    BusSignals bus{
        {global.cycle_ps() / 1000}, global.gPayloadLengthStatic, cycles_per_round(global), file_.cluster_line, {}};
    for (const fibex::FibexTriggering& one : file_.triggerings)
      if (one.slot <= global.gNumberOfStaticSlots) take(one);
    for (auto& [name, found] : found_) finish(found, bus);
    wrong_.throw_if_any();
    std::stable_sort(bus.signals.begin(), bus.signals.end(),
                     [](const BusSignal& a, const BusSignal& b) { return a.line < b.line; });
    return bus;
  }

 private:
  void fail(int line, std::string key, std::string value, std::string expected) {
    wrong_.add({name_, line, std::move(key), std::move(value), std::move(expected)});
  }

  void take(const fibex::FibexTriggering& one) {
    const auto frame = frames_.find(one.frame);
    if (frame == frames_.end() || frame->second->places.empty()) return;
    const auto senders = senders_.find(one.id);
    if (senders == senders_.end() || senders->second.size() != 1)
      return fail(one.line, "fx:FRAME-TRIGGERING", one.id,
                  fmt::format("must have one ECU that sends it, not {}",
                              senders == senders_.end() ? 0 : senders->second.size()));
    for (const fibex::FibexFrame::Place& place : frame->second->places) {
      const auto pdu = pdus_.find(place.pdu);
      if (pdu == pdus_.end()) continue;  // check_references() names it
      if (!is_plain(*pdu->second)) continue;
      for (const fibex::FibexSignal& signal : pdu->second->signals)
        take(signal, one, *senders->second.begin(), 8 * place.byte);
    }
  }

  // Each PDU is named once, though several frames have it.
  bool is_plain(const fibex::FibexPdu& pdu) {
    const bool plain = !pdu.multiplexer && !pdu.signals.empty();
    if (!plain && named_.insert(pdu.id).second)
      fail(pdu.line, "fx:PDU", pdu.name,
           pdu.multiplexer ? "must not be multiplexed: a signal that stands has its bits in each of its cycles"
                           : "must have signals: the bits of a PDU without them are not known");
    return plain;
  }

  void take(const fibex::FibexSignal& signal, const fibex::FibexTriggering& one, const std::string& node,
            int first_bit) {
    const auto offset = signal.offset();
    if (!offset) {
      if (named_.insert("signal " + signal.name).second)
        fail(signal.line, "fx:SIGNAL-INSTANCE", signal.name,
             "must be in high-low byte order: in the other one its bits are not contiguous");
      return;
    }
    const BusSignal here{signal.name, node, 1, signal.meaning.bits, {{one.slot, {}}, 0, first_bit + *offset},
                         signal.line};
    Found& found = found_.try_emplace(signal.name, Found{here, {}}).first->second;
    if (found.signal.place.number.slot != one.slot || found.signal.place.offset != here.place.offset ||
        found.signal.node != node || found.signal.bits != here.bits) {
      if (named_.insert("signal " + signal.name).second)
        fail(signal.line, "fx:SIGNAL-INSTANCE", signal.name,
             fmt::format("must have one place, sender and length: in line {} it has {}, here {}", found.signal.line,
                         place_text(found.signal.place), place_text(here.place)));
      return;
    }
    for (int cycle = one.base_cycle; cycle < cycles_per_round(file_.global); cycle += one.repetition)
      found.sent[static_cast<std::size_t>(one.channel)].insert(cycle);
  }

  void finish(Found& found, BusSignals& bus) {
    const auto& [on_a, on_b] = found.sent;
    BusSignal& signal = found.signal;
    if (!on_a.empty() && !on_b.empty() && on_a != on_b)
      return fail(signal.line, "fx:SIGNAL-INSTANCE", signal.name, "must have the same cycles on both channels");
    const auto series = series_of(on_a.empty() ? on_b : on_a, bus.cycles);
    if (!series)
      return fail(signal.line, "fx:SIGNAL-INSTANCE", signal.name,
                  "must be sent in every cycle, or in every 2nd, 4th, 8th, ...");
    signal.repetition = series->first;
    signal.place.first_cycle = series->second;
    signal.place.number.channels = on_b.empty()   ? model::Channels::kA
                                   : on_a.empty() ? model::Channels::kB
                                                  : model::Channels::kAB;
    bus.signals.push_back(std::move(signal));
  }

  fibex::FibexFile file_;
  std::string name_;
  Findings wrong_;
  std::map<std::string, const fibex::FibexFrame*> frames_;
  std::map<std::string, const fibex::FibexPdu*> pdus_;
  std::map<std::string, std::set<std::string>> senders_;  // by triggering
  std::map<std::string, Found> found_;                    // by name
  std::set<std::string> named_;                           // with a finding
};

}  // namespace

BusSignals parse_bus_signals(std::string text, std::string name) {
  const fibex::XmlFile xml = fibex::XmlFile::parse(std::move(text), name);
  Findings wrong, left_out;
  check_references(xml, wrong);
  fibex::FibexFile file = read_fibex(xml, wrong, left_out);
  wrong.throw_if_any();
  // Other parts that are left out do not matter, but a signal's bits would seem free.
  for (const Finding& finding : left_out.list())
    if (finding.key.ends_with("fx:SIGNAL-INSTANCE"))
      wrong.add({finding.file, finding.line, finding.key, finding.value,
                 "must have a signal with a coding, and so a length"});
  std::set<std::string, std::less<>> assumed;
  assume_global(file, name, assumed, wrong);
  wrong.throw_if_any();
  return BusReader(std::move(file), std::move(name), std::move(wrong)).read();
}

}  // namespace ttf::schedules::packing::imported
