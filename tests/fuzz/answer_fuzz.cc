// Any text as an experiment's answer.json. Laws: it is refused in a line, or makes a page. The page is the
// same each time, and no name in it is markup.
#include "report/experiment/report.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/page_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf;
  constexpr char kFile[] = "answer.json";
  report::experiment::ExperimentFolder folder;
  if (!fuzz::accepted(kFile, [&] { folder = report::experiment::parse_answer(fuzz::text_of(data, size), kFile); }))
    return 0;
  const std::string page = report::experiment::experiment_report_html(folder, {}, {});
  fuzz::check_page(page);
  TTF_CHECK(page == report::experiment::experiment_report_html(folder, {}, {}), "another page of the same answer");
  return 0;
}
