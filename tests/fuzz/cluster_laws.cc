#include "tests/fuzz/cluster_laws.h"

#include <cmath>
#include <memory>

#include "bus/wire/pdu_codec.h"
#include "core/check.h"
#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/exchange/cluster_text.h"
#include "schedules/file/loader.h"
#include "sim/drives/step_catalog.h"
#include "tests/fuzz/fibex_laws.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/nothing_there.h"

namespace ttf::fuzz {
namespace {

constexpr char kClusterFile[] = "cluster.yaml";

// Codes in use survive a journey through physical units.
void check_signals(const schedules::model::PduLayout& layout, const std::vector<schedules::model::Signal>& signals) {
  for (const schedules::model::Signal& signal : signals) {
    const std::uint32_t last = bus::wire::to_raw(signal, signal.high);
    for (const std::uint32_t raw : {0u, 1u, last / 3, last / 2, last - (last > 0 ? 1 : 0), last}) {
      const double physical = bus::wire::to_physical(signal, raw);
      TTF_CHECK(raw > last || bus::wire::to_raw(signal, physical) == raw, "{}.{}: {} is {} is {}", layout.name,
                signal.name, raw, physical, bus::wire::to_raw(signal, physical));
    }
  }
}

void check_ages(const schedules::model::Cluster& cluster) {
  for (const schedules::analysis::AgePath& age : schedules::analysis::measurement_ages(cluster))
    TTF_CHECK(Duration{} <= age.fusion_best && age.fusion_best <= age.fusion_worst &&
                  age.fused_best <= age.fused_worst && age.use_best <= age.use_worst &&
                  age.fusion_worst <= age.fused_worst,
              "fusion {}..{}, fused {}..{}, use {}..{} ns", age.fusion_best.ns, age.fusion_worst.ns, age.fused_best.ns,
              age.fused_worst.ns, age.use_best.ns, age.use_worst.ns);
  schedules::analysis::ages_text(cluster);
}

// The named time scale makes room for the arrival window, the next smaller one does not.
void check_time_scale(const schedules::model::Cluster& cluster) {
  if (!cluster.arrival_window) return;
  const auto window_fits = [&](std::int64_t time_scale) {
    for (const Finding& finding : schedules::check::check_real_time(cluster, time_scale))
      if (finding.key.starts_with("real_time")) return false;
    return true;
  };
  const std::int64_t smallest = schedules::check::smallest_time_scale(cluster, *cluster.arrival_window);
  TTF_CHECK(window_fits(smallest), "{} ppm", smallest);
  TTF_CHECK(smallest == schedules::check::kSmallestTimeScale || !window_fits(smallest - 1), "{} ppm", smallest);
}

recording::rows::RecordedInput some_recording() {
  return recording::rows::parse_laser_radar(
      "L\t10\t0\t1000\t10\t0\t1\t0\t0\t0\nR\t10\t0\t1\t51000\t10\t0\t1\t0\t0\t0\n", kClusterFile);
}

}  // namespace

void check_cluster(const std::string& text) {
  schedules::model::Cluster cluster;
  if (!accepted(kClusterFile, [&] { cluster = schedules::file::parse_cluster(text, kClusterFile); })) return;
  if (const auto findings = schedules::check::check(cluster); !findings.empty())
    return check_refusal(InputError(findings), kClusterFile);
  schedules::exchange::show_text(cluster);
  check_time_scale(cluster);
  if (!accepted(kClusterFile, [&] { schedules::model::bind_ports(cluster, sim::drives::step_ports()); })) return;
  for (const schedules::model::PduLayout& layout : cluster.pdus) {
    check_signals(layout, layout.header);
    check_signals(layout, layout.element);
  }
  check_ages(cluster);
  check_fibex_round_trip(cluster);
  sim::drives::Scenario scenario;
  scenario.duration = Duration::milliseconds(1'000);
  const auto rows = std::make_shared<const recording::rows::RecordedInput>(some_recording());
  for (std::size_t node = 0; node < cluster.nodes.size(); ++node)
    accepted(kClusterFile, [&] {
      sim::drives::make_steps(
          {&scenario, &cluster, fusion::strategies::StrategyKind::kAdva, 1, 0, nothing_there(), rows},
          static_cast<NodeId>(node));
    });
}

}  // namespace ttf::fuzz
