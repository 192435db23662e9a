#include "cli/manual/outline.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "cli/shipped.h"

namespace ttf::cli::manual {
namespace {

// The folders whose files a command takes by name, as it gives them to file_named().
std::vector<std::string_view> folders_of(std::string_view command) {
  if (command == "run") return {kScenarios};
  if (command == "launch" || command == "node") return {kScenarios, kSchedules};
  if (command == "experiment") return {kExperiments};
  if (command.starts_with("schedule ")) return {kSchedules};
  return {};
}

// Reads "{a,b,c}", which one_of() shows (cli/argument_checks.h).
std::vector<std::string> choices_of(std::string_view type) {
  std::vector<std::string> choices;
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == std::string_view::npos || close == std::string_view::npos) return choices;
  std::string_view words = type.substr(open + 1, close - open - 1);
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(','), words.size());
    choices.emplace_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return choices;
}

OptionOutline outline_of(const CLI::Option& option) {
  OptionOutline outline;
  for (const std::string& name : option.get_snames()) outline.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) outline.names.push_back("--" + name);
  if (option.get_positional()) outline.names.push_back(option.get_name());
  outline.meaning = option.get_description();
  outline.required = option.get_required();
  outline.many = option.get_items_expected_max() > 1;
  if (option.get_items_expected_max() == 0) return outline;
  const std::string type = option.get_type_name();
  outline.choices = choices_of(type);
  const std::size_t colon = type.find(':');  // "UINT:1..1024": the range says more
  outline.value = colon == std::string::npos ? type : type.substr(colon + 1);
  return outline;
}

CommandOutline outline_of(const CLI::App& app, const std::string& name) {
  CommandOutline outline;
  outline.name = name;
  outline.about = app.get_description();
  outline.notes = app.get_footer();
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())  // else it is there to be refused
      (option->get_positional() ? outline.arguments : outline.options).push_back(outline_of(*option));
  for (const std::string_view folder : folders_of(name))
    for (std::string& file : shipped_names(folder)) outline.shipped.push_back(std::move(file));
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    outline.commands.push_back(outline_of(*command, (name.empty() ? "" : name + " ") + command->get_name()));
  return outline;
}

void add_all(const CommandOutline& command, std::vector<const CommandOutline*>& all) {
  all.push_back(&command);
  for (const CommandOutline& inner : command.commands) add_all(inner, all);
}

}  // namespace

CommandOutline outline_of(const CLI::App& app) { return outline_of(app, ""); }

std::vector<const CommandOutline*> all_of(const CommandOutline& program) {
  std::vector<const CommandOutline*> all;
  add_all(program, all);
  return all;
}

}  // namespace ttf::cli::manual
