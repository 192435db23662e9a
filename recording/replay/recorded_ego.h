// The recorded motion of the sensors' vehicle, as poses or as odometry, and recorded lists placed by it.
//
// Between poses, place and heading are linear in time. Odometry makes a path (fusion/ego/ego_path.h), which is known as a
// whole before any list comes. So a list is placed alike in every order of arrival.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion/ego/ego_path.h"
#include "recording/replay/config.h"
#include "recording/replay/recorded_lists.h"
#include "recording/rows/ego_rows.h"
#include "recording/rows/observation_rows.h"

namespace ttf::recording::replay {

class RecordedEgo {
 public:
  RecordedEgo(const recording::rows::EgoRows& rows, const fusion::ego::OdometryErrors& errors);

  // Returns the vehicle's state; beyond the last row it goes on as before. No value before the first row.
  std::optional<fusion::ego::EgoState> at(GlobalTime time) const;
  GlobalTime first() const { return first_; }
  GlobalTime last() const { return last_; }
  const fusion::ego::OdometryErrors& errors() const { return errors_; }

 private:
  struct Pose {
    GlobalTime at{};
    fusion::linear::Vector<2> position = fusion::linear::Vector<2>::Zero();
    double heading = 0.0;
  };
  fusion::ego::OdometryErrors errors_;
  GlobalTime first_{}, last_{};
  std::vector<Pose> poses_;                   // or
  std::optional<fusion::ego::EgoPath> path_;  // of odometry
};

// Returns the recorded motion of `file`, and gives the tracker the errors of odometry. Poses are taken as exact. Throws
// InputError for keys of the tracker that the motion contradicts.
RecordedEgo recorded_ego_of(const recording::rows::EgoRows& rows, const std::string& file, ReplayConfig& config);

// Places the lists, and the truth beside the rows, in the frame of the motion. Throws InputError for a row at a time that the
// motion does not cover; `name` is the file's.
void carry(RecordedLists& recorded, std::vector<recording::rows::ObservationRow>& rows, const RecordedEgo& ego,
           const std::string& name);

}  // namespace ttf::recording::replay
