// A build without DDS (TTF_WITH_DDS): nothing is given to DDS, so these checks have nothing to find.
#include "cli/live_media/dds_configuration.h"

namespace ttf::cli::live_media {

void check_session_name(const std::string&) {}
void check_dds_configuration() {}

}  // namespace ttf::cli::live_media
