// Checks a cluster file by all rules. It prints the bounds of each measurement's age at its use.
//   check_schedule CLUSTER.yaml        exit code 2: the file breaks a rule
#include <cstdio>

#include "core/errors.h"
#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"

namespace schedules = ttf::schedules;

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "check_schedule CLUSTER.yaml\n"), 2;
  try {
    const schedules::model::Cluster cluster = schedules::check::load_checked_cluster(argv[1]);
    for (const auto& path : schedules::analysis::measurement_ages(cluster))
      std::printf("%s: used %.6g to %.6g ms after the measurement\n", cluster.sensor(path.sensor).name.c_str(),
                  ttf::in_ms(path.use_best), ttf::in_ms(path.use_worst));
  } catch (const ttf::InputError& error) {
    for (const ttf::Finding& finding : error.findings()) std::fprintf(stderr, "%s\n", finding.sentence().c_str());
    return 2;
  }
}
