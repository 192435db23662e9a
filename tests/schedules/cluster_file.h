// The shipped cluster files, and the findings after a change to one of them.
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"
#include "schedules/check/checker.h"
#include "schedules/file/inherit.h"
#include "schedules/file/loader.h"

namespace ttf::schedules {

inline const std::vector<std::string>& shipped_clusters() {
  static const std::vector<std::string> kNames{"paper_unsynchronised",
                                               "paper_synchronised",
                                               "paper_event_triggered",
                                               "paper_free_running",
                                               "paper_free_flexray",
                                               "paper_free_held",
                                               "paper_free_held_flexray",
                                               "paper_fitted",
                                               "paper_fitted_short",
                                               "paper_planned",
                                               "paper_earliest",
                                               "paper_planned_narrow",
                                               "paper_planned_wide",
                                               "paper_planned_held",
                                               "paper_planned_held_sixty",
                                               "paper_planned_wide_held",
                                               "paper_planned_wide_held_sixty",
                                               "paper_dynamic",
                                               "laser_radar",
                                               "laser_radar_synchronised",
                                               "flexray_demo",
                                               "twin_cameras",
                                               "thousand_unsynchronised",
                                               "thousand_synchronised",
                                               "two_lasers_synchronised",
                                               "two_lasers_unsynchronised",
                                               "surround_synchronised",
                                               "surround_unsynchronised",
                                               "moving_unsynchronised",
                                               "moving_synchronised",
                                               "closed_loop_unsynchronised",
                                               "closed_loop_synchronised",
                                               "driven_surround_unsynchronised",
                                               "driven_surround_synchronised",
                                               "closed_loop_free_running",
                                               "closed_loop_free_flexray",
                                               "closed_loop_planned",
                                               "closed_loop_planned_wide",
                                               "adaptive_unsynchronised",
                                               "adaptive_synchronised",
                                               "adaptive_loop_unsynchronised",
                                               "adaptive_loop_synchronised",
                                               "adaptive_loop_modes",
                                               "laser_and_radar_unsynchronised",
                                               "laser_and_radar_synchronised",
                                               "four_kinds_unsynchronised",
                                               "four_kinds_synchronised"};
  return kNames;
}

inline std::string shipped_path(const std::string& name) { return TTF_SOURCE_DIR "/schedules/" + name + ".yaml"; }

// The whole text of a cluster whose file may extend another.
inline std::string shipped_text(const std::string& name) { return file::inherited(shipped_path(name)).text; }

// Findings of the loader, or of the checker after successful loading.
inline std::vector<Finding> findings_of(const std::string& text) {
  try {
    return check::check(file::parse_cluster(text, "cluster.yaml"));
  } catch (const InputError& error) {
    return error.findings();
  }
}

inline std::string sentences(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) text += "\n  " + finding.sentence();
  return text;
}

}  // namespace ttf::schedules
