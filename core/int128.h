// A 128-bit integer for exact intermediate products of times and periods.
#pragma once

namespace ttf {

__extension__ typedef __int128 Int128;

}  // namespace ttf
