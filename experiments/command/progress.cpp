#include "experiments/command/progress.hpp"

#include <unistd.h>

#include <fmt/format.h>

namespace qddot::command {

void show_progress(const std::string& what) {
  if (::isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K{}", what);
}

std::string describe(const Point& p) {
  return p.outcome == Outcome::reached_end
             ? fmt::format("{} {} {:.3g}: error {:.1e} in {:.3g} s", p.method->name,
                           knob_name(p.method->knob), p.value, p.errors.position, p.time)
             : fmt::format("{} {} {:.3g}: {}", p.method->name, knob_name(p.method->knob), p.value,
                           name(p.outcome));
}

}  // namespace qddot::command
