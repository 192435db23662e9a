// Prints each warning of a drive, from its log or from those of its processes.
//   read_log LOG...        exit code 2: a log cannot be read
#include <cstdio>

#include "core/errors.h"
#include "recording/merge/merge.h"

namespace recording = ttf::recording;

// Overrides on() for the kinds of record that it wants; recording/records/records.h has them all.
struct Warnings final : recording::records::Sink {
  using Sink::on;
  void on(const recording::records::FeatureUsed& use) override {
    ++uses;
    for (const recording::records::FeatureObject& object : use.objects)
      if (object.warning)
        std::printf("%.2f ms: warning of track %d, %.6g m ahead\n", ttf::in_ms(use.stamp.true_time),
                    static_cast<int>(object.image.track), object.image.x);
  }
  int uses = 0;
};

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "read_log LOG...\n"), 2;
  try {
    const recording::merge::MergedLogs drive(std::vector<std::string>(argv + 1, argv + argc));
    Warnings warnings;
    drive.read(warnings);
    std::printf("%s by %s: %d uses of an image\n", drive.manifest().scenario_name.c_str(),
                drive.manifest().strategy.c_str(), warnings.uses);
  } catch (const ttf::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
