// Writes results to files and standard output. A failure to write is not the input's fault: the command fails
// with exit code 1.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::cli {

// Writes the whole file. Throws std::runtime_error with path and reason on failure.
void write_file(const std::string& path, std::string_view text);

// A file written piece by piece, which exists only once it is finished. An older file of its name is gone
// from the start. Throws as write_file().
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  void write(std::string_view text);
  void finish();

 private:
  std::string path_;
  std::FILE* file_;
};

// Names a written file or folder on standard error, in one line. `content` may sum it up: "3 frames".
void say_written(const std::string& path, const std::string& content = "");

// Throws InputError if `path`, given as `flag`, is the input file itself.
void refuse_overwriting(const std::string& input, const std::string& path, const std::string& flag);

// Creates the folder and its missing parents. Throws std::runtime_error with path and reason.
void create_folder(const std::string& path);

// Throws the errors of create_folder() and of a first file in it; leaves no trace.
void try_folder(const std::string& path);

// Prints each line of `text` on standard error as a warning of its own.
void print_warnings(std::string_view text);
void print_warnings(const std::vector<std::string>& warnings);

// Prints one line on standard error for each reason why a command did nothing with its input, or too little. Returns
// the exit code: 0 without reasons, else 1.
int print_reasons(std::string_view file, std::string_view headline, const std::vector<std::string>& reasons);

// Flushes standard output. Throws std::runtime_error with the reason on failure (disk full, closed).
void finish_standard_output();

}  // namespace ttf::cli
