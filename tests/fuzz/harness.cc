#include "tests/fuzz/harness.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/check.h"
#include "schedules/file/inherit.h"

namespace ttf::fuzz {

void check_lines(std::string_view text, std::string_view file) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    TTF_CHECK(line.substr(0, file.size()) == file && line.size() > file.size() && line[file.size()] == ':',
              "a line does not name its file: {}", line);
    TTF_CHECK(std::all_of(line.begin(), line.end(),
                          [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; }),
              "a line is not printable: {}", line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

void check_refusal(const InputError& error, std::string_view file) {
  const std::string_view text = error.what();
  check_lines(text, file);
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  TTF_CHECK(!error.findings().empty() && lines == error.findings().size(), "{} lines for {} findings", lines,
            error.findings().size());
}

std::string shipped(const std::string& path) {
  std::ifstream file(TTF_SOURCE_DIR "/" + path, std::ios::binary);
  TTF_CHECK(file.good(), "{} cannot be read", path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string shipped_cluster(const std::string& name) {
  return schedules::file::inherited(TTF_SOURCE_DIR "/schedules/" + name + ".yaml").text;
}

}  // namespace ttf::fuzz
