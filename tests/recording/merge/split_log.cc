// split_log LOG COUNT FOLDER: splits LOG into the logs that COUNT processes would have written.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/recording/merge/split_log.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  try {
    ttf::recording::merge::split_log(argv[1], argv[3], std::strtoul(argv[2], nullptr, 10));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
