#include "core/file_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace ttf {

std::string read_file(const std::string& path, std::size_t most) {
  const auto fail = [&path] {
    throw InputError({path, 0, "", "", std::string("cannot be read: ") + system_message(errno)});
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (file == nullptr) fail();
  // The buffer grows with the bytes read: a size field may claim any size.
  std::string bytes;
  std::vector<char> block(std::min(most, std::size_t{1} << 20));
  while (const std::size_t got = std::fread(block.data(), 1, std::min(block.size(), most - bytes.size()), file.get()))
    bytes.append(block.data(), got);
  if (std::ferror(file.get()) != 0) fail();
  return bytes;
}

std::string read_named_file(const std::string& path, Finding entry, std::string_view what) {
  try {
    return read_file(path);
  } catch (const InputError& error) {
    entry.value = path;
    entry.expected = fmt::format("must be {}, but it {}", what, error.findings().front().expected);
    throw InputError(std::move(entry));
  }
}

}  // namespace ttf
