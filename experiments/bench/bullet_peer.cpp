// Bullet's soft body. Its links correct positions after the free motion x* = q + h (v + h g). Each
// link in turn moves its two ends by s (l0 - l)/(1/m_a + 1/m_b), over their masses, along the link.
// Then v = (x - q)/h.
// One round with s = k h^2 (1/m_a + 1/m_b) gives the ends the momentum h k (l0 - l) of the spring.
// So the motion converges with order 1. Bullet computes l0 - l as (l0^2 - l^2)/(l0^2 + l^2) l,
// which is right to first order in the strain, in floats.
#include "experiments/bench/peers.hpp"

#ifdef QDDOT_BULLET

#include <BulletSoftBody/btSoftBody.h>
#include <algorithm>
#include <cmath>

#include "qddot/measure/motion/deadline.hpp"

namespace qddot::bench {
namespace {

btVector3 bullet_vector(const Eigen::Vector3d& x) {
  return {static_cast<btScalar>(x[0]), static_cast<btScalar>(x[1]), static_cast<btScalar>(x[2])};
}

class Bullet final : public Peer {
 public:
  Bullet() : Peer("Bullet soft body", Knob::step_size) {}

  std::vector<ForceKind> forces() const override { return {ForceKind::its_own}; }
  std::string misfit(const Scene& scene) const override {
    if (has_loads(scene)) return "its soft bodies have no constant loads of nodes";
    return has_quartic(scene) ? "its links have no quartic stiffness" : "";
  }
  std::vector<double> values(const Problem& problem) const override {
    return step_sizes(problem, 3, 4);
  }

  Run run(const Problem& problem, ForceKind, double h, double limit) override {
    const Scene& scene = problem.start;
    btSoftBodyWorldInfo world;
    world.m_gravity = bullet_vector(scene.gravity);
    world.air_density = world.water_density = 0;
    world.m_maxDisplacement = static_cast<btScalar>(1e9);
    btSoftBody body(&world);
    body.appendMaterial();  // which nodes take as theirs
    for (const Node& node : scene.nodes) {
      body.appendNode(bullet_vector(node.position),
                      node.pinned ? 0 : static_cast<btScalar>(node.mass));
      body.m_nodes[body.m_nodes.size() - 1].m_v = bullet_vector(node.velocity);
    }
    add_links(scene, h, body);
    body.m_cfg.collisions = 0;
    body.m_cfg.piterations = 1;

    Run run;
    run.steps = std::llround(problem.until / h);
    const Deadline deadline(limit);
    {
      const ProcessorTime watch(run.seconds);
      for (std::int64_t i = 0; i < run.steps && !deadline.passed(); ++i) {
        body.predictMotion(static_cast<btScalar>(h));
        body.solveConstraints();
      }
    }
    run.end = end_of(scene, body, problem.until);
    const bool is_finite = run.end.q.allFinite() && run.end.v.allFinite();
    run.outcome = deadline.passed() ? Outcome::over_budget
                  : is_finite       ? Outcome::reached_end
                                    : Outcome::not_finite;
    return run;
  }

 private:
  static void add_links(const Scene& scene, double h, btSoftBody& body) {
    for (const Spring& spring : scene.springs) {
      const auto a = static_cast<int>(spring.nodes[0]), b = static_cast<int>(spring.nodes[1]);
      const double per_mass = body.m_nodes[a].m_im + body.m_nodes[b].m_im;
      if (per_mass == 0) continue;
      btSoftBody::Material* material = body.appendMaterial();
      material->m_kLST =
          static_cast<btScalar>(std::min(1.0, spring.law.stiffness * h * h * per_mass));
      body.appendLink(a, b, material);
      auto& link = body.m_links[body.m_links.size() - 1];
      link.m_rl = static_cast<btScalar>(spring.law.rest_length);
      link.m_c1 = link.m_rl * link.m_rl;
    }
    // Else the first step would take the lengths as drawn for the rest lengths.
    body.m_bUpdateRtCst = false;
    body.updateLinkConstants();
  }

  static State end_of(const Scene& scene, const btSoftBody& body, double until) {
    std::vector<Node> nodes = scene.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto& node = body.m_nodes[static_cast<int>(i)];
      for (int d = 0; d < 3; ++d) {
        nodes[i].position[d] = node.m_x[d];
        nodes[i].velocity[d] = node.m_v[d];
      }
    }
    return state_of(nodes, scene.dimension, until);
  }
};

}  // namespace

std::unique_ptr<Peer> bullet() { return std::make_unique<Bullet>(); }

}  // namespace qddot::bench

#else

namespace qddot::bench {

std::unique_ptr<Peer> bullet() { return nullptr; }

}  // namespace qddot::bench

#endif
