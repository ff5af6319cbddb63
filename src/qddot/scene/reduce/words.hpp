#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "qddot/scene/reduce/reductions.hpp"

namespace qddot::reduce {

// The sentences that explain each reduction and why it is exact.
std::string pinned_sentence(std::size_t pins, std::size_t moving);
std::string merged_sentence(std::size_t gone, std::size_t left);
std::string condensed_sentence(const std::vector<std::size_t>& nodes, std::size_t series);
std::string flying_sentence(const std::vector<std::size_t>& nodes);
// Parts without pins: `falling` ones are integrated about their centres of mass, `resting` ones are
// at rest about theirs.
// Loads act on some of all parts if `is_loaded`.
std::string falling_sentence(std::size_t falling, std::size_t resting, bool is_loaded);
std::string parts_sentence(std::size_t parts);
// A sentence that says which reduction was left out of a part because it changed the part, and how.
std::string mistaken_sentence(const std::string& difference);
// The error of a scene whose start would have that difference with any reductions.
std::logic_error defect(const std::string& difference);

// Findings of the parts, each with its system: their subspaces, mirrors and constant K, with parts
// of one kind together. `dimension`: of the scene.
std::vector<Finding> findings_of(const std::vector<Part>& parts,
                                 const std::vector<std::unique_ptr<System>>& systems,
                                 int dimension);

}  // namespace qddot::reduce
