#include "experiments/advice/hard_case.hpp"

#include <array>

#include <fmt/format.h>

#include "experiments/advice/draws.hpp"
#include "experiments/advice/hard_kinds.hpp"

namespace qddot::judged_advice {
namespace {

struct HardKind {
  const char* name;
  void (*draw)(HardCase& c, Draws& draw);
};

constexpr std::array hard_motions = {HardKind{"near miss", near_miss},
                                     HardKind{"slow orbit", slow_orbit},
                                     HardKind{"bounce", bounce},
                                     HardKind{"planet", planet},
                                     HardKind{"through the pin", through_the_pin},
                                     HardKind{"fold", fold},
                                     HardKind{"column", column},
                                     HardKind{"uneven masses", uneven_masses},
                                     HardKind{"weakly coupled", weakly_coupled},
                                     HardKind{"equilibrium", equilibrium_start},
                                     HardKind{"small motion", small_motion},
                                     HardKind{"late event", late_event},
                                     HardKind{"before horizon", before_horizon},
                                     HardKind{"prestressed", prestressed},
                                     HardKind{"spinning", spinning},
                                     HardKind{"commensurate", commensurate},
                                     HardKind{"quartic", quartic},
                                     HardKind{"stiff", stiff},
                                     HardKind{"massless joints", massless_joints},
                                     HardKind{"two parts", two_parts},
                                     HardKind{"far from zero", far_from_zero}};

State start_of(const Scene& scene) {
  const auto d = static_cast<Index>(scene.dimension);
  const Index n = static_cast<Index>(scene.nodes.size()) * d;
  State state{0, Vec(n), Vec(n)};
  for (Index i = 0; i < n; ++i) {
    const Node& node = scene.nodes[static_cast<std::size_t>(i / d)];
    state.q[i] = node.position[i % d];
    state.v[i] = node.velocity[i % d];
  }
  return state;
}

Model model_of(const HardCase& c, const Reductions& reductions) {
  if (c.pairs.empty()) return Model(c.scene, reductions);
  return Model(
      system_of_pairs(c.scene.nodes, c.scene.dimension, c.pairs, c.gives_stiffness, c.gives_energy),
      start_of(c.scene), c.scene.dimension);
}

}  // namespace

Model HardCase::model() const { return model_of(*this, {}); }
Model HardCase::as_drawn() const { return model_of(*this, Reductions::only({Reduction::pins})); }

std::size_t hard_kinds() { return hard_motions.size(); }

HardCase hard_case(std::uint64_t number) {
  Draws draw(number ^ 0x5851f42d4c957f2d);
  const HardKind& kind = hard_motions[(number / 3) % hard_motions.size()];
  HardCase c{.number = number,
             .kind = kind.name,
             .accuracy = draw.by_logarithm(1e-10, 1e-1),
             .of = static_cast<AccuracyOf>(number % 3)};
  kind.draw(c, draw);
  c.scene.name = fmt::format("case {} ({})", number, kind.name);
  c.scene.until = c.until;
  return c;
}

}  // namespace qddot::judged_advice
