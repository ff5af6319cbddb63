#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "qddot/scene/mesh/mesh.hpp"

namespace qddot::mesh {

// The size of an element with these corners: the length of a line [m], the area of a polygon [m^2],
// the volume of a solid [m^3] with 4 (tetrahedron), 5 (pyramid), 6 (prism) or 8 (hexahedron)
// corners. The area is that of the polygon's projection on its mean plane, which is exact where it
// is flat. The sides of a solid are bilinear.
double element_size(int dimension, std::span<const Eigen::Vector3d> corners);

// The mass of each vertex [kg]: every element of the mesh's highest dimension gives equal shares of
// its size times `density` [kg/m^3, kg/m^2 or kg/m] to its corners. For simplices and
// parallelepipeds that is the row sum of the consistent mass matrix. Elements with the same corners
// count once.
std::vector<double> lumped_masses(const Mesh& mesh, double density);

}  // namespace qddot::mesh
