#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "qddot/scene/mesh/mesh.hpp"

namespace qddot::mesh {

// Collects the groups of a mesh while its file is read.
class GroupCollection {
 public:
  // Adds vertices to the group of that dimension and tag.
  void add(int dimension, int tag, std::span<const std::size_t> vertices) {
    Group& group = at(dimension, tag);
    group.vertices.insert(group.vertices.end(), vertices.begin(), vertices.end());
  }
  void name(int dimension, int tag, std::string name) { at(dimension, tag).name = std::move(name); }

  // The groups that have vertices, by dimension and tag.
  std::vector<Group> all() const {
    std::vector<Group> all;
    for (const auto& [key, group] : groups_) {
      if (!group.vertices.empty()) all.push_back(group);
    }
    return all;
  }

 private:
  Group& at(int dimension, int tag) {
    Group& group = groups_[{dimension, tag}];
    group.dimension = dimension;
    group.tag = tag;
    return group;
  }

  std::map<std::pair<int, int>, Group> groups_;
};

}  // namespace qddot::mesh
