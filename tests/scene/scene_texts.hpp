#pragma once

#include <string>

#include "qddot/scene/scene_file.hpp"
#include "tests/scene/refusal.hpp"

namespace qddot {
inline namespace tests {

// Two nodes and a spring; each test spoils a part.
inline const std::string two_links =
    "name = 'two links'\n"
    "dimension = 2\n"
    "gravity = [0.0, -9.81]\n"
    "until = 0.5\n"
    "[[nodes]]\n"
    "position = [0.1, 0.0]\n"
    "mass = 0.1\n"
    "pinned = true\n"
    "[[nodes]]\n"
    "position = [3.1, 4]\n"
    "velocity = [0.0, -1e-3]\n"
    "mass = 2\n"
    "[[springs]]\n"
    "nodes = [0, 1]\n"
    "stiffness = 1000.0\n"
    "rest_length = 0.5\n"
    "quartic = 7.0\n";

inline const std::string tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";

inline const std::string mesh_scene =
    "[mesh]\n"
    "file = 'm.obj'\n"
    "scale = 2\n"
    "stiffness = 10\n"
    "total_mass = 8\n"
    "[[mesh.pin]]\n"
    "min = [-1, -1, 0.3]\n"
    "max = [1, 1, 3]\n";

// Reads a text as if it stood in the file a.toml, beside the meshes m.obj, a tetrahedron, q.obj, a
// quadrangle, and bad.obj.
inline Scene parsed(const std::string& text, const SceneLimits& limits = {}) {
  const auto mesh = [](const std::string& file) -> std::string {
    if (file == "m.obj") return tetrahedron;
    if (file == "q.obj") return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    return file == "bad.obj" ? "v 1 2\n" : read_text(file);
  };
  return parse_scene(text, "a.toml", "", limits, mesh);
}

// The sentence by which parsed() refuses the text; empty if it accepts it.
inline std::string refusal(const std::string& text) {
  return refusal_of([&] { parsed(text); });
}

}  // namespace tests
}  // namespace qddot
