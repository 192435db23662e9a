// Whether Cyclone DDS takes what CYCLONEDDS_URI says, asked before anything is started.
#pragma once

namespace ttf::cli::live_media {

// Only Cyclone DDS knows, and it says why not on standard error: so a process of its own joins a domain and ends. To be
// called where this one has no other threads yet. Nothing happens where the variable is not set. Throws InputError
// with DDS' own words where it cannot join.
void check_dds_configuration();

}  // namespace ttf::cli::live_media
