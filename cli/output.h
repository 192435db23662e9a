// Where results go: files and standard output. What cannot be written is no input of the user's: the run failed, exit
// code 1.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::cli {

// Writes the whole file. Throws std::runtime_error with path and reason where it cannot.
void write_file(const std::string& path, std::string_view text);

// A file that is written piece by piece, and is there only if it was finished. An older one of its name is gone from
// the beginning on. Throws as write_file().
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

// Throws InputError where `path`, given as `flag`, is the very file that is being read.
void refuse_overwriting(const std::string& input, const std::string& path, const std::string& flag);

// Creates the folder and those it is in, as far as they are not there. Throws std::runtime_error with path and reason.
void create_folder(const std::string& path);

// Throws what create_folder() and the first file in it would; leaves nothing behind.
void try_folder(const std::string& path);

// Prints each line of `text` on standard error as a warning of its own.
void print_warnings(std::string_view text);
void print_warnings(const std::vector<std::string>& warnings);

// Hands what was printed to the system. Throws std::runtime_error with the reason where it is not taken (disk full,
// closed).
void finish_standard_output();

}  // namespace ttf::cli
