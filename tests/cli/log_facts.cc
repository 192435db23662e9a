// log_facts LOG...: prints facts for the scripts about one run's logs, merged as in every command.
// JSON:
//   clock                 of the merged records: "wall" or "common"; warnings: sentences
//   logs                  {name, host, whole: closed and sound}
//   states                {node, at_s, to, why}: changes of protocol operation control
//   corrections           {node, at_ns, global_ns, offset_microticks}: a clock's corrections, with its reading
//   features              at_s of each first use of an image that was not stale
//   last_s                by node, its last task's end
//   truths                the number of truth records
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recording/merge/merge.h"
#include "recording/records/records.h"

namespace {

using namespace ttf;

class Facts final : public recording::records::Sink {
 public:
  explicit Facts(const recording::log::LogManifest& manifest) : manifest_(manifest) {
    for (const char* list : {"states", "corrections", "features"}) json[list] = nlohmann::json::array();
    json["truths"] = 0;
    json["last_s"] = nlohmann::json::object();
  }

  using recording::records::Sink::on;
  void on(const recording::records::StateChanged& r) override {
    json["states"].push_back({{"node", name(r.stamp.node)},
                              {"at_s", seconds(r.stamp.true_time)},
                              {"to", std::string(r.to_name)},
                              {"why", std::string(r.why)}});
  }
  void on(const recording::records::ClockCorrected& r) override {
    json["corrections"].push_back({{"node", name(r.stamp.node)},
                                   {"at_ns", r.stamp.true_time.ns},
                                   {"global_ns", r.stamp.global.ns},
                                   {"offset_microticks", r.offset_microticks}});
  }
  void on(const recording::records::FeatureUsed& r) override {
    if (r.fresh && !r.stale) json["features"].push_back(seconds(r.stamp.true_time));
  }
  void on(const recording::records::TruthState&) override { json["truths"] = json["truths"].get<int>() + 1; }
  void on(const recording::records::TaskRun& r) override {
    auto& last = json["last_s"][name(r.start.node)];
    const double end = seconds(r.end.true_time);
    last = last.is_null() ? end : std::max(last.get<double>(), end);
  }

  nlohmann::json json;

 private:
  static double seconds(TrueTime at) { return static_cast<double>(at.ns) * 1e-9; }
  std::string name(NodeId node) const { return manifest_.node_names.at(index_of(node)); }

  const recording::log::LogManifest& manifest_;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const ttf::recording::merge::MergedLogs logs(std::vector<std::string>(argv + 1, argv + argc));
    Facts facts(logs.manifest());
    logs.read(facts);
    facts.json["clock"] = logs.manifest().clock;
    facts.json["warnings"] = logs.warnings();
    for (const ttf::recording::merge::StoredLog& log : logs.logs())
      facts.json["logs"].push_back({{"name", log.name()},
                                    {"host", log.info().manifest.host},
                                    {"whole", !log.info().truncated && log.info().warning.empty()}});
    fmt::print("{}\n", facts.json.dump());
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
