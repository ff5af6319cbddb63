#include "qddot/measure/exchange/energy_exchange.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace qddot::inline measure {
namespace {

constexpr Index points = 1000;  // equally spaced times at which means are compared
constexpr double slowest = 1.0 / 64, fastest = 4;

// The column at position i + x of a sequence of columns, linear between columns i and i + 1.
Vec between(const Eigen::MatrixXd& columns, double place) {
  const auto i = std::min(static_cast<Index>(place), columns.cols() - 2);
  const double x = std::min(place - static_cast<double>(i), 1.0);
  return (1 - x) * columns.col(i) + x * columns.col(i + 1);
}

// The integrals of all energies from 0 to each time, by the trapezoidal rule.
Eigen::MatrixXd integrals(const EnergyCourse& course) {
  const auto n = static_cast<Index>(course.times.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(course.energies.front().size(), n);
  for (std::size_t i = 1; i < course.times.size(); ++i) {
    const double dt = course.times[i] - course.times[i - 1];
    const auto column = static_cast<Index>(i);
    sums.col(column) =
        sums.col(column - 1) + 0.5 * dt * (course.energies[i - 1] + course.energies[i]);
  }
  return sums;
}

// Running means, one column for each of the equally spaced times from 0 to `end`.
Eigen::MatrixXd running_means(const EnergyCourse& course, double window, double end) {
  const Eigen::MatrixXd sums = integrals(course);
  const auto integral = [&](double t) {
    const auto after = std::ranges::upper_bound(course.times, t);
    const auto i =
        std::clamp<std::ptrdiff_t>(after - course.times.begin(), 1, std::ssize(course.times) - 1);
    const double left = course.times[std::size_t(i) - 1], right = course.times[std::size_t(i)];
    return between(sums, static_cast<double>(i - 1) + (t - left) / (right - left));
  };
  Eigen::MatrixXd means(sums.rows(), points);
  for (Index i = 0; i < points; ++i) {
    const double t = end * static_cast<double>(i) / (points - 1);
    const double from = std::max(0.0, t - window / 2), to = std::min(end, t + window / 2);
    means.col(i) = (integral(to) - integral(from)) / (to - from);
  }
  return means;
}

// The root mean square of I_j(t) - R_j(a t).
double misfit(const Eigen::MatrixXd& means, const Eigen::MatrixXd& other, double a) {
  // For a > 1 the sum is over the time of R, so that neither course leaves its range.
  const double s = std::max(a, 1.0);
  double sum = 0;
  for (Index i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) / s;
    sum += (between(means, t) - between(other, a * t)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points * means.rows()));
}

// The factor with the least misfit among `count` on either side of `a`, each `ratio` times the
// last.
double best_near(const Eigen::MatrixXd& means, const Eigen::MatrixXd& other, double a, double ratio,
                 int count) {
  double best = a, least = misfit(means, other, a);
  for (int i = -count; i <= count; ++i) {
    const double factor = std::clamp(a * std::pow(ratio, i), slowest, fastest);
    const double left = misfit(means, other, factor);
    if (left < least) {
      least = left;
      best = factor;
    }
  }
  return best;
}

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

ExchangeComparison compare(const EnergyCourse& course, const EnergyCourse& other, double window) {
  const double end = std::min(course.times.back(), other.times.back());
  const double scale = other.energies.front().sum();
  Eigen::MatrixXd means = running_means(course, window, end),
                  others = running_means(other, window, end);
  ExchangeComparison result;
  result.distance = (means - others).cwiseAbs().maxCoeff() / scale;
  result.first = means.col(0).sum() / scale;
  result.last = means.col(points - 1).sum() / scale;
  result.level = means.colwise().sum().mean() / scale;
  for (Eigen::MatrixXd* each : {&means, &others}) *each /= each->colwise().sum().mean();
  // Steps of 4 %, then of 0.2 %.
  result.tempo = best_near(means, others, 1, 1.04, 110);
  result.tempo = best_near(means, others, result.tempo, 1.002, 20);
  result.misfit = misfit(means, others, result.tempo);
  result.exchanged = (means.colwise() - Vec(means.col(0))).cwiseAbs().maxCoeff();
  return result;
}

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
