// 128-bit integers for exact intermediate products of times and periods.
#pragma once

namespace ttf {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

}  // namespace ttf
