#pragma once

#include <string>
#include <string_view>

namespace qddot::inline kit {

// The BLAS that CHOLMOD uses, as OpenBLAS describes itself: its version and the processor whose
// code it has chosen. "unknown" for any other BLAS.
std::string blas();

// The processor whose code OpenBLAS has chosen, as it names it; empty for any other BLAS.
std::string blas_core();

// The width in bits of this processor's vectors that OpenBLAS has code for: 512 (AVX-512), 256
// (AVX2) or 128.
int vector_bits();

// A value of the environment variable OPENBLAS_CORETYPE that has vectors of `bits`, if those of
// `core` are narrower; else empty. OpenBLAS takes processors newer than itself for old ones. It
// reads the variable when it is loaded, before a program can set it.
std::string_view wider_core(std::string_view core, int bits);

}  // namespace qddot::inline kit
