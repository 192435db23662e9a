#include "cli/schedule/synthesize.h"

#include <memory>
#include <string>

#include "cli/argument_checks.h"
#include "cli/schedule/packing/command.h"
#include "core/errors.h"

namespace ttf::cli::schedule {
namespace {

struct SynthesizeOptions {
  packing::PackingOptions packing;
  std::string out;
  bool json = false;
};

int synthesize(const SynthesizeOptions& options) {
  if (!options.packing.signals.empty()) return packing::pack_signals(options.packing, options.out, options.json);
  throw InputError({"command line", 0, "--signals", "", "must name the signals to pack"});
}

}  // namespace

void add_synthesize(CLI::App& schedule, Action& action) {
  auto options = std::make_shared<SynthesizeOptions>();
  CLI::App* command = schedule.add_subcommand("synthesize", "Pack signals into the fewest slots of the static segment");
  command->footer(
      "Examples: ttfusion schedule synthesize --signals examples/packing/signals.csv --payload 8byte -o packing.csv\n"
      "          ttfusion schedule synthesize --signals examples/packing/grown_signals.csv --fixed packing.csv "
      "--payload "
      "8byte -o grown.csv");
  packing::add_packing_options(*command, options->packing);
  command->add_option("-o,--out", options->out, "File to write: CSV (docs/packing.md)")->check(named());
  command->add_flag("--json", options->json, "Result as JSON on standard output");
  command->callback([options, &action] { action = [options] { return synthesize(*options); }; });
}

}  // namespace ttf::cli::schedule
