// Checks of the settings for DDS, before any process starts. In a build without DDS they find nothing.
#pragma once

#include <string>

namespace ttf::cli::live_media {

// Throws InputError with --session if DDS does not take the name of a drive.
void check_session_name(const std::string& name);

// Checks the content of CYCLONEDDS_URI: lets a child process join a domain and end. Only Cyclone DDS can judge its configuration, and it reports
// the cause on standard error. Call it while this process has no other threads. Returns at once if the
// variable is unset. Throws InputError with DDS' own words on failure.
void check_dds_configuration();

}  // namespace ttf::cli::live_media
