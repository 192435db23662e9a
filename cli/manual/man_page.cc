#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "cli/manual/outline.h"

namespace ttf::cli::manual {
namespace {

// Makes text safe for roff: a hyphen is a minus, as it is typed, and no line begins with a control character.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool begins_line = out.empty() || out.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '-')
      out += "\\-";
    else if (c == '\\')
      out += "\\e";
    else
      out += c;
  }
  return out;
}

std::string bold(std::string_view text) { return fmt::format("\\fB{}\\fR", roff(text)); }
std::string italic(std::string_view text) { return fmt::format("\\fI{}\\fR", roff(text)); }

std::string full_name(const CommandOutline& command) {
  return command.name.empty() ? "ttfusion" : "ttfusion " + command.name;
}

std::string page_name(const CommandOutline& command) {
  std::string name = full_name(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string value_of(const OptionOutline& option) {
  if (!option.choices.empty()) return bold(fmt::format("{}", fmt::join(option.choices, "|")));
  return italic(option.value);
}

std::string entry(const OptionOutline& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += (names.empty() ? "" : ", ") + (name.front() == '-' ? bold(name) : italic(name));
  const bool is_option = option.names.front().front() == '-';
  std::string value;
  if (is_option ? !option.value.empty() : !option.choices.empty()) value = (is_option ? " " : ": ") + value_of(option);
  return fmt::format(".TP\n{}{}\n{}\n", names, value, roff(option.meaning));
}

std::string synopsis(const CommandOutline& command) {
  std::string text = bold(full_name(command));
  if (!command.options.empty()) text += " [" + italic("OPTIONS") + "]";
  for (const OptionOutline& option : command.options)
    if (option.required) text += " " + bold(option.names.back()) + " " + value_of(option);
  if (!command.commands.empty()) text += " " + italic("COMMAND");
  for (const OptionOutline& argument : command.arguments) {
    const std::string name = italic(argument.names.front());
    text += " " + (argument.required ? name : "[" + name + "]") + (argument.many ? "..." : "");
  }
  return text + "\n";
}

std::string entries(const CommandOutline& command) {
  std::string text;
  for (const OptionOutline& argument : command.arguments) text += entry(argument);
  for (const OptionOutline& option : command.options) text += entry(option);
  return text;
}

// The remarks and examples, line by line as in --help.
std::string notes(const CommandOutline& command) {
  return command.notes.empty() ? "" : fmt::format(".PP\n.nf\n{}\n.fi\n", roff(command.notes));
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string man_page(const CommandOutline& command, const std::string& version) {
  std::string title = page_name(command);
  std::transform(title.begin(), title.end(), title.begin(), [](char c) { return c >= 'a' && c <= 'z' ? c - 32 : c; });
  const bool is_program = command.name.empty();
  std::string text = fmt::format(".TH {} 1 \"\" \"ttfusion {}\" \"ttfusion\"\n", title, version);
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(page_name(command)),
                      is_program ? "time\\-triggered distributed fusion" : roff(one_line(command.about)));
  text += ".SH SYNOPSIS\n" + synopsis(command);
  text += fmt::format(".SH DESCRIPTION\n{}\n", roff(command.about));
  text += ".SH OPTIONS\n" + entries(command) + notes(command);
  if (!command.commands.empty()) text += ".SH COMMANDS\n";
  for (const CommandOutline& inner : command.commands) {
    if (is_program)
      text += fmt::format(".TP\n{}(1)\n{}\n", bold(page_name(inner)), roff(inner.about));
    else
      text += fmt::format(".SS {}\n{}.PP\n{}\n{}{}", roff(full_name(inner)), synopsis(inner), roff(inner.about),
                          entries(inner), notes(inner));
  }
  text +=
      ".SH EXIT STATUS\n.TP\n0\nThe command did its work.\n.TP\n1\nThe command did nothing with its input, or a "
      "condition "
      "does not hold.\n.TP\n2\nThe input is bad: one sentence for each mistake names it.\n";
  if (command.name == "launch")
    text +=
        ".TP\n128 + n\nSignal n stopped the launch: 130 is Ctrl\\-C, 143 is SIGTERM. With \\-\\-duration 0 it is "
        "0.\n.TP\nany\nA required node failed, and this is the first one's code: 128 + n for signal n.\n";
  if (!is_program) text += ".SH SEE ALSO\n.BR ttfusion (1)\n";
  return text;
}

}  // namespace ttf::cli::manual
