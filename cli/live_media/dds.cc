// The live medium DDS.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bus/dds/live/listener.h"
#include "bus/dds/live/medium.h"
#include "bus/socketcan/interface.h"
#include "cli/live_media/dds_session.h"
#include "cli/live_media/live_media.h"
#include "cli/output.h"

namespace ttf::cli::live_media {
namespace {

using bus::dds::live::LiveLinePlan;

std::vector<supervision::PreflightItem> look_at_loopback(const std::vector<std::string>&,
                                                         const std::vector<PrivateCan>&) {
  const bus::socketcan::InterfaceState lo = bus::socketcan::interface_state("lo");
  if (!lo.there) return {{"lo", false, "is not there: DDS needs the loopback interface", {}}};
  if (!lo.up) return {{"lo", false, "is down: DDS needs the loopback interface", {"ip link set lo up"}}};
  return {{"lo", true, "is up: DDS runs over loopback", {}}};
}

bool is_on(const schedules::model::Cluster& cluster, NodeId node, schedules::model::Channel channel) {
  const auto& flexray = cluster.node(node).flexray;
  return flexray && includes(flexray->pChannels, channel);
}

// Returns the lines of a cluster, each with all its nodes.
std::vector<LiveLinePlan> lines_of(const schedules::model::Cluster& cluster) {
  std::vector<LiveLinePlan> lines;
  const auto add = [&](bus::ports::Line line, std::string topic, const auto& is_on_it) {
    LiveLinePlan plan{line, std::move(topic), {}, {}};
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
      if (is_on_it(static_cast<NodeId>(n))) plan.nodes.push_back(static_cast<NodeId>(n));
    lines.push_back(std::move(plan));
  };
  for (const schedules::model::Channel channel : schedules::model::kBothChannels)
    add(bus::ports::line_of(channel), bus::dds::live::live_topic(channel),
        [&](NodeId node) { return is_on(cluster, node, channel); });
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    add(bus::ports::line_of_can(b), bus::dds::live::live_can_topic(cluster.can_buses[b].name),
        [&](NodeId node) { return schedules::model::is_on_can(cluster.node(node), b); });
  return lines;
}

// Makes the medium; warns of nodes that are missing after the patience.
std::unique_ptr<bus::ports::LiveMedium> make_dds(const MediumSetting& setting) {
  const schedules::model::Cluster& cluster = setting.cluster;
  std::vector<LiveLinePlan> lines = lines_of(cluster);
  std::erase_if(lines, [&](const LiveLinePlan& line) { return std::ranges::count(line.nodes, setting.node) == 0; });
  for (LiveLinePlan& line : lines) line.not_awaited = setting.real_nodes;
  auto medium =
      std::make_unique<bus::dds::live::DdsMedium>(session_of(setting.session, cluster, false), setting.node, lines);
  try {
    if (setting.patience.count() > 0) medium->wait_ready(setting.patience);
  } catch (const bus::dds::common::NotReady& missing) {
    print_warnings(std::string("continues without the missing nodes: ") + missing.what());
  }
  return medium;
}

std::unique_ptr<bus::ports::Listener> listen_on_dds(const ListenerSetting& setting) {
  return std::make_unique<bus::dds::live::DdsListener>(session_of(setting.session, setting.cluster, false),
                                                       lines_of(setting.cluster), setting.identifiers);
}

// The fields are those of bus/dds/live/live_sample.idl.
Carriage carriage_on_dds(const schedules::model::Cluster& cluster, NodeId node, const std::string& session) {
  Carriage carriage;
  for (const LiveLinePlan& line : lines_of(cluster)) carriage.places.push_back(line.topic);
  carriage.properties = {{"domain", fmt::to_string(session_of(session, cluster, false).domain)},
                         {"partition", session},
                         {"type", "ttf::LiveSample, of bus/dds/live/live_sample.idl"},
                         {"readers", "best effort, volatile"},
                         {"writers", "best effort or reliable, volatile"}};
  const std::string sender = fmt::to_string(index_of(node));
  carriage.fields = {{"sender", "octet", sender, sender},
                     {"kind", "octet", fmt::to_string(static_cast<int>(bus::ports::Signal::kFrame)),
                      fmt::format("{} classic, {} FD", bus::dds::live::kClassicCan, bus::dds::live::kFastCan)},
                     {"tells_late", "octet", "1 if `late` is stated", "0"},
                     {"slot", "unsigned short", "the slot", "0"},
                     {"identifier", "unsigned long", "0", "the identifier"},
                     {"incarnation", "unsigned long long", "the same from start to end", "the same"},
                     {"number", "unsigned long long", "0, 1, 2... on each topic", "the same"},
                     {"host", "unsigned long long", "a number of its machine, not 0", "the same"},
                     {"sent", "long long", "now, by its clock [ns]", "the same"},
                     {"late", "long long", "`sent` less when it was due [ns]", "0"},
                     {"duration", "long long", "0", "0"},
                     {"bytes", "sequence<octet>", "header, payload, frame CRC", "the data"}};
  return carriage;
}

}  // namespace

const LiveMediumRow kDds{
    .name = "dds",
    .form = "dds",
    .form_help = "",
    .expectation = "dds",
    .not_in_virtual_time = "",
    .needs_dds = true,
    .look_at = look_at_loopback,
    .way_out = "",
    .make = make_dds,
    .listen = listen_on_dds,
    .carriage = carriage_on_dds,
};

}  // namespace ttf::cli::live_media
