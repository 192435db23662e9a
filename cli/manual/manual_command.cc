#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/manual/outline.h"
#include "cli/output.h"

namespace ttf::cli::manual {
namespace {

// In the folders below a prefix's share/ where each of them is looked for.
int write_manual(const CLI::App& app, const std::string& out) {
  const CommandOutline program = outline_of(app);
  const auto put = [&](const std::string& folder, const std::string& name, const std::string& text) {
    create_folder(out + "/" + folder);
    write_file(fmt::format("{}/{}/{}", out, folder, name), text);
  };
  put("man/man1", "ttfusion.1", man_page(program, TTF_VERSION));
  for (const CommandOutline& command : program.commands)
    put("man/man1", fmt::format("ttfusion-{}.1", command.name), man_page(command, TTF_VERSION));
  put("bash-completion/completions", "ttfusion", bash_completion(program));
  put("zsh/site-functions", "_ttfusion", zsh_completion(program));
  put("fish/vendor_completions.d", "ttfusion.fish", fish_completion(program));
  say_written(out);
  return 0;
}

}  // namespace

void add_manual(CLI::App& app, Action& action) {
  auto out = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("manual", "Man pages of all commands, and completion for bash, zsh and fish");
  command->footer("Example: ttfusion manual -o out/share");
  command->add_option("-o,--out", *out, "Folder to write, like a prefix's share/")->required()->check(named());
  command->callback([out, &app, &action] { action = [out, &app] { return write_manual(app, *out); }; });
}

}  // namespace ttf::cli::manual
