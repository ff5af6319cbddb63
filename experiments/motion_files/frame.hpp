#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "experiments/motion_files/motion_file.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::motion_files {

// The cells of a picture, numbered in this order: a point for each node on no spring and no face, a
// line for each spring, a triangle for each face.
struct Cells {
  std::vector<std::size_t> points;
  std::vector<std::array<std::size_t, 2>> lines;
  std::vector<std::array<std::size_t, 3>> triangles;

  std::size_t count() const { return points.size() + lines.size() + triangles.size(); }
};

Cells cells_of(const Scene& scene);

// The number of bits after the first one that a field keeps: a rounding of 2^-8, the step of a
// colour scale of 256 shades. The zeros after them make files small.
constexpr int kept_bits = 7;

// The numbers of one frame, as a file holds them: node after node, x, y and z of each.
struct Frame {
  double time = 0;               // [s]
  std::vector<float> positions;  // [m], to the last bit of a 32-bit float
  // Rounded to kept_bits; empty if not requested.
  std::vector<float> velocities;        // [m/s]
  std::vector<float> kinetic_energies;  // [J]
  std::vector<float> distances;         // [m], to the reference
  // Zero but for springs, and NaN for springs that are broken; of all cells.
  std::vector<float> strains;
};

// Makes the frames of one scene.
class Framing {
 public:
  // `scene` must outlive it. `wanted`: the fields of frames beside positions.
  Framing(const Scene& start, const Model& scene, const Fields& wanted);

  // The frame of the state, with distances if there is a reference; the next call overwrites it.
  // nullptr if a number is not finite or beyond 32-bit floats, and from then on. The strain of a
  // broken spring does not count.
  const Frame* of(const State& state, const State* reference);
  const Fields& wanted() const { return wanted_; }
  // All nodes of the last frame.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  // These fill the fields of nodes and of springs, from number `first` to `end`. Bit 31 of the
  // result is set if a number is not finite or beyond 32-bit floats.
  std::uint32_t take_nodes(std::size_t first, std::size_t end);
  std::uint32_t take_strains(std::size_t first, std::size_t end);
  // Before take_strains: gives broken springs the length zero, so that their strain cannot
  // overflow.
  void leave_out_broken(const State& state);
  // After it: their strain is NaN.
  void mark_broken(const State& state);

  // A spring that can break: the number of its phase, that of the spring and the length of strains.
  struct Breakable {
    std::size_t phase, spring;
    double length;

    bool is_broken(const State& state) const {
      return state.phases && (*state.phases)[phase] == Phase::broken;
    }
  };

  const Model& scene_;
  Fields wanted_;
  std::vector<double> masses_;  // [kg], zero where pinned
  std::vector<std::array<std::uint32_t, 2>> springs_;
  std::vector<Node> nodes_, exact_nodes_;
  std::vector<double> lengths_;
  std::vector<Breakable> breakable_;
  std::size_t first_line_, cells_;
  Frame frame_;
  bool has_ended_ = false;
};

// The formats of motions (see open_motion). `framing` has framed the start.

// A motion as a point cache of version 1, with positions alone. An .obj beside it has the nodes at
// the start, the faces and all springs.
std::unique_ptr<MotionFile> open_pc2(const std::string& path, const Scene& start, Framing framing);

// A motion in the VTKHDF 2.0 layout of PolyData over time, and for all readers an .xdmf beside it.
// HDF5 is not made for several threads: one at a time may work on files of this kind.
std::unique_ptr<MotionFile> open_vtkhdf(const std::string& path, const Scene& start,
                                        Framing framing, bool has_reference, Readers readers);

}  // namespace qddot::motion_files
