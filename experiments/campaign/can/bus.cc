#include "experiments/campaign/can/bus.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/errors.h"
#include "core/random.h"
#include "evaluation/faults/can_checks.h"
#include "experiments/campaign/can/draw.h"
#include "schedules/analysis/can_load.h"
#include "schedules/check/checker.h"
#include "sim/drives/drive.h"

namespace ttf::experiments::campaign::can {
namespace {

using evaluation::faults::CanCheck;

constexpr std::int64_t kFewestNodes = 3;  // a fault-free node needs another one

std::string_view short_name(CanCheck check) {
  switch (check) {
    case CanCheck::kAcknowledgement: return "ack";
    case CanCheck::kBusOff: return "bus off";
    case CanCheck::kBit:
    case CanCheck::kStuff:
    case CanCheck::kForm:
    case CanCheck::kCrc:
    case CanCheck::kForeign:
    case CanCheck::kTorn:
    case CanCheck::kPassive: return name_of(check);
  }
  return "";
}

Words words_of_a_can() {
  Words words;
  for (const CanCheck check : evaluation::faults::kAllCanChecks) {
    words.checks.push_back(name_of(check));
    words.check_columns.push_back(short_name(check));
  }
  for (const evaluation::faults::CanHarm harm : evaluation::faults::kAllCanHarms) words.harms.push_back(name_of(harm));
  words.trait = "automatic recovery";
  words.halt = "bus off";
  words.reintegrate = "recover";
  words.reintegrated = "recovered";
  words.frame_id = "identifier";
  words.unit_name = "ms";
  words.unit = Duration::milliseconds(1);
  return words;
}

schedules::model::Cluster checked_cluster(const CampaignFile& campaign) {
  schedules::model::Cluster cluster = read_cluster_of(campaign);
  if (auto wrong = schedules::check::check(cluster); !wrong.empty()) throw InputError(std::move(wrong));
  sim::drives::check_described(cluster);
  return cluster;
}

std::size_t find_bus(const CampaignFile& campaign, const schedules::model::Cluster& cluster) {
  const auto fail = [&](std::string expected) {
    throw InputError({campaign.file, campaign.can_line, "can", campaign.can, std::move(expected)});
  };
  std::string names;
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b) {
    const schedules::model::CanBus& bus = cluster.can_buses[b];
    names += (names.empty() ? ": " : ", ") + bus.name;
    if (bus.name != campaign.can) continue;
    const auto nodes = std::count_if(cluster.nodes.begin(), cluster.nodes.end(),
                                     [&](const schedules::model::Node& node) { return is_on_can(node, b); });
    if (nodes < kFewestNodes) fail(fmt::format("must have at least {} nodes: it has {}", kFewestNodes, nodes));
    for (const schedules::model::CanMessage& message : bus.messages)
      if (!schedules::analysis::can_worst_response(cluster, bus, message))
        fail(fmt::format("must have a worst-case response time for each message: {} has none",
                         cluster.pdu(message.pdu).name));
    return b;
  }
  fail(fmt::format("must be a CAN of {}{}", cluster.name, names));
  return 0;
}

}  // namespace

Bus::Bus(const CampaignFile& campaign)
    : campaign_(campaign), cluster_(checked_cluster(campaign)), bus_(find_bus(campaign, cluster_)),
      words_(words_of_a_can()) {}

DrawnFault Bus::draw(std::uint32_t index) const { return draw_fault(campaign_, cluster_, bus_, index); }

FaultOutcome Bus::run(std::size_t variant, const DrawnFault& drawn, std::uint32_t index, Story* story) const {
  return run_trial(setting(), campaign_.variants[variant], drawn, index, story);
}

bool Bus::has_trait(std::size_t variant) const {
  return campaign_.variants[variant].recovery == sim::medium::CanRecovery::kAutomatic;
}

bool Bus::is_harmless(std::size_t, const faults::Fault& fault) const {
  return std::find(campaign_.harmless.begin(), campaign_.harmless.end(), fault.kind) != campaign_.harmless.end();
}

std::optional<Expectation> Bus::expectation() const {
  if (campaign_.harmless.empty()) return std::nullopt;
  std::string kinds;
  for (const faults::FaultKind kind : campaign_.harmless)
    kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", faults::name_of(kind));
  return Expectation{"harmed_by_harmless", 0, fmt::format("no fault of {} does harm", kinds)};
}

}  // namespace ttf::experiments::campaign::can
