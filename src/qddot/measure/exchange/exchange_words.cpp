#include "qddot/measure/exchange/exchange_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace qddot::inline measure {
namespace {

// Tolerances for the tempo, the misfit, the change of the sum over the run, and its level; a course
// outside of them is wrong.
constexpr double tempo_tolerance = 1.1, most_misfit = 0.1, most_change = 0.1, most_level = 2;
// Exchanged parts of the sum: above the first there is an exchange, below the second none.
constexpr double some_exchange = 0.1, no_exchange = 0.02;

// The deviation of a tempo from 1: "14 % too slowly", "2.3 times too fast".
std::string off_by(double tempo) {
  const char* where = tempo > 1 ? "too fast" : "too slowly";
  const double factor = std::max(tempo, 1 / tempo);
  return factor < 2 ? fmt::format("{:.0f} % {}", 100 * std::abs(tempo - 1), where)
                    : fmt::format("{:.1f} times {}", factor, where);
}

}  // namespace

std::string verdict_on(const Summary& summary) {
  const bool blows_up =
      summary.outcome == Outcome::diverged || summary.outcome == Outcome::not_finite;
  return fmt::format("{} at t = {:.3g} s", blows_up ? "blows up" : name(summary.outcome),
                     summary.t_reached);
}

std::string verdict_on(const ExchangeComparison& c, const ExchangeComparison& reference) {
  const double kept = c.last / c.first;
  if (kept < 1 - most_change)
    return c.last < 0.005 ? "damps: nothing left"
                          : fmt::format("damps: {:.0f} % of the energy left", 100 * c.last);
  if (kept > 1 + most_change) return fmt::format("gains energy: {:.3g} times as much", c.last);
  if (c.level > most_level || c.level < 1 / most_level)
    return fmt::format("holds {:.2g} times the energy", c.level);
  if (reference.exchanged < some_exchange)
    return c.distance <= most_misfit ? "as it should: no exchange so far" : "exchanges wrongly";
  if (c.exchanged <= no_exchange) return "no exchange";
  if (c.misfit > most_misfit) return "exchanges wrongly";
  if (c.tempo > tempo_tolerance || c.tempo < 1 / tempo_tolerance)
    return "exchanges " + off_by(c.tempo);
  return "exchanges as it should";
}

}  // namespace qddot::inline measure
