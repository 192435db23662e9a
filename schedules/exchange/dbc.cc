#include "schedules/exchange/dbc.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "core/check.h"
#include "core/errors.h"
#include "schedules/analysis/can_load.h"
#include "schedules/model/sensor_lines.h"

namespace ttf::schedules::exchange {
namespace {

// Returns a C identifier as similar to `name` as possible that is not in `taken`.
std::string identifier_like(std::string_view name, std::set<std::string>& taken) {
  std::string text;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (text.empty() && digit) text += '_';
    text += digit || letter ? c : '_';
  }
  if (text.empty()) text += '_';
  std::string unique = text;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}_{}", text, n);
  return unique;
}

// Replaces quotes and control characters: strings have no escape in this format.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? '\'' : static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return out + '"';
}

// The content of identifier 0 on the interfaces of the FlexRay channels (docs/media/socketcan.md), by its first byte.
struct OnChannel {
  int kind;
  std::string_view name, unit;
  int byte, bytes;
  bool is_signed;
  std::int64_t low, high;
};
constexpr std::int64_t kCrc24 = 0xff'ffff, kAny32 = 0xffff'ffff, kSigned32 = 0x7fff'ffff;
constexpr OnChannel kOnChannel[] = {{1, "cas_duration", "ns", 1, 4, false, 0, kAny32},
                                    {1, "cas_crc", "", 5, 3, false, 0, kCrc24},
                                    {2, "wakeup_duration", "ns", 1, 4, false, 0, kAny32},
                                    {2, "wakeup_crc", "", 5, 3, false, 0, kCrc24},
                                    {3, "noise_duration", "ns", 1, 4, false, 0, kAny32},
                                    {3, "noise_crc", "", 5, 3, false, 0, kCrc24},
                                    {4, "slot", "", 1, 2, false, 1, 2047},
                                    {4, "cycle", "", 3, 1, false, 0, 63},
                                    {4, "late", "ns", 4, 4, true, -kSigned32 - 1, kSigned32},
                                    {4, "follow_up_crc", "", 8, 3, false, 0, kCrc24}};
constexpr int kOnChannelBytes = 12;

class DbcWriter {
 public:
  DbcWriter(const model::Cluster& cluster, const std::string& can) : cluster_(cluster) {
    for (const model::CanBus& bus : cluster.can_buses)
      if (can.empty() || bus.name == can) buses_.push_back(&bus);
    if (buses_.empty()) refuse(can);
    for (const model::Node& node : cluster.nodes) nodes_.push_back(identifier_like(node.name, node_names_));
    std::set<std::uint32_t> identifiers;
    for (const model::CanBus* bus : buses_)
      for (const model::CanMessage& message : bus->messages) {
        if (!identifiers.insert(message.identifier).second)
          throw InputError(
              cluster.finding(message.line, "identifier", fmt::format("{}", message.identifier),
                              "is on two CANs, and a DBC file has one message per identifier: --can NAME writes "
                              "one CAN"));
        messages_.push_back({bus, &message, identifier_like(cluster.pdu(message.pdu).name, message_names_)});
      }
    for (std::size_t s = 0; s < cluster.sensors.size(); ++s) add_lines(static_cast<SensorId>(s), identifiers);
    if (can.empty() && identifiers.count(0) == 0) channels_ = identifier_like("flexray_symbol", message_names_);
  }

  std::string write() {
    text_ = fmt::format("VERSION {}\n\nNS_ :\n\nBS_:\n\nBU_:", in_quotes(cluster_.name));
    for (const std::string& node : nodes_) text_ += " " + node;
    text_ += "\n";
    for (const Message& message : messages_) put_message(message);
    for (const Line& line : lines_) put_line(line);
    if (!channels_.empty()) put_channels();
    text_ += "\n";
    for (const Message& message : messages_) put_comment(message);
    for (const Line& line : lines_)
      text_ += fmt::format("CM_ BO_ {} {};\n", line.identifier,
                           in_quotes(line.strobe ? "In real time: the measurement is taken now."
                                                 : "In real time, where measurements are scheduled: measure now."));
    if (!channels_.empty())
      text_ +=
          "CM_ BO_ 0 \"On the interfaces of the FlexRay channels: a symbol (8 bytes), or how late the sync frame "
          "of a slot and cycle left.\";\n";
    put_attributes();
    if (!channels_.empty()) text_ += "VAL_ 0 kind 1 \"CAS\" 2 \"wakeup\" 3 \"noise\" 4 \"follow_up\" ;\n";
    return std::move(text_);
  }

 private:
  struct Message {
    const model::CanBus* bus;
    const model::CanMessage* message;
    std::string name;
  };

  struct Line {
    const model::CanBus* bus;
    SensorId sensor;
    bool strobe;
    std::uint32_t identifier;
    std::string name;
  };

  void add_lines(SensorId sensor, std::set<std::uint32_t>& identifiers) {
    const auto can = can_of_lines(cluster_, sensor);
    if (!can || std::find(buses_.begin(), buses_.end(), &cluster_.can_buses[*can]) == buses_.end()) return;
    const auto add = [&](bool strobe, std::uint32_t identifier, const char* what) {
      if (identifiers.insert(identifier).second)
        lines_.push_back({&cluster_.can_buses[*can], sensor, strobe, identifier,
                          identifier_like(cluster_.sensor(sensor).name + what, message_names_)});
    };
    add(true, model::strobe_identifier(sensor), "_strobe");
    add(false, model::trigger_identifier(sensor), "_trigger");
  }

  [[noreturn]] void refuse(const std::string& can) const {
    if (cluster_.can_buses.empty())
      throw InputError(Finding{cluster_.file, 0, "", "", "has no private CAN to write a DBC file of"});
    std::string names;
    for (const model::CanBus& bus : cluster_.can_buses) names += (names.empty() ? "" : ", ") + bus.name;
    throw InputError(Finding{cluster_.file, 0, "--can", can, "must be one of " + names});
  }

  std::string receivers(const Message& message) const {
    std::string text;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const std::vector<model::Task>& tasks = cluster_.nodes[n].tasks;
      const bool reads = std::any_of(tasks.begin(), tasks.end(), [&](const model::Task& task) {
        return std::any_of(task.reads.begin(), task.reads.end(), [&](const model::PortBinding& port) {
          return port.pdu == message.message->pdu && port.medium.is_can() && &cluster_.can(port.medium) == message.bus;
        });
      });
      if (reads) text += (text.empty() ? "" : ",") + nodes_[n];
    }
    return text.empty() ? "Vector__XXX" : text;  // the format's word for no receiver
  }

  // A big-endian signal stands at its most significant bit; bits count up from each byte's least significant
  // one.
  void put_signal(const model::Signal& signal, int first_bit, const std::string& name, const std::string& receivers) {
    text_ += fmt::format(" SG_ {} : {}|{}@0+ ({},{}) [{}|{}] {} {}\n", name, first_bit / 8 * 8 + 7 - first_bit % 8,
                         signal.bits, signal.resolution, signal.low, signal.low, signal.high, in_quotes(signal.unit),
                         receivers);
  }

  void put_message(const Message& message) {
    const model::PduLayout& layout = cluster_.pdu(message.message->pdu);
    const auto length = analysis::can_data_length(message.bus->flexible_data_rate, layout.fragment_bytes);
    TTF_CHECK(length.has_value(), "{} bytes on {}", layout.fragment_bytes, message.bus->name);
    text_ += fmt::format("\nBO_ {} {}: {} {}\n", message.message->identifier, message.name, *length,
                         nodes_[index_of(message.message->sender)]);
    const std::string received_by = receivers(message);
    std::set<std::string> names;
    for (const model::Signal& signal : layout.header)
      put_signal(signal, signal.bit_offset, identifier_like(signal.name, names), received_by);
    for (int e = 0; e < layout.elements_per_fragment; ++e)
      for (const model::Signal& signal : layout.element)
        put_signal(signal, layout.header_bits + e * layout.element_bits + signal.bit_offset,
                   identifier_like(fmt::format("{}_{}", signal.name, e), names), received_by);
  }

  void put_line(const Line& line) {
    const model::Sensor& sensor = cluster_.sensor(line.sensor);
    const std::string &device = nodes_[index_of(sensor.device)], &host = nodes_[index_of(sensor.host)];
    text_ += fmt::format("\nBO_ {} {}: {} {}\n", line.identifier, line.name, line.strobe ? model::kStrobeBytes : 0,
                         line.strobe ? device : host);
    if (line.strobe)
      text_ += fmt::format(" SG_ sequence : 7|{}@0+ (1,0) [0|{}] \"\" {}\n", 8 * model::kStrobeBytes, kAny32, host);
  }

  void put_channels() {
    text_ += fmt::format("\nBO_ 0 {}: {} Vector__XXX\n SG_ kind M : 7|8@0+ (1,0) [1|4] \"\" Vector__XXX\n", channels_,
                         kOnChannelBytes);
    for (const OnChannel& one : kOnChannel)
      text_ += fmt::format(" SG_ {} m{} : {}|{}@0{} (1,0) [{}|{}] \"{}\" Vector__XXX\n", one.name, one.kind,
                           8 * one.byte + 7, 8 * one.bytes, one.is_signed ? '-' : '+', one.low, one.high, one.unit);
  }

  void put_comment(const Message& message) {
    const model::PduLayout& layout = cluster_.pdu(message.message->pdu);
    const std::string elements =
        layout.max_fragments() == 1
            ? "One frame is a list: the elements below count are valid."
            : fmt::format(
                  "One frame is a fragment of a list of up to {} elements in {} fragments, which have one "
                  "sequence number; NAME_k is element {} * fragment + k of the list, valid if that is less "
                  "than count.",
                  layout.max_elements, layout.max_fragments(), layout.elements_per_fragment);
    text_ += fmt::format("CM_ BO_ {} {};\n", message.message->identifier,
                         in_quotes(fmt::format("{} Lists are queued at least {} ms apart.", elements,
                                               static_cast<double>(message.message->shortest_period.ns) / 1e6)));
  }

  void put_attributes() {
    text_ +=
        "BA_DEF_ BO_ \"CAN\" STRING ;\n"
        "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"J1939PG\",\"reserved\","
        "\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\","
        "\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\n"
        "BA_DEF_DEF_ \"CAN\" \"\";\n"
        "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n";
    for (const Message& message : messages_) {
      text_ += fmt::format("BA_ \"CAN\" BO_ {} {};\n", message.message->identifier, in_quotes(message.bus->name));
      if (message.bus->flexible_data_rate)
        text_ += fmt::format("BA_ \"VFrameFormat\" BO_ {} 14;\n", message.message->identifier);
    }
    for (const Line& line : lines_)
      text_ += fmt::format("BA_ \"CAN\" BO_ {} {};\n", line.identifier, in_quotes(line.bus->name));
    if (!channels_.empty()) text_ += "BA_ \"CAN\" BO_ 0 \"FlexRay\";\nBA_ \"VFrameFormat\" BO_ 0 14;\n";
  }

  const model::Cluster& cluster_;
  std::vector<const model::CanBus*> buses_;
  std::vector<std::string> nodes_;  // by node
  std::vector<Message> messages_;
  std::vector<Line> lines_;
  std::string channels_;  // the message of the FlexRay channels, or empty
  std::set<std::string> node_names_, message_names_;
  std::string text_;
};

}  // namespace

std::string dbc_text(const model::Cluster& cluster, const std::string& can) { return DbcWriter(cluster, can).write(); }

}  // namespace ttf::schedules::exchange
