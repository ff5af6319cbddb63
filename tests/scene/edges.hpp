#pragma once

#include <string>

#include <fmt/format.h>

#include "qddot/scene/mesh/mesh.hpp"

namespace qddot {
inline namespace tests {

// The edges of a mesh of up to ten vertices, each by its two ends: "01 02 12".
inline std::string edges_of(const mesh::Mesh& mesh) {
  std::string text;
  for (const auto& [i, j] : mesh.edges)
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", i, j);
  return text;
}

}  // namespace tests
}  // namespace qddot
