// Any bytes as an experiment's results.sqlite, beside its own answer. Laws: it is refused in a line with the
// file's name, or makes a page with complete tables. It answers every query.
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "core/check.h"
#include "report/experiment/report.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/page_laws.h"

namespace {

constexpr char kAnswer[] = R"({"experiment": "e", "question": "q", "answer": "a", "baseline": "a", "seed": 1, "runs": 4,
  "failed": 1, "confidence": 0.95, "points": [{"point": 0, "axes": {"noise": "1"}, "paradigms": {
  "a": {"m": {"count": 2, "mean": 1, "half_width": 1}},
  "b": {"m": {"count": 2, "mean": 2, "half_width": 1, "difference": {"count": 2, "mean": 1, "half_width": 1}}}}}]})";

// SQLite wants a name in a folder, beside which it may put its journal.
class ScratchFile {
 public:
  explicit ScratchFile(std::string_view bytes) {
    std::error_code none;
    const bool memory = std::filesystem::is_directory("/dev/shm", none);
    path_ = (memory ? "/dev/shm" : std::filesystem::temp_directory_path().string()) + "/ttf_store_XXXXXX";
    const int file = ::mkstemp(path_.data());
    TTF_CHECK(file >= 0, "no scratch file");
    TTF_CHECK(::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()), "no room");
    ::close(file);
  }
  ~ScratchFile() {
    std::error_code none;
    for (const char* of : {"", "-journal", "-wal", "-shm"}) std::filesystem::remove(path_ + of, none);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf;
  const ScratchFile file(fuzz::text_of(data, size));
  report::experiment::ExperimentFolder folder = report::experiment::parse_answer(kAnswer, "answer.json");
  if (!fuzz::accepted(file.path(), [&] { report::experiment::read_store(file.path(), folder); })) return 0;
  TTF_CHECK(folder.store.has_value(), "no store");
  try {
    fuzz::check_page(report::experiment::experiment_report_html(folder, {}, {}));
  } catch (const std::runtime_error& error) {
    // Only a different order of reading finds this (an index that differs from its table).
    TTF_CHECK(std::string_view(error.what()).starts_with(file.path()), "{}", error.what());
  }
  return 0;
}
