#pragma once

namespace kropla {

/// Whether what is true by construction is looked at again as the program runs: in developer and debug builds.
#ifdef NDEBUG
inline constexpr bool checks = false;
#else
inline constexpr bool checks = true;
#endif

}  // namespace kropla
