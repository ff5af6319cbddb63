#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::bench {

// Whose f a peer is given: the loop that its user would write, or ours; or none, as it has its own.
enum class ForceKind { plain, ours, its_own };
constexpr const char* force_name(ForceKind force) {
  return force == ForceKind::plain ? "plain" : force == ForceKind::ours ? "ours" : "its own";
}

// The force f(q) on a scene's free nodes as a user would write it: a loop over springs with Eigen's
// fixed vectors. q, f: dimension x free nodes.
class PlainForce {
 public:
  explicit PlainForce(const Scene& scene);

  // q'' = M^-1 f(q) [m/s^2].
  void acceleration(const double* q, double* a) const;
  // f(q) [N].
  void force(const double* q, double* f) const;

 private:
  // A spring between two free nodes, given by their places among these, or between a free node and
  // a point.
  struct Link {
    int i, j;
    SpringLaw law;
  };
  struct Anchor {
    int i;
    Eigen::Vector3d point;
    SpringLaw law;
  };

  template <int D>
  void sum(const double* q, double* f) const;

  int dimension_;
  Eigen::Vector3d gravity_;
  std::vector<double> mass_;
  std::vector<Link> links_;
  std::vector<Anchor> anchors_;
};

// q'' = M^-1 f(q) with either f, and how often it was asked for.
class Acceleration {
 public:
  Acceleration(const Scene& start, const System& system, ForceKind kind);

  void operator()(const double* q, double* a);
  std::int64_t evaluations() const { return evaluations_; }

 private:
  PlainForce plain_;
  const System& system_;
  ForceKind kind_;
  Vec per_mass_, q_, f_;
  std::int64_t evaluations_ = 0;
};

// The system with the plain f in the place of its own. Borrows both.
std::unique_ptr<System> with_plain_force(const System& system, const PlainForce& plain);

}  // namespace qddot::bench
