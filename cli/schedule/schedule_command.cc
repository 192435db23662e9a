#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/paper_size.h"
#include "cli/schedule/checks.h"
#include "cli/schedule/schedule_input.h"
#include "cli/shipped.h"
#include "core/errors.h"
#include "report/drawing/render.h"
#include "report/plots/schedule_picture.h"
#include "schedules/analysis/ages.h"
#include "schedules/analysis/chain/chains.h"
#include "schedules/analysis/dynamic_load.h"
#include "schedules/check/rules.h"
#include "schedules/exchange/cluster_text.h"
#include "schedules/exchange/cluster_yaml.h"
#include "schedules/exchange/dbc.h"
#include "schedules/exchange/fibex/export.h"
#include "schedules/exchange/fibex/import.h"
#include "schedules/file/loader.h"
#include "schedules/model/ports.h"
#include "schedules/modes/mode_text.h"
#include "schedules/modes/stated.h"
#include "sim/drives/scenario.h"
#include "sim/drives/step_catalog.h"

namespace ttf::cli::schedule {
namespace {

struct ScheduleOptions {
  std::string file;
  std::string out;
  std::string format;
  std::string can;
  std::string scenario;
  bool json = false;
  bool task_set = false;
  bool explicit_values = false;
  PaperSizeOptions paper;
  CaptureArguments capture;
  MediumArguments medium;
  std::optional<std::string> can_errors;
};

// Returns null for a time without a bound. A detector does not look at all pictures (schedules/analysis/ages.h), and
// frames of lower slots may keep a dynamic list waiting.
nlohmann::ordered_json known_ms(Duration time, bool known) {
  return known ? nlohmann::ordered_json(in_ms(time)) : nlohmann::ordered_json(nullptr);
}

// Returns null without frames in the dynamic segment.
nlohmann::ordered_json dynamic_json(const schedules::model::Cluster& cluster) {
  nlohmann::ordered_json json;
  for (const schedules::analysis::DynamicList& list : schedules::analysis::dynamic_lists(cluster))
    json["lists"].push_back(
        {{"pdu", list.pdu == kNoPdu ? "" : cluster.pdu(list.pdu).name},
         {"sender", cluster.node(list.sender).name},
         {"slots", {list.first_slot, list.last_slot}},
         {"channels", schedules::model::channels_text(list.channels)},
         {"minislots_each", list.minislots_each},
         {"turn", {list.earliest_turn, list.latest_turn}},
         {"always_in_time", list.always_in_time},
         {"sent_within_ms", known_ms(list.sent_within.value_or(Duration{}), list.sent_within.has_value())}});
  if (json.is_null()) return json;
  json["minislots"] = cluster.flexray.gNumberOfMinislots;
  for (const schedules::analysis::DynamicLoad& load : schedules::analysis::dynamic_load(cluster))
    json["worst_minislots"][load.channel == schedules::model::Channel::kA ? "A" : "B"] = load.minislots;
  return json;
}

// Prints a cluster's errors to standard output as well, for scripts.
void print_findings(const InputError& error) {
  nlohmann::ordered_json json{{"consistent", false}, {"findings", nlohmann::ordered_json::array()}};
  for (const Finding& finding : error.findings())
    json["findings"].push_back({{"file", finding.file},
                                {"line", finding.line},
                                {"key", finding.key},
                                {"value", finding.value},
                                {"expected", finding.expected},
                                {"text", finding.sentence()}});
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

// Reads a cluster file or a FIBEX file, and prints what was assumed or left out.
schedules::model::Cluster consistent_cluster(const std::string& file) {
  ScheduleInput input = checked_input(file);
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
  return std::move(input.cluster);
}

schedules::model::Cluster checked_schedule(const ScheduleOptions& options) {
  try {
    schedules::model::Cluster cluster = consistent_cluster(options.file);
    sim::drives::check_steps(cluster);
    return cluster;
  } catch (const InputError& error) {
    if (options.json) print_findings(error);
    throw;
  }
}

nlohmann::ordered_json contributions_json(const std::vector<schedules::analysis::Contribution>& parts) {
  nlohmann::ordered_json json;
  for (const schedules::analysis::Contribution& part : parts)
    json.push_back({{"name", part.name}, {"best_ms", in_ms(part.best)}, {"worst_ms", in_ms(part.worst)}});
  return json;
}

// Returns the dead time of the scenario's actuator; zero without a scenario.
Duration dead_time_in(const std::string& scenario) {
  if (scenario.empty()) return {};
  const sim::drives::Scenario read = sim::drives::load_scenario(file_named(scenario, {kScenarios}));
  if (!read.world.ego || !read.world.ego->actuator)
    throw InputError({"command line", 0, "--scenario", scenario, "must have a vehicle with world.ego.actuator"});
  return read.world.ego->actuator->dead_time;
}

nlohmann::ordered_json chain_json(const schedules::model::Cluster& cluster,
                                  const schedules::analysis::chain::Chain& chain, Duration dead_time) {
  const auto from_event = [&](Duration time) { return known_ms(time, chain.looks_at_all()); };
  nlohmann::ordered_json json{
      {"sensor", cluster.sensor(chain.sensor).name},
      {"chain", chain.name},
      {"exact", chain.exact},
      {"dead_time_ms", in_ms(dead_time)},
      {"reduced_reaction_time_ms",
       {in_ms(chain.reduced_reaction_best() + dead_time), in_ms(chain.reduced_reaction_worst() + dead_time)}},
      {"reaction_time_worst_ms", from_event(chain.reaction_worst() + dead_time)},
      {"reduced_data_age_worst_ms", from_event(chain.reduced_age_worst())},
      {"data_age_worst_ms", from_event(chain.age_worst())}};
  if (chain.fused) {
    json["held_reduced_reaction_time_worst_ms"] = in_ms(chain.reduced_reaction_worst(true) + dead_time);
    json["held_reaction_time_worst_ms"] = from_event(chain.reaction_worst(true) + dead_time);
    json["held_reduced_data_age_worst_ms"] = from_event(chain.reduced_age_worst(true));
  }
  json["contributions"] = contributions_json(chain.path.to_use);
  return json;
}

nlohmann::ordered_json modes_json(const schedules::model::Cluster& cluster,
                                  const schedules::modes::StatedModes& stated) {
  const auto& [detector, grid, modes] = stated;
  const auto ports = camera_ports(*detector.task);
  const std::string letters = schedules::modes::camera_letters(ports.size());
  nlohmann::ordered_json json{{"task", cluster.node(detector.node).name + "." + detector.task->name}};
  for (const schedules::modes::Mode& mode : modes)
    json["modes"].push_back({{"mode", mode.name},
                             {"sequence", schedules::sequence::letters(mode.sequence, letters)},
                             {"frame_ms", in_ms(mode.frame)},
                             {"frame_cycles", mode.cycles}});
  const std::vector<std::string> chains = schedules::modes::chain_names(cluster, detector);
  for (std::size_t c = 0; c < chains.size(); ++c) {
    nlohmann::ordered_json chain{{"chain", chains[c]}};
    for (const auto& row : schedules::modes::bounds_by_mode(cluster, {detector, grid, &modes, letters}, c))
      for (const schedules::modes::CameraBound& camera : row.cameras)
        chain["bounds"].push_back({{"mode", row.name},
                                   {"camera", ports[static_cast<std::size_t>(camera.sensor)]->port},
                                   {"reduced_reaction_time_ms", {in_ms(camera.least), in_ms(camera.most)}},
                                   {"reaction_time_in_region_ms", in_ms(camera.reaction_in_region)},
                                   {"reaction_time_ms", in_ms(camera.reaction)}});
    json["chains"].push_back(std::move(chain));
  }
  return json;
}

int check_tasks(const ScheduleOptions& options) {
  try {
    return check_task_set(options.file, options.json);
  } catch (const InputError& error) {
    if (options.json) print_findings(error);
    throw;
  }
}

int check(const ScheduleOptions& options) {
  if (options.task_set) return check_tasks(options);
  const schedules::model::Cluster cluster = checked_schedule(options);
  if (!options.capture.file.empty()) return check_against_capture(cluster, options.capture, options.json);
  if (options.medium.medium) return check_on_medium(cluster, options.medium, options.json);
  if (options.can_errors) return check_can_errors(cluster, *options.can_errors, options.json);
  const Duration dead_time = dead_time_in(options.scenario);
  if (!options.json) {
    fmt::print("{}: consistent\n{}{}{}{}", cluster.name, schedules::analysis::dynamic_text(cluster),
               schedules::analysis::ages_text(cluster), schedules::analysis::chain::chains_text(cluster, dead_time),
               schedules::modes::stated_text(cluster));
    if (const std::string skipped = schedules::check::skipped_text(cluster); !skipped.empty())
      fmt::print("{}; measurements have no ages\n", skipped);
    return 0;
  }
  nlohmann::ordered_json json;
  json["cluster"] = cluster.name;
  json["consistent"] = true;
  json["describes_tasks"] = cluster.describes_tasks();
  for (const schedules::check::ClusterRule& rule : schedules::check::rules())
    if (is_skipped(rule, cluster)) json["not_checked"].push_back(rule.name);
  if (auto dynamic = dynamic_json(cluster); !dynamic.is_null()) json["dynamic_segment"] = std::move(dynamic);
  for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(cluster)) {
    nlohmann::ordered_json one{{"sensor", cluster.sensor(path.sensor).name},
                               {"available_ms", {in_ms(path.fusion_best), in_ms(path.fusion_worst)}},
                               {"fused_ms", {in_ms(path.fused_best), in_ms(path.fused_worst)}},
                               {"first_use_ms", {in_ms(path.use_best), in_ms(path.use_worst)}},
                               {"newest_at_any_use_worst_ms", known_ms(path.newest_worst, !path.chosen)},
                               {"buffered_use_worst_ms", in_ms(path.buffered_use_worst)}};
    if (auto parts = contributions_json(path.to_use); !parts.is_null()) one["contributions"] = std::move(parts);
    json["ages"].push_back(std::move(one));
  }
  for (const schedules::analysis::AgePath& path : schedules::analysis::odometry_ages(cluster))
    json["odometry_ages"].push_back({{"sensor", cluster.sensor(path.sensor).name},
                                     {"available_ms", {in_ms(path.fusion_best), in_ms(path.fusion_worst)}},
                                     {"read_ms", {in_ms(path.fused_best), in_ms(path.fused_worst)}},
                                     {"contributions", contributions_json(path.to_fusion)}});
  for (const schedules::analysis::chain::Chain& chain : schedules::analysis::chain::chains(cluster))
    json["chains"].push_back(chain_json(cluster, chain, dead_time));
  for (const schedules::modes::StatedModes& stated : schedules::modes::stated_modes(cluster))
    json["modes"].push_back(modes_json(cluster, stated));
  fmt::print("{}\n", json.dump(2));
  return 0;
}

void write_text(const std::string& text, const std::string& path) {
  if (path.empty()) {
    fmt::print("{}", text);
    return;
  }
  write_file(path, text);
  say_written(path);
}

// Writes the whole cluster file, its inherited and derived values included.
void write_whole(const ScheduleOptions& options) {
  const std::string name = std::filesystem::path(options.file).filename().string();
  write_text(schedules::exchange::cluster_yaml(consistent_cluster(options.file),
                                               fmt::format("{} with all that it inherits and derives.", name)),
             options.out);
}

int show(const ScheduleOptions& options) {
  if (options.explicit_values) {
    if (!is_cluster_file(options.file))
      throw InputError({"command line", 0, "--explicit", options.file, "goes with a cluster file only"});
    if (!options.out.empty()) refuse_overwriting(options.file, options.out, "--out");
    if (!options.out.empty() && !options.out.ends_with(".yaml") && !options.out.ends_with(".yml"))
      throw InputError({"command line", 0, "--out", options.out, "must end in .yaml or .yml with --explicit"});
    write_whole(options);
    return 0;
  }
  if (!options.out.empty()) report::drawing::check_picture_path(options.out);
  const report::drawing::Sheet sheet = sheet_of(options.paper);
  if (options.paper.width && options.out.empty())
    throw InputError({"command line", 0, "--width", *options.paper.width, "goes with --out only"});
  const schedules::model::Cluster cluster = consistent_cluster(options.file);
  if (options.out.empty()) {
    fmt::print("{}", schedules::exchange::show_text(cluster));
    return 0;
  }
  report::drawing::write_picture(report::plots::schedule_svg(cluster, sheet), options.out);
  say_written(options.out);
  return 0;
}

int export_cluster(const ScheduleOptions& options) {
  if (!options.out.empty()) refuse_overwriting(options.file, options.out, "--out");
  refuse_other_format(options.out, options.format,
                      {{"fibex", {".xml", ".fibex"}}, {"dbc", {".dbc"}}, {"yaml", {".yaml", ".yml"}}});
  if (!options.can.empty() && options.format != "dbc")
    throw InputError(Finding{"command line", 0, "--can", options.can, "goes with --format dbc only"});
  if (options.format == "dbc") {
    write_text(schedules::exchange::dbc_text(consistent_cluster(options.file), options.can), options.out);
    return 0;
  }
  if (options.format == "fibex") {
    const schedules::model::Cluster cluster = consistent_cluster(options.file);
    if (const std::string note = without_tasks(cluster, "the file says of no node what it receives"); !note.empty())
      fmt::print(stderr, "note: {}\n", note);
    write_text(schedules::exchange::fibex::fibex_text(cluster), options.out);
    return 0;
  }
  if (is_cluster_file(options.file)) {
    write_whole(options);
    return 0;
  }
  const schedules::exchange::fibex::FibexImport import = fibex_input(options.file);
  for (const Finding& finding : import.left_out) fmt::print(stderr, "note: {}\n", finding.sentence());
  const std::string yaml = schedules::exchange::fibex::skeleton_yaml(import);
  schedules::file::parse_cluster(
      yaml,
      options.out.empty() ? "cluster.yaml" : options.out);  // checks that the output can be read back
  write_text(yaml, options.out);
  return 0;
}

void call_on_file(CLI::App& command, const std::shared_ptr<ScheduleOptions>& options, Action& action,
                  int (*run)(const ScheduleOptions&)) {
  command.callback([options, &action, run] {
    action = [options, run] {
      options->file = file_named(options->file, {kSchedules});
      return run(*options);
    };
  });
}

}  // namespace

void add_schedule(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("schedule", "Validate, draw and exchange schedules");
  command->require_subcommand(1);
  auto options = std::make_shared<ScheduleOptions>();
  CLI::App* checking =
      command->add_subcommand("check", "Prove a cluster consistent; bound its measurements' ages and its chains");
  checking->footer(
      "Examples: ttfusion schedule check schedules/paper_synchronised.yaml\n"
      "          ttfusion schedule check schedules/paper_synchronised.yaml --against out/drive.pcapng\n"
      "          ttfusion schedule check closed_loop_synchronised --scenario acc_braking_lead\n"
      "          ttfusion schedule check schedules/paper_synchronised.yaml --medium can-fd:1M/5M --time-scale 3\n"
      "          ttfusion schedule check moving_synchronised --can-errors 10ms\n"
      "          ttfusion schedule check --task-set schedules/task_sets/braking.csv");
  checking
      ->add_option("file", options->file,
                   "Cluster file or FIBEX file, or a shipped cluster's name; with --task-set a CSV file")
      ->required();
  checking->add_flag("--json", options->json, "Result as JSON on standard output");
  checking
      ->add_option("--scenario", options->scenario,
                   "Scenario whose actuator's dead time ends the chains to an actuator")
      ->check(named());
  add_capture_arguments(*checking, options->capture);
  add_medium_arguments(*checking, options->medium);
  checking->get_option("--medium")->excludes("--against");
  for (const char* other : {"--medium", "--against"}) checking->get_option("--scenario")->excludes(other);
  checking
      ->add_flag("--task-set", options->task_set,
                 "The file has bare tasks, messages and chains: their responses, reaction times and data ages")
      ->excludes("--medium", "--against", "--scenario");
  checking
      ->add_option(
          "--can-errors", options->can_errors,
          "Least time between two errors on a CAN, as in 10ms: how long lists take on the CANs, and whether they "
          "are sent in time")
      ->excludes("--medium", "--against", "--scenario", "--task-set");
  checking->callback([options, &action] {
    action = [options] {
      options->file = file_named(options->file, {options->task_set ? kTaskSets : kSchedules});
      return check(*options);
    };
  });
  CLI::App* showing = command->add_subcommand("show", "Draw one communication cycle as text, or as a picture with -o");
  showing->footer(
      "Examples: ttfusion schedule show schedules/paper_synchronised.yaml -o schedule.svg\n"
      "          ttfusion schedule show paper_fitted --explicit -o whole.yaml");
  showing->add_option("file", options->file, "Cluster file or FIBEX file, or a shipped cluster's name")->required();
  showing->add_option("-o,--out", options->out, "Picture to write: .svg, .png or .pdf; with --explicit a .yaml")
      ->check(named());
  showing->add_flag("--explicit", options->explicit_values,
                    "In place of the drawing a whole cluster file: all that this one inherits and derives");
  add_paper_size(*showing, options->paper);
  call_on_file(*showing, options, action, show);
  CLI::App* exporting =
      command->add_subcommand("export",
                              "Write a cluster as FIBEX 3.1, its CANs as DBC, itself with all that it "
                              "inherits and derives, or a FIBEX file's FlexRay cluster as the "
                              "beginning of a cluster file");
  exporting->footer(
      "Examples: ttfusion schedule export schedules/paper_synchronised.yaml --format fibex -o cluster.xml\n"
      "          ttfusion schedule export schedules/paper_synchronised.yaml --format dbc -o cluster.dbc\n"
      "          ttfusion schedule export schedules/paper_unsynchronised.yaml --format yaml -o whole.yaml\n"
      "          ttfusion schedule export cluster.xml --format yaml -o cluster.yaml");
  exporting->add_option("file", options->file, "Cluster file or a shipped one's name, or FIBEX file (yaml, fibex)")
      ->required();
  exporting->add_option("--format", options->format, "fibex; dbc: from a cluster file; yaml: a whole cluster file")
      ->required()
      ->check(one_of({"fibex", "dbc", "yaml"}));
  exporting->add_option("--can", options->can, "dbc: only this CAN of the cluster");
  exporting->add_option("-o,--out", options->out, "File to write; else standard output")->check(named());
  call_on_file(*exporting, options, action, export_cluster);
  add_sequence(*command, action);
  add_synthesize(*command, action);
}

}  // namespace ttf::cli::schedule
