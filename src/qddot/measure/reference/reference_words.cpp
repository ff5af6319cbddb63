#include <algorithm>

#include <fmt/format.h>

#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline measure {
namespace {

// "2.3" or "1.2e-10 to 2.3".
std::string range(double least, double largest) {
  return least == largest ? fmt::format("{:.3g}", largest)
                          : fmt::format("{:.3g} to {:.3g}", least, largest);
}

}  // namespace

std::string what_divides(const Reference& reference) {
  const Scales& scales = reference.scales;
  if (scales.parts.size() <= 1) {
    return fmt::format(
        "Errors are divided by the largest displacement of a node, {:.3g} m, and the largest "
        "speed, {:.3g} m/s.",
        scales.displacement, scales.speed);
  }
  const auto [near, far] = std::ranges::minmax(
      scales.parts, {}, [&](const PartScale& part) { return scales.displacement_of(part); });
  const auto [slow, fast] = std::ranges::minmax(
      scales.parts, {}, [&](const PartScale& part) { return scales.speed_of(part); });
  return fmt::format(
      "Errors are divided by the largest displacement of a node in its own part of the scene, {} "
      "m, and the largest speed there, {} m/s.",
      range(scales.displacement_of(near), scales.displacement_of(far)),
      range(scales.speed_of(slow), scales.speed_of(fast)));
}

std::string symmetry_in_words(const Reference& reference) {
  if (reference.is_only_symmetric()) {
    return fmt::format(
        "This motion exists only in exact symmetry: a push of one rounding out of it moves the "
        "nodes apart\nfrom t = {:.3g} s on (Lyapunov exponent {:.3g}/s). Errors are those of "
        "computing the symmetric motion.",
        reference.out_of_symmetry->horizon, reference.out_of_symmetry->lyapunov);
  }
  if (reference.is_reduced_by_symmetry && !reference.out_of_symmetry) {
    return "The effect of a push out of the motion's symmetry is unknown: it takes too long to "
           "compute.";
  }
  return "";
}

}  // namespace qddot::inline measure
