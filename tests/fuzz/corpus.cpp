#include "tests/fuzz/corpus.hpp"

namespace qddot {
inline namespace tests {

const std::vector<Sample>& corpus() {
  static const std::vector<Sample> samples = {
      {"links.toml",
       R"(name = "two links"
dimension = 2
gravity = [0.0, -9.81]
until = 0.5
start = "drawn"
stiff_above = 1e2
[[nodes]]
position = [0.0, 0.0]
pinned = true
[[nodes]]
position = [0.5, 0.0]
velocity = [0.0, -1e-3]
mass = 0.1
[[nodes]]
position = [1.0, 0]
mass = 0
[[springs]]
nodes = [0, 1]
stiffness = 1000.0
[[springs]]
nodes = [1, 2]
stiffness = 1_000
rest_length = 0.5 # m
quartic = 7.0
)"},
      {"inline.toml",
       R"(start = 'equilibrium'
dimension = 1
gravity = [1.5]
nodes = [{position = [0], pinned = true, mass = 3}, {position = [1.25], mass = 0x10},
         {position = [+2.5e0], velocity = [-0.0], mass = 1}]
springs = [{nodes = [0, 1], stiffness = 30, rest_length = 1.0},
           {nodes = [2, 1], stiffness = 60, rest_length = 0, quartic = 1e3}]
)"},
      {"space.toml",
       R"(name = 'Brücke \ "x"'
"dimension" = 3
[[nodes]]
position = [1e-3, -0.0, 2.5]
velocity = [5e-324, 1e308, -1]
mass = 1e-12
[[nodes]]
position = [0.1, 0.2, 0.30000000000000004]
mass = 2
[[springs]]
nodes = [1, 0]
stiffness = 0
)"},
      {"surface.toml",
       R"(gravity = [0.0, 0.0, -9.81]
until = 1
[mesh]
file = "tetrahedron.obj"
scale = 2
stiffness = 1e4
bending_stiffness = 10.0
total_mass = 2.0
[[mesh.pin]]
min = [-1, -1, -1]
max = [1, 1, 0.5]
[[mesh.pin]]
min = [0, 0, 0]
max = [0.5, 9, 9]
)"},
      {"medit.toml",
       "start = \"equilibrium\"\n[mesh]\nfile = \"glued.mesh\"\nstiffness = 5\nnode_mass = 1\n"},
      {"gmsh.toml",
       "dimension = 3\n[mesh]\nfile = \"new.msh\"\nstiffness = 5\nnode_mass = 0\n"
       "pin = [{min = [0, 0, 0], max = [0, 0, 0]}]\n"},
      {"cloth.toml",
       "until = 0.1\nstart = \"equilibrium\"\n[generator]\nkind = \"cloth\"\nnodes = 4\nside = "
       "2.5\n"
       "bending_stiffness = 0\n"},
      {"frame.toml",
       "stiff_above = 1_000\n[generator]\nkind = \"framed_cloth\"\nnodes = 3\nframe_stiffness = "
       "2e3\n"},
      {"lattice.toml",
       "name = \"\"\ngenerator = {kind = 'lattice', nodes_x = 3, nodes_y = 2, nodes_z = 2}\n"},
      {"chain.toml",
       "[generator]\nkind = \"chain\"\nnodes = 5\npinned_ends = 2\ngravity = -1.5\nuntil = 3\n"},
      {"orbit.toml", "[generator]\nkind = \"orbit\"\nrest_length = 0.0\nspeed = 1e-9\n"},
      {"tetrahedron.obj",
       "# a tetrahedron\nvt 0 0\nvn 0 0 1\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nv 0.5 0.25 1e0\n"
       "f 1 2 3\nf 1/1 2/1/1 4//1\nf -3 -2 -1\nf 1 3 4\nl 1 2 3 4\ns off\n"},
      {"polygons.obj",
       "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv +2 .5 -1e-3\nf 1 2 3 4\nf 2 3 5\nf 1 1 2 3\n"},
      {"glued.mesh",
       "MeshVersionFormatted 2\n# two tetrahedra\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n"
       "0 1 0 0\n0 0 1 0\n0 0 -1.5e0 0\nCorners\n2\n1\n2\nTriangles 1\n1 2 3 7\n"
       "Tetrahedra\n2\n1 2 3 4 0\n1 3 2 5 0\nEnd\n"},
      {"solid.mesh",
       "MeshVersionFormatted 1\nDimension 3\nHexahedra 1\n1 2 3 4 5 6 7 8 0\nVertices 9\n"
       "0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n.5 .5 2 0\n"
       "Pyramids 1\n5 6 7 8 9 0\nPrisms 1\n1 2 3 5 6 7 0\nQuadrilaterals 1\n1 2 3 4 0\n"
       "Edges 1\n1 9 0\n"},
      {"flat.mesh",
       "MeshVersionFormatted 1 Dimension 2 Vertices 4 0 0 0 1 0 0 1 1 0 0 1 0\n"
       "Triangles 2 1 2 3 0 1 3 4 0\n"},
      {"old.msh",
       "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"a b\"\n$EndPhysicalNames\n"
       "$Nodes\n5\n40 1 0 0\n7 0 0 0\n1000000000000 1 1 0\n8 0 1 0.5\n2 2 0.1 -1e-3\n$EndNodes\n"
       "$Elements\n5\n1 15 2 0 1 7\n2 1 0 7 8\n9 3 2 7 1 7 40 1000000000000 8\n"
       "4 2 3 -7 1 0 40 2 1000000000000\n5 2 0 7 40 1000000000000\n$EndElements\n"
       "$NodeData\n1\n\"u\"\n$EndNodeData\n"},
      {"new.msh",
       "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 7 0\n"
       "$EndEntities\n$Nodes\n3 5 2 99\n0 1 0 2\n40\n7\n1 0 0\n0 0 0\n2 1 1 2\n99\n8\n"
       "1 1 0 0.25 0.75\n0 1 0.5 0.5 0.5\n1 3 1 1\n2\n2 0.1 -1e-3 0.125\n$EndNodes\n"
       "$Elements\n4 5 1 9\n0 1 15 1\n1 7\n1 3 1 1\n2 7 8\n2 1 3 1\n9 7 40 99 8\n"
       "2 1 2 2\n4 40 2 99\n5 7 40 99\n$EndElements\n"},
      {"solid.msh",
       "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
       "5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 .5 .5 2\n$EndNodes\n$Elements\n4\n"
       "1 5 2 1 1 1 2 3 4 5 6 7 8\n2 6 0 1 2 3 5 6 7\n3 7 0 5 6 7 8 9\n4 4 0 1 2 3 9\n"
       "$EndElements\n"}};
  return samples;
}

}  // namespace tests
}  // namespace qddot
