#include "tests/fuzz/fibex_laws.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/exchange/fibex/export.h"
#include "schedules/exchange/fibex/import.h"
#include "schedules/file/loader.h"
#include "tests/fuzz/harness.h"
#include "tests/schedules/exchange/fibex/fibex_compare.h"

namespace ttf::fuzz {
namespace {

using schedules::exchange::fibex::FibexDifference;
using schedules::exchange::fibex::FibexImport;
using schedules::model::Cluster;

constexpr char kFibexFile[] = "cluster.xml";

// Names that FIBEX keeps unchanged. XML has no control characters, and space around text means nothing there.
// A SHORT-NAME has at most 128 bytes, including a frame's, made of its list and slot.
bool is_fibex_name(const std::string& name) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  return !name.empty() && name.size() <= 90 && name.front() != ' ' && name.back() != ' ' &&
         std::none_of(name.begin(), name.end(), control);
}

bool has_fibex_names(const Cluster& cluster) {
  bool all = is_fibex_name(cluster.name);
  for (const schedules::model::Node& node : cluster.nodes) all = all && is_fibex_name(node.name);
  for (const schedules::model::PduLayout& pdu : cluster.pdus) {
    all = all && is_fibex_name(pdu.name) && pdu.max_fragments() <= 256;
    for (const auto* signals : {&pdu.header, &pdu.element})
      for (const schedules::model::Signal& signal : *signals)
        all = all && is_fibex_name(signal.name) && (signal.unit.empty() || is_fibex_name(signal.unit));
  }
  return all;
}

void check_same(const Cluster& a, const Cluster& b) {
  const std::string difference = FibexDifference::of(a, b);
  TTF_CHECK(difference.empty(), "{}", difference);
}

}  // namespace

void check_fibex_round_trip(const Cluster& cluster) {
  if (!has_fibex_names(cluster)) return;
  const FibexImport import =
      schedules::exchange::fibex::parse_fibex(schedules::exchange::fibex::fibex_text(cluster), kFibexFile);
  check_same(cluster, import.cluster);
  TTF_CHECK(import.left_out.empty() && import.assumed.empty() && import.foreign.empty(), "{} left out, {} assumed",
            import.left_out.size(), import.assumed.size());
}

void check_fibex(const std::string& text) {
  FibexImport import;
  if (!accepted(kFibexFile, [&] { import = schedules::exchange::fibex::parse_fibex(text, kFibexFile); })) return;
  if (!import.left_out.empty()) check_refusal(InputError(import.left_out), kFibexFile);
  const std::string yaml = schedules::exchange::fibex::skeleton_yaml(import);
  Cluster again;
  try {
    again = schedules::file::parse_cluster(yaml, "cluster.yaml");
  } catch (const InputError& error) {
    TTF_CHECK(false, "what was imported does not load: {}\n{}", error.what(), yaml);
  }
  check_same(import.cluster, again);
  if (has_fibex_names(again))
    check_same(
        again,
        schedules::exchange::fibex::parse_fibex(schedules::exchange::fibex::fibex_text(again), kFibexFile).cluster);
}

}  // namespace ttf::fuzz
