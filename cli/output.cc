#include "cli/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/errors.h"

namespace ttf::cli {
namespace {

[[noreturn]] void fail(const std::string& where) {
  throw std::runtime_error(where + ": cannot be written: " + system_message(errno));
}

}  // namespace

void write_file(const std::string& path, std::string_view text) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
  if (file == nullptr || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) fail(path);
  // Writing the buffered rest may fail as well.
  if (std::fclose(file.release()) != 0) fail(path);
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (file_ == nullptr) fail(path_);
}

OutputFile::~OutputFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::error_code none;
  if (std::filesystem::is_regular_file(path_, none)) std::filesystem::remove(path_, none);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(path_);
}

void OutputFile::finish() {
  if (std::fflush(file_) != 0) fail(path_);
  std::FILE* const whole = std::exchange(file_, nullptr);
  if (std::fclose(whole) != 0) fail(path_);
}

void create_folder(const std::string& path) {
  std::error_code failure;
  std::filesystem::create_directories(path, failure);
  if (failure) throw std::runtime_error(path + ": cannot be created: " + failure.message());
}

void try_folder(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<fs::path> made;  // innermost first
  std::error_code none;
  for (fs::path folder = fs::absolute(path).lexically_normal(); !fs::exists(folder, none) && folder.has_relative_path();
       folder = folder.parent_path())
    made.push_back(folder);
  const auto unmake = [&] {
    for (const fs::path& folder : made) fs::remove(folder, none);  // keeps folders that are no longer empty
  };
  try {
    create_folder(path);
    std::string probe = path + "/ttfusion-XXXXXX";
    if (mkdtemp(probe.data()) == nullptr) fail(path);
    fs::remove(probe, none);
  } catch (...) {
    unmake();
    throw;
  }
  unmake();
}

void print_warnings(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    fmt::print(stderr, "warning: {}\n", text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void say_written(const std::string& path, const std::string& content) {
  fmt::print(stderr, "wrote {}{}{}\n", path, content.empty() ? "" : ": ", content);
}

void refuse_overwriting(const std::string& input, const std::string& path, const std::string& flag) {
  std::error_code none;  // a file that does not exist yet is not the input
  if (std::filesystem::equivalent(input, path, none))
    throw InputError({"command line", 0, flag, path, "must be another file than the input"});
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_warnings(warning);
}

int print_reasons(std::string_view file, std::string_view headline, const std::vector<std::string>& reasons) {
  for (const std::string& reason : reasons) fmt::print(stderr, "error: {}: {}: {}\n", file, headline, reason);
  return reasons.empty() ? 0 : 1;
}

void finish_standard_output() {
  // The stream keeps an error of an earlier, implicit flush.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail("standard output");
}

}  // namespace ttf::cli
