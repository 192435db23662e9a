// The live medium DDS.
#include <utility>

#include "bus/dds/live/medium.h"
#include "bus/socketcan/interface.h"
#include "cli/live_media/dds_session.h"
#include "cli/live_media/live_media.h"
#include "cli/output.h"

namespace ttf::cli::live_media {
namespace {

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

// Makes the medium; warns of nodes that are missing after the patience.
std::unique_ptr<bus::ports::LiveMedium> make_dds(const MediumSetting& setting) {
  const schedules::model::Cluster& cluster = setting.cluster;
  std::vector<bus::dds::live::LiveLinePlan> lines;
  const auto add = [&](bus::ports::Line line, std::string topic, const auto& is_on_it) {
    bus::dds::live::LiveLinePlan plan{line, std::move(topic), {}};
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
      if (is_on_it(static_cast<NodeId>(n))) plan.nodes.push_back(static_cast<NodeId>(n));
    if (is_on_it(setting.node)) lines.push_back(std::move(plan));
  };
  for (const schedules::model::Channel channel : schedules::model::kBothChannels)
    add(bus::ports::line_of(channel), bus::dds::live::live_topic(channel),
        [&](NodeId node) { return is_on(cluster, node, channel); });
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    add(bus::ports::line_of_can(b), bus::dds::live::live_can_topic(cluster.can_buses[b].name),
        [&](NodeId node) { return schedules::model::is_on_can(cluster.node(node), b); });
  auto medium =
      std::make_unique<bus::dds::live::DdsMedium>(session_of(setting.session, cluster, false), setting.node, lines);
  try {
    if (setting.patience.count() > 0) medium->wait_ready(setting.patience);
  } catch (const bus::dds::common::NotReady& missing) {
    print_warnings(std::string("continues without the missing nodes: ") + missing.what());
  }
  return medium;
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
    .listen = nullptr,
};

}  // namespace ttf::cli::live_media
