#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "experiments/kit/plain_model.hpp"
#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::judged_advice {

// A force law between two bodies at the distance r, as users bring it.
//   lennard_jones  V = 4 e ((s/r)^12 - (s/r)^6)
//   morse          V = e (1 - exp(-(r - s)/w))^2, of the width w = s/4
//   gravity        V = -e/r
struct PairLaw {
  enum class Form { lennard_jones, morse, gravity };

  Form form = Form::gravity;
  double depth = 1;  // e [J], of gravity [J m]
  double size = 1;   // s [m]

  // V, V' and V'' at r > 0.
  template <class Real>
  struct Values {
    Real energy, tension, tangent;
  };
  template <class Real>
  Values<Real> at(Real r) const {
    using std::exp;
    const Real e = depth, s = size;
    if (form == Form::gravity) return {-e / r, e / (r * r), -2 * e / (r * r * r)};
    if (form == Form::morse) {
      const Real w = s / 4, d = exp((s - r) / w), gap = 1 - d;
      return {e * gap * gap, 2 * e * gap * d / w, 2 * e * d * (2 * d - 1) / (w * w)};
    }
    const Real x = s / r, x3 = x * x * x, x6 = x3 * x3;
    return {4 * e * x6 * (x6 - 1), 24 * e * x6 * (1 - 2 * x6) / r,
            24 * e * x6 * (26 * x6 - 7) / (r * r)};
  }
};

// Two bodies that a law joins; without the second, the first is drawn to the origin.
struct OwnPair {
  std::size_t one = 0;
  std::optional<std::size_t> other{};
  PairLaw law{};
};

// The system of nodes, none of them pinned, with these forces. Its unknowns are their coordinates
// in `dimension` directions. If `computes_stiffness` is false, K comes from differences of f. If
// `computes_energy` is false, the system has no V.
std::shared_ptr<const System> system_of_pairs(const std::vector<Node>& nodes, int dimension,
                                              const std::vector<OwnPair>& pairs,
                                              bool computes_stiffness, bool computes_energy);

// The same forces for PlainMotion: three coordinates a node.
template <class Real>
class PlainPairs {
 public:
  using Vector = std::vector<Real>;

  PlainPairs(Scene scene, std::vector<OwnPair> pairs)
      : scene_(std::move(scene)), pairs_(std::move(pairs)) {}

  const Scene& scene() const { return scene_; }
  // Forces act towards zero, too.
  std::array<Real, 3> origin() const { return {}; }
  Vector positions() const { return plain_positions<Real>(scene_); }
  Vector velocities() const { return plain_velocities<Real>(scene_); }
  bool place_massless(Vector&) const { return true; }
  void acceleration(const Vector& x, Vector& a) const {
    a.assign(x.size(), 0);
    for (const OwnPair& pair : pairs_) {
      Real d[3];
      const Real r = distance(pair, x, d);
      const Real pull = pair.law.at(r).tension / r;
      for (std::size_t c = 0; c < 3; ++c) {
        a[3 * pair.one + c] += pull * d[c] / Real(scene_.nodes[pair.one].mass);
        if (pair.other)
          a[3 * *pair.other + c] -= pull * d[c] / Real(scene_.nodes[*pair.other].mass);
      }
    }
  }
  Real energy(const Vector& x, const Vector& v) const {
    Real sum = 0, d[3];
    for (const OwnPair& pair : pairs_) sum += pair.law.at(distance(pair, x, d)).energy;
    for (std::size_t i = 0; i < v.size(); ++i)
      sum += Real(scene_.nodes[i / 3].mass) * v[i] * v[i] / 2;
    return sum;
  }

 private:
  // d, from the first body to the second one, and its length.
  static Real distance(const OwnPair& pair, const Vector& x, Real (&d)[3]) {
    using std::sqrt;
    Real squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      d[c] = (pair.other ? x[3 * *pair.other + c] : Real(0)) - x[3 * pair.one + c];
      squares += d[c] * d[c];
    }
    return sqrt(squares);
  }

  Scene scene_;
  std::vector<OwnPair> pairs_;
};

}  // namespace qddot::judged_advice
