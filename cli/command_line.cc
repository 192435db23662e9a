#include "cli/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/counted.h"
#include "core/nearest.h"

namespace ttf::cli {
namespace {

Finding mistake(std::string argument, std::string value, std::string expected) {
  return {"command line", 0, std::move(argument), std::move(value), std::move(expected)};
}

std::string names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* one : commands) names.push_back(one->get_name());
  return joined(names, " or ");
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// Returns the innermost command that was parsed: "check" of "ttfusion schedule check".
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* in = &app;
  while (!in->get_subcommands().empty()) in = in->get_subcommands().front();
  return *in;
}

std::string full_name(const CLI::App& command) {
  const CLI::App* around = command.get_parent();
  return around == nullptr ? command.get_name() : full_name(*around) + " " + command.get_name();
}

Finding unknown_option(const CLI::App& command, const std::string& typed) {
  const std::string name = typed.substr(0, typed.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& one : option->get_lnames()) names.push_back(one);
    for (const std::string& one : option->get_snames()) names.push_back(one);
  }
  const auto bare = [](std::string_view text) {
    return text.substr(std::min(text.find_first_not_of('-'), text.size()));
  };
  const auto near = nearest(bare(name), names);
  const std::string is_none = fmt::format("is no option of `{}`", full_name(command));
  return mistake(name, "",
                 near ? fmt::format("{}: did you mean {}{}?", is_none, near->size() == 1 ? "-" : "--", *near)
                      : fmt::format("{}, whose --help lists them", is_none));
}

// Returns the first argument that no command on the way to `command` has; an option goes before other words.
std::optional<Finding> unknown_argument(const CLI::App& command) {
  for (const CLI::App* in = &command; in != nullptr; in = in->get_parent()) {
    std::vector<std::string> left = in->remaining();
    std::erase(left, "--");
    if (left.empty()) continue;
    const auto option = std::find_if(left.begin(), left.end(), [](const std::string& one) { return one[0] == '-'; });
    if (option != left.end()) return unknown_option(*in, *option);
    return mistake("", left.front(), fmt::format("is one argument too many for `{}`", full_name(*in)));
  }
  return std::nullopt;
}

std::optional<Finding> missing_argument(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_required() && option->count() == 0)
      return mistake(option->get_name(), "",
                     fmt::format("must be given to `{}`: {}", full_name(command), option->get_description()));
  if (command.get_require_subcommand_min() > 0 && command.get_subcommands().empty())
    return mistake("", full_name(command), fmt::format("must be followed by {}", names_of(commands_of(command))));
  return std::nullopt;
}

// Returns an option that needs another one, or excludes it.
std::optional<Finding> wrong_company(const CLI::App& command) {
  const auto options = command.get_options();
  for (const CLI::Option* option : options) {
    if (option->count() == 0) continue;
    const auto needs = option->get_needs(), excludes = option->get_excludes();
    for (const CLI::Option* other : options) {
      const auto is_other = [other](const CLI::Option* one) { return one == other; };
      if (other->count() == 0 && std::any_of(needs.begin(), needs.end(), is_other))
        return mistake(option->get_name(), "", fmt::format("goes with {} only", other->get_name()));
      if (other->count() > 0 && std::any_of(excludes.begin(), excludes.end(), is_other))
        return mistake(option->get_name(), "", fmt::format("must not be given with {}", other->get_name()));
    }
  }
  return std::nullopt;
}

// Returns the option of CLI11's text, "NAME: ..." or "Could not convert: NAME = ...", or null.
const CLI::Option* option_of(const CLI::App& command, const std::string& text) {
  for (const CLI::Option* option : command.get_options())
    if (text.starts_with(option->get_name() + ": ") ||
        text.starts_with("Could not convert: " + option->get_name() + " = "))
      return option;
  return nullptr;
}

// Returns a mistake for an option with no value, or with too many.
Finding wrong_count(const CLI::Option& option) {
  return option.results().size() > 1 ? mistake(option.get_name(), "", "must be given once")
                                     : mistake(option.get_name(), "", "must have a value: " + option.get_description());
}

// Returns a mistake in a value: CLI11's text is the option's name and the words of its check (cli/argument_checks.h).
Finding wrong_value(const CLI::Option& option, const std::string& text) {
  const auto& values = option.results();
  return mistake(option.get_name(), values.size() == 1 ? values.front() : "",
                 text.substr(option.get_name().size() + 2));
}

}  // namespace

std::optional<Finding> unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* in = &app;
  for (int i = 1; i < argc && in->get_require_subcommand_min() > 0; ++i) {
    const std::string name = argv[i];
    if (name.empty() || name.front() == '-') return std::nullopt;
    const auto commands = commands_of(*in);
    const auto command =
        std::find_if(commands.begin(), commands.end(), [&](const CLI::App* one) { return one->get_name() == name; });
    if (command == commands.end()) {
      std::vector<std::string> names;
      for (const CLI::App* one : commands) names.push_back(one->get_name());
      const auto near = nearest(name, names);
      return mistake("", name,
                     fmt::format("is no command of `{}`: {}", full_name(*in),
                                 near ? fmt::format("did you mean {}?", *near) : "must be " + names_of(commands)));
    }
    in = *command;
  }
  return std::nullopt;
}

Finding mistake_of(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  const std::string text = error.what();
  const CLI::Option* const option = option_of(command, text);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && option != nullptr) return wrong_count(*option);
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr && option != nullptr)
    return wrong_value(*option, text);
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr &&
      option != nullptr)  // a flag: others take any text
    return mistake(option->get_name(), option->results().front(), "must have no value");
  for (const auto& found : {unknown_argument(command), missing_argument(command), wrong_company(command)})
    if (found) return *found;
  return mistake("", "", text);
}

}  // namespace ttf::cli
