#include "qddot/measure/speed/chart_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

namespace qddot::inline measure {
namespace {

// So many of a chart's points may vary in their times without a word.
constexpr double largest_disturbed_part = 0.1;

// An error above this says only that the motion is lost.
constexpr double worst_error = 3;

// 1.2e-05 without a fraction of zeros and without zeros in the exponent: 1.2e-5.
std::string shortened(const std::string& scientific) {
  const std::size_t e = scientific.find('e');
  std::string mantissa = scientific.substr(0, e);
  if (mantissa.find('.') != mantissa.npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.ends_with('.')) mantissa.pop_back();
  }
  return fmt::format("{}e{}", mantissa, std::atoi(scientific.c_str() + e + 1));
}

// A positive number rounded to four digits; halves go up.
double to_four_digits(double value) {
  const std::string digits = fmt::format("{:.60e}", value);  // d.ddddd..., exact where a half is
  int four = 0;
  for (const std::size_t i : {0, 2, 3, 4}) four = 10 * four + (digits[i] - '0');
  if (digits[5] >= '5') ++four;
  const int exponent = std::atoi(digits.c_str() + digits.find('e') + 1);
  return std::strtod(fmt::format("{}e{}", four, exponent - 3).c_str(), nullptr);
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string horizon_in_words(const Reference& reference) {
  std::string words = fmt::format(
      "chaotic: from t = {} s on, two runs that start one rounding apart differ by more than 1e-2",
      number_in_words(reference.horizon));
  if (reference.lyapunov != 0)
    words += fmt::format(" (× 10 in {})", time_in_words(std::numbers::ln10 / reference.lyapunov));
  words +=
      fmt::format(".\nPosition errors at T = {} s mean nothing.", number_in_words(reference.end.t));
  if (!largest_difference_by_chance(reference)) {
    words += fmt::format(" Modal shares differ by {} by chance: no run is known to be right.",
                         number_in_words(reference.modal_shares_floor));
  } else if (reference.modal_shares_floor > 0) {
    words += " Fastest: of the runs whose energy is in the right modes.";
  }
  return words;
}

}  // namespace

std::string number_in_words(double value) {
  if (std::abs(value) >= 0.1 && std::abs(value) < 1000) return fmt::format("{:.3g}", value);
  return shortened(fmt::format("{:.1e}", value));
}

std::string knob_in_words(const Method& method, double value) {
  const double rounded = to_four_digits(value);
  const std::string number = rounded == 0 || rounded >= 1e-3
                                 ? fmt::format("{:.15g}", rounded)
                                 : shortened(fmt::format("{:.3e}", rounded));
  return method.knob == Knob::step_size ? fmt::format("h = {} s", number)
                                        : fmt::format("rtol = {}", number);
}

std::string time_in_words(double seconds) {
  struct Unit {
    const char* name;
    double scale;
  };
  constexpr std::array units = {Unit{"s", 1}, Unit{"ms", 1e-3}, Unit{"µs", 1e-6}};
  for (const auto& [name, scale] : units) {
    if (seconds >= 0.9999 * scale) return fmt::format("{:.3g} {}", seconds / scale, name);
  }
  return fmt::format("{:.3g} ns", seconds / 1e-9);
}

std::string failure_in_words(const Point& point, const Judged& judged) {
  if (point.outcome != Outcome::reached_end)
    return replaced(replaced(std::string(name(point.outcome)), "_", " "), "newton", "Newton");
  if (std::isnan(judged.error)) return "error not measured";
  if (judged.error > worst_error) return fmt::format("error above {:g}", worst_error);
  return is_timed(point) ? "" : "not timed";
}

std::string why_empty(const FrontRow& row, const Reference& reference) {
  if (certified(reference) > row.accuracy) return "beyond what the reference certifies";
  return row.may_be_reached ? "no method is known to have reached it" : "no method reached it";
}

std::string margin_in_words(double stability_margin) {
  return fmt::format("{:.2g} % {} its limit of stability", std::abs(100 * stability_margin),
                     stability_margin < 0 ? "above" : "below");
}

std::string disturbance_in_words(const Chart& chart) {
  const auto timed = std::ranges::count_if(chart.points, is_timed);
  const auto disturbed = std::ranges::count_if(
      chart.points, [](const Point& point) { return is_timed(point) && is_disturbed(point); });
  if (static_cast<double>(disturbed) <= largest_disturbed_part * static_cast<double>(timed))
    return "";
  return fmt::format(
      "The times of {} of {} points vary by more than a quarter between runs, as beside other "
      "programs:\nmeasure on an idle machine, or take --clock processor.",
      disturbed, timed);
}

std::vector<std::string> warnings(const FrontRow& row, const Reference& reference) {
  std::vector<std::string> words;
  if (!row.fastest) return words;
  if (row.stability_margin < small_margin) words.push_back(margin_in_words(row.stability_margin));
  if (const Point* rival = row.runner_up(); rival && may_be_faster(*rival, *row.fastest)) {
    words.push_back(
        fmt::format("{} may be as fast: times vary between runs, as beside other programs",
                    rival->method->name));
  }
  if (judged(*row.fastest, reference).is_uncertain) {
    words.push_back(fmt::format("error known only to within {:.1e}, as the reference itself is",
                                certified(reference)));
  }
  return words;
}

std::string floor_in_words(const ChartView& view) {
  if (std::isnan(view.floor)) return "";
  return fmt::format(
      "{} {}", view.quantity == Quantity::modes ? "difference by chance" : "reference certified to",
      number_in_words(view.floor));
}

std::vector<std::string> caveats(const Reference& reference, const StudyEnd& end) {
  std::vector<std::string> sentences;
  if (end.are_times_of_work) {
    sentences.emplace_back(
        "Times are not measured: they are counts of forces, stiffness matrices, factorisations and "
        "solves,\ntimes what each of these takes on one machine. Other work of a step is not "
        "counted.");
  }
  if (!end.interrupted_by.empty()) {
    sentences.push_back(fmt::format(
        "The study was interrupted by {}: points are missing.\nThe same command with --resume "
        "measures them.",
        end.interrupted_by));
  }
  if (reference.is_beyond_horizon()) sentences.push_back(horizon_in_words(reference));
  if (reference.is_only_symmetric()) {
    sentences.push_back(fmt::format(
        "this motion exists only in exact symmetry: a push of one rounding out of it moves the "
        "nodes apart from t = {} s on.\nErrors are those of computing the symmetric motion, from "
        "which any push leads away.",
        number_in_words(reference.out_of_symmetry->horizon)));
  }
  return sentences;
}

}  // namespace qddot::inline measure
