#pragma once

namespace qddot {

// What this machine's processor does at best on one thread, to hold a solver's rates against.

// Floating-point operations a second of a product of dense matrices large enough to run at full
// speed, the fastest of a few. Takes about 0.1 s.
double peak_flops();

// Bytes a second of reading `bytes` that lie in a row again and again, the fastest of a few passes:
// from the cache that holds them, else from memory. Takes about 0.1 s; 0 where there are none.
double reading_rate(double bytes);

}  // namespace qddot
