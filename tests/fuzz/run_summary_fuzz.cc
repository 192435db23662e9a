// Any text as the summary.json of a run without logs. Laws: it is refused in a line, or makes a page. The
// page is the same each time, and no name in it is markup. The same holds beside another run of it.
#include "report/drive/report.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/page_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf;
  constexpr char kFile[] = "summary.json";
  report::drive::ResultsFolder folder;
  if (!fuzz::accepted(kFile, [&] { folder = report::drive::parse_summary(fuzz::text_of(data, size), kFile); }))
    return 0;
  for (const report::drive::Drive& drive : folder.drives)
    TTF_CHECK(drive.log_name.find('/') == std::string::npos, "a log elsewhere: {}", drive.log_name);
  const std::string page = report::drive::drive_report_html({folder}, {});
  fuzz::check_page(page);
  TTF_CHECK(page == report::drive::drive_report_html({folder}, {}), "another page of the same run");
  report::drive::ResultsFolder other = folder;
  other.path = "other";
  for (report::drive::Drive& drive : other.drives) ++drive.seed;
  fuzz::check_page(report::drive::drive_report_html({folder, other}, {}));
  return 0;
}
