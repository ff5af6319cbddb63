#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/measure/reference/reference.hpp"
#include "qddot/model/system.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::bench {

// A scene as a user gives it to a peer: M q'' = f(q) over the coordinates of the free nodes, in the
// order of the scene, without other reductions.
struct Problem {
  // `started`: the scene as its motion starts; `until`: end time [s]. The reference is kept in
  // `folder` with `drawn`, its scene, and `origin`. Throws InvalidInput if a free node has no mass,
  // or if the end is beyond the horizon of a chaotic motion, where the positions are unknown.
  // Throws NoReference.
  Problem(const Scene& drawn, const Scene& started, double until, const std::string& folder,
          const nlohmann::json& origin);

  // The position error of an end state (see Errors); infinite where it is no number.
  double error(const State& end) const;

  Scene start;
  double until;          // [s]
  Model smallest;        // with all reductions,
  Reference reference;   // made of that, in its unknowns
  Model scene;           // pins alone left out
  Reference own;         // the same reference in these unknowns
  double length, speed;  // what positions [m] and velocities [m/s] are large or small by
};

// Whether the spring moves a node.
inline bool has_free_end(const Scene& scene, const Spring& spring) {
  return !scene.nodes[spring.nodes[0]].pinned || !scene.nodes[spring.nodes[1]].pinned;
}

// Whether a spring of the scene is more than linear.
inline bool has_quartic(const Scene& scene) {
  return std::ranges::any_of(scene.springs,
                             [](const Spring& spring) { return spring.law.quartic != 0; });
}

// The state of all free nodes, in the unknowns of a scene that is reduced by pins alone.
State state_of(const std::vector<Node>& nodes, int dimension, double t);

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
  std::vector<Eigen::Vector3d> load_;  // empty if there is none
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

}  // namespace qddot::bench
