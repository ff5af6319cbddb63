#include "qddot/model/time_curve.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {
namespace {

using Vector = TimeCurve::Vector;

// The second derivatives M of the spline at its knots. Inside, with intervals h and slopes s,
//   h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (s_i - s_{i-1});
// at the ends M is on the straight line through its two neighbours.
std::vector<Vector> second_derivatives(const std::vector<double>& t, const std::vector<Vector>& x) {
  const std::size_t last = t.size() - 1;
  std::vector<Vector> m(t.size(), Vector::Zero());
  if (last < 2) return m;
  std::vector<double> h(last), diagonal(t.size());
  std::vector<Vector> right(t.size());
  for (std::size_t i = 0; i < last; ++i) h[i] = t[i + 1] - t[i];
  const auto slope = [&](std::size_t i) { return Vector((x[i + 1] - x[i]) / h[i]); };
  if (last == 2) {
    std::ranges::fill(m, Vector(2 * (slope(1) - slope(0)) / (h[0] + h[1])));
    return m;
  }
  std::vector<double> lower(t.size()), upper(t.size());
  for (std::size_t i = 1; i < last; ++i) {
    lower[i] = h[i - 1], upper[i] = h[i], diagonal[i] = 2 * (h[i - 1] + h[i]);
    right[i] = 6 * (slope(i) - slope(i - 1));
  }
  diagonal[1] += h[0] * (1 + h[0] / h[1]);
  upper[1] -= h[0] * h[0] / h[1];
  const double before = h[last - 2], end = h[last - 1];
  diagonal[last - 1] += end * (1 + end / before);
  lower[last - 1] -= end * end / before;
  for (std::size_t i = 2; i < last; ++i) {
    const double part = lower[i] / diagonal[i - 1];
    diagonal[i] -= part * upper[i - 1];
    right[i] -= part * right[i - 1];
  }
  for (std::size_t i = last - 1; i > 0; --i) {
    m[i] = right[i];
    if (i + 1 < last) m[i] -= upper[i] * m[i + 1];
    m[i] /= diagonal[i];
  }
  m[0] = m[1] + (m[1] - m[2]) * (h[0] / h[1]);
  m[last] = m[last - 1] + (m[last - 1] - m[last - 2]) * (end / before);
  return m;
}

std::vector<Vector> turned_all(std::vector<Vector> all, const Eigen::Matrix3d& turn) {
  for (Vector& x : all) x = turn * x;
  return all;
}

bool are_near(const std::vector<Vector>& a, const std::vector<Vector>& b, double tolerance) {
  return std::ranges::equal(
      a, b, [&](const Vector& x, const Vector& y) { return (x - y).norm() <= tolerance; });
}

}  // namespace

PiecewiseCubic PiecewiseCubic::spline(std::vector<double> times, std::vector<Vector> values) {
  std::vector<Vector> bend = second_derivatives(times, values);
  return {std::move(times), std::move(values), std::move(bend), false};
}

PiecewiseCubic PiecewiseCubic::straight(std::vector<double> times, std::vector<Vector> values) {
  std::vector<Vector> bend(times.size(), Vector::Zero());
  return {std::move(times), std::move(values), std::move(bend), true};
}

std::array<Vector, 4> PiecewiseCubic::derivatives(double t, double within) const {
  const Vector none = Vector::Zero();
  if (within < times_.front()) return {values_.front(), none, none, none};
  if (within >= times_.back()) return {values_.back(), none, none, none};
  const auto next = std::ranges::upper_bound(times_, within);
  const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
  const double h = times_[i + 1] - times_[i], x = t - times_[i];
  const Vector third = (bend_[i + 1] - bend_[i]) / h;
  const Vector slope = (values_[i + 1] - values_[i]) / h - h / 6 * (2 * bend_[i] + bend_[i + 1]);
  return {values_[i] + x * (slope + x / 2 * (bend_[i] + x / 3 * third)),
          slope + x * (bend_[i] + x / 2 * third), bend_[i] + x * third, third};
}

PiecewiseCubic PiecewiseCubic::turned(const Eigen::Matrix3d& turn) const {
  return {times_, turned_all(values_, turn), turned_all(bend_, turn), is_straight_};
}

Vector TimeCurve::at(double t, double within) const {
  Vector sum = Vector::Zero();
  for (std::size_t k = polynomial.size(); k-- > 0;) sum = polynomial[k] + t * sum;
  for (const Harmonic& one : harmonics)
    sum += std::sin(one.frequency * t + one.phase) * one.amplitude;
  for (const PiecewiseCubic& table : tables) sum += table.at(t, within);
  for (const Own& function : own) sum += function.value(t);
  return sum;
}

Vector TimeCurve::rate(double t, double within) const {
  Vector sum = Vector::Zero();
  for (std::size_t k = polynomial.size(); k-- > 1;) {
    sum = static_cast<double>(k) * polynomial[k] + t * sum;
  }
  for (const Harmonic& one : harmonics) {
    sum += one.frequency * std::cos(one.frequency * t + one.phase) * one.amplitude;
  }
  for (const PiecewiseCubic& table : tables) sum += table.rate(t, within);
  for (const Own& function : own) sum += function.rate(t);
  return sum;
}

Vector TimeCurve::acceleration(double t, double within) const {
  Vector sum = Vector::Zero();
  for (std::size_t k = polynomial.size(); k-- > 2;) {
    sum = static_cast<double>(k * (k - 1)) * polynomial[k] + t * sum;
  }
  for (const Harmonic& one : harmonics) {
    sum -= one.frequency * one.frequency * std::sin(one.frequency * t + one.phase) * one.amplitude;
  }
  for (const PiecewiseCubic& table : tables) sum += table.derivatives(t, within)[2];
  // Differences over h and 2 h, without the error of h^2 (Richardson).
  const double h = 1e-3 * std::max(1e-3, std::abs(t));
  for (const Own& function : own) {
    const auto slope = [&](double s) -> Vector {
      return (function.rate(t + s) - function.rate(t - s)) / (2 * s);
    };
    sum += (4 * slope(h) - slope(2 * h)) / 3;
  }
  return sum;
}

std::vector<Corner> TimeCurve::corners() const {
  constexpr int of_a_line = 1, of_a_spline = 3;
  std::vector<Corner> all;
  for (const PiecewiseCubic& table : tables) {
    const std::vector<double>& times = table.times();
    for (std::size_t i = 0; i < times.size(); ++i) {
      const bool is_end = i == 0 || i + 1 == times.size();
      all.push_back({times[i], is_end || table.is_straight() ? of_a_line : of_a_spline});
    }
  }
  return all;
}

void TimeCurve::shift(const Vector& by) {
  if (polynomial.empty()) polynomial.emplace_back(Vector::Zero());
  polynomial.front() += by;
}

TimeCurve TimeCurve::turned(const Eigen::Matrix3d& turn) const {
  TimeCurve result{.polynomial = turned_all(polynomial, turn)};
  for (const Harmonic& one : harmonics) {
    result.harmonics.push_back({turn * one.amplitude, one.frequency, one.phase});
  }
  for (const PiecewiseCubic& table : tables) result.tables.push_back(table.turned(turn));
  for (const Own& function : own) {
    result.own.push_back(
        {[turn, value = function.value](double t) -> Vector { return turn * value(t); },
         [turn, rate = function.rate](double t) -> Vector { return turn * rate(t); }});
  }
  return result;
}

std::vector<Vector> TimeCurve::directions() const {
  std::vector<Vector> all = polynomial;
  for (const Harmonic& one : harmonics) all.push_back(one.amplitude);
  for (const PiecewiseCubic& table : tables) {
    all.insert(all.end(), table.values().begin(), table.values().end());
  }
  for (int d = 0; d < 3 && !own.empty(); ++d) all.push_back(Vector::Unit(d));
  return all;
}

bool TimeCurve::is_near(const TimeCurve& other, double tolerance) const {
  const auto harmonic = [&](const Harmonic& a, const Harmonic& b) {
    return a.frequency == b.frequency && a.phase == b.phase &&
           (a.amplitude - b.amplitude).norm() <= tolerance;
  };
  const auto table = [&](const PiecewiseCubic& a, const PiecewiseCubic& b) {
    return a.is_straight() == b.is_straight() && a.times() == b.times() &&
           are_near(a.values(), b.values(), tolerance);
  };
  return own.empty() && other.own.empty() && are_near(polynomial, other.polynomial, tolerance) &&
         std::ranges::equal(harmonics, other.harmonics, harmonic) &&
         std::ranges::equal(tables, other.tables, table);
}

}  // namespace qddot
