#include "core/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/errors.h"

namespace ttf {

std::string read_file(const std::string& path, std::size_t most) {
  const auto fail = [&path] {
    throw InputError({path, 0, "", "", std::string("cannot be read: ") + std::strerror(errno)});
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (file == nullptr) fail();
  // The buffer grows with the bytes read: a size field or a special file may claim any size.
  std::string bytes;
  std::vector<char> block(std::min(most, std::size_t{1} << 20));
  while (const std::size_t got = std::fread(block.data(), 1, std::min(block.size(), most - bytes.size()), file.get()))
    bytes.append(block.data(), got);
  if (std::ferror(file.get()) != 0) fail();
  return bytes;
}

}  // namespace ttf
