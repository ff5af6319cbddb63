#pragma once

namespace qddot::inline measure {

// Memory bandwidth of one core [bytes/s] in the triad a = b + s c (McCalpin, STREAM). The three
// arrays take `bytes` together and count once each. The fastest of all passes in `seconds`.
double triad_bandwidth(double bytes, double seconds);

// Multiplications and additions of one core [operations/s], from register to register with the
// widest vectors that the kernels use. The fastest of all passes in `seconds`.
double peak_flops(double seconds);

// The rate [bytes/s] at which one core reads `bytes` contiguous bytes repeatedly: from the cache
// that holds them, else from memory. Zero if `bytes` is zero.
double reading_rate(double bytes, double seconds);

}  // namespace qddot::inline measure
