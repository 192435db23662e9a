// Bytes as text, for data in a page.
#pragma once

#include <string>
#include <string_view>

namespace ttf::report::drawing {

// Returns bytes in base64 (RFC 4648, with padding).
std::string base64(std::string_view bytes);

}  // namespace ttf::report::drawing
