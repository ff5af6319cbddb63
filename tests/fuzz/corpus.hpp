#pragma once

#include <string>
#include <vector>

namespace qddot {
inline namespace tests {

// A small file that is read without complaint; the ending of its name says what it is.
struct Sample {
  std::string name, text;
};

// Scene files of all kinds, and meshes of all formats, which the scene files name.
const std::vector<Sample>& corpus();

}  // namespace tests
}  // namespace qddot
