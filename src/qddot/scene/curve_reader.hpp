#pragma once

#include <map>
#include <string>

#include "qddot/scene/scene.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot {

// Reads the curves of a scene file into Scene::curves. A curve is a table with some of
//   polynomial = [c_0, c_1, ...]     each c_k an array of the scene's dimension
//   harmonics = [{ amplitude = [..], frequency = Hz, phase = rad }, ...]
//                                    angular_frequency = rad/s in place of frequency
//   table = { times = [..], values = [[..], ..], interpolation = "spline" or "linear" }
// or the name of one of the file's [[curves]], which are such tables with a name.
class CurveReader {
 public:
  // Reads the [[curves]] of the file. The scene, whose dimension is known, must outlive this.
  CurveReader(const TomlTable& file, Scene& scene);

  // The number in Scene::curves of the curve at `key`; -1 without the key. Throws InvalidInput as
  // TomlTable does.
  int read(const TomlTable& table, std::string_view key) const;

 private:
  Scene& scene_;
  std::map<std::string, int> numbers_{};
};

}  // namespace qddot
