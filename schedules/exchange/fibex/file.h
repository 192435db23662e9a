// The content of a FIBEX file about one FlexRay cluster, element by element, before
// schedules/exchange/fibex/import.h interprets it as slots and lists. References keep the ids of the file.
//
// Bit positions in a PDU follow FIBEX' SAWTOOTH policy: bit 0 is the least significant bit of byte 0, bit 8 of
// byte 1. A signal in high-low byte order stands at its most significant bit, one in low-high order at its least
// significant bit.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/errors.h"
#include "schedules/exchange/fibex/parameters.h"
#include "schedules/exchange/fibex/xml.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange::fibex {

// The meaning of a signal's raw number. `unlike` is the reason why our signals cannot express it, or empty.
struct FibexCoding {
  model::Signal meaning;  // without name: unit, bits, low, high, resolution
  std::string unlike;
};

struct FibexSignal {
  std::string name;
  model::Signal meaning;  // with the name
  std::string unlike;
  int position = 0;
  bool high_low = true;
  int line = 0;

  // Bits from the PDU's first bit (the most significant of byte 0) to the signal's most significant bit. Nullopt
  // for a low-high signal over more than one byte: it is not contiguous in that order.
  std::optional<int> offset() const;
};

struct FibexMultiplexer {
  int switch_position = 0, switch_bits = 0;
  bool switch_high_low = true;
  int dynamic_position = 0;                                   // its one segment's
  std::vector<std::pair<std::int64_t, std::string>> layouts;  // switch code, PDU
  std::string static_pdu;
  std::string unlike;  // parts that this struct cannot hold, or empty
};

struct FibexPdu {
  std::string id, name;
  int bytes = 0;
  std::vector<FibexSignal> signals;  // in the order of their bits if they have an offset
  std::optional<FibexMultiplexer> multiplexer;
  std::optional<int> max_elements;  // in our own extension
  int line = 0;
};

struct FibexFrame {
  struct Place {
    std::string pdu;
    int byte = 0;
  };
  std::string id, name;
  int bytes = 0;
  std::vector<Place> places;
  std::optional<int> fragment;  // these three are in our own extension
  bool network_management = false;
  std::optional<int> message_id = std::nullopt;
  int line = 0;
};

struct FibexTriggering {
  std::string id, frame;
  model::Channel channel = model::Channel::kA;
  int slot = 0, base_cycle = 0, repetition = 1;
  int line = 0;
};

struct FibexEcu {
  std::string name;
  model::NodeParameters parameters;
  std::set<std::string, std::less<>> given;  // names of parameters stated in the file
  bool has_controller = false;
  std::vector<std::string> sends, receives;  // ids of frame triggerings
  std::optional<int> max_dynamic_words;      // MAX-DYNAMIC-PAYLOAD-LENGTH
  std::optional<int> max_drift;              // MAX-DRIFT, microticks
  std::optional<int> micro_per_macro;        // MICRO-PER-MACRO-NOM
  int line = 0, controller_line = 0;
};

struct FibexFile {
  std::string cluster_name;
  model::Topology topology = model::Topology::kBus;  // these two are in our own extension
  bool guardian = false;
  model::GlobalParameters global;
  std::set<std::string, std::less<>> given;  // names of parameters stated in the file
  int cluster_line = 0;
  std::set<std::string> channels;  // ids of CHANNEL-REFS; empty: all FlexRay channels of the file are its own
  std::vector<FibexEcu> ecus;
  std::vector<FibexTriggering> triggerings;  // in the order of the file
  std::vector<FibexFrame> frames;
  std::vector<FibexPdu> pdus;
};

// Adds errors to `wrong` and unknown content to `left_out`.
FibexFile read_fibex(const XmlFile& file, Findings& wrong, Findings& left_out);

// The helpers shared by the parts of read_fibex (file.cc, ecus.cc, signals.cc).
class FibexReader {
 public:
  FibexReader(const std::string& file, Findings& wrong, Findings& left_out)
      : file_(file), wrong_(wrong), left_out_(left_out) {}

  // Returns SHORT-NAME, or the ID if that is absent. One of them must be present and printable.
  std::string name_of(XmlElement& element);
  // Returns a whole number in a child; `otherwise` for an absent child.
  int integer(XmlElement& element, std::string_view name, int low, int high, std::optional<int> otherwise = {});
  // Returns a boolean in a child: "true", "false", "1", "0"; `otherwise` for an absent child.
  bool boolean(XmlElement& element, std::string_view name, bool otherwise);
  // Return the numbers in all children of that name, or the number in the single one.
  std::vector<double> numbers(XmlElement& element, std::string_view name);
  std::optional<double> number(XmlElement& element, std::string_view name);

  // Decides by its xsi:type; without one, by an element that only FlexRay has.
  bool is_flexray(XmlElement& element, std::string_view type, std::string_view witness);
  // Sets the parameters with an element in the file.
  template <class Parameters, std::size_t kCount>
  void parameters(XmlElement& element, const FibexParameter (&table)[kCount], Parameters& parameters,
                  std::set<std::string, std::less<>>& given) {
    for (const FibexParameter& one : table) {
      auto child = element.child(one.element);
      if (!child) continue;
      const std::string text = child->text();
      child->finish();
      if (const auto expected = set_fibex_value(parameters, one.name, text))
        fail(*child, text, *expected + " (" + std::string(one.name) + ")");
      else
        given.insert(std::string(one.name));
    }
  }

  void fail(const XmlElement& element, std::string value, std::string expected);
  void leave_out(const XmlElement& element, std::string value, std::string why);

 private:
  const std::string& file_;
  Findings& wrong_;
  Findings& left_out_;
};

// Maps ids of elements to channels.
using ChannelIds = std::map<std::string, model::Channel>;

std::vector<FibexEcu> read_ecus(XmlElement& elements, const ChannelIds& channels, FibexReader& reader);
std::map<std::string, FibexCoding> read_codings(XmlElement& root, XmlElement& elements, FibexReader& reader);
std::vector<FibexPdu> read_pdus(XmlElement& elements, const std::map<std::string, FibexCoding>& codings,
                                FibexReader& reader);
std::vector<FibexFrame> read_frames(XmlElement& elements, FibexReader& reader);

}  // namespace ttf::schedules::exchange::fibex
