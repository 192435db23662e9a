#include "schedules/dbc_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "core/check.h"
#include "core/errors.h"
#include "schedules/can_load.h"

namespace ttf::schedules {
namespace {

// A C identifier that none of `taken` is, as much like `name` as can be.
std::string identifier_like(std::string_view name, std::set<std::string>& taken) {
  std::string text;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (text.empty() && digit) text += '_';
    text += digit || letter ? c : '_';
  }
  if (text.empty()) text = "_";
  std::string unique = text;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}_{}", text, n);
  return unique;
}

// Strings have no escape in this format.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? '\'' : static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return out + '"';
}

class DbcWriter {
 public:
  DbcWriter(const Cluster& cluster, const std::string& can) : cluster_(cluster) {
    for (const CanBus& bus : cluster.can_buses)
      if (can.empty() || bus.name == can) buses_.push_back(&bus);
    if (buses_.empty()) refuse(can);
    for (const Node& node : cluster.nodes) nodes_.push_back(identifier_like(node.name, node_names_));
    std::set<std::uint32_t> identifiers;
    for (const CanBus* bus : buses_)
      for (const CanMessage& message : bus->messages) {
        if (!identifiers.insert(message.identifier).second)
          throw InputError(Finding{cluster.file, message.line, "identifier", fmt::format("{}", message.identifier),
                                   "is on two CANs, and a DBC file has one message per identifier: --can NAME writes "
                                   "one CAN"});
        messages_.push_back({bus, &message, identifier_like(cluster.pdu(message.pdu).name, message_names_)});
      }
  }

  std::string write() {
    text_ = fmt::format("VERSION {}\n\nNS_ :\n\nBS_:\n\nBU_:", quoted(cluster_.name));
    for (const std::string& node : nodes_) text_ += " " + node;
    text_ += "\n";
    for (const Message& message : messages_) put_message(message);
    text_ += "\n";
    for (const Message& message : messages_) put_comment(message);
    put_attributes();
    return std::move(text_);
  }

 private:
  struct Message {
    const CanBus* bus;
    const CanMessage* message;
    std::string name;
  };

  [[noreturn]] void refuse(const std::string& can) const {
    if (cluster_.can_buses.empty())
      throw InputError(Finding{cluster_.file, 0, "", "", "has no private CAN to write a DBC file of"});
    std::string names;
    for (const CanBus& bus : cluster_.can_buses) names += (names.empty() ? "" : ", ") + bus.name;
    throw InputError(Finding{cluster_.file, 0, "--can", can, "must be one of " + names});
  }

  std::string receivers(const Message& message) const {
    std::string text;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const std::vector<Task>& tasks = cluster_.nodes[n].tasks;
      const bool reads = std::any_of(tasks.begin(), tasks.end(), [&](const Task& task) {
        return std::any_of(task.reads.begin(), task.reads.end(), [&](const PortBinding& port) {
          return port.pdu == message.message->pdu && port.can_bus && &cluster_.can_buses[*port.can_bus] == message.bus;
        });
      });
      if (reads) text += (text.empty() ? "" : ",") + nodes_[n];
    }
    return text.empty() ? "Vector__XXX" : text;   // what the format calls nobody
  }

  // A big-endian signal is named by its most significant bit; bits count up from each byte's least significant one.
  void put_signal(const Signal& signal, int first_bit, const std::string& name, const std::string& receivers) {
    text_ += fmt::format(" SG_ {} : {}|{}@0+ ({},{}) [{}|{}] {} {}\n", name, first_bit / 8 * 8 + 7 - first_bit % 8,
                         signal.bits, signal.resolution, signal.low, signal.low, signal.high, quoted(signal.unit),
                         receivers);
  }

  void put_message(const Message& message) {
    const PduLayout& layout = cluster_.pdu(message.message->pdu);
    const auto length = can_data_length(message.bus->flexible_data_rate, layout.fragment_bytes);
    TTF_CHECK(length.has_value(), "{} bytes on {}", layout.fragment_bytes, message.bus->name);
    text_ += fmt::format("\nBO_ {} {}: {} {}\n", message.message->identifier, message.name, *length,
                         nodes_[index_of(message.message->sender)]);
    const std::string heard_by = receivers(message);
    std::set<std::string> names;
    for (const Signal& signal : layout.header)
      put_signal(signal, signal.bit_offset, identifier_like(signal.name, names), heard_by);
    for (int e = 0; e < layout.elements_per_fragment; ++e)
      for (const Signal& signal : layout.element)
        put_signal(signal, layout.header_bits + e * layout.element_bits + signal.bit_offset,
                   identifier_like(fmt::format("{}_{}", signal.name, e), names), heard_by);
  }

  void put_comment(const Message& message) {
    const PduLayout& layout = cluster_.pdu(message.message->pdu);
    const std::string elements =
        layout.max_fragments() == 1
            ? "One frame is a list: the elements below count are valid."
            : fmt::format("One frame is a fragment of a list of up to {} elements in {} fragments, which have one "
                          "sequence number; NAME_k is element {} * fragment + k of the list, valid if that is less "
                          "than count.",
                          layout.max_elements, layout.max_fragments(), layout.elements_per_fragment);
    text_ += fmt::format("CM_ BO_ {} {};\n", message.message->identifier,
                         quoted(fmt::format("{} Lists are queued at least {} ms apart.", elements,
                                            static_cast<double>(message.message->shortest_period.ns) / 1e6)));
  }

  void put_attributes() {
    text_ += "BA_DEF_ BO_ \"CAN\" STRING ;\n"
             "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"J1939PG\",\"reserved\","
             "\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\","
             "\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\n"
             "BA_DEF_DEF_ \"CAN\" \"\";\n"
             "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n";
    for (const Message& message : messages_) {
      text_ += fmt::format("BA_ \"CAN\" BO_ {} {};\n", message.message->identifier, quoted(message.bus->name));
      if (message.bus->flexible_data_rate)
        text_ += fmt::format("BA_ \"VFrameFormat\" BO_ {} 14;\n", message.message->identifier);
    }
  }

  const Cluster& cluster_;
  std::vector<const CanBus*> buses_;
  std::vector<std::string> nodes_;   // by node
  std::vector<Message> messages_;
  std::set<std::string> node_names_, message_names_;
  std::string text_;
};

}  // namespace

std::string dbc_text(const Cluster& cluster, const std::string& can) { return DbcWriter(cluster, can).write(); }

}  // namespace ttf::schedules
