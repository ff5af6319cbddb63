#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

// Kernels are compiled in several versions, each in a namespace of its own: for x86-64's levels
// (x86-64 psABI, "micro-architecture levels") or, on other processors, in one. The narrowest first.
#ifdef __x86_64__
#define QDDOT_LEVELS(X) X(v2) X(v3) X(v4)
#else
#define QDDOT_LEVELS(X) X(generic)
#endif

namespace qddot::kernels {

// The environment asks for kernels that this processor does not run. what() is one sentence with
// the variable, its value and what is allowed.
class NoSuchKernels : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Numbers the version in use: the processor's widest or, where the environment's QDDOT_KERNELS
// names one, that. Throws NoSuchKernels where the processor does not run it, and std::runtime_error
// where it runs none.
int level();

// Lists the names of all versions.
std::span<const std::string_view> levels();

}  // namespace qddot::kernels
