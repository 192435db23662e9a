#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "cli/manual/outline.h"

namespace ttf::cli::manual {
namespace {

// Returns the text in single quotes; `escape` stands for a quote in it.
std::string quoted(std::string_view text, std::string_view escape) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += escape;
    else
      out += c == '\n' ? ' ' : c;
  }
  return out + "'";
}
std::string for_sh(std::string_view text) { return quoted(text, R"('\'')"); }
std::string for_fish(std::string_view text) { return quoted(text, R"(\')"); }

std::string last_word(const std::string& name) { return name.substr(name.rfind(' ') + 1); }

std::vector<std::string> command_names(const CommandOutline& program) {
  std::vector<std::string> names;
  for (const CommandOutline* command : all_of(program))
    if (!command->name.empty()) names.push_back(command->name);
  return names;
}

// Returns the words that an argument of the command may be, besides files.
std::vector<std::string> argument_words(const CommandOutline& command) {
  std::vector<std::string> words = command.shipped;
  for (const OptionOutline& argument : command.arguments)
    words.insert(words.end(), argument.choices.begin(), argument.choices.end());
  return words;
}

// The pattern of a `case` for the names of all commands: 'run'|'schedule'|'schedule check'.
std::string case_pattern(const CommandOutline& program) {
  std::vector<std::string> names;
  for (const std::string& name : command_names(program)) names.push_back(for_sh(name));
  return fmt::format("{}", fmt::join(names, "|"));
}

// Offers the words of the option that stands before the cursor, else files. `offer` has one {} for the words.
std::string values(const CommandOutline& command, std::string_view before, std::string_view offer,
                   std::string_view files) {
  std::string cases;
  for (const OptionOutline& option : command.options) {
    if (option.value.empty()) continue;
    const std::string words = fmt::format("{}", fmt::join(option.choices, " "));
    cases += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"),
                         words.empty() ? std::string(files) : fmt::format(fmt::runtime(offer), words));
  }
  return cases.empty() ? "" : fmt::format("      case {} in\n{}      esac\n", before, cases);
}

}  // namespace

std::string bash_completion(const CommandOutline& program) {
  std::string text = fmt::format(R"(# Completion of ttfusion for bash.
_ttfusion() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= word options= words= files=
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "${{command:+$command }}$word" in
      {}) command="${{command:+$command }}$word" ;;
    esac
  done
  case "$command" in
)",
                                 case_pattern(program));
  for (const CommandOutline* command : all_of(program)) {
    std::vector<std::string> options, words = argument_words(*command);
    for (const OptionOutline& option : command->options)
      options.insert(options.end(), option.names.begin(), option.names.end());
    for (const CommandOutline& inner : command->commands) words.push_back(last_word(inner.name));
    text += fmt::format("    {})\n{}      options={} words={} files={} ;;\n", for_sh(command->name),
                        values(*command, "\"$before\"", "COMPREPLY=($(compgen -W '{}' -- \"$current\"))",
                               "mapfile -t COMPREPLY < <(compgen -f -- \"$current\")"),
                        for_sh(fmt::format("{}", fmt::join(options, " "))),
                        for_sh(fmt::format("{}", fmt::join(words, " "))), command->commands.empty() ? "yes" : "");
  }
  return text + R"(  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    [[ -z $files ]] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -o filenames -F _ttfusion ttfusion
)";
}

std::string zsh_completion(const CommandOutline& program) {
  // _describe takes 'name:meaning', with a backslash before colons of the name.
  const auto described = [](const std::string& name, const std::string& meaning) {
    return for_sh(name + ":" + meaning);
  };
  std::string text = fmt::format(R"(#compdef ttfusion
# Completion of ttfusion for zsh.
_ttfusion() {{
  local command= word
  local -a flags names inner
  for word in ${{words[2,CURRENT-1]}}; do
    case "${{command:+$command }}$word" in
      {}) command="${{command:+$command }}$word" ;;
    esac
  done
  case "$command" in
)",
                                 case_pattern(program));
  for (const CommandOutline* command : all_of(program)) {
    text += fmt::format("    {})\n{}", for_sh(command->name),
                        values(*command, "\"${words[CURRENT-1]}\"", "compadd -- {}", "_files"));
    for (const OptionOutline& option : command->options)
      for (const std::string& name : option.names)
        text += fmt::format("      flags+=({})\n", described(name, option.meaning));
    for (const CommandOutline& inner : command->commands)
      text += fmt::format("      inner+=({})\n", described(last_word(inner.name), inner.about));
    text += fmt::format("      names=({}) ;;\n", fmt::join(argument_words(*command), " "));
  }
  return text + R"(  esac
  if [[ ${words[CURRENT]} == -* ]]; then
    _describe option flags
  elif (( $#inner )); then
    _describe command inner
  else
    (( $#names )) && compadd -- $names
    _files
  fi
}
_ttfusion "$@"
)";
}

std::string fish_completion(const CommandOutline& program) {
  std::vector<std::string> names;
  for (const std::string& name : command_names(program)) names.push_back(for_fish(name));
  std::string text = fmt::format(R"(# Completion of ttfusion for fish.
function __ttfusion_at --description 'whether the command line is at this command'
    set -l command
    for word in (commandline -opc)[2..-1]
        switch (string trim "$command $word")
            case {}
                set command (string trim "$command $word")
        end
    end
    test "$command" = "$argv"
end
)",
                                 fmt::join(names, " "));
  for (const CommandOutline* command : all_of(program)) {
    const std::string at = fmt::format("complete -c ttfusion -n {}", for_fish("__ttfusion_at " + command->name));
    for (const CommandOutline& inner : command->commands)
      text += fmt::format("{} -f -a {} -d {}\n", at, last_word(inner.name), for_fish(inner.about));
    if (const auto words = argument_words(*command); !words.empty())
      text += fmt::format("{} -a {}\n", at, for_fish(fmt::format("{}", fmt::join(words, " "))));
    for (const OptionOutline& option : command->options) {
      std::string line = at;
      for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!option.choices.empty())
        line += fmt::format(" -x -a {}", for_fish(fmt::format("{}", fmt::join(option.choices, " "))));
      else if (!option.value.empty())
        line += " -r";
      text += fmt::format("{} -d {}\n", line, for_fish(option.meaning));
    }
  }
  return text;
}

}  // namespace ttf::cli::manual
