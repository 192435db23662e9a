#include "schedules/exchange/fibex/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/decimal.h"
#include "schedules/exchange/fibex/parameters.h"

namespace ttf::schedules::exchange::fibex {
namespace {

constexpr std::size_t kLongestName = 128;  // for a SHORT-NAME

}  // namespace

std::string FibexReader::name_of(XmlElement& element) {
  const std::string id = element.attribute("ID");
  const std::string name = element.text_of("ho:SHORT-NAME").value_or(id);
  if (name.empty()) fail(element, "", "must have a SHORT-NAME");
  if (name.size() > kLongestName)
    fail(element, name, fmt::format("must have a name of at most {} bytes", kLongestName));
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20) {
      fail(element, name, "must have a printable name");
      break;
    }
  return name;
}

int FibexReader::integer(XmlElement& element, std::string_view name, int low, int high, std::optional<int> otherwise) {
  auto child = element.child(name);
  if (!child) {
    if (!otherwise) fail(element, "", fmt::format("must have a {}", name));
    return otherwise.value_or(low);
  }
  const std::string text = child->text();
  child->finish();
  const auto value = parse_scaled(text, 1);
  if (value && *value >= low && *value <= high) return static_cast<int>(*value);
  fail(*child, text, fmt::format("must be a whole number, {}..{}", low, high));
  return low;
}

bool FibexReader::boolean(XmlElement& element, std::string_view name, bool otherwise) {
  auto child = element.child(name);
  if (!child) return otherwise;
  const std::string text = child->text();
  child->finish();
  if (text == "true" || text == "1") return true;
  if (text != "false" && text != "0") fail(*child, text, "must be true or false");
  return false;
}

std::vector<double> FibexReader::numbers(XmlElement& element, std::string_view name) {
  std::vector<double> found;
  for (XmlElement& child : element.children(name)) {
    child.ignore("@INTERVAL-TYPE");  // all limits count as closed
    const std::string text = child.text();
    child.finish();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value))
      found.push_back(value);
    else
      fail(child, text, "must be a number");
  }
  return found;
}

std::optional<double> FibexReader::number(XmlElement& element, std::string_view name) {
  const std::vector<double> found = numbers(element, name);
  if (found.size() > 1) fail(element, "", fmt::format("must have one {}", name));
  return found.empty() ? std::nullopt : std::optional<double>(found.front());
}

bool FibexReader::is_flexray(XmlElement& element, std::string_view type, std::string_view witness) {
  const std::string given = element.attribute("xsi:type");
  return given.empty() ? element.has(witness) : given == fmt::format("flexray:{}", type);
}

void FibexReader::fail(const XmlElement& element, std::string value, std::string expected) {
  wrong_.add({file_, element.line(), element.path(), std::move(value), std::move(expected)});
}

void FibexReader::leave_out(const XmlElement& element, std::string value, std::string why) {
  left_out_.add({file_, element.line(), element.path(), std::move(value), std::move(why)});
}

namespace {

constexpr int kLastSlotId = 2047;  // cSlotIDMax
constexpr std::int64_t kPsPerUs = 1'000'000;

// Checks that the period is an eighth of gdBit (cSamplesPerBit), which is read or derived from the bit rate.
void read_sample_clock(XmlElement& cluster, const FibexFile& file, FibexReader& reader) {
  constexpr std::int64_t kShortest = 12'500, kLongest = 50'000;  // ps, gdSampleClockPeriod
  auto period = cluster.child("flexray:SAMPLE-CLOCK-PERIOD");
  if (!period) return;
  const std::string text = period->text();
  period->finish();
  const auto value = parse_scaled(text, kPsPerUs);
  if (!value || *value < kShortest || *value > kLongest)
    return reader.fail(*period, text, "must be 0.0125..0.05 us (gdSampleClockPeriod)");
  const bool has_bit = file.given.contains("gdBit"), has_rate = file.given.contains("baudrate");
  if (!has_bit && !has_rate) return;
  const std::int64_t bit = has_bit ? file.global.gdBit_ps : kPsPerUs * 1'000'000 / file.global.baudrate;
  if (*value != bit / 8)
    reader.leave_out(*period, text,
                     fmt::format("is left out: it is an eighth of the bit time, {}", scaled_text(bit / 8, kPsPerUs)));
}

void read_protocol(XmlElement& cluster, FibexReader& reader) {
  if (auto protocol = cluster.child("fx:PROTOCOL")) {
    const std::string text = protocol->text();
    protocol->finish();
    std::string capitals;
    for (const char c : text) capitals += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    if (capitals != "FLEXRAY") reader.fail(*protocol, text, "must be FlexRay");
  }
  if (auto version = cluster.child("fx:PROTOCOL-VERSION")) {
    const std::string text = version->text();
    version->finish();
    if (text.empty() || text[0] < '0' || text[0] > '9')
      reader.fail(*version, text, "must be a version of the protocol, such as 2.1");
    else if (text[0] != '2')
      reader.leave_out(*version, text, "is left out: the parameters are read as those of FlexRay 2.1");
  }
}

void read_cluster(XmlElement& cluster, FibexFile& out, FibexReader& reader) {
  static constexpr FibexParameter kSpeed[] = {{"baudrate", "fx:SPEED"}};
  out.cluster_name = reader.name_of(cluster);
  out.cluster_line = cluster.line();
  reader.parameters(cluster, kSpeed, out.global, out.given);
  reader.parameters(cluster, kFibexCluster, out.global, out.given);
  if (auto wake_up = cluster.child("flexray:WAKE-UP")) {
    reader.parameters(*wake_up, kFibexWakeUp, out.global, out.given);
    wake_up->finish();
  }
  if (auto extension = cluster.child("fx:MANUFACTURER-EXTENSION")) {
    reader.parameters(*extension, kFibexExtension, out.global, out.given);
    reader.parameters(*extension, kFibexRound, out.global, out.given);
    if (out.global.gCycleCountMax % 2 == 0)
      reader.fail(*extension, std::to_string(out.global.gCycleCountMax), "must have an odd CYCLE-COUNT-MAX");
    if (const auto topology = extension->text_of("ttf:TOPOLOGY")) {
      if (*topology != "star" && *topology != "bus")
        reader.fail(*extension, *topology, "must have a TOPOLOGY bus or star");
      out.topology = *topology == "star" ? model::Topology::kStar : model::Topology::kBus;
    }
    out.guardian = reader.boolean(*extension, "ttf:GUARDIAN", false);
    extension->finish();
  }
  read_sample_clock(cluster, out, reader);
  read_protocol(cluster, reader);
  for (XmlElement& one : cluster.children_of("fx:CHANNEL-REFS", "fx:CHANNEL-REF")) {
    out.channels.insert(one.attribute("ID-REF"));
    one.finish();
  }
  cluster.ignore("fx:MEDIUM");  // electrical or optical: its delays are separate parameters
  if (const auto policy = cluster.text_of("fx:BIT-COUNTING-POLICY"); policy && *policy != "SAWTOOTH")
    reader.fail(cluster, *policy, "must have the BIT-COUNTING-POLICY SAWTOOTH: no other is understood");
  if (!reader.boolean(cluster, "fx:IS-HIGH-LOW-BIT-ORDER", true))
    reader.fail(cluster, "false", "must have the IS-HIGH-LOW-BIT-ORDER true: no other is understood");
  cluster.finish();
}

// CYCLE-COUNTER names one cycle of the round; BASE-CYCLE and CYCLE-REPETITION a series.
void read_timing(XmlElement& timing, FibexTriggering& out, int cycles, FibexReader& reader) {
  out.slot = reader.integer(timing, "fx:SLOT-ID", 1, kLastSlotId);
  if (timing.has("fx:CYCLE-COUNTER")) {
    out.base_cycle = reader.integer(timing, "fx:CYCLE-COUNTER", 0, cycles - 1);
    out.repetition = cycles;
  } else {
    out.repetition = reader.integer(timing, "fx:CYCLE-REPETITION", 1, 64, 1);
    out.base_cycle = reader.integer(timing, "fx:BASE-CYCLE", 0, 63, 0);
    if (out.base_cycle >= out.repetition)
      reader.fail(timing, std::to_string(out.base_cycle),
                  fmt::format("must have a BASE-CYCLE below CYCLE-REPETITION, 0..{}", out.repetition - 1));
  }
  timing.finish();
}

// Returns channel A or B; nullopt if the file does not name it.
std::optional<model::Channel> read_channel(XmlElement& channel, FibexFile& out, FibexReader& reader) {
  const std::string name = channel.text_of("flexray:FLEXRAY-CHANNEL-NAME").value_or("");
  channel.ignore("ho:SHORT-NAME");
  if (name != "A" && name != "B") reader.fail(channel, name, "must have a FLEXRAY-CHANNEL-NAME, A or B");
  for (XmlElement& one : channel.children_of("fx:FRAME-TRIGGERINGS", "fx:FRAME-TRIGGERING")) {
    FibexTriggering triggering;
    triggering.id = one.attribute("ID");
    triggering.channel = name == "B" ? model::Channel::kB : model::Channel::kA;
    triggering.line = one.line();
    triggering.frame = one.reference("fx:FRAME-REF");
    auto timings = one.children_of("fx:TIMINGS", "fx:ABSOLUTELY-SCHEDULED-TIMING");
    one.finish();
    if (timings.empty()) reader.leave_out(one, triggering.id, "has no ABSOLUTELY-SCHEDULED-TIMING, and is left out");
    for (XmlElement& timing : timings) {
      read_timing(timing, triggering, cycles_per_round(out.global), reader);
      out.triggerings.push_back(triggering);
    }
  }
  channel.finish();
  if (name != "A" && name != "B") return std::nullopt;
  return name == "B" ? model::Channel::kB : model::Channel::kA;
}

bool is_understood(const std::string& version) {
  const bool digits =
      std::all_of(version.begin(), version.end(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
  return digits && version.size() > 1 && version[0] >= '2' && version[0] <= '4' && version[1] == '.';
}

// Reads the channels of the cluster and leaves out those of others.
ChannelIds read_channels(XmlElement& elements, FibexFile& out, FibexReader& reader) {
  ChannelIds channels;
  for (XmlElement& channel : elements.children_of("fx:CHANNELS", "fx:CHANNEL")) {
    const std::string id = channel.attribute("ID");
    if (!reader.is_flexray(channel, "CHANNEL-TYPE", "flexray:FLEXRAY-CHANNEL-NAME")) {
      reader.leave_out(channel, id, "is not a FlexRay channel, and is left out");
    } else if (!out.channels.empty() && !out.channels.contains(id)) {
      reader.leave_out(channel, id, "is not a channel of the first FlexRay cluster, and is left out");
    } else {
      const auto which = read_channel(channel, out, reader);
      if (!which) continue;
      for (const auto& [other, same] : channels)
        if (same == *which)
          reader.fail(channel, id,
                      fmt::format("must be the cluster's only channel {}; {} is one, too", letter(same), other));
      channels[id] = *which;
    }
  }
  return channels;
}

}  // namespace

FibexFile read_fibex(const XmlFile& file, Findings& wrong, Findings& left_out) {
  FibexFile out;
  FibexReader reader(file.name(), wrong, left_out);
  XmlElement root = file.root(left_out);
  if (root.name() != "fx:FIBEX") {
    reader.fail(root, "", "must be fx:FIBEX, the root of a FIBEX file");
    return out;
  }
  if (const std::string version = root.attribute("VERSION"); !version.empty() && !is_understood(version))
    reader.fail(root, version, "must have a VERSION 2.x, 3.x or 4.x: no other is understood");
  root.ignore("fx:PROJECT");
  auto elements = root.child("fx:ELEMENTS");
  if (!elements) {
    reader.fail(root, "", "must have fx:ELEMENTS");
    return out;
  }
  bool found = false;
  for (XmlElement& cluster : elements->children_of("fx:CLUSTERS", "fx:CLUSTER")) {
    if (found || !reader.is_flexray(cluster, "CLUSTER-TYPE", "flexray:MACRO-PER-CYCLE")) {
      reader.leave_out(cluster, cluster.attribute("ID"), "is not the first FlexRay cluster, and is left out");
      continue;
    }
    found = true;
    read_cluster(cluster, out, reader);
  }
  if (!found) reader.fail(*elements, "", "must have a cluster of xsi:type flexray:CLUSTER-TYPE");
  const ChannelIds channels = read_channels(*elements, out, reader);
  out.ecus = read_ecus(*elements, channels, reader);
  const auto codings = read_codings(root, *elements, reader);
  out.pdus = read_pdus(*elements, codings, reader);
  out.frames = read_frames(*elements, reader);
  elements->finish();
  root.finish();
  return out;
}

}  // namespace ttf::schedules::exchange::fibex
