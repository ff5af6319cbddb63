#pragma once

namespace qddot {

// How fast one core moves memory [bytes/s] in the triad a = b + s c (McCalpin, STREAM), over arrays
// that take `bytes` together and are counted once each: the fastest of the passes of `seconds`.
double triad_bandwidth(double bytes, double seconds);

// How fast one core multiplies and adds [operations/s], from register to register with the widest
// vectors it is compiled for: the fastest of the passes of `seconds`.
double peak_flops(double seconds);

}  // namespace qddot
