#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cli/schedule/checks.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/time.h"
#include "schedules/analysis/can_load.h"

namespace ttf::cli::schedule {
namespace {

constexpr Duration kLeastApart = Duration::microseconds(1), kMostApart = Duration::milliseconds(1'000'000);

// A list on its CAN. A time without a value has no bound.
struct ListUnderErrors {
  std::string can, list;
  Duration period{};
  std::optional<Duration> without, with;
  bool in_time = false;  // the bus is free of it before the next list is queued
};

std::vector<ListUnderErrors> lists_under_errors(const schedules::model::Cluster& cluster, Duration apart) {
  using namespace schedules::analysis;
  std::vector<ListUnderErrors> lists;
  for (const schedules::model::CanBus& bus : cluster.can_buses)
    for (const schedules::model::CanMessage& message : bus.messages) {
      ListUnderErrors one{.can = bus.name,
                          .list = cluster.pdu(message.pdu).name,
                          .period = message.shortest_period,
                          .without = can_worst_response(cluster, bus, message),
                          .with = can_response_by_theory(cluster, bus, message, apart),
                          .in_time = false};
      one.in_time = one.with && *one.with + can_after_acceptance(bus) <= one.period;
      lists.push_back(one);
    }
  return lists;
}

Duration least_apart(const std::string& text) {
  const std::optional<Duration> apart = parse_duration(text);
  if (!apart || *apart < kLeastApart || *apart > kMostApart)
    throw InputError({"command line", 0, "--can-errors", text,
                      "must be the least time between two errors with its unit, as in 10ms: 1us..1000s"});
  return *apart;
}

std::string milliseconds_or_dash(std::optional<Duration> time) {
  return time ? fmt::format("{:.3f}", in_ms(*time)) : "-";
}

void print_can_json(const schedules::model::Cluster& cluster, Duration apart, const std::vector<ListUnderErrors>& lists,
                    bool holds) {
  const auto ms_or_null = [](std::optional<Duration> time) {
    return time ? nlohmann::ordered_json(in_ms(*time)) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{{"cluster", cluster.name},
                              {"errors_apart_ms", in_ms(apart)},
                              {"holds", holds},
                              {"lists", nlohmann::ordered_json::array()}};
  for (const ListUnderErrors& one : lists)
    json["lists"].push_back({{"can", one.can},
                             {"list", one.list},
                             {"shortest_period_ms", in_ms(one.period)},
                             {"without_errors_ms", ms_or_null(one.without)},
                             {"with_errors_ms", ms_or_null(one.with)},
                             {"in_time", one.in_time}});
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

int check_can_errors(const schedules::model::Cluster& cluster, const std::string& apart, bool json) {
  const Duration errors = least_apart(apart);
  const std::vector<ListUnderErrors> lists = lists_under_errors(cluster, errors);
  bool holds = true;
  for (const ListUnderErrors& one : lists) holds = holds && one.in_time;
  if (json) {
    print_can_json(cluster, errors, lists, holds);
    return holds ? 0 : 1;
  }
  fmt::print("{}: {} with errors on a CAN {} ms apart or more\n", cluster.name,
             lists.empty() ? "no list"
             : holds       ? "all lists are sent in time"
                           : "not all lists are sent in time",
             scaled_text(errors.ns, 1'000'000));
  if (lists.empty()) return 0;
  std::size_t list = 18, can = 22;  // at least
  for (const ListUnderErrors& one : lists) list = std::max(list, one.list.size()), can = std::max(can, one.can.size());
  fmt::print("{:<{}}  {:<{}}{:>18}{:>10}{:>10}\n", "list sent [ms]", list, "on", can, "every", "without", "with");
  for (const ListUnderErrors& one : lists)
    fmt::print("{:<{}}  {:<{}}{:>18.3f}{:>10}{:>10}{}\n", one.list, list, one.can, can, in_ms(one.period),
               milliseconds_or_dash(one.without), milliseconds_or_dash(one.with), one.in_time ? "" : "  late");
  return holds ? 0 : 1;
}

}  // namespace ttf::cli::schedule
