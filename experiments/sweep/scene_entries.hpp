#pragma once

#include "experiments/sweep/study_file.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot::sweep {

// The scenes of one table of a study's list of scenes: { file = ... } or { generator = ... }, whose
// lists and ranges multiply. `horizons` [s] are the end times if the table has no `until`. Throws
// InvalidInput if the table is wrong, or if it would make more than `most` scenes.
std::vector<StudyScene> scenes_of(const TomlTable& entry, const toml::table& table,
                                  const std::vector<double>& horizons, double most);

// The numbers above 0 at a key: one, or a list of at least one, each once; none where it is
// missing.
std::vector<double> positive_numbers(const TomlTable& table, const toml::table& values,
                                     std::string_view key);

}  // namespace qddot::sweep
