#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/summary.h"
#include "cli/output.h"
#include "core/errors.h"
#include "keys/documents.h"
#include "keys/explore.h"
#include "keys/outline.h"
#include "keys/render.h"
#include "keys/summary/summary.h"

namespace ttf::cli::keys {
namespace {

using ttf::keys::Document;
using ttf::keys::Page;

struct KeysOptions {
  std::string kind;
  std::string format = "text";
  std::string out;
};

std::vector<Page> pages_of(const Document& document, const std::string& format) {
  const ttf::keys::Outline outline = ttf::keys::outline(ttf::keys::explore(document.load));
  if (format == "markdown") return ttf::keys::markdown_pages(document, outline);
  if (format == "json-schema") return {{ttf::keys::schema_file(document), ttf::keys::json_schema(document, outline)}};
  return {{document.kind + ".txt", ttf::keys::text_of(document, outline)}};
}

std::vector<Page> pages_of_summary(const std::string& format) {
  const std::vector<ttf::keys::summary::Member> members = drive::summary_members();
  if (format == "markdown") return ttf::keys::summary::pages(members);
  if (format == "json-schema") return {ttf::keys::summary::schema(members)};
  return {{fmt::format("{}.txt", ttf::keys::summary::kKind), ttf::keys::summary::text(members)}};
}

int print_keys(const KeysOptions& options) {
  if (options.out.empty() && options.kind.empty() && options.format == "json-schema")
    throw InputError({"command line", 0, "--format", options.format, "goes with one kind of file, or with --out"});
  std::vector<Page> pages;
  for (const Document& document : ttf::keys::documents())
    if (options.kind.empty() || options.kind == document.kind)
      for (Page& page : pages_of(document, options.format)) pages.push_back(std::move(page));
  if (options.kind.empty() || options.kind == ttf::keys::summary::kKind)
    for (Page& page : pages_of_summary(options.format)) pages.push_back(std::move(page));
  const bool one_file = !options.kind.empty() && options.format != "markdown";
  if (!options.out.empty() && !one_file) create_folder(options.out);
  for (const Page& page : pages)
    if (options.out.empty())
      fmt::print("{}", page.text);
    else
      write_file(one_file ? options.out : (std::filesystem::path(options.out) / page.file).string(), page.text);
  if (!options.out.empty()) say_written(options.out);
  return 0;
}

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const Document& document : ttf::keys::documents()) names.push_back(document.kind);
  names.emplace_back(ttf::keys::summary::kKind);
  return names;
}

}  // namespace

void add_keys(CLI::App& app, Action& action) {
  auto options = std::make_shared<KeysOptions>();
  CLI::App* command =
      app.add_subcommand("keys", "Every key of the files that the other commands read, and of summary.json");
  command->footer(
      "Examples: ttfusion keys cluster\n"
      "          ttfusion keys cluster --format json-schema -o cluster.schema.json\n"
      "          ttfusion keys --format markdown -o out/keys");
  command->add_option("kind", options->kind, "Kind of file (default: all kinds)")->check(one_of(kinds()));
  command->add_option("--format", options->format, "text (default), markdown or json-schema")
      ->check(one_of({"text", "markdown", "json-schema"}));
  command->add_option("-o,--out", options->out, "File to write; folder where there are several: all kinds, or markdown")
      ->check(named());
  command->callback([options, &action] { action = [options] { return print_keys(*options); }; });
}

}  // namespace ttf::cli::keys
