#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/command/command_line.hpp"

namespace qddot::command {

// What processes that divide a study among them can measure apart from each other.
struct Shares {
  std::vector<std::string> names{};
  // The options that choose them. A share is the same whatever others are asked for.
  std::vector<std::string> chosen_by{};
};

// The share that makes what all others measure against.
inline const std::string reference_share = "reference";

// Adds --list-shares, --share, --journal and --kept (see study.hpp).
void add_share_options(CommandLine& line);
// Whether --list-shares and --kept were given; no program needs to have them.
bool lists_shares(const CommandLine& line);
bool is_of_kept(const CommandLine& line);
// What --share and --journal were given; empty where they were not.
std::string share_of(const CommandLine& line);
std::string journal_of(const CommandLine& line);

// The name of the piece that says that a share is whole.
std::string whole_mark(const std::string& share);
// That piece: where and when it was measured, the seconds that the process took until now, and the
// failure in words, or null, where there is no reference to measure against.
nlohmann::json whole_record(const nlohmann::json& failure);

}  // namespace qddot::command
