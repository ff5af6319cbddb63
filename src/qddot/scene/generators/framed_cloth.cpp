// The cloth in a stiff frame: the structural springs along its four borders. They alone bound the
// step of explicit methods, some thirty times below the cloth's own bound.
#include <algorithm>

#include "qddot/scene/generators/cloth_grid.hpp"
#include "qddot/scene/generators/ranges.hpp"

namespace qddot {
namespace {

std::vector<GeneratorParameter> parameters() {
  auto all = cloth_parameters();
  all.push_back({"frame_stiffness", 1e7, least, most, "between neighbours on a border in N/m"});
  return all;
}

Scene draw_framed_cloth(const GeneratorValues& p) {
  Scene scene = draw_cloth(p);
  const auto count = static_cast<std::size_t>(p.at("nodes"));
  const auto is_border = [&](std::size_t row) { return row == 0 || row == count - 1; };
  for (auto& [nodes, law, holds, stiff] : scene.springs) {
    const auto [a, b] = nodes;
    const std::size_t i = a / count, j = a % count, i2 = b / count, j2 = b % count;
    const bool along_j = i == i2 && j + 1 == j2, along_i = i + 1 == i2 && j == j2;
    if ((along_j && is_border(i)) || (along_i && is_border(j)))
      law.stiffness = p.at("frame_stiffness");
  }
  // The frame counts as stiff if it is stiffer than the whole cloth.
  const double cloth =
      std::max({p.at("structural_stiffness"), p.at("shear_stiffness"), p.at("bending_stiffness")});
  scene.stiff_above = std::max(cloth, cloth + 0.5 * (p.at("frame_stiffness") - cloth));
  return scene;
}

}  // namespace

Generator framed_cloth() {
  return {.name = "framed_cloth",
          .summary = "the cloth with stiff borders, which alone bound explicit steps",
          .parameters = parameters(),
          .size = cloth_size,
          .draw = draw_framed_cloth};
}

}  // namespace qddot
