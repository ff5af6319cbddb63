#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/scene/reduce/as_drawn.hpp"
#include "qddot/scene/reduce/part_members.hpp"
#include "qddot/scene/reduce/pieces.hpp"
#include "qddot/scene/reduce/springs.hpp"
#include "qddot/scene/reduce/words.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot::reduce {
namespace {

// Whether the part of each node never leaves a line.
std::vector<bool> on_lines(const std::vector<Node>& nodes, const std::vector<Spring>& springs,
                           const Scene& scene) {
  const int dimension = scene.dimension;
  std::vector<bool> is_on_line(nodes.size(), dimension == 1);
  if (dimension == 1) return is_on_line;
  for (PartMembers& members : parts_of(nodes, springs)) {
    DrawnPart drawn = drawn_part(std::move(members), nodes, springs, scene);
    let_fall(drawn);  // a part stays on its line when it falls, whether that is reduced or not
    if (frame_of(drawn, dimension).dimension > 1) continue;
    for (std::size_t i = 0; i < drawn.free; ++i) is_on_line[drawn.nodes[i]] = true;
  }
  return is_on_line;
}

// The steps of the reduction, in order.
class Steps {
 public:
  Steps(const Scene& scene, const Reductions& reductions)
      : scene_(scene), reductions_(reductions) {}

  Pieces taken();

 private:
  void leave_out_pins();
  void name_stiff();
  void merge();
  void condense();
  void leave_out_static_springs();
  void note_general(const Part& part);
  std::vector<PartMembers> divide();
  void build(std::vector<PartMembers> parts);
  // The part as its motion is integrated; nothing if it rests in its falling frame.
  std::optional<DrawnPart> moving_part(PartMembers members);
  // The part with all reductions that leave its start as drawn.
  Part faithful_part(DrawnPart& drawn);
  void report(Reduction reduction, std::string what) {
    pieces_.findings.push_back({reduction, std::move(what)});
  }

  // The springs so far: the scene's own until a step changes them.
  const std::vector<Spring>& springs() const { return changed_ ? *changed_ : scene_.springs; }

  const Scene& scene_;
  const Reductions& reductions_;
  std::optional<std::vector<Spring>> changed_{};
  Pieces pieces_{.nodes = scene_.nodes, .dimension = scene_.dimension, .curves = scene_.curves};
  std::size_t resting_ = 0;  // parts that rest in their fall
};

Pieces Steps::taken() {
  for (std::size_t i = 0; i < pieces_.nodes.size(); ++i) {
    Node& node = pieces_.nodes[i];
    if (!node.pinned) continue;
    node.velocity.setZero();
    if (node.curve < 0) continue;
    const TimeCurve& curve = scene_.curves[static_cast<std::size_t>(node.curve)];
    node.velocity = curve.rate(0);
    pieces_.moving.push_back({i, curve});
  }
  if (reductions_.has(Reduction::pins) || !pieces_.moving.empty() || has_rods(scene_))
    leave_out_pins();
  name_stiff();
  if (reductions_.has(Reduction::duplicates)) merge();
  if (reductions_.has(Reduction::massless)) condense();
  leave_out_static_springs();
  build(divide());
  return std::move(pieces_);
}

void Steps::name_stiff() {
  const auto is_named = [&](const Spring& spring) {
    return spring.stiff == is_stiff(spring.law, scene_.stiff_above);
  };
  if (std::ranges::all_of(scene_.springs, is_named)) return;
  changed_ = scene_.springs;
  for (Spring& spring : *changed_) spring.stiff = is_stiff(spring.law, scene_.stiff_above);
}

void Steps::leave_out_pins() {
  const auto pins =
      static_cast<std::size_t>(std::ranges::count(pieces_.nodes, true, &Node::pinned));
  if (pins > 0) report(Reduction::pins, pinned_sentence(pins, pieces_.moving.size()));
}

void Steps::merge() {
  const std::size_t before = springs().size();
  std::optional<std::vector<Spring>> merged = merged_springs(springs(), pieces_.nodes.size());
  if (!merged) return;
  changed_ = std::move(merged);
  report(Reduction::duplicates, merged_sentence(before - springs().size(), springs().size()));
}

void Steps::condense() {
  if (std::ranges::none_of(pieces_.nodes, [](const Node& n) { return !n.pinned && n.mass == 0; }))
    return;
  if (!changed_) changed_ = scene_.springs;
  pieces_.series = condense_series(pieces_.nodes, *changed_, scene_.stiff_above,
                                   on_lines(pieces_.nodes, *changed_, scene_));
  if (pieces_.series.empty()) return;
  std::vector<std::size_t> condensed;
  for (const Series& series : pieces_.series) {
    series.place(pieces_.nodes);
    for (const auto& joint : series.joints) condensed.push_back(joint.node);
  }
  report(Reduction::massless, condensed_sentence(condensed, pieces_.series.size()));
}

void Steps::leave_out_static_springs() {
  for (const auto& [ends, law, holds, stiff] : springs()) {
    const Node &a = pieces_.nodes[ends[0]], &b = pieces_.nodes[ends[1]];
    if (!a.pinned || !b.pinned) continue;
    if (a.curve >= 0 || b.curve >= 0) {
      pieces_.driven_springs.push_back({ends, law});
    } else {
      pieces_.static_energy += law.energy((b.position - a.position).norm());
    }
  }
}

// Steps keep the order of springs that are not plain, and change none of them.
void Steps::note_general(const Part& part) {
  const auto note = [&](const std::vector<int>& own, bool (*is_of_kind)(const SpringLaw&),
                        std::vector<std::size_t>& numbers) {
    if (own.empty()) return;
    const auto of = [&](const std::vector<Spring>& all) {
      std::vector<std::size_t> found;
      for (std::size_t e = 0; e < all.size(); ++e) {
        if (is_of_kind(all[e].law)) found.push_back(e);
      }
      return found;
    };
    const std::vector<std::size_t> now = of(springs()), drawn = of(scene_.springs);
    for (const int e : own) {
      const auto place = std::ranges::lower_bound(now, static_cast<std::size_t>(e));
      numbers.push_back(drawn[static_cast<std::size_t>(place - now.begin())]);
    }
  };
  note(
      part.general(), [](const SpringLaw& law) { return law.is_general(); }, pieces_.general);
  note(
      part.rods(), [](const SpringLaw& law) { return law.rigid; }, pieces_.rods);
  for (const auto& [constraint, share] : part.shares())
    pieces_.shares.push_back({pieces_.constraints + constraint, share});
  if (!part.shares().empty()) pieces_.constraints = pieces_.shares.back().constraint + 1;
}

std::vector<PartMembers> Steps::divide() {
  std::vector<bool> is_condensed(pieces_.nodes.size(), false);
  for (const Series& series : pieces_.series) {
    for (const auto& joint : series.joints) is_condensed[joint.node] = true;
  }
  std::vector<PartMembers> parts;
  std::vector<std::size_t> flying;
  for (PartMembers& members : parts_of(pieces_.nodes, springs())) {
    const auto first = static_cast<std::size_t>(members.nodes.front());
    if (is_condensed[first]) continue;  // it is on no spring any more
    const Node& node = pieces_.nodes[first];
    const bool is_driven = node.curve >= 0 || (scene_.gravity_curve >= 0 && node.mass > 0);
    if (members.springs.empty() && !is_driven && reductions_.has(Reduction::free_flight)) {
      Flight flight{.velocity = node.velocity};
      if (node.mass > 0) {
        flight.gravity = scene_.gravity + node.load / node.mass;
        flight.air_damping = scene_.air_damping;
      }
      pieces_.flying.push_back({flight, first});
      flying.push_back(first);
    } else {
      parts.push_back(std::move(members));
    }
  }
  if (!flying.empty()) report(Reduction::free_flight, flying_sentence(flying));
  if (!reductions_.has(Reduction::parts)) return joined(std::move(parts));
  if (parts.size() > 1) report(Reduction::parts, parts_sentence(parts.size()));
  return parts;
}

void Steps::build(std::vector<PartMembers> parts) {
  std::vector<std::unique_ptr<System>> systems;
  Index n = 0;
  for (PartMembers& members : parts) {
    std::optional<DrawnPart> drawn = moving_part(std::move(members));
    if (!drawn) continue;
    Part& part = pieces_.parts.emplace_back(faithful_part(*drawn));
    note_general(part);
    systems.push_back(part.take_system());
    pieces_.static_energy += part.energy_of_origin();
    n += part.unknowns();
  }
  pieces_.initial = {0, Vec(n), Vec(n)};
  Index at = 0;
  for (Part& part : pieces_.parts) {
    const State own = part.take_initial();
    pieces_.initial.q.segment(at, own.q.size()) = own.q;
    pieces_.initial.v.segment(at, own.v.size()) = own.v;
    at += own.q.size();
  }
  const auto falling = static_cast<std::size_t>(
      std::ranges::count_if(pieces_.parts, [](const Part& part) { return part.fall().moves(); }));
  const bool is_loaded = std::ranges::any_of(pieces_.parts, &Part::is_loaded);
  if (falling + resting_ > 0)
    report(Reduction::falling, falling_sentence(falling, resting_, is_loaded));
  for (Finding& finding : findings_of(pieces_.parts, systems, pieces_.dimension)) {
    pieces_.findings.push_back(std::move(finding));
  }
  if (systems.empty()) {
    pieces_.system = make_mass_spring(
        {.dimension = pieces_.dimension, .offers_split = scene_.stiff_above.has_value()});
  } else if (systems.size() == 1) {
    pieces_.system = std::move(systems.front());
  } else {
    pieces_.system = std::make_unique<BlockDiagonalSystem>(std::move(systems));
  }
}

std::optional<DrawnPart> Steps::moving_part(PartMembers members) {
  DrawnPart drawn = drawn_part(std::move(members), pieces_.nodes, springs(), scene_);
  drawn.air_damping = scene_.air_damping;
  drawn.offers_split = scene_.stiff_above.has_value();
  if (!reductions_.has(Reduction::falling)) return drawn;
  let_fall(drawn);
  if (!rests(drawn)) return drawn;
  ++resting_;
  for (const std::size_t node : drawn.nodes) {
    pieces_.flying.push_back({drawn.fall, node});
  }
  return {};
}

Part Steps::faithful_part(DrawnPart& drawn) {
  const DrawnEnergies energies(drawn);
  Reductions reductions = reductions_;
  const auto with_these = [&] {
    if (drawn.springs.size() == 0) drawn.springs = drawn_springs(drawn, pieces_.nodes, springs());
    Part part(drawn, pieces_.dimension, reductions);
    drawn.springs = {};
    part.make_system();
    return part;
  };
  Part part = with_these();
  for (const Reduction suspect :
       {Reduction::mirror, Reduction::dimension, Reduction::constant_stiffness}) {
    if (!reductions.has(suspect)) continue;
    const auto difference = part.difference_from(drawn, energies);
    if (!difference) return part;
    report(suspect, mistaken_sentence(*difference));
    reductions = reductions.without(suspect);
    part = with_these();
  }
  if (const auto difference = part.difference_from(drawn, energies)) throw defect(*difference);
  return part;
}

}  // namespace

Pieces pieces_of(const Scene& scene, const Reductions& reductions) {
  return Steps(scene, reductions).taken();
}

}  // namespace qddot::reduce
