#pragma once

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace qddot {

// A cubic on each interval between ascending times, constant before the first and after the last.
class PiecewiseCubic {
 public:
  using Vector = Eigen::Vector3d;

  // The spline through the values: twice continuously differentiable, and with the third derivative
  // continuous at the first and last knot between (not-a-knot: de Boor, A Practical Guide to
  // Splines, 2001, chapter IV). It is the parabola or the straight line through three or two.
  static PiecewiseCubic spline(std::vector<double> times, std::vector<Vector> values);
  // Straight lines from value to value.
  static PiecewiseCubic straight(std::vector<double> times, std::vector<Vector> values);

  // The value at t, on the piece that `within` is in (at a corner, the one behind it), continued.
  Vector at(double t, double within) const { return derivatives(t, within)[0]; }
  Vector rate(double t, double within) const { return derivatives(t, within)[1]; }
  const std::vector<double>& times() const { return times_; }
  const std::vector<Vector>& values() const { return values_; }
  bool is_straight() const { return is_straight_; }
  // The derivatives 0 ... 3 at t, on that piece.
  std::array<Vector, 4> derivatives(double t, double within) const;
  // The same values, each multiplied by a matrix.
  PiecewiseCubic turned(const Eigen::Matrix3d& turn) const;

 private:
  PiecewiseCubic(std::vector<double> times, std::vector<Vector> values, std::vector<Vector> bend,
                 bool is_straight)
      : times_(std::move(times)),
        values_(std::move(values)),
        bend_(std::move(bend)),
        is_straight_(is_straight) {}

  std::vector<double> times_;
  std::vector<Vector> values_, bend_;  // the latter: second derivatives
  bool is_straight_;
};

// A time [s] at which a derivative of a function of time jumps; `order` is that of the first one: 1
// for a bend, 0 for a jump of the function itself.
struct Corner {
  double t;
  int order;
};

// A vector that changes with time by a known law: the displacement of a support [m], a load [N], or
// an acceleration [m/s^2]. It is the sum of
//   c_0 + c_1 t + c_2 t^2 + ...,   a sin(w t + phi) for each harmonic,
// tables, and functions of the caller's own. Components beyond the scene's dimension are zero.
struct TimeCurve {
  using Vector = Eigen::Vector3d;
  struct Harmonic {
    Vector amplitude = Vector::Zero();
    double frequency = 0;  // w [rad/s], not negative
    double phase = 0;      // phi [rad]
  };
  // A function of t [s] and its derivative, both given.
  struct Own {
    std::function<Vector(double)> value, rate;
  };
  std::vector<Vector> polynomial{};  // c_k
  std::vector<Harmonic> harmonics{};
  std::vector<PiecewiseCubic> tables{};
  std::vector<Own> own{};

  Vector at(double t) const { return at(t, t); }
  Vector rate(double t) const { return rate(t, t); }
  // The same on the pieces of tables that `within` is in, continued.
  Vector at(double t, double within) const;
  Vector rate(double t, double within) const;
  // The second derivative; for functions of the caller's own a difference of rates, right to about
  // ten digits.
  Vector acceleration(double t, double within) const;
  // The corners of its tables, ascending in each table.
  std::vector<Corner> corners() const;
  // Adds a constant.
  void shift(const Vector& by);
  // The curve turn s(t).
  TimeCurve turned(const Eigen::Matrix3d& turn) const;
  // Vectors that span all of its values; the unit vectors if it has functions of the caller's own.
  std::vector<Vector> directions() const;
  // Whether the other curve is this one within `tolerance` of each vector. Functions of the
  // caller's own are like none.
  bool is_near(const TimeCurve& other, double tolerance) const;
};

}  // namespace qddot
