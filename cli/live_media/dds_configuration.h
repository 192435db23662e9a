// Checks that Cyclone DDS accepts the content of CYCLONEDDS_URI, before any process starts.
#pragma once

namespace ttf::cli::live_media {

// Lets a child process join a domain and end: only Cyclone DDS can judge its configuration, and it reports
// the cause on standard error. Call it while this process has no other threads. Returns at once if the
// variable is unset. Throws InputError with DDS' own words on failure.
void check_dds_configuration();

}  // namespace ttf::cli::live_media
