#include "schedules/exchange/fibex/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "schedules/analysis/minislots.h"
#include "schedules/exchange/fibex/assumptions.h"
#include "schedules/exchange/fibex/lists.h"
#include "schedules/exchange/fibex/references.h"
#include "schedules/model/limits.h"
#include "schedules/model/repetitions.h"

namespace ttf::schedules::exchange::fibex {
namespace {

class Importer {
 public:
  Importer(FibexFile file, std::string name, Findings wrong, Findings left_out)
      : file_(std::move(file)), name_(std::move(name)), wrong_(std::move(wrong)), left_out_(std::move(left_out)) {}

  FibexImport import() {
    wrong_.throw_if_any();
    model::Cluster& cluster = out_.cluster;
    cluster.file = name_;
    cluster.name = file_.cluster_name;
    assume_global(file_, name_, out_.assumed, wrong_);
    wrong_.throw_if_any();
    cluster.flexray = file_.global;
    cluster.topology = file_.topology;
    cluster.guardian = file_.guardian;
    pdus_ = by_id("fx:PDU", file_.pdus);
    frames_ = by_id("fx:FRAME", file_.frames);
    take_lists();
    take_nodes();
    limit("fx:PDUS", cluster.pdus.size());
    limit("fx:ECUS", cluster.nodes.size());
    wrong_.throw_if_any();  // ids are bytes
    take_frames();
    complete_nodes();
    wrong_.throw_if_any();
    name_once();
    return std::move(out_);
  }

 private:
  void fail(int line, std::string key, std::string value, std::string expected) {
    wrong_.add({name_, line, std::move(key), std::move(value), std::move(expected)});
  }
  void leave_out(int line, std::string key, std::string value, std::string why) {
    left_out_.add({name_, line, std::move(key), std::move(value), std::move(why)});
  }
  void limit(std::string key, std::size_t count) {
    if (count > model::kMostNamed)
      fail(0, std::move(key), std::to_string(count), fmt::format("must have at most {} entries", model::kMostNamed));
  }

  template <class Item> std::map<std::string, const Item*> by_id(const char* key, const std::vector<Item>& items) {
    std::map<std::string, const Item*> found;
    for (const Item& item : items)
      if (!found.emplace(item.id, &item).second) fail(item.line, key, item.id, "must have an ID of its own");
    return found;
  }

  void take_lists() {
    std::set<std::string> parts;  // parts of lists, which are reported with them
    std::vector<const FibexPdu*> others;
    std::map<std::string, int> names;
    for (const FibexPdu& pdu : file_.pdus) {
      ListFound found = as_list(pdu, pdus_);
      if (!found.layout) continue;
      if (!names.emplace(pdu.name, pdu.line).second) fail(pdu.line, "fx:PDU", pdu.name, "must have a name of its own");
      parts.insert({pdu.id, pdu.multiplexer->static_pdu, pdu.multiplexer->layouts.front().second});
      lists_[pdu.id] = static_cast<PduId>(out_.cluster.pdus.size());
      out_.cluster.pdus.push_back(std::move(*found.layout));
    }
    for (const FibexPdu& pdu : file_.pdus) {
      if (parts.count(pdu.id) != 0) continue;
      std::string reason = as_list(pdu, pdus_).reason;
      leave_out(pdu.line, "fx:PDU", pdu.name,
                fmt::format("does not fit a list of a cluster file, and becomes a comment: {}", reason));
      out_.foreign.push_back({pdu, std::move(reason)});
    }
  }

  // Takes the ECUs that are on the cluster.
  void take_nodes() {
    std::set<std::string> triggered;
    for (const FibexTriggering& one : file_.triggerings) triggered.insert(one.id);
    std::set<std::string> names;
    for (const FibexEcu& ecu : file_.ecus) {
      const auto in_cluster = [&](const std::string& id) { return triggered.count(id) != 0; };
      if (!ecu.has_controller && std::none_of(ecu.sends.begin(), ecu.sends.end(), in_cluster) &&
          std::none_of(ecu.receives.begin(), ecu.receives.end(), in_cluster)) {
        leave_out(ecu.line, "fx:ECU", ecu.name, "is not on the FlexRay cluster, and is left out");
        continue;
      }
      if (!names.insert(ecu.name).second) fail(ecu.line, "fx:ECU", ecu.name, "must have a name of its own");
      const auto id = static_cast<NodeId>(out_.cluster.nodes.size());
      for (const std::string& sent : ecu.sends) {
        if (!in_cluster(sent))
          fail(ecu.line, "fx:OUTPUT-PORT", sent, "must have a FRAME-TRIGGERING-REF of this cluster");
        if (const auto [other, fresh] = senders_.emplace(sent, id); !fresh && other->second != id)
          fail(ecu.line, "fx:OUTPUT-PORT", sent, fmt::format("must have one sender, not {} too", ecu.name));
      }
      model::Node& node = out_.cluster.nodes.emplace_back();
      node.name = ecu.name;
      node.line = ecu.line;
      ecus_.push_back(&ecu);
    }
  }

  // Returns whether a cluster file can have the frame in one of its segments.
  bool has_a_slot(const FibexTriggering& one) {
    const auto out = [&](const std::string& value, const std::string& why) {
      leave_out(one.line, "fx:FRAME-TRIGGERING", value, why);
      return false;
    };
    const model::GlobalParameters& g = out_.cluster.flexray;
    if (one.slot > g.gNumberOfStaticSlots + g.gNumberOfMinislots)
      return out(fmt::format("slot {}", one.slot), "is left out: it is beyond the static slots and the minislots");
    if (const auto allowed = frame_repetitions(g);
        std::find(allowed.begin(), allowed.end(), one.repetition) == allowed.end())
      return out(fmt::format("repetition {}", one.repetition),
                 fmt::format("is left out: it {}", repetitions_text(g, allowed)));
    const auto sender = senders_.find(one.id);
    if (sender == senders_.end()) return out(one.id, "is left out: no ECU sends it");
    if (!model::includes(ecus_[index_of(sender->second)]->parameters.pChannels, one.channel))
      return out(one.id, "is left out: its sender has no connector to its channel");
    return true;
  }

  void take_frames() {
    // Slot, base cycle, repetition, index of the frame in the file, sender -> channels, line of the first.
    using Key = std::tuple<int, int, int, std::ptrdiff_t, NodeId>;
    std::map<Key, std::pair<unsigned, int>> slots;
    for (const FibexTriggering& one : file_.triggerings) {
      const auto frame = frames_.find(one.frame);
      if (frame == frames_.end()) {
        fail(one.line, "fx:FRAME-TRIGGERING", one.frame, "must have a FRAME-REF to a frame of this file");
        continue;
      }
      if (!has_a_slot(one)) continue;
      auto& [channels, line] =
          slots[{one.slot, one.base_cycle, one.repetition, frame->second - file_.frames.data(), senders_.at(one.id)}];
      const unsigned channel = 1u << static_cast<unsigned>(one.channel);
      if ((channels & channel) != 0)
        leave_out(one.line, "fx:FRAME-TRIGGERING", one.id, "is left out: it repeats an earlier one");
      if (channels == 0) line = one.line;
      channels |= channel;
    }
    for (const auto& [key, found] : slots) {
      const auto& [slot, base_cycle, repetition, frame, sender] = key;
      model::FrameSlot out;
      out.slot = slot;
      out.channels = static_cast<model::Channels>(found.first);
      out.base_cycle = base_cycle;
      out.repetition = repetition;
      out.sender = sender;
      out.line = found.second;
      const FibexFrame& contents = file_.frames[static_cast<std::size_t>(frame)];
      std::string words = take_contents(contents, out);
      if (is_dynamic(out_.cluster.flexray, out)) take_dynamic(contents, out);
      out_.cluster.frames.push_back(out);
      out_.contents.push_back(std::move(words));
    }
    order_frames();
    take_receivers();
  }

  // The key orders by slot and base cycle; within one, channel A first.
  void order_frames() {
    std::vector<std::size_t> order(out_.cluster.frames.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto rank = [&](std::size_t i) {
      const model::FrameSlot& f = out_.cluster.frames[i];
      return std::tuple{f.slot, f.base_cycle, f.repetition, static_cast<int>(f.channels), i};
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    std::vector<model::FrameSlot> frames;
    std::vector<std::string> contents;
    for (const std::size_t i : order) {
      frames.push_back(out_.cluster.frames[i]);
      contents.push_back(out_.contents[i]);
    }
    out_.cluster.frames = std::move(frames);
    out_.contents = std::move(contents);
  }

  // A dynamic frame with a list is a fragment of it, and as long as that. Any other keeps its length.
  void take_dynamic(const FibexFrame& frame, model::FrameSlot& out) {
    if (out.pdu == kNoPdu) out.payload_bytes = frame.bytes;
    const int bytes = 2 * analysis::dynamic_words(out_.cluster, out);
    if (out.pdu != kNoPdu && frame.bytes != bytes)
      leave_out(frame.line, "fx:FRAME", fmt::format("{} bytes", frame.bytes),
                fmt::format("is left out: in the dynamic segment {} is as long as its fragment, {} bytes", frame.name,
                            bytes));
    if (frame.network_management)
      leave_out(frame.line, "ttf:NETWORK-MANAGEMENT", "true", "is left out: the vector is sent in the static segment");
  }

  // Sets the frame's part of a list; the returned text describes any other content.
  std::string take_contents(const FibexFrame& frame, model::FrameSlot& out) {
    std::string contents;
    const bool dynamic = is_dynamic(out_.cluster.flexray, out);
    out.network_management = frame.network_management && !dynamic;
    if (dynamic && frame.message_id) out.message_id = static_cast<std::uint16_t>(*frame.message_id);
    const int front = preamble_bytes(out_.cluster.flexray, out);
    if (!dynamic && frame.message_id)
      leave_out(frame.line, "ttf:MESSAGE-ID", std::to_string(*frame.message_id),
                "is left out: message ids are sent in the dynamic segment");
    if (!dynamic && frame.bytes > 2 * out_.cluster.flexray.gPayloadLengthStatic)
      fail(frame.line, "fx:FRAME", std::to_string(frame.bytes),
           fmt::format("must have a BYTE-LENGTH of at most {}, the static payload",
                       2 * out_.cluster.flexray.gPayloadLengthStatic));
    for (const FibexFrame::Place& place : frame.places) {
      const auto pdu = pdus_.find(place.pdu);
      if (pdu == pdus_.end()) {
        fail(frame.line, "fx:FRAME", place.pdu, "must have PDU-REFs to PDUs of this file");
        continue;
      }
      const auto list = lists_.find(place.pdu);
      if (list != lists_.end() && place.byte == front && frame.places.size() == 1)
        take_fragment(frame, list->second, out);
      else
        contents += fmt::format("{}{} at byte {}", contents.empty() ? "" : ", ", pdu->second->name, place.byte);
    }
    if (out.pdu == kNoPdu && !contents.empty()) contents = fmt::format("{} carries {}", frame.name, contents);
    return contents;
  }

  // Takes the number in our own extension, or counts in the order of the slots.
  void take_fragment(const FibexFrame& frame, PduId pdu, model::FrameSlot& out) {
    const int fragments = out_.cluster.pdu(pdu).max_fragments();
    out.pdu = pdu;
    out.fragment = frame.fragment.value_or(0);
    if (out.fragment >= fragments)
      fail(frame.line, "ttf:FRAGMENT", std::to_string(out.fragment), fmt::format("must be 0..{}", fragments - 1));
    if (frame.fragment || fragments == 1) return;
    int& next = next_fragment_[{index_of(pdu), index_of(out.sender), out.base_cycle, out.repetition}];
    out.fragment = next++ % fragments;
    leave_out(frame.line, "fx:FRAME", frame.name,
              fmt::format("does not say which fragment it carries; the order of slots makes it {}", out.fragment));
  }

  void take_receivers() {
    std::map<std::string, std::string> what;  // triggering -> frame or list
    for (const FibexTriggering& one : file_.triggerings) {
      const auto frame = frames_.find(one.frame);
      if (frame == frames_.end()) continue;
      const auto& places = frame->second->places;
      const auto pdu = places.size() == 1 ? pdus_.find(places[0].pdu) : pdus_.end();
      what[one.id] = pdu != pdus_.end() ? pdu->second->name : frame->second->name;
    }
    for (const FibexEcu* ecu : ecus_) {
      std::vector<std::string>& receives = out_.receives.emplace_back();
      for (const std::string& id : ecu->receives) {
        const auto found = what.find(id);
        if (found == what.end())
          fail(ecu->line, "fx:INPUT-PORT", id, "must have a FRAME-TRIGGERING-REF of this cluster");
        else if (std::find(receives.begin(), receives.end(), found->second) == receives.end())
          receives.push_back(found->second);
      }
    }
  }

  void complete_nodes() {
    for (std::size_t i = 0; i < ecus_.size(); ++i) {
      int first = 0;
      for (const model::FrameSlot& frame : out_.cluster.frames)
        if (index_of(frame.sender) == i && first == 0) first = frame.slot;
      model::Node& node = out_.cluster.nodes[i];
      node.flexray = assume_local(*ecus_[i], out_.cluster.flexray, first, out_.assumed);
      node.microtick_ps = node.flexray->pdMicrotick_ps;
      const int words = analysis::longest_dynamic_words(out_.cluster, static_cast<NodeId>(i));
      if (const auto most = ecus_[i]->max_dynamic_words; most && *most != words)
        leave_out(ecus_[i]->controller_line, "flexray:MAX-DYNAMIC-PAYLOAD-LENGTH", std::to_string(*most),
                  fmt::format("is left out: it is the length of {}'s longest dynamic frame, {}", node.name, words));
      check_derived(*ecus_[i], *node.flexray);
    }
  }

  // Checks further values of a controller that follow from the kept ones.
  void check_derived(const FibexEcu& ecu, const model::NodeParameters& p) {
    const auto other = [&](const char* key, int value, std::string what) {
      leave_out(ecu.controller_line, key, std::to_string(value), "is left out: " + std::move(what));
    };
    if (const int drift = p.pdListenTimeout / 2 - p.pMicroPerCycle; ecu.max_drift && *ecu.max_drift != drift)
      other("flexray:MAX-DRIFT", *ecu.max_drift, fmt::format("it is pdListenTimeout / 2 - pMicroPerCycle, {}", drift));
    const int macroticks = out_.cluster.flexray.gMacroPerCycle, least = p.pMicroPerCycle / macroticks;
    const int most = (p.pMicroPerCycle + macroticks - 1) / macroticks;
    if (ecu.micro_per_macro && (*ecu.micro_per_macro < least || *ecu.micro_per_macro > most))
      other("flexray:MICRO-PER-MACRO-NOM", *ecu.micro_per_macro,
            fmt::format("it is pMicroPerCycle / gMacroPerCycle, {}", least));
  }

  // Merges repeated findings: an unknown element often occurs a hundred times.
  void name_once() {
    std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known;
    std::vector<std::pair<Finding, int>> once;
    for (const Finding& finding : left_out_.list()) {
      const auto [at, fresh] = known.try_emplace({finding.key, finding.value, finding.expected}, once.size());
      if (fresh)
        once.emplace_back(finding, 1);
      else
        ++once[at->second].second;
    }
    for (auto& [finding, times] : once) {
      if (times > 1) finding.expected += fmt::format(" ({} times)", times);
      out_.left_out.push_back(std::move(finding));
    }
    std::stable_sort(out_.left_out.begin(), out_.left_out.end(),
                     [](const Finding& a, const Finding& b) { return a.line < b.line; });
  }

  FibexFile file_;
  std::string name_;
  Findings wrong_, left_out_;
  FibexImport out_;
  std::map<std::string, const FibexPdu*> pdus_;  // by id
  std::map<std::string, const FibexFrame*> frames_;
  std::map<std::string, PduId> lists_;     // by id
  std::map<std::string, NodeId> senders_;  // the triggerings', by id
  std::vector<const FibexEcu*> ecus_;      // the cluster's nodes
  std::map<std::tuple<std::size_t, std::size_t, int, int>, int> next_fragment_;
};

FibexImport import_from(const XmlFile& xml) {
  Findings wrong, left_out;
  check_references(xml, wrong);
  wrong.throw_if_any();  // later steps follow references without checks
  FibexFile file = read_fibex(xml, wrong, left_out);
  return Importer(std::move(file), xml.name(), std::move(wrong), std::move(left_out)).import();
}

}  // namespace

FibexImport import_fibex(const std::string& path) { return import_from(XmlFile::load(path)); }

FibexImport parse_fibex(std::string text, std::string name) {
  return import_from(XmlFile::parse(std::move(text), std::move(name)));
}

}  // namespace ttf::schedules::exchange::fibex
