// Any text as an experiment's summary.csv. Laws: it is refused in a line, or every table and script gets a
// valid file name. No name in a script or table becomes a command, a line or a row.
#include <algorithm>

#include "core/check.h"
#include "core/csv.h"
#include "report/paper/experiment.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;

void check_table(const std::string& text) {
  CsvLines lines(text);
  std::size_t fields = 0;
  while (lines.next()) {
    TTF_CHECK(lines.broken().empty(), "line {}: {}", lines.line(), lines.broken());
    if (fields == 0) fields = lines.fields().size();
    TTF_CHECK(lines.fields().size() == fields, "line {} has {} fields of {}", lines.line(), lines.fields().size(),
              fields);
  }
}

// Outside double quotes there are only our own words, all printable; a back quote would run a program there.
void check_script(const std::string& text) {
  bool quoted = false, comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    TTF_CHECK(c < 0 || c >= ' ' || c == '\n', "a control character");
    if (c == '\n') {
      TTF_CHECK(!quoted, "a text that goes on: {}", text.substr(i > 60 ? i - 60 : 0, 60));
      TTF_CHECK(!comment || text[i - 1] != '\\', "a comment that goes on");
      comment = false;
    } else if (comment) {
      continue;
    } else if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == '#' && !quoted) {
      comment = true;
    } else {
      TTF_CHECK(c != '`', "a command");
    }
  }
  TTF_CHECK(!quoted, "a text that never ends");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr char kFile[] = "summary.csv";
  std::vector<report::paper::PaperFile> files;
  const auto words = [](std::string_view measure) {
    return measure == "nees" ? report::paper::MeasureWords{"m^2", "a word"} : report::paper::MeasureWords{};
  };
  if (!fuzz::accepted(kFile, [&] {
        files = report::paper::paper_of_experiment(fuzz::text_of(data, size), kFile, "e\n\"`x`\\", words);
      }))
    return 0;
  for (const report::paper::PaperFile& file : files) {
    TTF_CHECK(!file.name.starts_with('.') && std::all_of(file.name.begin(), file.name.end(),
                                                         [](char c) {
                                                           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                                                  (c >= '0' && c <= '9') || c == '_' || c == '.';
                                                         }),
              "a file called {}", file.name);
    if (file.name.ends_with(".csv"))
      check_table(file.text);
    else
      check_script(file.text);
  }
  return 0;
}
