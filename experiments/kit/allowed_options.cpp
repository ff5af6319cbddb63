#include "experiments/kit/allowed_options.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/integrators/base/step_times.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

constexpr double coarse_rtol = 0.1, fine_rtol = 1e-14;
// M - h^2 K needs the square of h, and all its digits.
constexpr double least_step = 1e-150, largest_step = 1e150;
constexpr double least_part_of_scale = 1e-30;

}  // namespace

void require_positive(double value, const std::string& option, const std::string& meaning) {
  if (std::isfinite(value) && value > 0) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is {}, finite and greater than 0",
                                 option, value, meaning));
}

void require_within(int value, int low, int high, const std::string& option) {
  if (value >= low && value <= high) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is a whole number from {} to {}", option,
                                 value, low, high));
}

void require_repeats(int repeats) { require_within(repeats, 1, 1000, "--repeats"); }

void require_given(const std::string& text, const std::string& option, const std::string& meaning) {
  if (text.empty()) throw InvalidInput(fmt::format("{} is missing; it is {}", option, meaning));
}

void require_rtol(double rtol, const std::string& option) {
  require_positive(rtol, option, "a relative tolerance");
  if (rtol >= least_rtol && rtol < 1) return;
  throw InvalidInput(
      fmt::format("{} {:g} is not allowed; it is a relative tolerance from {:g} (some roundings of "
                  "a number) to below 1 (as large as the motion)",
                  option, rtol, least_rtol));
}

void require_step_size(double h, const std::string& option, double until) {
  require_positive(h, option, "h in s");
  if (h < until / most_steps) {
    throw InvalidInput(
        fmt::format("{} {:g} is not allowed; it is h in s, at least {:.3g}: in {:g} s, double "
                    "precision can tell apart at most {:g} steps",
                    option, h, until / most_steps, until, most_steps));
  }
  if (h >= least_step && h <= largest_step) return;
  throw InvalidInput(
      fmt::format("{} {:g} is not allowed; it is h in s, from {:g} to {:g}, so that "
                  "its square is a number",
                  option, h, least_step, largest_step));
}

void require_atol(const Options& options) {
  if (options.atol == 0) return;
  require_positive(options.atol, "--atol", "an absolute tolerance");
  const double least = least_part_of_scale * std::min(options.length, options.speed);
  const double most = std::max(options.length, options.speed);
  if (options.atol >= least && options.atol < most) return;
  throw InvalidInput(fmt::format(
      "--atol {:g} is not allowed; it is an absolute tolerance in m and m/s, from {:.2g} to below "
      "{:.3g}, as the scene measures {:.3g} m and its speeds are {:.3g} m/s",
      options.atol, least, most, options.length, options.speed));
}

std::string tolerance_warning(const Options& options) {
  if (options.rtol > coarse_rtol) {
    return fmt::format(
        "--rtol {:g} allows an error of {:g} of the motion in a step: the result hardly means "
        "anything",
        options.rtol, options.rtol);
  }
  if (options.rtol > 0 && options.rtol < fine_rtol) {
    return fmt::format(
        "--rtol {:g} is near the rounding of numbers, 2e-16: errors may stay above it, and steps "
        "may become very short",
        options.rtol);
  }
  if (options.atol >= std::min(options.length, options.speed)) {
    const bool is_length = options.atol >= options.length;
    return fmt::format("--atol {:g} is above the size of {}, {:.3g} {}: their errors do not count",
                       options.atol, is_length ? "positions" : "velocities",
                       is_length ? options.length : options.speed, is_length ? "m" : "m/s");
  }
  return "";
}

}  // namespace qddot::inline kit
