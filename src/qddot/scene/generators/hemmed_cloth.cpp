// The cloth with a stiff hem: the structural springs along the three borders that are not between
// its pins. They bound the step of explicit methods; as rods (rods_above) they do not.
#include <algorithm>

#include "qddot/scene/generators/cloth_grid.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

std::vector<GeneratorParameter> parameters_of_hem() {
  auto all = cloth_parameters();
  all.push_back({"hem_stiffness", 1e7, least, most, "between neighbours on the hem in N/m"});
  return all;
}

Scene draw_hemmed_cloth(const GeneratorValues& p) {
  Scene scene = draw_cloth(p);
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  for (Spring& spring : scene.springs) {
    const auto [a, b] = spring.nodes;
    const std::size_t i = a / count, j = a % count, i2 = b / count, j2 = b % count;
    const bool along_side = i == i2 && j + 1 == j2 && (i == 0 || i == count - 1),
               along_end = i + 1 == i2 && j == j2 && j == count - 1;
    if (along_side || along_end) spring.law.stiffness = p.at("hem_stiffness");
  }
  const double cloth =
      std::max({p.at("structural_stiffness"), p.at("shear_stiffness"), p.at("bending_stiffness")});
  scene.stiff_above = std::max(cloth, cloth + 0.5 * (p.at("hem_stiffness") - cloth));
  return scene;
}

}  // namespace

Generator hemmed_cloth() {
  return {.name = "hemmed_cloth",
          .summary = "the cloth with a stiff hem, which may be of rods",
          .parameters = parameters_of_hem(),
          .size = cloth_size,
          .draw = draw_hemmed_cloth};
}

}  // namespace qddot
