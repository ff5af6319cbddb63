#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

// Kernels are compiled once for each x86-64 level (x86-64 psABI, "micro-architecture levels"), each
// in its own namespace, narrowest first. Other processors have one version.
#ifdef __x86_64__
#define QDDOT_LEVELS(X) X(v2) X(v3) X(v4)
#else
#define QDDOT_LEVELS(X) X(generic)
#endif

namespace qddot::kernels {

// Thrown if the environment asks for kernels that this processor cannot run. what() is one sentence
// with the variable, its value and the allowed ones.
class NoSuchKernels : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The number of the version in use: the widest that the processor runs, or the one that the
// environment variable QDDOT_KERNELS names. Throws NoSuchKernels if the processor cannot run the
// named one, and std::runtime_error if it runs none.
int level();

// Lists the names of all versions.
std::span<const std::string_view> levels();

}  // namespace qddot::kernels
