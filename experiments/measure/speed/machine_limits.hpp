#pragma once

namespace qddot::measure {

// How fast one core moves memory [bytes/s] in the triad a = b + s c (McCalpin, STREAM), over arrays
// that take `bytes` together and are counted once each: the fastest of the passes of `seconds`.
double triad_bandwidth(double bytes, double seconds);

// How fast one core multiplies and adds [operations/s], from register to register with the widest
// vectors that the kernels use: the fastest of the passes of `seconds`.
double peak_flops(double seconds);

// How fast one core reads `bytes` that lie in a row again and again [bytes/s]: from the cache that
// holds them, else from memory. Zero where there are none.
double reading_rate(double bytes, double seconds);

}  // namespace qddot::measure
