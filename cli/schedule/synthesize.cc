#include <memory>
#include <string>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/schedule/packing/command.h"
#include "cli/schedule/planning/command.h"
#include "core/errors.h"

namespace ttf::cli::schedule {
namespace {

struct SynthesizeOptions {
  std::string plan;
  packing::PackingOptions packing;
  std::string out;
  std::string trade_off;
  bool binding = false;
  bool json = false;
};

int synthesize(const SynthesizeOptions& options) {
  if (!options.plan.empty())
    return planning::synthesize_plan(options.plan, {options.out, options.trade_off, options.binding, options.json});
  if (!options.packing.signals.empty()) return packing::pack_signals(options.packing, options.out, options.json);
  throw InputError({"command line", 0, "plan", "", "must name a plan, or --signals the signals to pack"});
}

}  // namespace

void add_synthesize(CLI::App& schedule, Action& action) {
  auto options = std::make_shared<SynthesizeOptions>();
  CLI::App* command = schedule.add_subcommand(
      "synthesize", "Choose the instants and slots that a plan leaves out, or pack signals into the fewest slots");
  command->footer(
      "Examples: ttfusion schedule synthesize schedules/plans/paper.yaml -o paper_planned.yaml\n"
      "          ttfusion schedule synthesize schedules/plans/paper_least_error.yaml -o out/least_error.yaml\n"
      "          ttfusion schedule synthesize schedules/plans/paper.yaml --binding --trade-off out/trade_off.svg\n"
      "          ttfusion schedule synthesize --signals examples/packing/signals.csv --payload 8byte -o packing.csv\n"
      "          ttfusion schedule synthesize --signals examples/packing/grown_signals.csv --fixed packing.csv "
      "--payload 8byte -o grown.csv\n"
      "          ttfusion schedule synthesize --signals examples/packing/variants.csv --payload 8byte "
      "--fibex bus.xml -o variants.csv\n"
      "          ttfusion schedule synthesize --signals examples/packing/variants.csv --payload 8byte "
      "--fixed bus_sport.xml --fixed bus_estate.xml --fixed bus_base.xml -o variants.csv");
  CLI::Option* plan =
      command->add_option("plan", options->plan, "Plan (docs/schedules/synthesis.md), or a shipped one's name")
          ->check(named());
  packing::add_packing_options(*command, options->packing);
  plan->excludes("--signals");
  command
      ->add_option(
          "-o,--out", options->out,
          "File to write: a cluster file, or CSV (docs/schedules/packing.md); without it, a plan's values are printed")
      ->check(named());
  command
      ->add_option("--trade-off", options->trade_off,
                   "Of a plan: what a smaller age costs, as a picture (.svg, .png, .pdf) or a table (.csv)")
      ->check(named())
      ->excludes("--signals");
  command->add_flag("--json", options->json, "Result as JSON on standard output");
  command->add_flag("--binding", options->binding, "Of a plan: prints what binds each chain, piece by piece")
      ->excludes("--signals", "--json");
  command->callback([options, &action] { action = [options] { return synthesize(*options); }; });
}

}  // namespace ttf::cli::schedule
